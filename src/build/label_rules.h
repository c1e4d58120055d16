// How rows of values become rows of labels: one rule each for whole numbers, bands and functions of the caller's.
//
//   struct Rule {
//     using Label = ...;                                                 // uint8, uint16 or uint32: holds every label
//     bool operator()(const T* values, std::int64_t count, Label* labels) const;  // false: a value is no label
//   };
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "blackleaf/label_voxels.h"

namespace blackleaf::detail {

/// The value itself.
template <class T>
struct WholeNumberRule {
  using Label = std::conditional_t<sizeof(T) == 1, std::uint8_t,
                                   std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint32_t>>;
  /// Rows of values are rows of labels as they stand.
  static constexpr bool kSame = std::is_same_v<T, Label>;

  bool operator()(const T* values, std::int64_t count, Label* labels) const {
    if constexpr (std::is_floating_point_v<T>) {
      bool good = true;
      for (std::int64_t i = 0; i < count; ++i) {
        const bool in_range = values[i] >= 0 && values[i] < T{0x1p32};
        labels[i] = in_range ? static_cast<Label>(values[i]) : 0;
        good &= in_range && static_cast<T>(labels[i]) == values[i];
      }
      return good;
    } else {
      // The bits that a label has not: of the sign, and of what is beyond 32 bits.
      using Bits = std::make_unsigned_t<T>;
      Bits extra = 0;
      for (std::int64_t i = 0; i < count; ++i) {
        const auto bits = static_cast<Bits>(values[i]);
        extra = static_cast<Bits>(extra | bits);
        labels[i] = static_cast<Label>(bits);
      }
      if (std::is_signed_v<T> && extra >> (8 * sizeof(T) - 1) != 0) return false;
      if constexpr (sizeof(T) == 8) return extra >> 32 == 0;
      return true;
    }
  }
};

/// The least value of T that is not below a number; none if all are.
template <class T>
std::optional<T> least_from(double bound) {
  if constexpr (std::is_integral_v<T>) {
    // 2^digits is the first whole number above the type's; unlike the largest value it is a double exactly.
    const double above = std::ldexp(1.0, std::numeric_limits<T>::digits);
    bound = std::ceil(bound);
    if (bound >= above) return std::nullopt;
    if (bound <= (std::is_signed_v<T> ? -above : 0.0)) return std::numeric_limits<T>::min();
    return static_cast<T>(bound);
  } else if constexpr (std::is_same_v<T, float>) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    // Beyond the largest float the conversion would not be defined.
    if (bound > double{kLargest}) return std::numeric_limits<float>::infinity();
    if (bound < -double{kLargest}) return -kLargest;
    const auto value = static_cast<float>(bound);
    return double{value} < bound ? std::nextafter(value, std::numeric_limits<float>::infinity()) : value;
  } else {
    return bound;
  }
}

/// The number of thresholds not above the value.
template <class T, class L>
class BandRule {
 public:
  using Label = L;
  static constexpr bool kSame = false;

  /// Requires: the thresholds are finite and do not decrease; L holds their number.
  explicit BandRule(const std::vector<double>& thresholds) {
    for (const double threshold : thresholds)
      if (const std::optional<T> least = least_from<T>(threshold)) bounds_.push_back(*least);
  }

  bool operator()(const T* values, std::int64_t count, L* labels) const {
    if (bounds_.size() > kFew) {
      for (std::int64_t i = 0; i < count; ++i) labels[i] = search(values[i]);
      return true;
    }
    // A whole piece is compared with one threshold after the other: the compiler makes vectors of that.
    constexpr std::int64_t kPiece = 64;
    std::int64_t done = 0;
    for (; done + kPiece <= count; done += kPiece) {
      std::array<T, kPiece> piece;
      std::copy_n(values + done, kPiece, piece.begin());
      std::array<L, kPiece> sums{};
      for (const T bound : bounds_)
        for (std::size_t i = 0; i < kPiece; ++i) sums[i] = static_cast<L>(sums[i] + (piece[i] >= bound ? 1 : 0));
      std::copy_n(sums.begin(), kPiece, labels + done);
    }
    for (; done < count; ++done) labels[done] = search(values[done]);
    return true;
  }

 private:
  static constexpr std::size_t kFew = 16;

  L search(T value) const {
    if constexpr (std::is_floating_point_v<T>) {
      if (std::isnan(value)) return 0;
    }
    return static_cast<L>(std::upper_bound(bounds_.begin(), bounds_.end(), value) - bounds_.begin());
  }

  std::vector<T> bounds_;
};

/// What the caller's function says.
template <class T>
class FunctionRule {
 public:
  using Label = std::uint32_t;
  static constexpr bool kSame = false;

  explicit FunctionRule(LabelOf<T> label_of) : label_of_(std::move(label_of)) {}

  bool operator()(const T* values, std::int64_t count, Label* labels) const {
    for (std::int64_t i = 0; i < count; ++i)
      labels[i] = i > 0 && values[i] == values[i - 1] ? labels[i - 1] : label_of_(values[i]);
    return true;
  }

 private:
  LabelOf<T> label_of_;
};

}  // namespace blackleaf::detail
