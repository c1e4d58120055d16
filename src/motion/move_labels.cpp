// Label maps in arbitrary motion: as octrees are, with labels for colours. A target node's centres, moved back, touch
// at most three source nodes of its level on an axis; where these have one label so has the node, elsewhere it is
// split, down to voxels.
#include <algorithm>
#include <array>
#include <optional>

#include "blackleaf/move.h"
#include "extent.h"
#include "label_tree.h"
#include "moved_back.h"
#include "produce_labels.h"

namespace blackleaf {
namespace {

using detail::CellRange;
using detail::LabelTree;

class MovedLabels {
 public:
  struct Task {
    Cube cube;
    std::array<std::int64_t, 3> low, size;   // source cells of the cube's level
    std::array<LabelTree::Node, 27> source;  // x + 3 (y + 3 z) from the lowest
  };

  MovedLabels(const FixedMotion& motion, const LabelMap& map, int depth)
      : back_(motion), tree_(map, depth), depth_(depth) {}

  Task root() const {
    return at({0, 0, 0, depth_}, [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      return (x | y | z) == 0 ? tree_.root() : LabelTree::Node::of_label(0);
    });
  }

  Task child(const Task& task, int, unsigned octant) const {
    return at(task.cube.child(static_cast<int>(octant)), [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      return tree_.child(task.source[index(task, x >> 1, y >> 1, z >> 1)],
                         static_cast<unsigned>((x & 1) | (y & 1) << 1 | (z & 1) << 2));
    });
  }

  std::optional<std::uint32_t> label(const Task& task, int level) const {
    const LabelTree::Node first = task.source[0];
    std::uint32_t largest = 0;  // of the closed voxels that hold a voxel's centre
    for (std::int64_t z = 0; z < task.size[2]; ++z)
      for (std::int64_t y = 0; y < task.size[1]; ++y)
        for (std::int64_t x = 0; x < task.size[0]; ++x) {
          const LabelTree::Node node = task.source[static_cast<std::size_t>(x + 3 * (y + 3 * z))];
          if (level > 0 && !(node.has_one_label() && node == first)) return std::nullopt;
          largest = std::max(largest, node.label());
        }
    return largest;
  }

 private:
  static std::size_t index(const Task& task, std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::size_t>((x - task.low[0]) + 3 * ((y - task.low[1]) + 3 * (z - task.low[2])));
  }

  template <class NodeOf>
  Task at(const Cube& cube, NodeOf node_of) const {
    const CellRange cells = back_.box(cube).cells(cube.level);
    Task task;
    task.cube = cube;
    task.low = cells.low;
    for (std::size_t i = 0; i < 3; ++i) task.size[i] = cells.high[i] - cells.low[i] + 1;
    for (std::int64_t z = cells.low[2]; z <= cells.high[2]; ++z)
      for (std::int64_t y = cells.low[1]; y <= cells.high[1]; ++y)
        for (std::int64_t x = cells.low[0]; x <= cells.high[0]; ++x)
          task.source[index(task, x, y, z)] = node_of(x, y, z);
    return task;
  }

  detail::MovedBack back_;
  LabelTree tree_;
  int depth_;
};

}  // namespace

LabelMap move(const LabelMap& map, const Motion& motion, Leaving leaving, const Work& work) {
  const Octree solid = octree_from_labels(map);
  if (solid.is_empty()) return map;
  if (leaving == Leaving::clip && motion.translation().norm() > FixedMotion::kMaxTranslation)
    return LabelMap(map.depth(), map.frame());
  const FixedMotion fixed(motion);
  const auto target = detail::target_universe(map.depth(), detail::extent_of(solid, fixed), leaving);
  return detail::produce_labels(MovedLabels(fixed.shifted(target.offset), map, target.depth), target.depth,
                                detail::grown_frame(map.frame(), target), work);
}

}  // namespace blackleaf
