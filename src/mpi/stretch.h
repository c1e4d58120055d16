// Stretches of the Millar curve: how a universe is cut among processes (MHF92, section 4), and what a stretch is made
// of.
//
// A stretch is an interval [first, last) of voxel numbers, any at all: the paper's processors had equal shares of a
// power of eight, ours are cut where the work is halved, or divided by seven. An octree whose voxels outside a stretch
// are white is that stretch's *part* of the octree: a condensed octree like any other.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blackleaf/curve.h"
#include "blackleaf/octree.h"

namespace blackleaf::mpi {

struct Stretch {
  std::uint64_t first = 0, last = 0;
  bool empty() const { return first >= last; }
  friend bool operator==(const Stretch&, const Stretch&) = default;
};

/// Rising numbers, from 0 to 8^depth: process i has [cuts[i], cuts[i + 1]).
using Cuts = std::vector<std::uint64_t>;

constexpr std::uint64_t voxels_of(int level) { return std::uint64_t{1} << (3 * level); }
inline Stretch whole(int depth) { return {0, voxels_of(depth)}; }
inline Stretch stretch_of(const Cuts& cuts, int process) {
  const auto i = static_cast<std::size_t>(process);
  return {cuts[i], cuts[i + 1]};
}
/// The process whose stretch holds a number.
int process_at(const Cuts& cuts, std::uint64_t number);
/// All of the curve for the first process: for universes that are too small to cut.
Cuts uncut(int depth, int processes);

/// A box of voxels, [low, high) on every axis.
struct VoxelBox {
  std::array<std::int64_t, 3> low{}, high{};
  std::int64_t voxels() const { return (high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]); }
  friend bool operator==(const VoxelBox&, const VoxelBox&) = default;
};

/// Volumes are cut between blocks of this level, those that voxel_stream.cpp builds from.
inline constexpr int kBlockLevel = 6;

/// Cuts between blocks that give every process as many of the box's voxels as the other, to half a block. O(processes
/// x depth).
Cuts cuts_by_voxels(int depth, const VoxelBox& box, int processes);

/// What a stretch has of a box, as few boxes without overlap: its largest nodes, at most 14 a level, joined where two
/// share a side. Requires: the stretch begins and ends between blocks.
std::vector<VoxelBox> boxes_of(int depth, const Stretch& stretch, const VoxelBox& box);

/// Cuts that give every process the same weight, as nearly as they can be made between the units: unit i begins at
/// numbers[i] and has weights[i]. Requires: rising numbers, at least one unit.
Cuts cuts_by_weight(int depth, std::span<const std::uint64_t> numbers, std::span<const std::uint64_t> weights,
                    int processes);

/// The part of an octree that a stretch has. Requires: the stretch begins and ends between bricks, multiples of 64, or
/// is the whole. O(words in it + depth).
Octree part_of(const Octree& octree, const Stretch& stretch);

/// The octree of some octrees of one depth, of which no two have a black voxel in common; its frame is that of the
/// first. Whole subtrees are copied; only nodes of several are gone into, so disjoint stretches cost their seams,
/// O(words copied + seams x depth). Requires: at least one, or a depth of 2 at least.
Octree join(std::span<const Octree> parts);

}  // namespace blackleaf::mpi
