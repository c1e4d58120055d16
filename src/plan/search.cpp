#include "search.h"

#include <ompl/base/PlannerData.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>

namespace blackleaf::detail {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

// SE(3) with distances in one step: planners look for nearest neighbours so often that OMPL's own, which asks its two
// parts by virtual functions, would take most of the time of planning. The numbers are the same.
class Space : public ob::SE3StateSpace {
 public:
  double distance(const ob::State* a, const ob::State* b) const override {
    const auto *p = a->as<StateType>(), *q = b->as<StateType>();
    const double x = p->getX() - q->getX(), y = p->getY() - q->getY(), z = p->getZ() - q->getZ();
    const auto &r = p->rotation(), &s = q->rotation();
    const double cosine = std::abs(r.x * s.x + r.y * s.y + r.z * s.z + r.w * s.w);  // of half the angle
    const double half_angle = cosine > 1 - kSame ? 0 : std::acos(cosine);
    return weights_[0] * std::sqrt(x * x + y * y + z * z) + weights_[1] * half_angle;
  }

 private:
  static constexpr double kSame = 1e-9;  // as in SO3StateSpace
};

Pose pose_of(const ob::State* state) {
  const auto* se3 = state->as<Space::StateType>();
  const auto& q = se3->rotation();
  return {0, {se3->getX(), se3->getY(), se3->getZ()}, Eigen::Quaterniond(q.w, q.x, q.y, q.z)};
}

void set(ob::State* state, const Pose& pose) {
  auto* se3 = state->as<Space::StateType>();
  se3->setXYZ(pose.translation.x(), pose.translation.y(), pose.translation.z());
  auto& q = se3->rotation();
  const Eigen::Quaterniond& r = pose.rotation;
  q.w = r.w();
  q.x = r.x();
  q.y = r.y();
  q.z = r.z();
}

// Whole motions instead of samples of them.
class WholeMotions : public ob::MotionValidator {
 public:
  WholeMotions(const ob::SpaceInformationPtr& information, const World& world)
      : ob::MotionValidator(information), world_(world) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    const bool free = world_.is_free(pose_of(from), pose_of(to));
    ++(free ? valid_ : invalid_);
    return free;
  }

  bool checkMotion(const ob::State* from, const ob::State* to, std::pair<ob::State*, double>& last) const override {
    const double part = world_.free_part(pose_of(from), pose_of(to));
    ++(part == 1 ? valid_ : invalid_);
    if (part == 1) return true;
    last.second = part;
    if (last.first) si_->getStateSpace()->interpolate(from, to, part, last.first);
    return false;
  }

 private:
  const World& world_;
};

class Cost : public ob::OptimizationObjective {
 public:
  Cost(const ob::SpaceInformationPtr& information, const MotionCost& cost)
      : ob::OptimizationObjective(information), cost_(cost) {
    description_ = "length and clearance";
  }
  ob::Cost stateCost(const ob::State*) const override { return identityCost(); }
  ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
    return ob::Cost(cost_(pose_of(from), pose_of(to)));
  }
  ob::Cost motionCostHeuristic(const ob::State* from, const ob::State* to) const override {
    return ob::Cost(si_->distance(from, to));
  }

 private:
  const MotionCost& cost_;
};

// PRM* on one thread. OMPL's own solve() looks for a way in a second thread, whenever that comes to it, so that no two
// runs build the same roadmap.
class PrmStar : public og::PRMstar {
 public:
  explicit PrmStar(const ob::SpaceInformationPtr& information) : og::PRMstar(information) {}

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& stop) override {
    checkValidity();
    while (const ob::State* state = pis_.nextStart()) startM_.push_back(addMilestone(si_->cloneState(state)));
    while (const ob::State* state = pis_.nextGoal()) goalM_.push_back(addMilestone(si_->cloneState(state)));
    if (startM_.empty() || goalM_.empty()) return ob::PlannerStatus::INVALID_START;
    bestCost_ = opt_->infiniteCost();
    ob::PathPtr way;
    while (true) {
      ob::PathPtr next;
      maybeConstructSolution(startM_, goalM_, next);
      if (next && (!way || opt_->isCostBetterThan(next->cost(opt_), way->cost(opt_)))) {
        if (!way) pdef_->getIntermediateSolutionCallback()(this, {}, next->cost(opt_));
        way = next;
      }
      if (stop()) break;
      int asked = 0;
      growRoadmap(ob::PlannerTerminationCondition([&] { return ++asked > kBatch || stop(); }));
    }
    if (!way) return ob::PlannerStatus::TIMEOUT;
    pdef_->addSolutionPath(ob::PlannerSolution(way));
    return ob::PlannerStatus::EXACT_SOLUTION;
  }

 private:
  static constexpr int kBatch = 60;  // questions asked of `stop` between two looks for a way
};

