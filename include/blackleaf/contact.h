// Contact: do two solids interfere, by how much, how far apart are they.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blackleaf/motion.h"
#include "blackleaf/octree.h"
#include "blackleaf/prepared_solid.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// True iff the interiors share a point, i.e. some voxel is black in both. Touching is not interference. Parallel
/// traversal that stops at the first hit (AN84, section 5). Throws Error(bad_argument) when depths differ.
/// O(min of the words).
bool interferes(const Octree& a, const Octree& b);

/// Voxels black in both, the volume of a and b. Throws as above. O(min of the words).
std::uint64_t overlap_volume(const Octree& a, const Octree& b);

/// The octree of what `a` shares with `b` moved, voxelised: intersect(a, move(b, motion_of_b, Leaving::clip)), bit for
/// bit, made only where `a` is. It has the frame of `a`; volume() measures it. Without a motion see intersect(). Throws
/// as above, and Error(cancelled). O(surface of both where both are, and of the overlap).
Octree overlap(const Octree& a, const Octree& b, const Motion& motion_of_b, const Work& work = {});

/// What a moved solid is taken for.
enum class Meaning {
  voxelised,  // the voxels that `move` makes of it; what is outside the universe does not count
  exact,      // its cubes, tilted, wherever they are: no rounding but that of the motion itself (FixedMotion)
};

/// True iff the interior of `a` and that of `b`, moved, share a point. Nothing is moved to find out. Voxelised it is
/// interferes(a, move(b, motion_of_b, Leaving::clip)), bit for bit; exact it is decided by separating axes in integers.
/// Touching is not interference. Leaving the universe is no error. Throws as above. O(pairs of nodes near contact).
bool interferes(const Octree& a, const Octree& b, const Motion& motion_of_b, Meaning meaning);
/// The same answer, sooner: for many questions about the same solids.
bool interferes(const PreparedSolid& a, const PreparedSolid& b, const Motion& motion_of_b, Meaning meaning);
/// The answers for many motions, in order, on all threads that `work` allows. Throws as above, and Error(cancelled).
std::vector<bool> interferes(const PreparedSolid& a, const PreparedSolid& b, std::span<const Motion> motions_of_b,
                             Meaning meaning, const Work& work = {});

/// Two nearest points of two solids.
struct Distance {
  double voxels = 0;                           // Euclidean; 0 when they touch or interfere
  std::int64_t squared = 0;                    // the same, exact
  std::array<std::int32_t, 3> on_a{}, on_b{};  // witness points, corners of the lattice
};
/// The distance of two solids of one universe, or none if one is empty. Throws as above. Branch and bound over pairs of
/// nodes.
std::optional<Distance> distance(const Octree& a, const Octree& b);

}  // namespace blackleaf
