// Plan: a way for a solid from one pose to another that touches nothing (docs/PLANNING.md).
//
// Meaning. The object is a solid in the universe of its environment. A pose turns it about its centroid and then shifts
// it (path.h). A pose is free when the exact moved solid interferes neither with the environment nor with anything that
// moves, and stays in the universe. A motion from one pose to the next (straight, turning evenly the shorter way) is
// free when every pose on it is; this is decided for the whole motion, not for samples of it, so nothing is thin enough
// to be jumped.
//
// OMPL's planners choose which poses and motions to try. Every path that is returned was checked once more from end to
// end, as path_is_clear() does.
//
// Lengths. The length of a motion is a bound on the way of any point of the object: |dT| + angle * r, r the largest
// distance of a corner of the object's bounding box from its centroid. It is what planners shorten, what `length` adds
// up and what speed is measured by.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "blackleaf/octree.h"
#include "blackleaf/path.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// OMPL's planners of that name. RRT-Connect and KPIECE take the first way that they find, the others go on to better
/// ones.
enum class Planner { rrt_connect, rrt_star, prm_star, kpiece, bit_star };

/// "rrt-connect", "rrt-star", "prm-star", "kpiece", "bit-star".
std::string name_of(Planner planner);
/// The planner of a name, none if there is none of it.
std::optional<Planner> planner_of(std::string_view name);

/// Another solid that moves: it rests at its first pose before its path begins and at its last when it has ended.
struct Mover {
  Octree octree;
  Path path;
};

struct PlanOptions {
  Planner planner = Planner::rrt_connect;
  /// The most time to take. A plan that is found earlier does not depend on it.
  double seconds = 60;
  /// The same seed gives the same path, on any number of threads.
  std::uint32_t seed = 1;
  /// Voxels that must stay free between the object and all else, the universe's walls too: every pose of the path is
  /// farther than this. 0: it may not even touch. Negative: boxes of black voxels may overlap up to that deep
  /// (first_contact.h), for what rests on a floor or slides along a wall.
  double clearance = 0;
  /// Voxels that the path keeps from the environment where it can: nearer than this a motion costs more than its
  /// length, in contact 1 + kNearness times it. 0: clearance does not count.
  double preferred_clearance = 0;
  static constexpr double kNearness = 10;
  /// Whether the way found is shortened, or brought where it is clearer, and its corners are rounded.
  bool shorten = true;
  /// Voxels of the longest motion that RRT-Connect, RRT* and KPIECE try; 0: a third of the object's radius, and a
  /// 32nd of the universe's side at least; three times that for RRT*.
  double range = 0;
  /// How many rounds a planner that goes on to better ways takes after the first.
  int refinement = 500;
  /// Voxels that any point of the object may travel in a second.
  double speed = 1;
};

struct Plan {
  /// The way, from time 0 at the start; none if none was found in time.
  std::optional<Path> path;
  /// Voxels between the object and whatever is nearest, at each pose; infinite where nothing is. The universe's walls
  /// do not count.
  std::vector<double> clearance;
  double length = 0;
  double seconds = 0;
  /// How many poses and motions were looked at.
  std::uint64_t poses_tried = 0, motions_tried = 0;
  /// If none was found: the way that came nearest to the goal, and the length that was left between its end and the
  /// goal.
  std::vector<Pose> nearest;
  double missing = 0;
};

/// Plans the way of `object` from `start` to `goal` (their times do not matter) through `environment` and among
/// `movers`, whose paths begin at time 0 as this one does; they are given in order of their priority and keep their
/// paths. The object must also be free to rest at the goal for good.
///
/// Throws Error(bad_argument) when depths differ, the environment is deeper than 19, the object is empty, or the object
/// interferes at the start or at the goal (the error says with what, where and by how much); Error(out_of_universe)
/// when it does not lie in the universe there; Error(cancelled). Not to be called by two threads at once that want the
/// same path again: OMPL has one source of seeds for a process, so calls wait for each other.
Plan plan(const Octree& environment, const Octree& object, const Pose& start, const Pose& goal,
          const PlanOptions& options = {}, std::span<const Mover> movers = {}, const Work& work = {});

/// True: the object on its path, and at rest before and after it, keeps more than `clearance` from the environment,
/// from all movers and from the universe's walls, at every time; proven by clear() of first_contact.h. False: at some
/// time it comes within 2^-9 voxels of that. `path.about()` may be any point. Throws Error(bad_argument) as plan()
/// does.
bool path_is_clear(const Octree& environment, const Octree& object, const Path& path, double clearance = 0,
                   std::span<const Mover> movers = {}, const Work& work = {});

}  // namespace blackleaf
