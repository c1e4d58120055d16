// What is drawn in the benchmarks.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "blackleaf/octree.h"

namespace blackleaf::bench {

/// The ball about the lattice point in the middle of the smallest universe that holds it.
Octree ball_of_radius(int radius);
/// From where it is seen: (12, -16, 15).
const Eigen::Vector3d& ball_direction();

/// Lattice edges of length 1 where the solid's boundary is not flat, hidden ones too.
std::uint64_t unit_feature_edges(const Octree& octree);

}  // namespace blackleaf::bench
