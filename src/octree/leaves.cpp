#include "blackleaf/leaves.h"

#include "blackleaf/curve.h"

namespace blackleaf {
namespace {

template <class Visit>
void walk(const Node& node, const Cube& cube, std::uint64_t first, std::uint8_t table, Visit& visit) {
  if (!node.is_gray()) {
    visit(Leaf{cube, first}, node.is_black());
    return;
  }
  const std::uint64_t voxels = std::uint64_t{1} << (3 * (cube.level - 1));
  for (const curve::Step step : curve::kSteps[table]) {
    walk(node.child(step.octant), cube.child(step.octant), first, step.table, visit);
    first += voxels;
  }
}

}  // namespace

void for_each_leaf(const Octree& octree, const std::function<void(const Leaf&, bool)>& visit) {
  walk(octree.root(), octree.universe(), 0, 0, visit);
}

void for_each_black_leaf(const Octree& octree, const std::function<void(const Leaf&)>& visit) {
  auto if_black = [&](const Leaf& leaf, bool black) {
    if (black) visit(leaf);
  };
  walk(octree.root(), octree.universe(), 0, 0, if_black);
}

std::vector<Leaf> black_leaves(const Octree& octree) {
  std::vector<Leaf> leaves;
  for_each_black_leaf(octree, [&](const Leaf& leaf) { leaves.push_back(leaf); });
  return leaves;
}

}  // namespace blackleaf
