#include "stretch.h"

#include <algorithm>
#include <cmath>

namespace blackleaf::detail {
namespace {

// The leg of a path from one time to another with no pose between them.
Leg leg(const Path* path, double from, double to) {
  Leg result;
  if (path == nullptr) return result;
  const std::vector<Pose>& poses = path->poses();
  result.about = path->about();
  const auto after = std::upper_bound(poses.begin(), poses.end(), from,
                                      [](double time, const Pose& pose) { return time < pose.time; });
  const Pose& first = after == poses.begin() ? poses.front() : *(after - 1);
  result.rotation = first.rotation;
  result.translation = first.translation;
  if (after == poses.begin() || after == poses.end()) return result;  // before the first pose, or after the last
  const Pose& last = *after;
  const double length = last.time - first.time, begin = (from - first.time) / length, part = (to - from) / length;
  Eigen::Quaterniond turn = first.rotation.conjugate() * last.rotation;
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();
  if (sine > 0) {
    const double angle = 2 * std::atan2(sine, turn.w());
    result.axis = turn.vec() / sine;
    result.angle = part * angle;
    if (begin > 0)
      result.rotation =
          (first.rotation * Eigen::Quaterniond(Eigen::AngleAxisd(begin * angle, result.axis))).normalized();
  }
  const Eigen::Vector3d whole = last.translation - first.translation;
  result.translation += begin * whole;
  result.way = part * whole;
  return result;
}

}  // namespace

RigidMap Leg::at(double s) const {
  const Eigen::Quaterniond turned =
      angle == 0 ? rotation : (rotation * Eigen::Quaterniond(Eigen::AngleAxisd(s * angle, axis))).normalized();
  RigidMap map;
  map.rotation = turned.toRotationMatrix();
  map.shift = about + translation + s * way - map.rotation * about;
  return map;
}

std::vector<Stretch> stretches(const Path* a, const Path* b, double from, double to) {
  std::vector<double> times = {from, to};
  for (const Path* path : {a, b})
    if (path != nullptr)
      for (const Pose& pose : path->poses())
        if (from < pose.time && pose.time < to) times.push_back(pose.time);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  if (times.size() == 1) times.push_back(times.front());
  std::vector<Stretch> result;
  for (std::size_t i = 0; i + 1 < times.size(); ++i)
    result.push_back({times[i], times[i + 1], leg(a, times[i], times[i + 1]), leg(b, times[i], times[i + 1])});
  return result;
}

double coordinate_size(const Path* path, double side) {
  double size = 2 * side;
  if (path == nullptr) return size;
  double farthest = 0;
  for (const Pose& pose : path->poses()) farthest = std::max(farthest, pose.translation.norm());
  return size + farthest + 2 * path->about().norm();
}

}  // namespace blackleaf::detail
