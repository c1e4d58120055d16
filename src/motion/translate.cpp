// Integer translation (AN84). The paper adds the displacement to every leaf's path; here every target node reads off
// the (at most eight) source nodes of its own size that it covers, from the root down.
#include <algorithm>
#include <string>

#include "blackleaf/error.h"
#include "blackleaf/move.h"
#include "octree/produce.h"
#include "shift_plan.h"
#include "shift_producer.h"

namespace blackleaf {

detail::ShiftPlan detail::plan_shift(int depth, const Box& box, const std::array<std::int64_t, 3>& by,
                                     Leaving leaving) {
  constexpr std::int64_t kFar = std::int64_t{1} << (kMaxDepth + 2);
  ShiftPlan plan;
  Extent extent;
  std::string sides;
  for (std::size_t i = 0; i < 3; ++i) {
    // Beyond kFar everything is outside whatever the universe; keep the fixed-point numbers small.
    plan.by[i] = std::clamp(by[i], -kFar, kFar);
    if (plan.by[i] != by[i])
      sides += (sides.empty() ? "" : ", ") + ("more than " + std::to_string(kFar)) + " voxels along " +
               (by[i] < 0 ? '-' : '+') + static_cast<char>('x' + i);
    extent.min[i] = (box.min[i] + plan.by[i]) * (std::int64_t{1} << FixedMotion::kFractionBits);
    extent.max[i] = (box.max[i] + plan.by[i]) * (std::int64_t{1} << FixedMotion::kFractionBits);
  }
  plan.gone = !sides.empty();
  if (plan.gone && leaving != Leaving::clip)
    throw Error(ErrorCode::out_of_universe, "the moved solid leaves every universe: it is moved by " + sides,
                leaving == Leaving::error ? "move it less or clip it (--clip)" : "move it less");
  plan.target = target_universe(depth, extent, leaving);
  for (std::size_t i = 0; i < 3; ++i) plan.by[i] += plan.target.offset[i];
  return plan;
}

Octree translate(const Octree& octree, const std::array<std::int64_t, 3>& by, Leaving leaving, const Work& work) {
  const auto box = bounding_box(octree);
  if (!box) return octree;
  const detail::ShiftPlan plan = detail::plan_shift(octree.depth(), *box, by, leaving);
  if (plan.gone) return Octree(octree.depth(), Colour::white, octree.frame());
  if (plan.is_identity(octree.depth())) return octree;
  return detail::produce(detail::ShiftProducer(plan.by, octree, plan.target.depth), plan.target.depth,
                         detail::grown_frame(octree.frame(), plan.target), work);
}

}  // namespace blackleaf
