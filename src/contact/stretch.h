// Stretch: a piece of time in which two solids move evenly, without a pose in between.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "blackleaf/path.h"
#include "box_pair.h"

namespace blackleaf::detail {

/// How one solid moves in a stretch; s runs from 0 to 1.
struct Leg {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // at s = 0
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();                // of the turn, in the solid's own directions
  double angle = 0;                                              // of the whole stretch, radians, at most pi
  Eigen::Vector3d translation = Eigen::Vector3d::Zero(), way = Eigen::Vector3d::Zero();  // at s = 0; to s = 1
  Eigen::Vector3d about = Eigen::Vector3d::Zero();

  bool rests() const { return angle == 0 && way.isZero(0); }
  RigidMap at(double s) const;
  /// How far a point of the solid is from the axis of the turn.
  double radius(const Eigen::Vector3d& point) const { return (point - about).cross(axis).norm(); }
};

struct Stretch {
  double begin = 0, end = 0;  // times
  Leg a, b;

  double time(double s) const { return s == 0 ? begin : s == 1 ? end : begin + s * (end - begin); }
};

/// The stretches from one time to another, cut at the poses of both paths; a null path is rest where the solid is. One
/// stretch of no length if from == to. Requires: from <= to.
std::vector<Stretch> stretches(const Path* a, const Path* b, double from, double to);

/// An upper bound on the size of all coordinates that come up on the way, for solids in a universe of this side.
double coordinate_size(const Path* path, double side);

}  // namespace blackleaf::detail
