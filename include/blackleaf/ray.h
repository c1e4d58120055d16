// Rays: where a ray meets a solid.
//
// Meaning. A ray is the points origin + t direction, t >= 0, in voxels. It is rounded once: the origin to multiples of
// 2^-30 voxels, the direction to 39 bits of its largest coordinate, so that what needs no more bits stays as it is;
// from there on every decision is made in integers. The ray is in the solid where the cubes on all sides of it are
// black: single points, where it only grazes an edge or a corner, do not count, nor does a ray in a face that has black
// cubes on one side only. So rays see solids as drawings do.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

struct Ray {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::UnitX();
};

/// Where a ray enters or leaves a solid.
struct RayPoint {
  double time = 0;  // in units of the direction's length; right to 2^-51 of itself
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// The face's normal, outward; zero where the ray begins in the solid. Of several faces, at an edge or a corner, the
  /// one across the first axis.
  Eigen::Vector3i normal = Eigen::Vector3i::Zero();
};

/// The first point of the ray in the solid, if there is one with time <= `up_to`: its origin if it begins there. Throws
/// Error(bad_argument) unless all numbers are finite, the direction is not 0 and |origin_i| <= 2^23. O(nodes passed).
std::optional<RayPoint> first_hit(const Octree& octree, const Ray& ray,
                                  double up_to = std::numeric_limits<double>::infinity());
/// The same for many rays, in order, on all threads that `work` allows.
std::vector<std::optional<RayPoint>> first_hits(const Octree& octree, std::span<const Ray> rays, const Work& work = {});

/// A stretch of a ray in the solid.
struct RayStretch {
  RayPoint enter, leave;
};
/// All of them, in order; no two touch. Throws as above. O(nodes passed).
std::vector<RayStretch> crossings(const Octree& octree, const Ray& ray);

}  // namespace blackleaf
