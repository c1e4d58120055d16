// The kernels that grow solids by balls: which voxels of a small target node lie within the radius of a black voxel.
//
// Both are given the sites near the node and say the same; small_ball is the faster one for small radii, far_ball for
// large ones.
#pragma once

#include <array>
#include <cstdint>

#include "sites.h"
#include "tile.h"

namespace blackleaf::detail {

/// The largest whole number whose square is at most this. Requires: 0 <= square <= 2^50.
std::int64_t root_of(std::int64_t square);

/// A ball as discs: the voxels (x, y, z) with x^2 + y^2 + z^2 <= squared.
class SmallBall {
 public:
  static constexpr int kMostReach = 16;
  static constexpr int kTileLevel = 5;

  /// Requires: 0 <= squared < (kMostReach + 1)^2.
  explicit SmallBall(std::int64_t squared);

  /// The voxels of a target node within the ball of a black voxel of the sites. Bits of rows: a row of 64 source voxels
  /// is spread along x by every width of the ball at once, then spread rows are united over y for each of the ball's
  /// discs, then discs over z: O(reach^2) word operations a target row, whatever the solid.
  /// Requires: cube.level <= kTileLevel.
  Tile grow(const Sites& sites, const Cube& cube) const;

 private:
  int reach_;  // floor of the radius
  // half_[z][w]: the ball's voxels at distance z along z and w along x reach this far along y; -1: none.
  std::array<std::array<int, kMostReach + 1>, kMostReach + 1> half_{};
};

class FarBall {
 public:
  static constexpr int kTileLevel = 4;

  /// Requires: 0 <= squared < 2^50.
  explicit FarBall(std::int64_t squared) : squared_(squared) {}

  /// The same by squared distances, axis after axis (Felzenszwalb and Huttenlocher 2012; here a least over all rows in
  /// reach, as sums over 16 voxels at once, because a tile is short): along x from the nearest black voxels of every
  /// source row, over y, over z. Rows that cannot reach the tile any more are left out at each step.
  /// Requires: cube.level <= kTileLevel.
  Tile grow(const Sites& sites, const Cube& cube) const;

 private:
  std::int64_t squared_;
};

}  // namespace blackleaf::detail
