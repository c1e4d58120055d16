// Runs: the (count, colour) stream of MHF92 along the Millar curve, and its conversion to and from octrees.
//
// A stream of order n is a list of runs whose counts add up to 8^n; neighbours of one colour count as one run. Colours
// are any 32-bit numbers; octrees know black and white, so conversion takes "colour != 0" as black unless told
// otherwise. The monochrome form drops the colours: counts alternate, foreground (black) first, with a zero count first
// when the first voxel is white (MHF92, section 3).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

struct Run {
  std::uint64_t count = 0;
  std::uint32_t colour = 0;
  friend bool operator==(const Run&, const Run&) = default;
};

/// A run cut to one aligned cube: `level` k stands for 8^k voxels.
struct CubeRun {
  int level = 0;
  std::uint32_t colour = 0;
  friend bool operator==(const CubeRun&, const CubeRun&) = default;
};

/// The runs of an octree in curve order, colours 1 (black) and 0 (white), neighbours merged. O(words).
std::vector<Run> runs(const Octree& octree);
/// Calls visit(count, black) for each run of an octree in curve order, neighbours merged. O(words), no memory.
void for_each_run(const Octree& octree, const std::function<void(std::uint64_t count, bool black)>& visit);

/// The monochrome form of the same: alternating counts, black first.
std::vector<std::uint64_t> monochrome(const Octree& octree);

/// The octree of a stream, in one pass: a node is stored only when its last voxel has been read, and then for good.
/// Runs of count zero are allowed. Throws Error(bad_input) unless the counts add up to exactly 8^depth.
/// O(runs * depth).
Octree octree_from_runs(std::span<const Run> runs, int depth, Frame frame = {},
                        const std::function<bool(std::uint32_t)>& is_black = {});
Octree octree_from_monochrome(std::span<const std::uint64_t> counts, int depth, Frame frame = {});

/// A stream cut into the largest aligned cubes, in curve order, as MHF92's section 3 does (16 x 23 becomes two 2-cubes
/// of 8, and so on). The stream need not fill a universe.
std::vector<CubeRun> cubes(std::span<const Run> runs);

/// Pulls a stream of runs one at a time: returns false at the end.
using RunSource = std::function<bool(std::uint64_t& count, bool& black)>;
/// The octree of a stream that is pulled as it is needed; memory is that of the octree. As octree_from_runs.
Octree octree_from_source(const RunSource& source, int depth, Frame frame = {});

}  // namespace blackleaf
