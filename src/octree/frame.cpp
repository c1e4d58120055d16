#include "blackleaf/frame.h"

#include <Eigen/LU>
#include <cmath>

namespace blackleaf {

bool Frame::same_as(const Frame& other, double tolerance) const {
  const double voxel = axes.colwise().norm().minCoeff();
  return unit == other.unit && (origin - other.origin).norm() <= tolerance * voxel &&
         (axes - other.axes).cwiseAbs().maxCoeff() <= tolerance * voxel;
}

std::optional<std::array<std::int64_t, 3>> whole_shift(const Frame& from, const Frame& to) {
  if (!Frame{to.origin, from.axes, from.unit}.same_as(to)) return std::nullopt;
  const Eigen::Vector3d shift = to.axes.fullPivLu().solve(from.origin - to.origin);
  const Eigen::Vector3d whole = shift.array().round();
  // Geometry in file headers is rounded; what is left of a voxel after that must be far below one.
  constexpr double kTolerance = 1e-3;
  if (!((shift - whole).cwiseAbs().maxCoeff() <= kTolerance) || !(whole.cwiseAbs().maxCoeff() < 0x1p40))
    return std::nullopt;
  return std::array<std::int64_t, 3>{std::llround(whole[0]), std::llround(whole[1]), std::llround(whole[2])};
}

}  // namespace blackleaf
