// OMPL's RRT-Connect over FCL's octrees: the usual way, poses sampled along every motion.
#include <fcl/geometry/octree/octree.h>
#include <fcl/narrowphase/collision.h>
#include <octomap/OcTree.h>
#include <ompl/base/DiscreteMotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <memory>

#include "blackleaf/leaves.h"
#include "blackleaf/measures.h"
#include "contenders.h"
#include "plan_scene.h"

namespace blackleaf::bench {
namespace {

namespace ob = ompl::base;
using Space = ob::SE3StateSpace;

std::shared_ptr<fcl::OcTree<double>> tree_of(const Octree& octree) {
  auto tree = std::make_shared<octomap::OcTree>(1.0);
  for (int z = 0; z < octree.side(); ++z)
    for (int y = 0; y < octree.side(); ++y)
      for (int x = 0; x < octree.side(); ++x)
        if (octree.contains(x, y, z))
          tree->setNodeValue(octomap::point3d(float(x) + 0.5F, float(y) + 0.5F, float(z) + 0.5F),
                             tree->getClampingThresMaxLog(), true);
  tree->updateInnerOccupancy();
  tree->prune();
  return std::make_shared<fcl::OcTree<double>>(tree);
}

class Fcl {
 public:
  explicit Fcl(const NarrowPassage& scene)
      : scene_(scene), environment_(tree_of(scene.environment)), object_(tree_of(scene.object)) {
    const Box box = *bounding_box(scene.object);
    about_ = *centroid(scene.object);
    Eigen::Vector3d arm;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      arm[axis] = std::max(box.max[i] - about_[axis], about_[axis] - box.min[i]);
    }
    radius_ = arm.norm();
  }

  // The same space, planner, range and seed as ours.
  bool solve(std::uint32_t seed) const {
    ompl::msg::noOutputHandler();
    ompl::RNG::setSeed(seed + 1);
    auto space = std::make_shared<Space>();
    ob::RealVectorBounds bounds(3);
    for (unsigned i = 0; i < 3; ++i) {
      bounds.setLow(i, -about_[static_cast<Eigen::Index>(i)]);
      bounds.setHigh(i, scene_.environment.side() - about_[static_cast<Eigen::Index>(i)]);
    }
    space->setBounds(bounds);
    space->setSubspaceWeight(1, 2 * radius_);
    auto information = std::make_shared<ob::SpaceInformation>(space);
    information->setStateValidityChecker([&](const ob::State* state) {
      return information->satisfiesBounds(state) && is_free(*state->as<Space::StateType>());
    });
    information->setMotionValidator(std::make_shared<ob::DiscreteMotionValidator>(information));
    // No point travels half of the plate's thickness between two poses, so none goes through it unseen.
    information->setStateValidityCheckingResolution(scene_.thinnest() / 2 / space->getMaximumExtent());
    information->setup();
    auto problem = std::make_shared<ob::ProblemDefinition>(information);
    ob::ScopedState<Space> from(space), to(space);
    set(from, scene_.start);
    set(to, scene_.goal);
    problem->setStartAndGoalStates(from, to);
    ompl::geometric::RRTConnect planner(information);
    planner.setRange(radius_ / 3);
    planner.setProblemDefinition(problem);
    planner.setup();
    planner.solve(ob::timedPlannerTerminationCondition(scene_.options.seconds));
    return problem->hasExactSolution();
  }

 private:
  static void set(ob::ScopedState<Space>& state, const Pose& pose) {
    state->setXYZ(pose.translation.x(), pose.translation.y(), pose.translation.z());
    state->rotation().setIdentity();
  }

  bool is_free(const Space::StateType& state) const {
    const auto& q = state.rotation();
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
    motion.translation() =
        about_ - motion.linear() * about_ + Eigen::Vector3d(state.getX(), state.getY(), state.getZ());
    const fcl::CollisionRequest<double> request;
    fcl::CollisionResult<double> result;
    return fcl::collide<double>(environment_.get(), Eigen::Isometry3d::Identity(), object_.get(), motion, request,
                                result) == 0;
  }

  NarrowPassage scene_;
  std::shared_ptr<fcl::OcTree<double>> environment_, object_;
  Eigen::Vector3d about_;
  double radius_ = 0;
};

}  // namespace

void add_fcl_plan() {
  add_timed_plans("plan/narrow", "fcl-octree", [] {
    const auto fcl = std::make_shared<Fcl>(NarrowPassage(6));
    return [fcl](std::uint32_t seed) { return fcl->solve(seed); };
  });
}

}  // namespace blackleaf::bench
