// The engine of arbitrary motion by itself, for tests and benchmarks: what move() gives, also where it knows a shorter
// way.
#pragma once

#include "blackleaf/move.h"

namespace blackleaf::detail {

/// As move(), but always by looking centres up.
Octree move_by_look_up(const Octree& octree, const Motion& motion, Leaving leaving = Leaving::error,
                       const Work& work = {});

}  // namespace blackleaf::detail
