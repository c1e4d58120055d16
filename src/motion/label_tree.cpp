#include "label_tree.h"

#include <cassert>
#include <limits>
#include <string>

#include "blackleaf/curve.h"
#include "blackleaf/error.h"

namespace blackleaf::detail {

// Reads the runs of a map in the order in which the curve asks for nodes.
class LabelTree::Builder {
 public:
  Builder(const LabelMap& map, LabelTree& tree) : map_(map), tree_(tree), left_(map.count(0)) {}

  Node node(int level, std::uint8_t table) {
    const std::uint64_t voxels = std::uint64_t{1} << (3 * level);
    if (left_ >= voxels) {
      const Node result = Node::of_label(map_.labels()[run_]);
      left_ -= voxels;
      if (left_ == 0 && ++run_ < map_.run_count()) left_ = map_.count(run_);
      return result;
    }
    std::array<Node, 8> children;
    for (const curve::Step step : curve::kSteps[table]) children[step.octant] = node(level - 1, step.table);
    return tree_.add(children);
  }

 private:
  const LabelMap& map_;
  LabelTree& tree_;
  std::size_t run_ = 0;
  std::uint64_t left_;  // voxels of the run
};

LabelTree::LabelTree(const LabelMap& map, int depth) {
  assert(depth >= map.depth());
  root_ = Builder(map, *this).node(map.depth(), 0);
  for (int level = map.depth(); level < depth; ++level) root_ = add({root_});
}

LabelTree::Node LabelTree::add(const std::array<Node, 8>& nodes) {
  if (children_.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::bad_argument, "the label map has more than 2^32 nodes", "move its labels one by one");
  Children& children = children_.emplace_back();
  for (std::size_t octant = 0; octant < 8; ++octant) {
    children.values[octant] = nodes[octant].label();
    children.inner |= (nodes[octant].has_one_label() ? 0u : 1u) << octant;
  }
  return Node(std::uint64_t{1} << 32 | (children_.size() - 1));
}

}  // namespace blackleaf::detail
