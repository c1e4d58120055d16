// Sweep: the space that a moving solid passes through, as an octree (docs/SWEEP.md).
//
// Meaning. The sweep of a solid over a list of motions is the union of the moved solids: a voxel is black iff move() of
// one of the motions makes it black. It is found without any of the moved octrees, and equals their union bit for bit.
//
// A path has infinitely many motions; its sweep is that over motions so close together that no point of the solid
// travels `step` voxels from one to the next. Then
//   - a black voxel's centre lies in the swept space of the whole path (up to move()'s 2^-18 voxels of rounding);
//   - every point that the solid passes through is less than step/2 voxels from a point of one of the moved solids;
//   - a voxel whose centre the solid holds at any time more than step/2 deep is black.
// With step <= 1 no voxel is jumped: only voxels whose centres the solid grazes less than half a voxel deep may be
// missed. Halving the step halves that.
#pragma once

#include <span>
#include <vector>

#include "blackleaf/label_map.h"
#include "blackleaf/motion.h"
#include "blackleaf/move.h"
#include "blackleaf/octree.h"
#include "blackleaf/path.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// The union of move(octree, motion) over all motions; the empty solid for none. A solid that leaves the universe by
/// any of them is treated by `leaving` as in move(): the error says how far it leaves at most, growing makes one
/// universe for all. The same for every thread count. Cost: that of the swept surface times the motions that pass each
/// part of it, not of the motions times a move.
Octree sweep(const Octree& octree, std::span<const Motion> motions, Leaving leaving = Leaving::error,
             const Work& work = {});

/// The sweep over motions_along(octree, path, step).
Octree sweep(const Octree& octree, const Path& path, double step = 1, Leaving leaving = Leaving::error,
             const Work& work = {});

/// The sweep of all labels at once: every voxel takes the largest label that any of the motions brings to it, as move()
/// does; 0 where none does. In other words: the solids of the labels are swept one by one, in increasing order, and
/// each paints over what is there. So the voxels of all labels but 0 are those that the solid of all labels but 0
/// sweeps; that solid decides what leaves the universe. Cost: that of the sweeps of all labels' solids.
LabelMap sweep(const LabelMap& map, std::span<const Motion> motions, Leaving leaving = Leaving::error,
               const Work& work = {});
/// The sweep over motions_along(the solid of all labels but 0, path, step).
LabelMap sweep(const LabelMap& map, const Path& path, double step = 1, Leaving leaving = Leaving::error,
               const Work& work = {});

/// The motions of a path at path.times(bounding box of the solid, step); one motion for the empty solid. Throws
/// Error(bad_argument) as path.times() does.
std::vector<Motion> motions_along(const Octree& octree, const Path& path, double step = 1);

/// A solid and motions of it in one universe.
struct RoomForMotions {
  Octree octree;
  std::vector<Motion> motions;
};
/// The same if the solid stays in its universe by all motions, or is to be clipped. Otherwise throws
/// Error(out_of_universe) that says how far it leaves at most, or, when growing, gives the solid at its place in a
/// universe that holds it by all motions, and the motions about that place: moves into one universe for all of them.
RoomForMotions room_for(const Octree& octree, std::span<const Motion> motions, Leaving leaving = Leaving::error,
                        const Work& work = {});

/// A label map and motions of it in one universe.
struct RoomForLabels {
  LabelMap labels;
  std::vector<Motion> motions;
};
/// The same for label maps; the solid of all labels but 0 decides.
RoomForLabels room_for(const LabelMap& map, std::span<const Motion> motions, Leaving leaving = Leaving::error,
                       const Work& work = {});

}  // namespace blackleaf
