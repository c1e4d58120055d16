// Search: one run of one of OMPL's planners in a World. search.cpp is the only file that knows OMPL.
#pragma once

#include <functional>
#include <vector>

#include "blackleaf/plan.h"
#include "world.h"

namespace blackleaf::detail {

/// What a motion costs; never less than its length.
using MotionCost = std::function<double(const Pose& from, const Pose& to)>;

struct Found {
  bool reached = false;
  std::vector<Pose> way;  // from the start to the goal, or as near to it as the search came
};

/// Searches until a way is found (and bettered for `options.refinement` rounds, by planners that do so) or `stop` says
/// true. `stop` may throw. `cost` is empty if length is all that counts. Requires: start and goal are free.
Found search(const World& world, const Pose& start, const Pose& goal, const PlanOptions& options,
             const MotionCost& cost, const std::function<bool()>& stop);

}  // namespace blackleaf::detail
