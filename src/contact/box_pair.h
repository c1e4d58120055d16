// Two boxes, one upright and one placed anyhow: how far apart, along which axes.
//
// Everything is in the upright box's frame: a point y of the other box's own frame is at F y + g. F is a rotation, or
// as near to one as FixedMotion's grid leaves it (2^-37); that the columns of F are not quite of length 1 and
// orthogonal is allowed for where it matters.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "box_tree.h"

namespace blackleaf::detail {

/// Where the second frame is, seen from the first: y -> F y + g.
struct RigidMap {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};

inline Eigen::Vector3d centre_of(const BoxNode& box) {
  return {double{box.centre[0]}, double{box.centre[1]}, double{box.centre[2]}};
}
inline Eigen::Vector3d half_of(const BoxNode& box) {
  return {double{box.half[0]}, double{box.half[1]}, double{box.half[2]}};
}

struct NearestPoints {
  double distance = 0;  // 0 when they overlap, as far as doubles can tell
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero(), on_b = Eigen::Vector3d::Zero();  // in the frame of a
};

/// Nearest points of two closed boxes. The distance is found to 1e-11 + 2^-46 of the coordinates' size, which is
/// certified: the distance between the points is an upper bound, and the gap between the boxes' projections onto their
/// connection a lower one (Gilbert, Johnson and Keerthi 1988). Should rounding keep the two apart, all pairs of
/// features are looked at. O(1).
NearestPoints nearest_points(const BoxNode& a, const BoxNode& b, const RigidMap& map_of_b);

/// The largest gap between the projections onto the 15 axes that may separate two boxes: face normals and crossed
/// edges. Negative: the depth of their overlap. Positive: at most their distance.
double separation(const BoxNode& a, const BoxNode& b, const RigidMap& map_of_b);

}  // namespace blackleaf::detail
