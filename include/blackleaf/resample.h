// Resample: the same solid of the world on another lattice of voxels.
#pragma once

#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// The solid in the universe of that depth and frame: a voxel is black iff its centre, in the world, lies in a black
/// voxel of `octree`, whatever the sizes and directions of both. What lies outside the universe is dropped. Places are
/// computed in doubles: a centre within 2^-30 of the coordinates' size of a face may go to either side of it. Throws
/// Error(bad_argument) when the units differ ("unit" and "voxel", which meshes and bare octrees have, go with any) or a
/// frame has no volume, Error(cancelled). O(surface of the result * depth).
Octree resampled(const Octree& octree, const Frame& frame, int depth, const Work& work = {});

}  // namespace blackleaf
