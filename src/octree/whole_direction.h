// Directions as whole numbers, so that what follows from them can be decided exactly.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace blackleaf::detail {

/// The direction as coprime integers of at most 2^20 in size. Directions with whole-number components (up to 2^20 after
/// division by their greatest common divisor) are kept exactly; all others are rounded once to the nearest multiple of
/// 2^-20 of their largest component. Requires: finite and not zero.
std::array<std::int64_t, 3> whole_direction(const Eigen::Vector3d& direction);

/// Whether two directions, made whole, lie on one line. Requires: as above.
inline bool parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const std::array<std::int64_t, 3> p = whole_direction(a), q = whole_direction(b);
  return p == q || p == std::array<std::int64_t, 3>{-q[0], -q[1], -q[2]};  // both are coprime
}

}  // namespace blackleaf::detail
