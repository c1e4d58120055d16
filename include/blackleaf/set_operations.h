// Set operations on octrees of one universe.
//
// Where one operand is of one colour the result is the other's subtree, copied a level at a time, or one colour; only
// nodes that are gray in both are looked into. So the cost is that of copying the result, at the speed of memory, and
// of walking down to where the surfaces of the operands meet. Laws: those of Boolean algebra, with the empty universe
// as 0 and the full one as 1; equal solids are equal octrees, bit for bit.
#pragma once

#include <span>

#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// Voxel by voxel; the result has the frame of `a`. Throw Error(bad_argument) when depths differ, Error(cancelled).
/// O(words of the result + words of both where both are gray).
Octree unite(const Octree& a, const Octree& b, const Work& work = {});
Octree intersect(const Octree& a, const Octree& b, const Work& work = {});
Octree subtract(const Octree& a, const Octree& b, const Work& work = {});
Octree symmetric_difference(const Octree& a, const Octree& b, const Work& work = {});

/// The same of any number of octrees at once, with the frame of the first: voxels black in any of them, in all of them,
/// in an odd number of them. No intermediate octree is made by the first two; the third combines pairs, then pairs of
/// the results, and so on. Requires: at least one.
Octree unite(std::span<const Octree> octrees, const Work& work = {});
Octree intersect(std::span<const Octree> octrees, const Work& work = {});
Octree symmetric_difference(std::span<const Octree> octrees, const Work& work = {});

/// The rest of the universe; the same frame. O(words), at the speed of memory.
Octree complement(const Octree& a, const Work& work = {});

}  // namespace blackleaf
