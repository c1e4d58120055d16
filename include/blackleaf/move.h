// Moving octrees: integer translation (AN84), arbitrary rotation and translation (WA87).
#pragma once

#include <array>
#include <cstdint>

#include "blackleaf/label_map.h"
#include "blackleaf/motion.h"
#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// What to do when a moved solid leaves the universe.
enum class Leaving {
  error,  // throw Error(out_of_universe) that says by how much and on which side
  clip,   // drop what is outside
  grow,   // double the universe until it holds everything; the frame keeps world coordinates
};

/// The solid shifted by whole voxels, lossless. Throws Error(out_of_universe) by `leaving`; when even a universe of
/// depth 20 is too small, always. O(words of source and target) (AN84, section 3).
Octree translate(const Octree& octree, const std::array<std::int64_t, 3>& by, Leaving leaving = Leaving::error,
                 const Work& work = {});
/// The same with all labels at once; what leaves the universe is what has a label other than 0, and 0 comes in.
/// O(runs of source and target * depth).
LabelMap translate(const LabelMap& map, const std::array<std::int64_t, 3>& by, Leaving leaving = Leaving::error,
                   const Work& work = {});

/// The solid moved by X' = RX + T: a target voxel is black iff its centre, moved back by FixedMotion, lies in the
/// closed solid. Exact, and the same for every thread count. A solid leaves the universe when a corner of a moved black
/// cube lies outside by more than 2^-16 voxels (no voxel centre is then lost). O(surface of source and target) (WA87,
/// sections 3 and 4); quarter turns and translations that leave centres off the faces of voxels are done by relabelling
/// and shifting, with the same result (lattice.h).
Octree move(const Octree& octree, const Motion& motion, Leaving leaving = Leaving::error, const Work& work = {});

/// All labels moved at once: every voxel takes the label that its centre comes from. A centre that comes from exactly
/// between voxels, on a face, an edge or a corner, takes the largest of their labels; so any label wins over 0, and the
/// voxels of all labels but 0 are those of the moved solid of all labels but 0. In other words: the solids of the
/// labels are moved one by one, in increasing order, and each paints over what is there. The solid of all labels but 0
/// decides what leaves the universe. Exact, and the same for every thread count. O(runs * depth) of source and target.
LabelMap move(const LabelMap& map, const Motion& motion, Leaving leaving = Leaving::error, const Work& work = {});

}  // namespace blackleaf
