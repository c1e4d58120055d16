// What a motion does to a universe, before anything is moved.
#pragma once

#include <optional>

#include "blackleaf/frame.h"
#include "extent.h"
#include "lattice_move.h"

namespace blackleaf::detail {

struct MovePlan {
  bool stays = false;  // there is nothing to move
  bool gone = false;   // nothing can be left in the target
  // If neither:
  TargetUniverse target;
  Frame frame;
  std::optional<LatticeMove> lattice;  // the shorter way, if there is one, into the target
  std::optional<FixedMotion> motion;   // into the target
};

/// Throws Error(out_of_universe) as move().
MovePlan plan_move(const Octree& octree, const Motion& motion, Leaving leaving);

}  // namespace blackleaf::detail
