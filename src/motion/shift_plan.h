// What a shift by whole voxels does to a universe, for octrees and label maps alike.
#pragma once

#include <array>
#include <cstdint>

#include "blackleaf/measures.h"
#include "extent.h"

namespace blackleaf::detail {

struct ShiftPlan {
  TargetUniverse target;
  std::array<std::int64_t, 3> by{};  // with target.offset; |by_i| < 2^24
  bool gone = false;                 // nothing can be left in the target

  bool is_identity(int depth) const { return !gone && target.depth == depth && by == std::array<std::int64_t, 3>{}; }
};

/// For a solid of a universe of the given depth with this box. Throws Error(out_of_universe) as translate().
ShiftPlan plan_shift(int depth, const Box& box, const std::array<std::int64_t, 3>& by, Leaving leaving);

}  // namespace blackleaf::detail
