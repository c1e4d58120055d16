#include "world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "blackleaf/error.h"
#include "motion/grow.h"
#include "octree/same_depth.h"

namespace blackleaf::detail {
namespace {

const Octree& checked(const Octree& environment, const Octree& object) {
  require_same_depth(environment, object);
  if (environment.depth() >= kMaxDepth)
    throw Error(ErrorCode::bad_argument, "a universe of depth 20 leaves no room for the walls that planning adds",
                "build both with a depth of 19 at most");
  if (object.is_empty())
    throw Error(ErrorCode::bad_argument, "the object to plan for has no black voxel", "give one that has");
  return environment;
}

std::array<std::int64_t, 3> corner_in_larger(const Octree& octree) {
  const std::int64_t half = octree.side() / 2;
  return {half, half, half};
}

Octree in_larger(const Octree& octree, bool black_outside, const Work& work) {
  return grow({octree, corner_in_larger(octree), black_outside}, 0, octree.depth() + 1, {}, work);
}

double largest_arm(const Box& box, const Eigen::Vector3d& about) {
  Eigen::Vector3d arm;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    arm[axis] = std::max(box.max[i] - about[axis], about[axis] - box.min[i]);
  }
  return arm.norm();
}

Motion motion_about(const Eigen::Vector3d& about, const Pose& pose) {
  return Motion::translation(pose.translation) * Motion::rotation(pose.rotation).about(about);
}

// Half of the angle, in [0, pi / 2].
double half_angle(const Pose& from, const Pose& to) {
  const Eigen::Quaterniond q = from.rotation.conjugate() * to.rotation;
  return std::atan2(q.vec().norm(), std::abs(q.w()));
}

}  // namespace

Pose pose_between(const Pose& from, const Pose& to, double t) {
  Pose begin = from, end = to;
  begin.time = 0;
  end.time = 1;
  return Path({begin, end}).pose_at(t);
}

World::World(const Octree& environment, const Octree& object, double clearance, const Work& work)
    : environment_(checked(environment, object)),
      object_(object),
      clearance_(clearance),
      about_(*centroid(object)),
      placed_about_(about_ + Eigen::Vector3d::Constant(environment.side() / 2.0)),
      box_(*bounding_box(object)),
      radius_(largest_arm(box_, about_)),
      prepared_environment_(environment),
      prepared_object_(object),
      walled_(in_larger(environment, true, work)),
      placed_(in_larger(object, false, work)) {}

double World::distance(const Pose& from, const Pose& to) const {
  return (to.translation - from.translation).norm() + 2 * half_angle(from, to) * radius_;
}

Motion World::motion(const Pose& pose) const { return motion_about(about_, pose); }

Path World::placed_path(std::vector<Pose> poses) const {
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].time = static_cast<double>(i);
  return Path(std::move(poses), placed_about_);
}

bool World::is_free(const Pose& pose) const {
  ++poses_tried_;
  if (clearance_ < 0) return clear(walled_, placed_, placed_path({pose}), {clearance_ + kMargin, kTolerance});
  return farther_than(clearance_ + kMargin + kTolerance, walled_, placed_, motion_about(placed_about_, pose));
}

bool World::is_free(const Pose& from, const Pose& to) const {
  // Most motions that are not free are so in the middle, or at a quarter, which is seen at once.
  for (const double t : {0.5, 0.25, 0.75})
    if (!is_free(pose_between(from, to, t))) return false;
  ++motions_tried_;
  return clear(walled_, placed_, placed_path({from, to}), {clearance_ + kMargin, kTolerance});
}

double World::free_part(const Pose& from, const Pose& to) const {
  ++motions_tried_;
  const auto contact = first_contact(walled_, placed_, placed_path({from, to}), {clearance_ + kMargin, kTolerance});
  if (!contact) return 1;
  // A little earlier, so that there is room to go on from there.
  return std::clamp(contact->time - 0.5 / std::max(distance(from, to), 1.0), 0.0, 1 - 0x1p-20);
}

bool World::is_clear(const Path& path, const Work& work) const {
  const ContactOptions options{clearance_, kLastTolerance};
  const Path placed(path.poses(), path.about() + (placed_about_ - about_));
  return clear(prepared_environment_, prepared_object_, path, options, work) &&
         clear(walled_, placed_, placed, options, work);
}

std::optional<MovedDistance> World::nearest(const Pose& pose, double up_to) const {
  return blackleaf::distance(prepared_environment_, prepared_object_, motion(pose), up_to);
}

}  // namespace blackleaf::detail
