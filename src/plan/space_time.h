// Space-time search: a way among solids that move, from poses and times to later ones.
//
// A tree of (pose, time) grows from the start at time 0. Every branch goes straight from one pose and time to a later
// one, no faster than the speed that is allowed, free of the environment and of all movers at every time between. Where
// it grows to is drawn at random: the goal, as early as it can be reached; poses of a guide, a way on which nothing but
// movers stands, at any time, so that the object can wait there or go back; and any poses. (A forward tree as of
// LaValle and Kuffner's kinodynamic planning, 2001; priorities as of Erdmann and Lozano-Perez, On multiple moving
// objects, 1987.)
#pragma once

#include <functional>
#include <vector>

#include "random.h"
#include "search.h"
#include "traffic.h"

namespace blackleaf::detail {

/// The guide at full speed, if nothing comes in its way; otherwise as above. `way` are poses with times, from time 0.
Found search_in_time(const World& world, const Traffic& traffic, const std::vector<Pose>& guide, double speed,
                     Random random, const std::function<bool()>& stop);

/// A way in time made straighter: no pose of it is later than before.
std::vector<Pose> shorten_in_time(const World& world, const Traffic& traffic, std::vector<Pose> way, double speed,
                                  Random random, const std::function<bool()>& stop);

}  // namespace blackleaf::detail
