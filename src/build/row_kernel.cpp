#include "row_kernel.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "octree/simd_kernels.h"

// Highway compiles what follows once for every instruction set, and chooses when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "build/row_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BLACKLEAF_VOLUME_TYPES  // this file is read once for every instruction set
#define BLACKLEAF_VOLUME_TYPES(DO) \
  DO(uint8_t) DO(int8_t) DO(uint16_t) DO(int16_t) DO(uint32_t) DO(int32_t) DO(float) DO(double)
#endif

HWY_BEFORE_NAMESPACE();
namespace blackleaf::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Of whole words.
template <class T>
HWY_INLINE void range_lanes(const T* values, std::size_t words, T low, T high, std::uint64_t* out) {
  const hn::CappedTag<T, 64> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto inside = [&](const T* from) {
    const auto v = hn::LoadU(d, from);
    if constexpr (std::is_floating_point_v<T>) {
      return hn::And(hn::Ge(v, hn::Set(d, low)), hn::Le(v, hn::Set(d, high)));
    } else {
      // How far it is above low, modulo 2^n, is at most high - low.
      const hn::RebindToUnsigned<decltype(d)> du;
      using U = hn::TFromD<decltype(du)>;
      const auto above = hn::Sub(hn::BitCast(du, v), hn::Set(du, static_cast<U>(low)));
      const auto most = hn::Set(du, static_cast<U>(static_cast<U>(high) - static_cast<U>(low)));
      return hn::RebindMask(d, hn::Eq(hn::Min(above, most), above));
    }
  };
  for (std::size_t word = 0; word < words; ++word, values += 64) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < 64; i += lanes) {
      std::array<std::uint8_t, 8> part{};  // as many bits as there are lanes
      hn::StoreMaskBits(d, inside(values + i), part.data());
      std::uint64_t of_part;
      std::memcpy(&of_part, part.data(), sizeof(of_part));
      bits |= (lanes < 64 ? of_part & ((std::uint64_t{1} << lanes) - 1) : of_part) << i;
    }
    out[word] = bits;
  }
}

#define BLACKLEAF_RANGE_LANES(T)                                                                \
  void range_lanes_##T(const T* values, std::size_t words, T low, T high, std::uint64_t* out) { \
    range_lanes<T>(values, words, low, high, out);                                              \
  }
BLACKLEAF_VOLUME_TYPES(BLACKLEAF_RANGE_LANES)
#undef BLACKLEAF_RANGE_LANES

}  // namespace HWY_NAMESPACE
}  // namespace blackleaf::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blackleaf::detail {
namespace {

#define BLACKLEAF_RANGE_WORDS(T)                                                            \
  HWY_EXPORT(range_lanes_##T);                                                              \
  void range_words(const T* values, std::size_t words, T low, T high, std::uint64_t* out) { \
    HWY_DYNAMIC_DISPATCH(range_lanes_##T)(values, words, low, high, out);                   \
  }
BLACKLEAF_VOLUME_TYPES(BLACKLEAF_RANGE_WORDS)
#undef BLACKLEAF_RANGE_WORDS

template <class T>
void range_scalar(const T* values, std::size_t count, T low, T high, std::uint64_t* words) {
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 64 == 0) words[i / 64] = 0;
    words[i / 64] |= std::uint64_t{low <= values[i] && values[i] <= high} << (i % 64);
  }
}

}  // namespace

template <class T>
void range_bits(const T* values, std::size_t count, T low, T high, std::uint64_t* words) {
  if (scalar_kernel_wanted()) return range_scalar(values, count, low, high, words);
  const std::size_t whole = count / 64, rest = count % 64;
  if (!(low <= high)) {
    std::fill_n(words, whole + (rest > 0 ? 1 : 0), 0);
    return;
  }
  if (whole > 0) range_words(values, whole, low, high, words);
  if (rest == 0) return;
  std::array<T, 64> last{};
  std::copy_n(values + 64 * whole, rest, last.data());
  range_words(last.data(), 1, low, high, words + whole);
  words[whole] &= (std::uint64_t{1} << rest) - 1;
}

#define BLACKLEAF_INSTANTIATE(T) template void range_bits<T>(const T*, std::size_t, T, T, std::uint64_t*);
BLACKLEAF_VOLUME_TYPES(BLACKLEAF_INSTANTIATE)
#undef BLACKLEAF_INSTANTIATE

}  // namespace blackleaf::detail
#endif  // HWY_ONCE
