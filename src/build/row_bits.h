// Rows of values to rows of bits.
#pragma once

#include <algorithm>
#include <cstdint>

#include "row_kernel.h"

namespace blackleaf::detail {

/// A closed range of values. NaN lies in none.
template <class T>
struct InRange {
  T low, high;
};

/// Bit i is the predicate of value i. Requires: 0 < count <= 64.
template <class T, class Inside>
std::uint64_t row_bits(const T* values, std::int64_t count, const Inside& inside) {
  std::uint64_t bits = 0;
  for (std::int64_t i = 0; i < count; ++i) bits |= std::uint64_t{inside(values[i])} << i;
  return bits;
}
template <class T>
std::uint64_t row_bits(const T* values, std::int64_t count, const InRange<T>& inside) {
  std::uint64_t bits = 0;
  range_bits(values, static_cast<std::size_t>(count), inside.low, inside.high, &bits);
  return bits;
}

/// The same of any number of values, 64 in a word. Requires: count > 0.
template <class T, class Inside>
void row_bits(const T* values, std::int64_t count, const Inside& inside, std::uint64_t* words) {
  for (std::int64_t i = 0; i < count; i += 64)
    *words++ = row_bits(values + i, std::min<std::int64_t>(64, count - i), inside);
}
template <class T>
void row_bits(const T* values, std::int64_t count, const InRange<T>& inside, std::uint64_t* words) {
  range_bits(values, static_cast<std::size_t>(count), inside.low, inside.high, words);
}

/// The voxels [x0, x1) of a row as bits, in words that begin at the multiples of 64, from the one at or before x0.
/// Bits of the last word beyond x1 are 0. Requires: x0 < x1.
template <class T, class Inside>
void row_words(const T* values, std::int64_t x0, std::int64_t x1, const Inside& inside, std::uint64_t* words) {
  if ((x0 & 63) != 0) {
    const std::int64_t end = std::min((x0 | 63) + 1, x1);
    *words++ = row_bits(values, end - x0, inside) << (x0 & 63);
    values += end - x0;
    x0 = end;
  }
  if (x0 < x1) row_bits(values, x1 - x0, inside, words);
}

}  // namespace blackleaf::detail
