// The narrow passage that planners are timed on, and how.
#pragma once

#include <functional>
#include <string>

#include "blackleaf/octree.h"
#include "blackleaf/path.h"
#include "blackleaf/plan.h"

namespace blackleaf::bench {

/// examples/plan's puzzle at its own depth 6, or larger: an elbow whose arms, 4 thick and 16 long, go one after the
/// other through a hole of 12 x 12 in a plate 2 thick; in voxels of depth 6. The path is asked for as it is found.
struct NarrowPassage {
  explicit NarrowPassage(int depth);
  Octree environment, object;
  Pose start, goal;
  PlanOptions options;
  double scale = 1;  // voxels here for one of depth 6
  double thinnest() const { return 2 * scale; }
};

/// Adds a contender for the median over ten seeds of the processor seconds that `solve(seed)` takes to find a way; it
/// says whether it has. Fails if it has not for one of them.
void add_timed_plans(const std::string& key, const std::string& who,
                     const std::function<std::function<bool(std::uint32_t)>()>& prepare);

}  // namespace blackleaf::bench
