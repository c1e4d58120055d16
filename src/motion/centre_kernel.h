// The inner loop of `move`: the voxels of eight bricks looked up at centres cut to 32 bits, by SIMD where there is any.
//
// A coordinate has 5 bits for the voxel and 27 for the fraction. A centre is the sum of two terms that were cut, which
// loses less than two units of the last place; so a fraction that is neither 0 nor all ones has the right voxel and
// lies on no lattice plane. A brick with any other centre is called unclear, and is left to exact arithmetic.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "voxel_rows.h"

namespace blackleaf::detail {

inline constexpr int kCentreBits = 27;  // of fraction

/// By axis, then by bit of a brick: from the first centre of a brick to each of its 64.
using CentreSteps = std::array<std::array<std::uint32_t, 64>, 3>;
/// By brick, then by axis: the first centre, relative to the origin of the rows.
using FirstCentres = std::array<std::array<std::uint32_t, 3>, 8>;

/// Sets bits[i] to the 64 voxels of brick i. Returns the bricks that are unclear, one bit each; their bits are
/// unspecified. Requires: all centres lie in the rows' range.
unsigned look_up(const FirstCentres& firsts, const CentreSteps& steps, const VoxelRows& rows,
                 std::array<std::uint64_t, 8>& bits);

/// The kernels that this machine can run, best first; the last is "scalar".
std::vector<std::string> centre_kernels();
/// Makes look_up use one of them from now on; the empty name is the best. For tests; not while look_up runs.
void use_centre_kernel(const std::string& name);

}  // namespace blackleaf::detail
