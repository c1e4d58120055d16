#include "blackleaf/align.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <limits>
#include <string>

#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "extent.h"
#include "grow.h"
#include "octree/parallel.h"

namespace blackleaf {
namespace {

using Shift = std::array<std::int64_t, 3>;

constexpr std::int64_t kMostShift = std::int64_t{1} << (kMaxDepth + 1);

std::vector<Shift> shifts_of(std::span<const Octree> octrees) {
  std::vector<Shift> shifts;
  for (std::size_t i = 0; i < octrees.size(); ++i) {
    const auto shift = whole_shift(octrees[i].frame(), octrees.front().frame());
    if (!shift)
      throw Error(ErrorCode::bad_argument,
                  "the voxels of octree " + std::to_string(i + 1) + " are not on the lattice of those of the first",
                  "make both from one frame");
    for (const std::int64_t by : *shift)
      if (std::abs(by) > kMostShift)
        throw Error(
            ErrorCode::out_of_universe,
            "octree " + std::to_string(i + 1) + " lies farther from the first than a universe of depth 20 reaches",
            "bring them closer");
    shifts.push_back(*shift);
  }
  return shifts;
}

// The universe of the first octree, doubled until it holds all solids.
detail::TargetUniverse universe_of_all(std::span<const Octree> octrees, const std::vector<Shift>& shifts) {
  detail::Extent extent;
  extent.min.fill(std::numeric_limits<std::int64_t>::max());
  extent.max.fill(std::numeric_limits<std::int64_t>::min());
  bool any = false;
  for (std::size_t k = 0; k < octrees.size(); ++k) {
    const auto box = bounding_box(octrees[k]);
    if (!box) continue;
    any = true;
    for (std::size_t i = 0; i < 3; ++i) {
      constexpr std::int64_t kOne = std::int64_t{1} << FixedMotion::kFractionBits;
      extent.min[i] = std::min(extent.min[i], (box->min[i] + shifts[k][i]) * kOne);
      extent.max[i] = std::max(extent.max[i], (box->max[i] + shifts[k][i]) * kOne);
    }
  }
  if (!any) return {octrees.front().depth(), {}};
  return detail::target_universe(octrees.front().depth(), extent, Leaving::grow,
                                 {"the solids together", "bring them closer"});
}

}  // namespace

std::vector<Octree> aligned(std::span<const Octree> octrees, const Work& work) {
  assert(!octrees.empty());
  const std::vector<Shift> shifts = shifts_of(octrees);
  const auto target = universe_of_all(octrees, shifts);
  const Frame frame = detail::grown_frame(octrees.front().frame(), target);
  std::vector<Octree> result;
  for (std::size_t k = 0; k < octrees.size(); ++k) {
    Shift corner = shifts[k];
    for (std::size_t i = 0; i < 3; ++i) corner[i] += target.offset[i];
    if (corner == Shift{} && octrees[k].depth() == target.depth) {
      result.push_back(octrees[k].with_frame(frame));
      continue;
    }
    const auto part = [&](std::size_t done) { return static_cast<double>(done) / static_cast<double>(octrees.size()); };
    // Grown by nothing, in another universe.
    result.push_back(
        detail::grow({octrees[k], corner, false}, 0, target.depth, frame, detail::part_of(work, part(k), part(k + 1))));
  }
  return result;
}

}  // namespace blackleaf
