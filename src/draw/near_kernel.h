// The inner loops of near fields (near_field.h), by SIMD where there is any.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "edge_family.h"
#include "near_blocks.h"
#include "near_looks.h"

namespace blackleaf::detail {

/// Lays out five blocks side by side along x, of the first the upper half and of the last the lower: 32 voxels. `rows`
/// is where their first row goes.
void lay_out(const std::array<NearBlock, 5>& blocks, char* rows);

/// What is asked of all edges of a family that begin at 16^3 corners.
struct NearQuestion {
  const EdgeFamily& family;
  const char* rows;                  // of voxels (VoxelStep)
  VoxelStep corner;                  // the voxel above the first corner
  VoxelStep beside_b, beside_c;      // from a voxel to its lower neighbours along the family's b and c
  std::span<const NearLook> first;   // looks: those that may hide whole edges,
  std::span<const NearLook> others;  // and those of which it only matters whether they meet anything
};

/// By layer along z, a bit for each look: the first, then the others.
using NearMet = std::array<std::array<std::uint64_t, 2>, 16>;
static_assert(kMostNearLooks <= 128);

/// The answers: 16 layers along z of 16 rows of 32 bits along y, bit x; to be all 0 before. Edges that may be visible
/// (feature_edges.h) are `clear` if none of the looks meets black, `partly` clear if some do but none of the first
/// hides all of the edge. `met` are the looks that meet black for any of the latter.
void look(const NearQuestion& question, std::uint32_t* clear, std::uint32_t* partly, NearMet& met);

}  // namespace blackleaf::detail
