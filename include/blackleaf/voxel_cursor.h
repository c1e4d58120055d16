// VoxelCursor: the colours of voxels that are asked for one near the other.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "blackleaf/octree.h"

namespace blackleaf {

/// Remembers the path to the last voxel, so that the next one costs as many levels as lie below their common node, and
/// nothing where both are in one leaf or one brick of 4^3 voxels. Not for several threads at once; a copy for each.
/// Holds the octree.
class VoxelCursor {
 public:
  explicit VoxelCursor(const Octree& octree);

  /// As Octree::contains: voxels outside the universe are white. O(levels below the common node with the last voxel).
  bool contains(std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto outside = static_cast<std::uint64_t>(x | y | z) >> depth_;
    if (outside != 0) return false;
    const auto changed = static_cast<std::uint64_t>((x ^ x_) | (y ^ y_) | (z ^ z_));
    x_ = x;
    y_ = y;
    z_ = z;
    if (changed >> level_ != 0) descend(static_cast<int>(std::bit_width(changed)));
    const auto bit = (x >> 1 & 1) << 3 | (y >> 1 & 1) << 4 | (z >> 1 & 1) << 5 | (x & 1) | (y & 1) << 1 | (z & 1) << 2;
    return (voxels_ >> bit & 1) != 0;
  }

 private:
  void descend(int common);

  Octree octree_;
  int depth_;
  std::int64_t x_ = 0, y_ = 0, z_ = 0;
  // The leaf or brick that holds the last voxel: its level, and its voxels as a brick's; all bits alike in a leaf.
  int level_ = 0;
  std::uint64_t voxels_ = 0;
  int known_ = 0;                                    // the path holds from this level up
  std::array<std::uint64_t, kMaxDepth + 1> path_{};  // words of the gray nodes that hold the last voxel
  std::array<const std::uint64_t*, kMaxDepth + 1> words_{};
};

}  // namespace blackleaf
