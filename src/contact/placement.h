// Placement: where a moved solid is, in doubles and exactly.
//
// The moved solid of b is the set of points X with (A X + c) / 2^38 in b's solid, A and c the integers of FixedMotion:
// a point X of a's universe is the point P(X) = (A X + c) / 2^38 of b's. All is done in b's frame, in which b's boxes
// are upright and a's are tilted. Their edges go along the columns of A / 2^38, which are of length 1 and at right
// angles up to 2^-37.
#pragma once

#include <array>
#include <cstdint>

#include "blackleaf/motion.h"

namespace blackleaf::detail {

class Placement {
 public:
  using Point = std::array<std::int64_t, 3>;

  explicit Placement(const FixedMotion& motion) : motion_(motion) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        turn_[i][j] = static_cast<double>(motion.inverse_rotation[i][j]) * 0x1p-38;  // exact: below 2^53
  }

  const FixedMotion& motion() const { return motion_; }
  /// A / 2^38, rows; exact.
  const std::array<std::array<double, 3>, 3>& turn() const { return turn_; }

  /// Twice P(X) in units of 2^-38 voxels, from twice X: exact. Requires: |2 X_i| <= 2^21; then it is below 2^62 + 2^60
  /// (motion.h).
  Point moved(const std::array<std::int32_t, 3>& doubled) const {
    Point result;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& a = motion_.inverse_rotation[i];
      result[i] = a[0] * doubled[0] + a[1] * doubled[1] + a[2] * doubled[2] + 2 * motion_.inverse_translation[i];
    }
    return result;
  }

  /// P(0) in voxels, off by 2^-53 of itself at most.
  std::array<double, 3> shift() const {
    std::array<double, 3> result;
    for (std::size_t i = 0; i < 3; ++i) result[i] = static_cast<double>(motion_.inverse_translation[i]) * 0x1p-38;
    return result;
  }

 private:
  FixedMotion motion_;
  std::array<std::array<double, 3>, 3> turn_{};
};

}  // namespace blackleaf::detail
