// BlockTree: a universe built block by block, in whatever order and on whatever thread the blocks of 64^3 voxels are
// finished, and joined along the Millar curve in the end. What is not yet joined takes the room of the octree itself.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blackleaf/octree.h"
#include "octree/node_arrays.h"
#include "octree/produce.h"

namespace blackleaf::detail {

class BlockTree {
 public:
  static constexpr int kLevel = 6;
  static constexpr std::int32_t kSide = std::int32_t{1} << kLevel;

  /// Every voxel outside [low, high) is white. Requires: depth > kLevel; 0 <= low < high <= 2^depth on every axis.
  BlockTree(int depth, const std::array<std::int64_t, 3>& low, const std::array<std::int64_t, 3>& high);

  /// Makes a block from what a producer (produce.h) says of it. Safe for different blocks at once. `scratch` must be
  /// empty and is left so. Requires: a cube of level kLevel that meets [low, high) and has not been made before.
  template <class Producer>
  void produce(const Producer& producer, const Cube& block, NodeArrays& scratch) {
    auto task = producer.root();
    blocks_[index(block)] = scratch.pack(produce_node(producer, task, block, table(block), scratch), kLevel);
  }

  /// The octree of the blocks; those that were not made are white. Leaves the object empty.
  Octree finish(Frame frame);

 private:
  bool misses(const Cube& cube) const;
  std::size_t index(const Cube& block) const;
  // The table with which the curve enters a block.
  std::uint8_t table(const Cube& block) const;
  Subtree join(const Cube& cube, std::uint8_t table, NodeArrays& arrays);

  int depth_;
  std::array<std::int64_t, 3> first_, count_;  // blocks
  std::vector<PackedNode> blocks_;             // x fastest
};

}  // namespace blackleaf::detail
