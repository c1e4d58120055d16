// The inner loops of near fields (near_field.h), by SIMD where there is any.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "edge_family.h"
#include "near_blocks.h"
#include "near_looks.h"

namespace blackleaf::detail {

/// Five pieces of 8 x 8 rows of eight voxels side by side along x: where the first row is, 16 bytes from layer to
/// layer.
using SideBySide = std::array<const std::uint8_t*, 5>;

/// Lays them out, of the first the upper half and of the last the lower: 32 voxels. `rows` is where their first row
/// goes.
void lay_out(const SideBySide& pieces, char* rows);

/// Edges of a family that begin at 16^3 corners: 16 layers along z of 16 rows of 32 bits along y, bit x.
using EdgeRows = std::uint32_t*;

/// Writes, by axis, the edges that may be visible (feature_edges.h), none of families seen end-on; `corner` is the step
/// from `rows` to the voxel above the first corner. Returns a bit for each family that has any.
unsigned candidates(const std::array<EdgeFamily, 3>& families, const char* rows, const VoxelStep& corner,
                    const std::array<EdgeRows, 3>& edges);

/// What is asked of all edges of one family.
struct NearQuestion {
  const EdgeFamily& family;
  const char* rows;                  // of voxels (VoxelStep)
  VoxelStep beside_b;                // from a voxel to its lower neighbour along the family's b
  std::span<const NearLook> first;   // looks: those that may hide whole edges,
  std::span<const NearLook> others;  // and those of which it only matters whether they meet anything
};

/// By layer along z, a bit for each look: the first, then the others.
using NearMet = std::array<std::array<std::uint64_t, 2>, 16>;
static_assert(kMostNearLooks <= 128);

/// Looks from `edges`. Those are clear if none of the looks meets black: they are taken out and put into `clear`, which
/// has none before. If one of the first looks hides all of an edge, it is taken out too. What is left is partly clear;
/// `met` are the looks that meet black for any of it.
void look(const NearQuestion& question, EdgeRows edges, EdgeRows clear, NearMet& met);

}  // namespace blackleaf::detail
