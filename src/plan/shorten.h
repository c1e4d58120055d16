// Shorten: a way made cheaper by short cuts, clearer where clearance counts, and rounder at its corners.
#pragma once

#include <functional>
#include <vector>

#include "random.h"
#include "search.h"
#include "world.h"

namespace blackleaf::detail {

/// The way with the same ends, every motion of it free, at most as dear. `cost` is empty if length is all that counts.
/// Gives back what it has when `stop` says true.
std::vector<Pose> shorten(const World& world, std::vector<Pose> way, const MotionCost& cost, double preferred_clearance,
                          Random random, const std::function<bool()>& stop);

}  // namespace blackleaf::detail
