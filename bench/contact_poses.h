// The poses of two bunnies near contact, and how long questions about them take.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "blackleaf/motion.h"

namespace blackleaf::bench {

/// 200 motions of a bunny beside the bunny: turned anyhow about the universe's centre, then shifted anyhow by 0.9
/// to 1.1 of what brings the two, exact and tilted, to touch. Made once in a process.
const std::vector<Motion>& contact_poses(int depth);

/// Asks whether the two interfere.
using Ask = std::function<bool(const Motion&)>;

/// Adds the contenders `who` and `who`_p95: the median and the 95th percentile, over the poses, of the seconds that one
/// answer takes; that of a pose is the median of `rounds` rounds. `prepare` makes what is asked, which is not timed.
void add_timed_poses(const std::string& key, const std::string& who, int depth, const std::function<Ask()>& prepare,
                     int rounds = 7);

}  // namespace blackleaf::bench
