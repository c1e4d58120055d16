// Ranges of values, asked for as doubles, in the type that a volume's values have.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>

#include "blackleaf/volume_file.h"
#include "blackleaf/voxels.h"

namespace blackleaf::detail {

template <class T>
constexpr ValueRange<T> empty_range() {
  return {T{1}, T{0}};
}

/// The values v of T with low <= v <= high, compared as exact numbers; a range whose low exceeds its high if none.
/// Requires: neither bound is NaN.
template <class T>
ValueRange<T> range_between(double low, double high) {
  using Limits = std::numeric_limits<T>;
  if constexpr (std::is_integral_v<T>) {
    low = std::ceil(low);
    high = std::floor(high);
    // 2^digits is the first whole number above the type's; unlike the largest value it is a double exactly.
    const double above = std::ldexp(1.0, Limits::digits);
    const double lowest = std::is_signed_v<T> ? -above : 0.0;
    if (low > high || low >= above || high < lowest) return empty_range<T>();
    return {low <= lowest ? Limits::min() : static_cast<T>(low), high >= above ? Limits::max() : static_cast<T>(high)};
  } else if constexpr (std::is_same_v<T, double>) {
    return {low, high};
  } else {
    const auto rounded = [](double bound, bool up) {
      constexpr double kLargest = std::numeric_limits<float>::max();
      constexpr float kInfinity = std::numeric_limits<float>::infinity();
      // Beyond the largest float only infinity is left; the conversion itself would not be defined there.
      if (bound > kLargest) return up || std::isinf(bound) ? kInfinity : std::numeric_limits<float>::max();
      if (bound < -kLargest) return up && !std::isinf(bound) ? -std::numeric_limits<float>::max() : -kInfinity;
      const auto value = static_cast<float>(bound);
      if (up && value < bound) return std::nextafter(value, kInfinity);
      if (!up && value > bound) return std::nextafter(value, -kInfinity);
      return value;
    };
    return {rounded(low, true), rounded(high, false)};
  }
}

/// The range that the options ask for. Requires: options that check_options has passed.
template <class T>
ValueRange<T> wanted_range(const VolumeOptions& options) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (options.label) return range_between<T>(*options.label, *options.label);
  if (options.low || options.high)
    return range_between<T>(options.low.value_or(-kInfinity), options.high.value_or(kInfinity));
  if constexpr (std::is_integral_v<T>) {
    return {T{1}, std::numeric_limits<T>::max()};
  } else {
    return {std::numeric_limits<T>::denorm_min(), std::numeric_limits<T>::infinity()};
  }
}

}  // namespace blackleaf::detail
