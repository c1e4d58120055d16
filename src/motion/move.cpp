// Arbitrary motion (WA87), from the target's side: a target node's voxel centres, moved back, lie in an upright box of
// the source; where the source is of one colour on that box so is the node, elsewhere the node is split, and in a brick
// each of the 64 centres is looked up. The answer is WA87's, which asks every moved leaf for the voxels it covers; the
// cost is that of the target's surface instead of leaves times depth.
#include "blackleaf/move.h"

#include "extent.h"
#include "lattice_move.h"
#include "move_general.h"
#include "move_plan.h"
#include "move_producer.h"
#include "octree/produce.h"

namespace blackleaf {
namespace {

enum class Way { any, look_up };

Octree moved(const Octree& octree, const Motion& motion, Leaving leaving, const Work& work, Way way) {
  const detail::MovePlan plan = detail::plan_move(octree, motion, leaving);
  if (plan.stays) return octree;
  if (plan.gone) return Octree(octree.depth(), Colour::white, octree.frame());
  if (plan.lattice && way == Way::any) return detail::moved(octree, *plan.lattice, plan.target.depth, plan.frame, work);
  return detail::produce(detail::MoveProducer(*plan.motion, octree, plan.target.depth), plan.target.depth, plan.frame,
                         work);
}

}  // namespace

detail::MovePlan detail::plan_move(const Octree& octree, const Motion& motion, Leaving leaving) {
  MovePlan plan;
  plan.stays = octree.is_empty();
  plan.gone = leaving == Leaving::clip && motion.translation().norm() > FixedMotion::kMaxTranslation;
  if (plan.stays || plan.gone) return plan;
  const FixedMotion fixed(motion);
  plan.target = target_universe(octree.depth(), extent_of(octree, fixed), leaving);
  plan.frame = grown_frame(octree.frame(), plan.target);
  plan.lattice = lattice_move(fixed, octree.depth());
  if (plan.lattice)
    for (std::size_t i = 0; i < 3; ++i) plan.lattice->by[i] += plan.target.offset[i];
  plan.motion = fixed.shifted(plan.target.offset);
  return plan;
}

Octree move(const Octree& octree, const Motion& motion, Leaving leaving, const Work& work) {
  return moved(octree, motion, leaving, work, Way::any);
}

Octree detail::move_by_look_up(const Octree& octree, const Motion& motion, Leaving leaving, const Work& work) {
  return moved(octree, motion, leaving, work, Way::look_up);
}

}  // namespace blackleaf
