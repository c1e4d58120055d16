#include "blackleaf/path.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "blackleaf/error.h"

namespace blackleaf {
namespace {

constexpr double kLargest = 1e9;     // of any number of a path: sums and products stay far from overflow
constexpr double kLengthOff = 1e-3;  // what quaternions written with four digits may miss of length 1

[[noreturn]] void refuse(std::size_t pose, const std::string& what, const std::string& remedy) {
  throw Error(ErrorCode::bad_argument, "poses[" + std::to_string(pose) + "]" + what, remedy);
}

bool in_range(const auto& numbers) { return numbers.allFinite() && numbers.cwiseAbs().maxCoeff() <= kLargest; }

// The turn from one pose to the next, the shorter way round: R_to = R_from * (turn by `angle` about `axis`), the axis
// in the source's own directions.
struct Turn {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  double angle = 0;  // radians, in [0, pi]
};

Turn turn_between(const Pose& from, const Pose& to) {
  Eigen::Quaterniond q = from.rotation.conjugate() * to.rotation;
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine == 0) return {};
  return {q.vec() / sine, 2 * std::atan2(sine, q.w())};
}

}  // namespace

Path::Path(std::vector<Pose> poses, const Eigen::Vector3d& about) : poses_(std::move(poses)), about_(about) {
  if (poses_.empty()) throw Error(ErrorCode::bad_argument, "a path has no pose", "give it one at least");
  const std::string finite = "use finite numbers of at most 1e9";
  if (!in_range(about_)) throw Error(ErrorCode::bad_argument, "about is out of range", finite);
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    Pose& pose = poses_[i];
    if (!(std::abs(pose.time) <= kLargest)) refuse(i, ".time is out of range", finite);
    if (!in_range(pose.translation)) refuse(i, ".translation is out of range", finite);
    if (!pose.rotation.coeffs().allFinite()) refuse(i, ".rotation is out of range", finite);
    const double length = pose.rotation.norm();
    if (!(std::abs(length - 1) <= kLengthOff))
      refuse(i, ".rotation has length " + std::to_string(length) + ", which no rotation has",
             "give a quaternion w,x,y,z of length 1");
    pose.rotation.normalize();
    if (i > 0 && !(poses_[i - 1].time < pose.time))
      refuse(i, ".time is not after that of poses[" + std::to_string(i - 1) + "]", "let times increase");
  }
}

// The segment that holds a time of the path, both ends included. Requires: two poses at least.
std::size_t Path::segment_of(double time) const {
  const auto after =
      std::upper_bound(poses_.begin(), poses_.end(), time, [](double t, const Pose& pose) { return t < pose.time; });
  const auto index = static_cast<std::size_t>(after - poses_.begin());
  return std::clamp<std::size_t>(index, 1, poses_.size() - 1) - 1;
}

Pose Path::pose_at(double time) const {
  assert(!std::isnan(time));
  if (time <= begin() || poses_.size() == 1) return {time, poses_.front().translation, poses_.front().rotation};
  if (time >= end()) return {time, poses_.back().translation, poses_.back().rotation};
  const std::size_t segment = segment_of(time);
  const Pose &from = poses_[segment], &to = poses_[segment + 1];
  const double part = (time - from.time) / (to.time - from.time);
  if (part == 0) return from;
  const Turn turn = turn_between(from, to);
  Pose pose{time, from.translation + part * (to.translation - from.translation), from.rotation};
  if (turn.angle > 0)
    pose.rotation = (from.rotation * Eigen::Quaterniond(Eigen::AngleAxisd(part * turn.angle, turn.axis))).normalized();
  return pose;
}

Motion Path::motion_at(double time) const {
  const Pose pose = pose_at(time);
  const Motion turned = Motion::rotation(pose.rotation).about(about_);
  return Motion(turned.rotation(), turned.translation() + pose.translation);
}

double Path::segment_bound(std::size_t segment, const Box& box) const {
  const Pose &from = poses_[segment], &to = poses_[segment + 1];
  const Turn turn = turn_between(from, to);
  double radius = 0;
  if (turn.angle > 0)
    for (unsigned corner = 0; corner < 8; ++corner) {
      Eigen::Vector3d arm;
      for (unsigned i = 0; i < 3; ++i)
        arm[i] = (corner >> i & 1 ? box.max : box.min)[i] - about_[static_cast<Eigen::Index>(i)];
      radius = std::max(radius, arm.cross(turn.axis).norm());
    }
  // Every operation is off by 2^-53 of its result; none cancels more than |arm| <= 2e9.
  constexpr double kRounding = 1 + 0x1p-40;
  return ((to.translation - from.translation).norm() + turn.angle * (radius + 0x1p-16)) * kRounding;
}

double Path::motion_bound(double from, double to, const Box& box) const {
  if (from > to) std::swap(from, to);
  from = std::clamp(from, begin(), end());
  to = std::clamp(to, begin(), end());
  double way = 0;
  if (poses_.size() == 1) return way;
  for (std::size_t segment = segment_of(from); segment + 1 < poses_.size() && poses_[segment].time < to; ++segment) {
    const double first = poses_[segment].time, last = poses_[segment + 1].time;
    const double part = (std::min(to, last) - std::max(from, first)) / (last - first);
    way += std::max(part, 0.0) * segment_bound(segment, box);
  }
  return way * (1 + 0x1p-40);
}

std::vector<double> Path::times(const Box& box, double step) const {
  if (!(step > 0) || !std::isfinite(step))
    throw Error(ErrorCode::bad_argument, "a path is cut into steps of " + std::to_string(step) + " voxels",
                "let steps be longer than 0");
  std::vector<double> times;
  for (std::size_t segment = 0; segment + 1 < poses_.size(); ++segment) {
    const double parts = std::floor(segment_bound(segment, box) * (1 + 0x1p-40) / step) + 1;
    if (!(parts + static_cast<double>(times.size()) < static_cast<double>(kMostTimes)))
      throw Error(ErrorCode::bad_argument,
                  "the path would have more than " + std::to_string(kMostTimes) + " steps, the most there may be",
                  "take longer steps or a part of the path");
    const double first = poses_[segment].time, length = poses_[segment + 1].time - first;
    const auto count = static_cast<std::size_t>(parts);
    for (std::size_t i = 0; i < count; ++i) times.push_back(first + length * (static_cast<double>(i) / parts));
  }
  times.push_back(end());
  return times;
}

}  // namespace blackleaf
