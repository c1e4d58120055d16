// Offset: solids grown and shrunk by a ball, and the opening and closing made of both.
//
// Meaning. The ball of radius r is closed and Euclidean, and distances go from voxel centre to voxel centre. With
// |p - q| the distance of two voxels' centres, p and q running over all of space, outside the universe too, where
// every voxel is white:
//
//   grow S by r      voxels p with |p - q| <= r for a black q             the union of the balls about S
//   shrink S by r    voxels p with q black for every |p - q| <= r         the centres of balls that lie in S
//   opening          shrink, then grow: the union of the balls that lie in S; thin parts and spikes vanish
//   closing          grow, then shrink: what no ball that misses S can reach; holes and gaps are filled
//
// Squared distances of centres are whole numbers, so p and q are within r iff their squared distance is at most
// floor(r^2), which is taken exactly of the double r: no decision is rounded. sqrt(2) = 1.414213562... lies between two
// doubles; 1.4142135623730951, the nearest, is above it and reaches the diagonal neighbours.
//
// Laws. shrink(S, r) is the complement of grow(complement of S, r), the outside counting as black in the latter;
// opening
// <= S <= closing; both are idempotent; all four grow with S; offset by less than 1 leaves S as it is.
#pragma once

#include "blackleaf/move.h"
#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// The solid grown by a ball of `radius` voxels, or shrunk by one of -radius if that is negative. A shrunk solid stays
/// in its universe; a grown one may leave it, by up to floor(radius) voxels: Throws Error(out_of_universe) by
/// `leaving`; Error(bad_argument) for a radius that is no finite number; Error(cancelled).
///
/// The cost follows the surface of the result times the radius, not the universe and not the volume of the ball: nodes
/// wholly within the radius of one black node, or farther from all, are decided at once; the voxels of the others are
/// decided in tiles, each from those black voxels that may lie within the radius of it (docs/SETS.md).
Octree offset(const Octree& octree, double radius, Leaving leaving = Leaving::error, const Work& work = {});

/// Shrunk by `radius`, then grown again. Throws Error(bad_argument) unless the radius is finite and not negative.
Octree opening(const Octree& octree, double radius, const Work& work = {});

/// Grown by `radius`, then shrunk again, as in unbounded space: the solid between may leave the universe, the result
/// cannot. Throws Error(bad_argument) as opening() does, and Error(out_of_universe) when the grown solid needs more
/// than depth 20.
Octree closing(const Octree& octree, double radius, const Work& work = {});

}  // namespace blackleaf
