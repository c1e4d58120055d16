#include "blackleaf/resample.h"

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "blackleaf/error.h"
#include "blackleaf/implicit.h"

namespace blackleaf {
namespace {

using Place = std::array<std::int64_t, 3>;

struct Found {
  bool black = false, white = false;
  bool both() const { return black && white; }
};

// Which colours the voxels [low, high] of a node have.
void look(const Node& node, const Cube& cube, const Place& low, const Place& high, Found& found) {
  const std::array<std::int64_t, 3> corner = {cube.x, cube.y, cube.z};
  for (std::size_t i = 0; i < 3; ++i)
    if (high[i] < corner[i] || low[i] >= corner[i] + cube.side()) return;
  if (!node.is_gray()) {
    (node.is_black() ? found.black : found.white) = true;
    return;
  }
  for (int octant = 0; octant < 8 && !found.both(); ++octant)
    look(node.child(octant), cube.child(octant), low, high, found);
}

}  // namespace

Octree resampled(const Octree& octree, const Frame& frame, int depth, const Work& work) {
  const Frame& own = octree.frame();
  const auto unknown = [](const Frame& f) { return f.unit == "unit" || f.unit == "voxel"; };
  if (own.unit != frame.unit && !unknown(own) && !unknown(frame))
    throw Error(ErrorCode::bad_argument,
                "one octree is measured in '" + own.unit + "' and the other in '" + frame.unit + "'",
                "give both the same unit");
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(own.axes);
  if (!lu.isInvertible() || !(std::abs(frame.axes.determinant()) > 0))
    throw Error(ErrorCode::bad_argument, "a frame's axes lie in one plane", "build the octree with another frame");
  // A point p of the target is the point m p + c of the source.
  const Eigen::Matrix3d m = lu.solve(frame.axes);
  const Eigen::Vector3d c = lu.solve(frame.origin - own.origin);
  const Eigen::Vector3d reach = m.cwiseAbs().rowwise().sum();
  const auto floor = [](double x) {
    return static_cast<std::int64_t>(std::floor(std::min(std::max(x, -0x1p40), 0x1p40)));
  };
  const auto classify = [&](const Cube& cube) {
    const Eigen::Vector3d centre =
        m * (Eigen::Vector3d(cube.x, cube.y, cube.z) + Eigen::Vector3d::Constant(cube.side() / 2.0)) + c;
    Place low, high;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      // A little wider than the centres' box, for rounding.
      const double half = cube.level == 0 ? 0 : reach[axis] * (cube.side() - 1) / 2 * (1 + 0x1p-30) + 0x1p-10;
      low[i] = floor(centre[axis] - half);
      high[i] = floor(centre[axis] + half);
    }
    Found found;
    for (std::size_t i = 0; i < 3; ++i) found.white = found.white || low[i] < 0 || high[i] >= octree.side();
    look(octree.root(), octree.universe(), low, high, found);
    return found.both() ? Colour::gray : found.black ? Colour::black : Colour::white;
  };
  return octree_from_classifier(depth, classify, frame, work);
}

}  // namespace blackleaf
