// Contact: do two solids interfere, by how much, how far apart are they.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "blackleaf/motion.h"
#include "blackleaf/octree.h"

namespace blackleaf {

/// True iff the interiors share a point, i.e. some voxel is black in both. Touching is not interference. Parallel
/// traversal that stops at the first hit (AN84, section 5). Throws Error(bad_argument) when depths differ.
/// O(min of the words).
bool interferes(const Octree& a, const Octree& b);

/// Voxels black in both, the volume of a and b. Throws as above. O(min of the words).
std::uint64_t overlap_volume(const Octree& a, const Octree& b);

/// True iff the interior of `a` and the interior of the exact moved solid of `b` share a point: tilted cubes, no
/// rounding but that of the motion itself (FixedMotion); decided by separating axes in 128-bit integers. Nothing is
/// voxelised, and leaving the universe is no error. Throws as above. O(pairs of nodes near contact).
bool interferes_exactly(const Octree& a, const Octree& b, const Motion& motion_of_b);

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
