// Align: octrees of different universes brought into one, by what their frames say.
#pragma once

#include <span>
#include <vector>

#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// The same solids, each where its frame says, in one universe: that of the first, doubled until it holds all black
/// voxels, as Leaving::grow does. All have one depth and one frame then, and can be combined. Throws
/// Error(bad_argument) when a frame is not of the first one's lattice (`whole_shift` in frame.h),
/// Error(out_of_universe) when depth 20 is too small, Error(cancelled). Requires: at least one octree. O(words of all).
std::vector<Octree> aligned(std::span<const Octree> octrees, const Work& work = {});

}  // namespace blackleaf
