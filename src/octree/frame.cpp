#include "blackleaf/frame.h"

namespace blackleaf {

bool Frame::same_as(const Frame& other, double tolerance) const {
  const double voxel = axes.colwise().norm().minCoeff();
  return unit == other.unit && (origin - other.origin).norm() <= tolerance * voxel &&
         (axes - other.axes).cwiseAbs().maxCoeff() <= tolerance * voxel;
}

}  // namespace blackleaf
