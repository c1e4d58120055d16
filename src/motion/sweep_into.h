// The steps of a sweep, for octrees and label maps alike: which universe, then the union in it.
#pragma once

#include <span>
#include <vector>

#include "blackleaf/measures.h"
#include "blackleaf/motion.h"
#include "blackleaf/octree.h"
#include "blackleaf/work.h"
#include "extent.h"

namespace blackleaf::detail {

/// The universe for a solid with this bounding box on its way by all motions. Throws Error(out_of_universe) as sweep().
TargetUniverse universe_for(const Octree& octree, const Box& box, std::span<const Motion> motions, Leaving leaving);

/// The union of the moved solids in that universe; what is outside is dropped. Requires: the box holds the solid, which
/// is not empty.
Octree sweep_into(const TargetUniverse& target, const Octree& octree, const Box& box, std::span<const Motion> motions,
                  const Work& work);

/// Motions of a solid of the old universe as motions of the same solid in the new one.
void move_with(const TargetUniverse& target, std::vector<Motion>& motions);

}  // namespace blackleaf::detail
