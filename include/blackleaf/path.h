// Path: poses of a solid over time.
//
// Meaning. A pose turns the solid about one fixed point of the source, `about`, and then shifts it:
// X' = R (X - about) + about + T, in voxels. Between two poses the translation is straight and the rotation turns at
// constant speed about one axis the shorter way round (slerp); time runs evenly. Before the first pose and after the
// last the solid rests.
//
// What follows: within a segment a point X travels exactly |dT + turning of X| <= |dT| + angle * r, r its distance from
// the axis, and evenly in time, so a segment cut into k equal parts has k parts of equal bound. A full turn needs three
// poses at least: the shorter way between two equal rotations is no turn at all.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "blackleaf/measures.h"
#include "blackleaf/motion.h"

namespace blackleaf {

struct Pose {
  double time = 0;  // in any unit; files say seconds
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// An immutable path of one pose or more.
class Path {
 public:
  /// Quaternions within 1e-3 of length 1 are normalised. Throws Error(bad_argument) that names the pose unless there is
  /// one at least, all numbers are finite and at most 1e9 in size, times increase strictly, quaternions have length 1.
  explicit Path(std::vector<Pose> poses, const Eigen::Vector3d& about = Eigen::Vector3d::Zero());

  const std::vector<Pose>& poses() const { return poses_; }
  /// The point of the source that rotations leave in place.
  const Eigen::Vector3d& about() const { return about_; }
  double begin() const { return poses_.front().time; }
  double end() const { return poses_.back().time; }

  /// The pose at a time; exactly the given one at the time of a pose. Requires: not NaN. O(log poses).
  Pose pose_at(double time) const;
  /// The same as a motion of the source.
  Motion motion_at(double time) const;

  /// An upper bound on the way, in voxels, that any point of the box travels between two times, in either order: the
  /// sum over the segments of |dT| + angle * r, r the largest distance of a corner of the closed box [min, max] from
  /// the segment's axis of rotation. So no point of the box is farther than this from itself at the other time.
  /// Rounding is allowed for. O(log poses + segments between).
  double motion_bound(double from, double to, const Box& box) const;

  /// Times from begin() to end(), those of all poses among them, such that the motion bound of the box from each to the
  /// next is below `step` voxels; evenly spaced within a segment. Throws Error(bad_argument) unless `step` is a finite
  /// number above 0, and when more than kMostTimes would be needed.
  std::vector<double> times(const Box& box, double step = 1) const;
  static constexpr std::size_t kMostTimes = std::size_t{1} << 20;

 private:
  std::size_t segment_of(double time) const;
  double segment_bound(std::size_t segment, const Box& box) const;

  std::vector<Pose> poses_;
  Eigen::Vector3d about_;
};

}  // namespace blackleaf
