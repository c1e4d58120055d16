// Rows of values to rows of bits: the inner loop of building from voxels.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

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
// bytes by signed saturation, which keeps -1 and 0, and their top bits collected.
template <class T>
class InRange {
 public:
  InRange(T low, T high) : low_(fill(low)), high_(fill(high)) {}

  bool operator()(T value) const { return low_[0] <= value && value <= high_[0]; }

  std::uint64_t sixteen(const T* values) const {
    constexpr std::size_t kLanes = 16 / sizeof(T);
    Vectors<sizeof(T)> verdicts;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      Lanes lanes;
      std::memcpy(&lanes, values + i * kLanes, sizeof lanes);
      const auto verdict = (low_ <= lanes) & (lanes <= high_);
      verdicts.v[i] = std::bit_cast<__m128i>(verdict);
    }
    return static_cast<std::uint64_t>(_mm_movemask_epi8(narrow(verdicts)));
  }

 private:
  using Lanes [[gnu::vector_size(16)]] = T;
  template <std::size_t kCount>
  struct Vectors {
    __m128i v[kCount];
  };

  static Lanes fill(T value) {
    std::array<T, 16 / sizeof(T)> lanes;
    lanes.fill(value);
    return std::bit_cast<Lanes>(lanes);
  }
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

  Lanes low_, high_;
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
  return inside.sixteen(values) | inside.sixteen(values + 16) << 16 | inside.sixteen(values + 32) << 32 |
         inside.sixteen(values + 48) << 48;
}

#endif

}  // namespace blackleaf::detail
