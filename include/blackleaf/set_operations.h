// Set operations on octrees of one universe.
#pragma once

#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// Voxel by voxel; the result has the frame of `a`. Throw Error(bad_argument) when depths differ.
/// O(words of both) by parallel traversal.
Octree unite(const Octree& a, const Octree& b, const Work& work = {});
Octree intersect(const Octree& a, const Octree& b, const Work& work = {});
Octree subtract(const Octree& a, const Octree& b, const Work& work = {});
Octree symmetric_difference(const Octree& a, const Octree& b, const Work& work = {});
/// The rest of the universe.
Octree complement(const Octree& a, const Work& work = {});

}  // namespace blackleaf
