// Distance: how far a solid is from a moved one, and from points.
//
// Meaning. The moved solid is exact: its cubes are tilted, nothing is voxelised, and the motion is rounded once to the
// grid of FixedMotion. The distance of two solids is the least distance of a point of one from a point of the other,
// both solids closed, so it is 0 when they touch and when they interfere. Whether it is 0 is decided in integers; other
// distances are right to 1e-9 voxels up to depth 12 (doubles beyond: 2^-44 of the coordinates' size).
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "blackleaf/motion.h"
#include "blackleaf/octree.h"
#include "blackleaf/prepared_solid.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// Two nearest points of two solids, in voxels of the universe.
struct MovedDistance {
  double voxels = 0;                                                               // 0 iff they touch or interfere
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero(), on_b = Eigen::Vector3d::Zero();  // that far apart
};

/// The distance of `a` from `b` moved, or none if one is empty or they are farther apart than `up_to`. When the solids
/// interfere, on_a and on_b are one point of both. The moved solid may lie anywhere, in the universe or not. Throws
/// Error(bad_argument) when depths differ. Branch and bound over pairs of nodes; O(pairs of nodes near the shortest
/// connection).
std::optional<MovedDistance> distance(const PreparedSolid& a, const PreparedSolid& b, const Motion& motion_of_b,
                                      double up_to = std::numeric_limits<double>::infinity());
/// The same for octrees that are asked once; preparing them costs O(words).
std::optional<MovedDistance> distance(const Octree& a, const Octree& b, const Motion& motion_of_b,
                                      double up_to = std::numeric_limits<double>::infinity());
/// The same for many motions, on all threads that `work` allows; in order.
std::vector<std::optional<MovedDistance>> distances(const PreparedSolid& a, const PreparedSolid& b,
                                                    std::span<const Motion> motions_of_b, const Work& work = {});

/// True iff the distance is more than `voxels`, or one is empty. Stops as soon as that is known either way, which is
/// much earlier than the distance itself. Throws as distance(). Requires: voxels >= 0.
bool farther_than(double voxels, const PreparedSolid& a, const PreparedSolid& b, const Motion& motion_of_b);

/// The point of a solid nearest to a given point.
struct ClosestPoint {
  double voxels = 0;  // how far; 0 in the closed solid
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};
/// None if the solid is empty. Requires: finite coordinates. O(depth) for most points.
std::optional<ClosestPoint> closest(const PreparedSolid& solid, const Eigen::Vector3d& point);
std::optional<ClosestPoint> closest(const Octree& solid, const Eigen::Vector3d& point);
/// The same for many points, on all threads that `work` allows; in order. Empty if the solid is empty.
std::vector<ClosestPoint> closest(const PreparedSolid& solid, std::span<const Eigen::Vector3d> points,
                                  const Work& work = {});

}  // namespace blackleaf
