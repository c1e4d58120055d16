#include "blackleaf/voxel_cursor.h"

#include <algorithm>

#include "node_arrays.h"

namespace blackleaf {

VoxelCursor::VoxelCursor(const Octree& octree)
    : octree_(octree), depth_(octree.depth()), words_(detail::level_words(octree)) {
  const Node root = detail::brick_level_root(octree);
  level_ = known_ = root.level();
  if (!root.is_gray()) {
    voxels_ = root.is_black() ? ~std::uint64_t{0} : 0;
  } else if (root.level() == 2) {
    voxels_ = root.word();
  } else {
    path_[static_cast<std::size_t>(known_)] = root.word();
    descend(known_);
  }
}

// Finds the leaf or brick of the last voxel; it and the one before have a node of level `common` in common.
void VoxelCursor::descend(int common) {
  int level = std::max(common, known_);
  std::uint64_t word = path_[static_cast<std::size_t>(level)];
  for (; level > 2; --level) {
    const auto below = static_cast<std::size_t>(level - 1);
    const auto octant = static_cast<unsigned>((x_ >> below & 1) | (y_ >> below & 1) << 1 | (z_ >> below & 1) << 2);
    known_ = level;
    level_ = level - 1;
    if ((word >> (8 + octant) & 1) == 0) {
      voxels_ = -(word >> octant & 1);
      return;
    }
    word = words_[below][detail::gray_child_index(word, octant)];
    path_[below] = word;
  }
  voxels_ = word;
}

}  // namespace blackleaf
