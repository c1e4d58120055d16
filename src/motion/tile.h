// Tile: the voxels of a small target node as rows of bits, on the way from a kernel to the tree.
#pragma once

#include <array>
#include <cstdint>

#include "octree/node_arrays.h"

namespace blackleaf::detail {

/// Up to 32^3 voxels: voxel (x, y, z) from the tile's corner is bit x of rows[z][y].
struct Tile {
  static constexpr int kLevel = 5;
  static constexpr std::size_t kSide = std::size_t{1} << kLevel;

  std::array<std::array<std::uint32_t, kSide>, kSide> rows{};

  /// The node of the given level that the tile's voxels make, entered with `table`. Requires: 2 <= level <= 5; rows of
  /// a smaller node are only read as far as it goes.
  Subtree subtree(int level, std::uint8_t table, NodeArrays& arrays) const;
};

}  // namespace blackleaf::detail
