// Extent: how far a moved solid reaches, whether it leaves its universe, and universes that are grown to hold it.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "blackleaf/motion.h"
#include "blackleaf/move.h"
#include "blackleaf/octree.h"

namespace blackleaf::detail {

/// The box of a moved solid on the target's axes, in units of 2^-38 voxels.
struct Extent {
  std::array<std::int64_t, 3> min{}, max{};
};

/// The extent of R X + T over all corners X of black cubes, R and T as in `motion`; each of the six bounds by branch
/// and bound over the tree. Requires: the octree is not empty.
Extent extent_of(const Octree& octree, const FixedMotion& motion);

/// A target universe: its depth, and where the corner of the original universe lies in it.
struct TargetUniverse {
  int depth = 0;
  std::array<std::int64_t, 3> offset{};
};

/// How an error names what leaves the universe, and the first remedy.
struct LeavingWords {
  std::string solid = "the moved solid", remedy = "move it less";
};

/// The universe for a solid of this extent: the old one if it holds it (up to 2^-16 voxels, see move.h) or when
/// clipping; doubled toward the sides where it is left when growing. Throws Error(out_of_universe) with the sides and
/// by how much.
TargetUniverse target_universe(int depth, const Extent& extent, Leaving leaving, const LeavingWords& words = {});

/// The frame of the target universe: world coordinates stay.
Frame grown_frame(const Frame& frame, const TargetUniverse& target);

}  // namespace blackleaf::detail
