// Align: octrees of different universes brought into one, by what their frames say.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// Where the corner of a universe with frame `other` lies in the voxels of one with frame `frame`: none unless the
/// voxels of both are the same lattice in the world, up to 10^-6 voxels, and the corners at most 2^21 voxels apart on
/// every axis. Growing a universe (Leaving::grow) gives such a frame.
std::optional<std::array<std::int64_t, 3>> whole_shift(const Frame& frame, const Frame& other);

/// The same solids, each where its frame says, in one universe: that of the first, doubled until it holds all black
/// voxels, as Leaving::grow does. All have one depth and one frame then, and can be combined. Throws
/// Error(bad_argument) when a frame is not of the first one's lattice, Error(out_of_universe) when depth 20 is too
/// small, Error(cancelled). Requires: at least one octree. O(words of all).
std::vector<Octree> aligned(std::span<const Octree> octrees, const Work& work = {});

}  // namespace blackleaf
