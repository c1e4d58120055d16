// The inner loop of `move`: 64 voxel centres of a target brick looked up in the source at once, by SIMD where there is
// any.
//
// The centres of a brick, moved back, lie in a box less than 3 sqrt(3) = 5.2 voxels long, which with the closed cubes
// on both sides touches at most 7 voxels, so at most 4 pairs of voxels on an axis. Coordinates are therefore needed
// only modulo 8, and 8^3 voxels are 64 bytes, one for each 2^3 of them: the eight bricks of a cell of level 3 as they
// are stored. Where the box crosses from one cell to the next, each byte comes from the cell whose pair of voxels is in
// the box. Nothing is ever shifted.
//
// A coordinate has 16 bits: 3 of voxel and 13 of fraction. A centre is the sum of two terms that were cut, which loses
// less than two units of the last place; so with one unit added, a fraction that is neither 0 nor 1 has the right voxel
// and lies on no lattice plane. Any other centre is called unclear, and is left to exact arithmetic.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "neighbourhood.h"

namespace blackleaf::detail {

inline constexpr int kCentreBits = 13;  // of fraction

/// By axis: from the first centre of a brick to each of its 64; those with even and those with odd indices apart.
struct CentreSteps {
  std::array<std::array<std::uint16_t, 32>, 3> even{}, odd{};
};

/// Eight bricks in octant order: 8^3 voxels.
using Block = std::array<std::uint64_t, 8>;

/// What is asked about a brick, and the answer.
struct BrickLookUp {
  /// The first centre, one unit added.
  std::array<std::uint16_t, 3> first;
  /// The first pair of voxels of the box on every axis, 0..3 within its cell.
  std::array<std::uint8_t, 3> pair;
  /// The cell in which the box begins; how much farther the one is in which it ends, on every axis.
  std::uint8_t cell;
  std::array<std::uint8_t, 3> next;

  /// The voxels of the box; those at (x, y, z) modulo 8.
  Block around;
  std::uint64_t bits;     // of the target brick; unspecified where unclear
  std::uint64_t unclear;  // centres

  /// The colour of a source voxel. Requires: it is in the box.
  bool black(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const auto word = static_cast<std::size_t>((x >> 2 & 1) | (y >> 1 & 2) | (z & 4));
    const auto bit = (x >> 1 & 1) << 3 | (y >> 1 & 1) << 4 | (z >> 1 & 1) << 5 | (x & 1) | (y & 1) << 1 | (z & 1) << 2;
    return (around[word] >> bit & 1) != 0;
  }
};

/// Answers them. Requires: a source of level 3 that holds the boxes.
void look_up(const CentreSteps& steps, const Neighbourhood& source, std::span<BrickLookUp> bricks);

}  // namespace blackleaf::detail
