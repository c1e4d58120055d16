// Arbitrary motion (WA87), from the target's side: a target node's voxel centres, moved back, lie in an upright box of
// the source; where the source is of one colour on that box so is the node, elsewhere the node is split, and in a brick
// each of the 64 centres is looked up. The answer is WA87's, which asks every moved leaf for the voxels it covers; the
// cost is that of the target's surface instead of leaves times depth.
#include "blackleaf/move.h"

#include "extent.h"
#include "lattice_move.h"
#include "move_general.h"
#include "move_producer.h"
#include "octree/produce.h"

namespace blackleaf {
namespace {

enum class Way { any, look_up };

Octree moved(const Octree& octree, const Motion& motion, Leaving leaving, const Work& work, Way way) {
  if (octree.is_empty()) return octree;
  if (leaving == Leaving::clip && motion.translation().norm() > FixedMotion::kMaxTranslation)
    return Octree(octree.depth(), Colour::white, octree.frame());
  const FixedMotion fixed(motion);
  const auto target = detail::target_universe(octree.depth(), detail::extent_of(octree, fixed), leaving);
  const Frame frame = detail::grown_frame(octree.frame(), target);
  if (way == Way::any)
    if (auto lattice = detail::lattice_move(fixed, octree.depth())) {
      for (std::size_t i = 0; i < 3; ++i) lattice->by[i] += target.offset[i];
      return detail::moved(octree, *lattice, target.depth, frame, work);
    }
  return detail::produce(detail::MoveProducer(fixed.shifted(target.offset), octree, target.depth), target.depth, frame,
                         work);
}

}  // namespace

Octree move(const Octree& octree, const Motion& motion, Leaving leaving, const Work& work) {
  return moved(octree, motion, leaving, work, Way::any);
}

Octree detail::move_by_look_up(const Octree& octree, const Motion& motion, Leaving leaving, const Work& work) {
  return moved(octree, motion, leaving, work, Way::look_up);
}

}  // namespace blackleaf
