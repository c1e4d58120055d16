// Bounds in messages.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

namespace blackleaf::detail {

/// A number of four digits that is not below the value, nor much above it: a least length that users can type.
/// Requires: a finite value above 0.
inline std::string rounded_up(double value) {
  std::string digits(32, '\0');
  for (double most = value;; most *= 1 + 0x1p-12) {
    digits.resize(32);
    digits.resize(static_cast<std::size_t>(std::snprintf(digits.data(), digits.size(), "%.4g", most)));
    if (std::stod(digits) >= value) return digits;
  }
}

}  // namespace blackleaf::detail
