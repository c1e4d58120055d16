// What a solid shares with a moved one, as an octree: the moved one is made only where the other is not white.
#include "blackleaf/contact.h"
#include "blackleaf/move.h"
#include "blackleaf/set_operations.h"
#include "motion/move_producer.h"
#include "octree/produce.h"
#include "octree/same_depth.h"

namespace blackleaf {
namespace {

using detail::MoveProducer;
using detail::Subtree;

class OverlapProducer {
 public:
  struct Task {
    Node a;
    MoveProducer::Task moved;  // unless a is white
  };

  OverlapProducer(const Octree& a, const Octree& b, const FixedMotion& motion) : a_(a), moved_(motion, b, a.depth()) {}

  Task root() const { return {a_.root(), moved_.root()}; }
  Colour classify(const Task& task, const Cube&) const {
    if (task.a.is_white() || task.moved.colour == Colour::white) return Colour::white;
    return task.a.is_black() && task.moved.colour == Colour::black ? Colour::black : Colour::gray;
  }
  Task child(const Task& task, const Cube& cube, int octant) const {
    Task below;
    below.a = task.a.child(octant);
    if (below.a.is_white()) return below;
    if (task.moved.colour == Colour::gray)
      below.moved = moved_.child(task.moved, cube, octant);
    else
      below.moved.colour = task.moved.colour;
    return below;
  }
  std::array<Subtree, 8> bricks(const Task& task, const Cube& cube) const {
    if (classify(task, cube) == Colour::white) return {};
    std::array<Subtree, 8> result = moved_.bricks(task.moved, cube);
    for (std::size_t octant = 0; octant < 8; ++octant) {
      Subtree& moved = result[octant];
      const std::uint64_t bits = moved.colour == Colour::gray ? moved.word : moved.colour == Colour::black ? kAll : 0;
      moved = Subtree::brick(bits & task.a.child(static_cast<int>(octant)).brick());
    }
    return result;
  }
  // Only universes of less than 8^3 voxels are asked for bricks, and these are not made here.
  std::uint64_t brick(const Task&, const Cube&) const { return 0; }

 private:
  static constexpr std::uint64_t kAll = ~std::uint64_t{0};

  const Octree& a_;
  MoveProducer moved_;
};

}  // namespace

Octree overlap(const Octree& a, const Octree& b, const Motion& motion_of_b, const Work& work) {
  detail::require_same_depth(a, b);
  if (a.is_empty() || b.is_empty() || !(motion_of_b.translation().norm() <= FixedMotion::kMaxTranslation))
    return Octree(a.depth(), Colour::white, a.frame());
  if (a.depth() < 3) return intersect(a, move(b, motion_of_b, Leaving::clip, work), work);
  return detail::produce(OverlapProducer(a, b, FixedMotion(motion_of_b)), a.depth(), a.frame(), work);
}

}  // namespace blackleaf
