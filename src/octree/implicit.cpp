#include "blackleaf/implicit.h"

#include <algorithm>
#include <string>

#include "blackleaf/error.h"
#include "brick.h"
#include "produce.h"

namespace blackleaf {
namespace {

struct ClassifierProducer {
  struct Task {};
  const std::function<Colour(const Cube&)>& ask;
  int depth;

  Task root() const { return {}; }
  Colour classify(Task&, const Cube& cube) const { return cube.level > depth ? Colour::gray : ask(cube); }
  Task child(const Task&, const Cube&, int) const { return {}; }
  std::uint64_t brick(const Task&, const Cube& cube) const {
    std::uint64_t bits = 0;
    for (int octant = 0; octant < (depth == 1 ? 1 : 8); ++octant) {
      const Cube below = cube.child(octant);
      const Colour colour = ask(below);
      std::uint64_t byte = colour == Colour::black ? 0xFF : 0;
      if (colour == Colour::gray)
        for (int voxel = 0; voxel < 8; ++voxel)
          byte |= std::uint64_t{ask(below.child(voxel)) == Colour::black} << voxel;
      bits |= byte << (8 * octant);
    }
    return bits;
  }
};

}  // namespace

Octree octree_from_classifier(int depth, const std::function<Colour(const Cube&)>& classify, Frame frame,
                              const Work& work) {
  if (depth < 1 || depth > kMaxDepth)
    throw Error(ErrorCode::bad_argument, "depth " + std::to_string(depth) + " is out of range", "use 1 to 20");
  return detail::produce(ClassifierProducer{classify, depth}, depth, std::move(frame), work);
}

Octree ball(int depth, const Eigen::Vector3d& centre, double radius, Frame frame) {
  const auto classify = [&](const Cube& cube) {
    // The voxel centres of the cube span [low, high]; compare the nearest and the farthest of them with the radius.
    const Eigen::Vector3d low = Eigen::Vector3d(cube.x, cube.y, cube.z).array() + 0.5;
    const Eigen::Vector3d high = low.array() + (cube.side() - 1.0);
    const Eigen::Vector3d nearest = centre.cwiseMax(low).cwiseMin(high);
    const Eigen::Vector3d farthest = (centre - low).cwiseAbs().cwiseMax((centre - high).cwiseAbs());
    if ((centre - nearest).squaredNorm() > radius * radius) return Colour::white;
    if (farthest.squaredNorm() <= radius * radius) return Colour::black;
    return Colour::gray;
  };
  return octree_from_classifier(depth, classify, std::move(frame));
}

Octree box(int depth, const std::array<std::int32_t, 3>& min, const std::array<std::int32_t, 3>& max, Frame frame) {
  const auto classify = [&](const Cube& cube) {
    const std::array<std::int32_t, 3> low = {cube.x, cube.y, cube.z};
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t high = low[i] + cube.side();
      if (high <= min[i] || low[i] >= max[i]) return Colour::white;
      inside = inside && min[i] <= low[i] && high <= max[i];
    }
    return inside ? Colour::black : Colour::gray;
  };
  return octree_from_classifier(depth, classify, std::move(frame));
}

}  // namespace blackleaf
