// Place: why an object cannot be where it is to start or to end, in one line.
#pragma once

#include <string>

#include "traffic.h"
#include "world.h"

namespace blackleaf::detail {

/// Throws Error(out_of_universe) or Error(bad_argument) that says where the object touches what and by how much, unless
/// it is free at the pose. `where` is "at the start", for instance.
void require_free(const World& world, const Pose& pose, const std::string& where);
/// The same of solids that move: the pose's time counts.
[[noreturn]] void refuse_for_traffic(const World& world, const Traffic& traffic, const Pose& pose,
                                     const std::string& where);

}  // namespace blackleaf::detail
