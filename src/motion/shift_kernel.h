// The inner steps of translation, compiled for every instruction set: what 2^3 neighbouring source cells hold, one
// place of the level below further on, or some voxels further on.
//
// Cells are words, or what stands for one of one colour (SourceTree), x + 2 y + 4 z, eight words apart from each other:
// so the cells of one child among the 64 words that cells_below() leaves are cells like any.
#pragma once

#include <cstdint>

#include "brick_shift.h"

namespace blackleaf::detail {

/// The cells of the eight children of a target node whose own are `cells`: word 8 i + octant is cell i of that child.
/// `first` has a bit for each axis, 1 for x, 2 for y, 4 for z: whether the first child begins at the second of the 4
/// places on it. Requires: `below` are the words of the level below, one at least.
void cells_below(const std::uint64_t* cells, const std::uint64_t* below, unsigned first, std::uint64_t* result);

/// The eight bricks, by octant, of a target node of level 3 whose source cells are `cells`.
void shifted_bricks(const std::uint64_t* cells, const std::uint64_t* below, unsigned first, const BlockShift& shift,
                    std::uint64_t* result);

}  // namespace blackleaf::detail
