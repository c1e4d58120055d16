#include "blackleaf/plan.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>

#include "blackleaf/error.h"
#include "place.h"
#include "search.h"
#include "shorten.h"
#include "space_time.h"
#include "traffic.h"
#include "world.h"

namespace blackleaf {
namespace {

using namespace detail;

constexpr std::array<std::pair<Planner, std::string_view>, 5> kNames = {{{Planner::rrt_connect, "rrt-connect"},
                                                                         {Planner::rrt_star, "rrt-star"},
                                                                         {Planner::prm_star, "prm-star"},
                                                                         {Planner::kpiece, "kpiece"},
                                                                         {Planner::bit_star, "bit-star"}}};

// The clock of one plan: whether its time is over, and the progress that it shows.
class Clock {
 public:
  Clock(double limit, const Work& work) : limit_(limit), work_(work) {}

  double seconds() const { return std::chrono::duration<double>(Now::now() - start_).count(); }

  bool is_over() {
    const double now = seconds();
    if (work_.progress && now >= next_) {
      next_ = now + 0.05;
      if (!work_.progress(std::min(now / limit_, 1.0))) throw Error(ErrorCode::cancelled, "interrupted");
    }
    return now >= limit_;
  }

 private:
  using Now = std::chrono::steady_clock;
  Now::time_point start_ = Now::now();
  double limit_, next_ = 0;
  const Work& work_;
};

// The integral of 1 + kNearness (1 - c / preferred)^2 over the motion, c the clearance where it is less than preferred;
// by trapezia half as long as that.
MotionCost cost_of(const World& world, double preferred) {
  if (preferred <= 0) return {};
  return [&world, preferred](const Pose& from, const Pose& to) {
    const double length = world.distance(from, to);
    const auto parts = static_cast<std::int64_t>(std::ceil(2 * length / preferred));
    const auto density = [&](double t) {
      const auto near = world.nearest(pose_between(from, to, t), preferred);
      const double lack = near ? 1 - near->voxels / preferred : 0;
      return 1 + PlanOptions::kNearness * lack * lack;
    };
    double sum = (density(0) + density(1)) / 2;
    for (std::int64_t i = 1; i < parts; ++i) sum += density(static_cast<double>(i) / static_cast<double>(parts));
    return length * sum / static_cast<double>(std::max<std::int64_t>(parts, 1));
  };
}

// At the speed that is allowed; poses that are the same twice are left out.
std::vector<Pose> timed(const World& world, const std::vector<Pose>& way, double speed) {
  std::vector<Pose> result;
  for (Pose pose : way) {
    const double length = result.empty() ? 0 : world.distance(result.back(), pose);
    pose.time = result.empty() ? 0 : result.back().time + length / speed;
    if (!result.empty() && !(pose.time > result.back().time)) continue;
    result.push_back(pose);
  }
  return result;
}

double length_of(const World& world, const std::vector<Pose>& way) {
  double length = 0;
  for (std::size_t i = 1; i < way.size(); ++i) length += world.distance(way[i - 1], way[i]);
  return length;
}

double clearance_at(const World& world, const Traffic& traffic, const Pose& pose) {
  double least = std::numeric_limits<double>::infinity();
  if (const auto near = world.nearest(pose, least)) least = near->voxels;
  if (const auto near = traffic.nearest(pose, least)) least = near->at.voxels;
  return least;
}

Pose checked(Pose pose) {
  pose.time = 0;
  return Path({pose}).poses().front();  // throws for what is no pose
}

void check(const PlanOptions& options) {
  const auto above_zero = [](double value) { return value > 0 && std::isfinite(value); };
  const auto refuse = [](const std::string& what) {
    throw Error(ErrorCode::bad_argument, what, "use a finite number above zero");
  };
  if (!above_zero(options.seconds)) refuse("the time limit of a plan is not above zero");
  if (!(options.range >= 0) || !std::isfinite(options.range)) refuse("the range of a planner is not above zero");
  if (!above_zero(options.speed)) refuse("the speed of a plan is not above zero");
  if (!std::isfinite(options.clearance) || std::abs(options.clearance) > 1e6 ||
      !(options.preferred_clearance >= 0 && options.preferred_clearance <= 1e6))
    throw Error(ErrorCode::bad_argument, "the clearance of a plan is out of range", "use a number of voxels");
}

}  // namespace

std::string name_of(Planner planner) {
  for (const auto& [each, name] : kNames)
    if (each == planner) return std::string(name);
  return {};
}

std::optional<Planner> planner_of(std::string_view name) {
  for (const auto& [planner, each] : kNames)
    if (each == name) return planner;
  return std::nullopt;
}

Plan plan(const Octree& environment, const Octree& object, const Pose& start, const Pose& goal,
          const PlanOptions& options, std::span<const Mover> movers, const Work& work) {
  check(options);
  Clock clock(options.seconds, work);
  const std::function<bool()> stop = [&] { return clock.is_over(); };
  const World world(environment, object, options.clearance, work);
  const Traffic traffic(movers, world);
  const Pose from = checked(start), to = checked(goal);
  require_free(world, from, "at the start");
  require_free(world, to, "at the goal");
  Pose before = from, after = to;
  before.time = traffic.begin();
  after.time = traffic.end();
  if (!traffic.is_free(before, from)) refuse_for_traffic(world, traffic, from, "at the start");
  if (!traffic.may_rest(after, after.time)) refuse_for_traffic(world, traffic, after, "at the goal");

  const MotionCost cost = cost_of(world, options.preferred_clearance);
  const Random random(options.seed);
  Found found{true, {from}};
  if (world.distance(from, to) > 0) found = search(world, from, to, options, cost, stop);
  if (found.reached) {
    if (options.shorten)
      found.way = shorten(world, std::move(found.way), cost, options.preferred_clearance, random, stop);
    found.way = timed(world, found.way, options.speed);
    if (!traffic.is_empty()) {
      found = search_in_time(world, traffic, found.way, options.speed, random, stop);
      if (found.reached && options.shorten)
        found.way = shorten_in_time(world, traffic, std::move(found.way), options.speed, random, stop);
    }
  }

  Plan plan;
  if (found.reached) {
    plan.path.emplace(found.way, world.about());
    if (!world.is_clear(*plan.path, work) || !traffic.is_clear(*plan.path, work))
      throw std::logic_error("a way that was found free is not clear");
    for (const Pose& pose : plan.path->poses()) plan.clearance.push_back(clearance_at(world, traffic, pose));
    plan.length = length_of(world, found.way);
  } else {
    plan.missing = world.distance(found.way.back(), to);
    plan.nearest = std::move(found.way);
  }
  plan.poses_tried = world.poses_tried();
  plan.motions_tried = world.motions_tried();
  plan.seconds = clock.seconds();
  return plan;
}

bool path_is_clear(const Octree& environment, const Octree& object, const Path& path, double clearance,
                   std::span<const Mover> movers, const Work& work) {
  const World world(environment, object, clearance, work);
  const Traffic traffic(movers, world);
  return world.is_clear(path, work) && traffic.is_clear(path, work);
}

}  // namespace blackleaf
