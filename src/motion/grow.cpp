#include "grow.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "grow_kernels.h"
#include "octree/produce.h"

namespace blackleaf::detail {
namespace {

// Ball: the kernel for target nodes of its kTileLevel.
template <class Ball>
class Grown {
 public:
  using Task = Sites;

  Grown(const Placed& solid, std::int64_t squared, int depth)
      : solid_(solid), squared_(squared), depth_(depth), ball_(squared) {}

  Task root() const {
    const auto corner = [&](std::size_t i) { return static_cast<std::int32_t>(solid_.corner[i]); };
    const Node node = brick_level_root(solid_.octree);
    Sites sites;
    if (!node.is_white()) sites.push_back({node, VoxelBox::of(Cube{corner(0), corner(1), corner(2), node.level()})});
    if (solid_.black_outside) {
      // Six half-spaces, as far as any target voxel may see.
      constexpr std::int32_t kFar = std::int32_t{1} << 23;
      for (std::size_t i = 0; i < 3; ++i) {
        VoxelBox box{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};
        box.high[i] = corner(i) - 1;
        sites.push_back({Node::uniform(kMaxDepth, Colour::black), box});
        box.high[i] = kFar;
        box.low[i] = corner(i) + solid_.octree.side();
        sites.push_back({Node::uniform(kMaxDepth, Colour::black), box});
      }
    }
    return near(sites, Cube{0, 0, 0, std::max(depth_, 2)});
  }

  Task child(const Task& task, const Cube& cube, int) const { return near(task, cube); }

  Colour classify(Task& task, const Cube& cube) const {
    if (task.empty()) return Colour::white;
    const VoxelBox box = VoxelBox::of(cube);
    const bool covered = std::any_of(task.begin(), task.end(), [&](const Site& s) { return covers(s, box, squared_); });
    return covered ? Colour::black : Colour::gray;
  }

  Subtree subtree(Task& task, const Cube& cube, std::uint8_t table, NodeArrays& arrays) const {
    const Colour colour = classify(task, cube);
    if (colour != Colour::gray) return Subtree::uniform(colour);
    if (cube.level <= Ball::kTileLevel) return ball_.grow(task, cube).subtree(cube.level, table, arrays);
    std::array<Subtree, 8> children;
    for (const curve::Step step : curve::kSteps[table]) {
      const Cube below = cube.child(step.octant);
      Task task_below = near(task, below);
      children[step.octant] = subtree(task_below, below, step.table, arrays);
    }
    return arrays.close(cube.level, children);
  }

 private:
  Sites near(const Sites& sites, const Cube& cube) const {
    Sites result;
    const VoxelBox box = VoxelBox::of(cube);
    for (const Site& site : sites) add_near(result, site, box, cube.level, squared_);
    return result;
  }

  Placed solid_;
  std::int64_t squared_;
  int depth_;  // of the target
  Ball ball_;
};

}  // namespace

Octree grow(const Placed& solid, std::int64_t squared, int depth, Frame frame, const Work& work) {
  assert(squared >= 0 && squared <= std::int64_t{1} << 44);
  constexpr std::int64_t kMost = SmallBall::kMostReach;
  if (squared < (kMost + 1) * (kMost + 1))
    return produce(Grown<SmallBall>(solid, squared, depth), depth, std::move(frame), work);
  return produce(Grown<FarBall>(solid, squared, depth), depth, std::move(frame), work);
}

}  // namespace blackleaf::detail