ob::PlannerPtr make(const PlanOptions& options, const ob::SpaceInformationPtr& information, double range) {
  switch (options.planner) {
    case Planner::rrt_connect: {
      auto planner = std::make_shared<og::RRTConnect>(information);
      planner->setRange(range);
      return planner;
    }
    case Planner::rrt_star: {
      auto planner = std::make_shared<og::RRTstar>(information);
      planner->setRange(range);
      return planner;
    }
    case Planner::prm_star:
      return std::make_shared<PrmStar>(information);
    case Planner::kpiece: {
      auto planner = std::make_shared<og::KPIECE1>(information);
      planner->setRange(range);
      return planner;
    }
    case Planner::bit_star:
      return std::make_shared<og::BITstar>(information);
  }
  return nullptr;
}

// Of all that the planner has reached from the start, the way to what is nearest to the goal.
std::vector<Pose> nearest_way(const ob::Planner& planner, const ob::SpaceInformationPtr& information,
                              const ob::State* goal) {
  ob::PlannerData data(information);
  planner.getPlannerData(data);
  const unsigned count = data.numVertices();
  if (data.numStartVertices() == 0) return {};
  constexpr unsigned kNone = std::numeric_limits<unsigned>::max();
  std::vector<unsigned> from(count, kNone), queue;
  for (unsigned i = 0; i < data.numStartVertices(); ++i) {
    queue.push_back(data.getStartIndex(i));
    from[queue.back()] = queue.back();
  }
  unsigned best = queue.front();
  double missing = std::numeric_limits<double>::infinity();
  for (std::size_t at = 0; at < queue.size(); ++at) {
    const unsigned vertex = queue[at];
    const double rest = information->distance(data.getVertex(vertex).getState(), goal);
    if (rest < missing) {
      missing = rest;
      best = vertex;
    }
    std::vector<unsigned> edges;
    data.getEdges(vertex, edges);
    for (const unsigned next : edges)
      if (from[next] == kNone) {
        from[next] = vertex;
        queue.push_back(next);
      }
  }
  std::vector<Pose> way{pose_of(data.getVertex(best).getState())};
  for (; from[best] != best; best = from[best]) way.push_back(pose_of(data.getVertex(from[best]).getState()));
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace

Found search(const World& world, const Pose& start, const Pose& goal, const PlanOptions& options,
             const MotionCost& cost, const std::function<bool()>& stop) {
  // OMPL has one source of seeds and one log for the whole process.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  ompl::msg::noOutputHandler();
  ompl::RNG::setSeed(options.seed + 1);  // 0 is no seed for it

  auto space = std::make_shared<Space>();
  ob::RealVectorBounds bounds(3);
  // The centroid lies in the hull of the object, so in the universe whenever the object does.
  for (unsigned i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    bounds.setLow(i, -world.about()[axis]);
    bounds.setHigh(i, world.environment().side() - world.about()[axis]);
  }
  space->setBounds(bounds);
  space->setSubspaceWeight(1, 2 * world.radius());  // OMPL measures rotations by half their angle
  auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker(
      [&](const ob::State* state) { return information->satisfiesBounds(state) && world.is_free(pose_of(state)); });
  information->setMotionValidator(std::make_shared<WholeMotions>(information, world));
  information->setup();

  auto problem = std::make_shared<ob::ProblemDefinition>(information);
  ob::ScopedState<Space> from(space), to(space);
  set(from.get(), start);
  set(to.get(), goal);
  problem->setStartAndGoalStates(from, to);
  if (cost)
    problem->setOptimizationObjective(std::make_shared<Cost>(information, cost));
  else
    problem->setOptimizationObjective(std::make_shared<ob::PathLengthOptimizationObjective>(information));

  // Rounds are counted by how often a planner asks whether to stop, which is the same in every run; what `stop` throws
  // must not pass through OMPL.
  std::exception_ptr thrown;
  bool reached = false;
  std::int64_t rounds_left = options.refinement;
  problem->setIntermediateSolutionCallback(
      [&](const ob::Planner*, const std::vector<const ob::State*>&, const ob::Cost) { reached = true; });
  const ob::PlannerTerminationCondition done([&] {
    if (thrown || (reached && rounds_left-- <= 0)) return true;
    try {
      return stop();
    } catch (...) {
      thrown = std::current_exception();
      return true;
    }
  });
  // Turns in narrow places want short motions, and large rooms long ones; RRT*, whose one tree goes all the way and is
  // rewired as it grows, wants fewer.
  const double usual =
      std::max(world.radius() / 3, world.environment().side() / 32.0) * (options.planner == Planner::rrt_star ? 3 : 1);
  const ob::PlannerPtr planner = make(options, information, options.range > 0 ? options.range : usual);
  planner->setProblemDefinition(problem);
  planner->setup();
  planner->solve(done);
  if (thrown) std::rethrow_exception(thrown);

  Found found;
  found.reached = problem->hasExactSolution();
  if (found.reached) {
    for (const ob::State* state : problem->getSolutionPath()->as<og::PathGeometric>()->getStates())
      found.way.push_back(pose_of(state));
  } else {
    found.way = nearest_way(*planner, information, to.get());
  }
  if (found.way.empty()) found.way.push_back(start);
  return found;
}

}  // namespace blackleaf::detail
