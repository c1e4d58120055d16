#include "block_tree.h"

#include <cassert>

namespace blackleaf::detail {

BlockTree::BlockTree(int depth, const std::array<std::int64_t, 3>& low, const std::array<std::int64_t, 3>& high)
    : depth_(depth) {
  assert(depth > kLevel);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first_[axis] = low[axis] >> kLevel;
    count_[axis] = ((high[axis] - 1) >> kLevel) + 1 - first_[axis];
  }
  blocks_.resize(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]));
}

bool BlockTree::misses(const Cube& cube) const {
  const std::int64_t side = cube.side();
  const auto apart = [&](std::int64_t begin, std::size_t axis) {
    return begin + side <= first_[axis] << kLevel || begin >= (first_[axis] + count_[axis]) << kLevel;
  };
  return apart(cube.x, 0) || apart(cube.y, 1) || apart(cube.z, 2);
}

std::size_t BlockTree::index(const Cube& block) const {
  assert(block.level == kLevel && !misses(block));
  const std::int64_t x = (block.x >> kLevel) - first_[0], y = (block.y >> kLevel) - first_[1],
                     z = (block.z >> kLevel) - first_[2];
  return static_cast<std::size_t>(x + count_[0] * (y + count_[1] * z));
}

std::uint8_t BlockTree::table(const Cube& block) const {
  std::uint8_t table = 0;
  for (int level = depth_ - 1; level >= kLevel; --level) {
    const int octant = (block.x >> level & 1) | (block.y >> level & 1) << 1 | (block.z >> level & 1) << 2;
    table = curve::kDigits[table][static_cast<std::size_t>(octant)].table;
  }
  return table;
}

Subtree BlockTree::join(const Cube& cube, std::uint8_t table, NodeArrays& arrays) {
  if (misses(cube)) return Subtree::uniform(Colour::white);
  if (cube.level == kLevel) return arrays.append(std::move(blocks_[index(cube)]));
  std::array<Subtree, 8> children;
  for (const curve::Step step : curve::kSteps[table])
    children[step.octant] = join(cube.child(step.octant), step.table, arrays);
  return arrays.close(cube.level, children);
}

Octree BlockTree::finish(Frame frame) {
  NodeArrays arrays;
  for (int level = 2; level < kLevel; ++level) {
    std::size_t count = 0;
    for (const PackedNode& block : blocks_) count += block.count(level);
    arrays.reserve(level, count);
  }
  const Subtree top = join({0, 0, 0, depth_}, 0, arrays);
  blocks_.clear();
  return arrays.finish(depth_, top, std::move(frame));
}

}  // namespace blackleaf::detail
