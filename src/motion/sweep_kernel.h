// The inner loop of `sweep`: which of the 64 voxels of a brick a motion makes black, by SIMD where there is any.
//
// A coordinate of the source has 5 bits for the voxel and 27 for the fraction, as in centre_kernel.h. A centre is the
// sum of ten terms that were cut, which loses less than ten units of the last place; so a fraction that is not within
// kUnclear units of a whole number has the right voxel and lies on no lattice plane. A brick with any other centre is
// called unclear, and is left to exact arithmetic.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace blackleaf::detail {

/// 32^3 voxels of a source as rows along x: voxel (x, y, z) is bit x of row y + 32 z.
using SweepRows = std::array<std::uint32_t, 32 * 32>;

/// The centre of a brick's first voxel, in the rows, and from a voxel's centre to the next along each axis of the
/// target: step[axis of the target][axis of the source].
struct CutCentres {
  std::array<std::uint32_t, 3> first{};
  std::array<std::array<std::uint32_t, 3>, 3> step{};
};

inline constexpr int kSweepFraction = 27;
inline constexpr std::uint32_t kUnclear = 16;

/// The voxels of a brick, by bit, whose centres lie in black voxels; none if the brick is unclear. Requires: all
/// centres lie in the rows.
std::optional<std::uint64_t> covered_voxels(const CutCentres& centres, const SweepRows& rows);

}  // namespace blackleaf::detail
