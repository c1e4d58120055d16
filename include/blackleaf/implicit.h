// Octrees of solids that are known by a question rather than by data.
#pragma once

#include <functional>

#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// The octree of a solid given by a classifier: black or white when every voxel of the cube has that colour, gray when
/// it cannot tell; for single voxels (level 0) it must answer black or white. Called from many threads.
/// O(gray answers).
Octree octree_from_classifier(int depth, const std::function<Colour(const Cube&)>& classify, Frame frame = {},
                              const Work& work = {});

/// Voxels whose centre is within `radius` of `centre` (closed ball), both in voxels.
Octree ball(int depth, const Eigen::Vector3d& centre, double radius, Frame frame = {});
/// The voxels [min, max) on every axis, cut to the universe.
Octree box(int depth, const std::array<std::int32_t, 3>& min, const std::array<std::int32_t, 3>& max, Frame frame = {});

}  // namespace blackleaf
