// Rows of values to rows of bits: the inner loop of building from voxels.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace blackleaf::detail {

/// Bit i is the predicate of value i. Requires: 0 <= count <= 64.
template <class T, class Inside>
std::uint64_t row_bits(const T* values, int count, const Inside& inside) {
  std::uint64_t bits = 0;
  for (int i = 0; i < count; ++i) bits |= std::uint64_t{inside(values[i])} << i;
  return bits;
}

/// The same for 64 values.
template <class T, class Inside>
std::uint64_t word_bits(const T* values, const Inside& inside) {
  return row_bits(values, 64, inside);
}

/// A closed range of values, prepared for row_bits(). NaN lies in none.
#ifndef __SSE2__

template <class T>
class InRange {
 public:
  InRange(T low, T high) : low_(low), high_(high) {}
  bool operator()(T value) const { return low_ <= value && value <= high_; }

 private:
  T low_, high_;
};

#else

// Sixteen values at a time: compared in vectors of 16 bytes, the verdicts (all ones or zero in each lane) narrowed to
// bytes by signed saturation, which keeps -1 and 0, and their top bits collected. Vectors know only signed `greater`
// for integers; so integers are asked whether they are outside, and unsigned ones compared with their top bits flipped.
template <class T>
class InRange {
 public:
  InRange(T low, T high) : low_(low), high_(high), lows_(fill(low)), highs_(fill(high)) {}

  bool operator()(T value) const { return low_ <= value && value <= high_; }

  std::uint64_t sixteen(const T* values) const { return verdicts(values) ^ (kOutside ? 0xFFFF : 0); }
  std::uint64_t sixty_four(const T* values) const {
    const std::uint64_t bits =
        verdicts(values) | verdicts(values + 16) << 16 | verdicts(values + 32) << 32 | verdicts(values + 48) << 48;
    return kOutside ? ~bits : bits;
  }

 private:
  static constexpr bool kOutside = std::is_integral_v<T>;
  using Lane = typename std::conditional_t<kOutside, std::make_signed<T>, std::type_identity<T> >::type;
  using Lanes [[gnu::vector_size(16)]] = Lane;

  static Lanes fill(T value) {
    std::array<T, 16 / sizeof(T)> lanes;
    lanes.fill(value);
    return load(lanes.data());
  }
  static Lanes load(const T* values) {
    Lanes lanes;
    std::memcpy(&lanes, values, sizeof lanes);
    if constexpr (std::is_unsigned_v<T>) lanes ^= std::numeric_limits<Lane>::min();
    return lanes;
  }

  std::uint64_t verdicts(const T* values) const {
    Vectors<sizeof(T)> verdicts;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      const Lanes lanes = load(values + i * (16 / sizeof(T)));
      if constexpr (kOutside)
        verdicts.v[i] = std::bit_cast<__m128i>((lows_ > lanes) | (lanes > highs_));
      else
        verdicts.v[i] = std::bit_cast<__m128i>((lows_ <= lanes) & (lanes <= highs_));
    }
    return static_cast<std::uint64_t>(_mm_movemask_epi8(narrow(verdicts)));
  }

  template <std::size_t kCount>
  struct Vectors {
    __m128i v[kCount];
  };

  static __m128i narrow(const Vectors<1>& a) { return a.v[0]; }
  static __m128i narrow(const Vectors<2>& a) { return _mm_packs_epi16(a.v[0], a.v[1]); }
  static __m128i narrow(const Vectors<4>& a) {
    return _mm_packs_epi16(_mm_packs_epi32(a.v[0], a.v[1]), _mm_packs_epi32(a.v[2], a.v[3]));
  }
  static __m128i narrow(const Vectors<8>& a) {
    const auto halves = [](__m128i p, __m128i q) {  // the low halves of four 64-bit lanes
      return _mm_castps_si128(_mm_shuffle_ps(_mm_castsi128_ps(p), _mm_castsi128_ps(q), _MM_SHUFFLE(2, 0, 2, 0)));
    };
    const Vectors<4> fours = {
        {halves(a.v[0], a.v[1]), halves(a.v[2], a.v[3]), halves(a.v[4], a.v[5]), halves(a.v[6], a.v[7])}};
    return narrow(fours);
  }

  T low_, high_;
  Lanes lows_, highs_;
};

template <class T>
std::uint64_t row_bits(const T* values, int count, const InRange<T>& inside) {
  std::uint64_t bits = 0;
  int i = 0;
  for (; i + 16 <= count; i += 16) bits |= inside.sixteen(values + i) << i;
  for (; i < count; ++i) bits |= std::uint64_t{inside(values[i])} << i;
  return bits;
}

/// The same for 64 values.
template <class T>
std::uint64_t word_bits(const T* values, const InRange<T>& inside) {
  return inside.sixty_four(values);
}

#endif

/// The voxels [x0, x1) of a row as bits, in words that begin at the multiples of 64, from the one at or before x0.
/// Bits of the last word beyond x1 are 0. Requires: x0 < x1.
template <class T, class Inside>
void row_words(const T* values, std::int64_t x0, std::int64_t x1, const Inside& inside, std::uint64_t* words) {
  const auto part = [&](std::int64_t end) {
    *words++ = row_bits(values, static_cast<int>(end - x0), inside) << (x0 & 63);
    values += end - x0;
    x0 = end;
  };
  if ((x0 & 63) != 0) part(std::min((x0 | 63) + 1, x1));
  for (; x0 + 64 <= x1; x0 += 64, values += 64) *words++ = word_bits(values, inside);
  if (x0 < x1) part(x1);
}

}  // namespace blackleaf::detail
