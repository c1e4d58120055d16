// From world to universe coordinates.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>

#include "blackleaf/error.h"
#include "blackleaf/frame.h"

namespace blackleaf::detail {

/// How far outside the universe a point may lie and still be put on its wall: what rounding can do to a mesh that was
/// placed to fill its universe.
inline constexpr double kWallTolerance = 0x1p-16;  // voxels

/// The map from world to universe coordinates. Axes along the world's are divided by, not multiplied with a rounded
/// inverse.
class ToUniverse {
 public:
  /// Throws Error(bad_argument) for axes that do not span space.
  explicit ToUniverse(const Frame& frame) : origin_(frame.origin), scale_(frame.axes.diagonal()) {
    const double size = frame.axes.colwise().norm().prod();
    if (!frame.axes.allFinite() || !frame.origin.allFinite() || !(std::abs(frame.axes.determinant()) > 1e-9 * size))
      throw Error(ErrorCode::bad_argument, "the frame's axes do not span space", "give three independent axes");
    diagonal_ = frame.axes.isDiagonal(0);
    if (!diagonal_) inverse_ = frame.axes.inverse();
  }
  Eigen::Vector3d operator()(const Eigen::Vector3d& world) const {
    const Eigen::Vector3d p = world - origin_;
    if (diagonal_) return p.cwiseQuotient(scale_);
    return inverse_ * p;
  }

 private:
  Eigen::Vector3d origin_, scale_;
  Eigen::Matrix3d inverse_;
  bool diagonal_;
};

}  // namespace blackleaf::detail
