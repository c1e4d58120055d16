// Universes for point clouds.
#include <cmath>
#include <string>

#include "blackleaf/error.h"
#include "blackleaf/points.h"
#include "rounded_up.h"

namespace blackleaf {
namespace {

void require_points(const Eigen::AlignedBox3d& points) {
  if (points.isEmpty())
    throw Error(ErrorCode::bad_input, "there are no points", "give one at least, with finite coordinates");
  if (!points.min().allFinite() || !points.max().allFinite() || !points.sizes().allFinite())
    throw Error(ErrorCode::bad_input, "the points are too far apart for floating point", "scale them down");
}

void require_depth(int depth, int lowest) {
  if (depth < lowest || depth > kMaxDepth)
    throw Error(ErrorCode::bad_argument, "depth " + std::to_string(depth) + " is out of range",
                lowest == 0 ? "use 1 to 20, or 0 for the smallest that holds the points" : "use 1 to 20");
}

// The size of voxels that hold the points in a universe of this depth wherever the lattice's walls fall.
std::string larger_voxels(const Eigen::AlignedBox3d& points, int depth) {
  if (depth < 2) return "use larger voxels";
  return "use voxels of side " + detail::rounded_up(points.sizes().maxCoeff() / (std::ldexp(1.0, depth) - 2)) +
         " or more";
}

MeshPlacement placement(int depth, const Eigen::Vector3d& origin, double voxel_size) {
  return {depth, {origin, Eigen::Matrix3d::Identity() * voxel_size, "unit"}};
}

}  // namespace

MeshPlacement place_points_by_fraction(const Eigen::AlignedBox3d& points, int depth, double fraction) {
  require_depth(depth, 1);
  if (!(fraction > 0 && fraction <= 1))
    throw Error(ErrorCode::bad_argument, "fraction " + std::to_string(fraction) + " is out of range",
                "use more than 0, at most 1");
  require_points(points);
  const double longest = points.sizes().maxCoeff();
  const double size = std::ldexp(longest / fraction, -depth);
  if (!(size > 0) || !std::isfinite(std::ldexp(size, depth)))
    throw Error(ErrorCode::bad_input,
                longest > 0 ? "the points give voxels of a size beyond floating point" : "all points lie at one place",
                "give the voxels' size instead");
  const Eigen::Vector3d centre = points.min() + 0.5 * points.sizes();
  return placement(depth, centre.array() - std::ldexp(size, depth - 1), size);
}

MeshPlacement place_points_by_voxel_size(const Eigen::AlignedBox3d& points, double voxel_size, int depth) {
  require_depth(depth, 0);
  if (!(voxel_size > 0) || !std::isfinite(voxel_size))
    throw Error(ErrorCode::bad_argument, "voxel size " + std::to_string(voxel_size) + " is out of range",
                "use a finite size above 0");
  require_points(points);
  // Voxels by their places in a lattice over all space.
  if (const double span = points.sizes().maxCoeff() / voxel_size; !(span < 0x1p50))
    throw Error(ErrorCode::out_of_universe,
                "the points span 2^50 voxels or more, but a universe of depth " + std::to_string(kMaxDepth) + " has " +
                    std::to_string(std::int64_t{1} << kMaxDepth),
                larger_voxels(points, kMaxDepth));
  const Eigen::Vector3d first = (points.min() / voxel_size).array().floor();
  const Eigen::Vector3d last = (points.max() / voxel_size).array().floor();
  if (!(first.cwiseAbs().maxCoeff() < 0x1p50) || !(last.cwiseAbs().maxCoeff() < 0x1p50))
    throw Error(ErrorCode::bad_input, "the points lie 2^50 voxels or more from the origin",
                "use larger voxels, or shift the points");
  const Eigen::Vector3d voxels = (last - first).array() + 1.0;
  const double longest = voxels.maxCoeff();
  if (depth == 0)
    for (depth = 1; depth < kMaxDepth && longest > std::ldexp(1.0, depth);) ++depth;
  if (longest > std::ldexp(1.0, depth))
    throw Error(ErrorCode::out_of_universe,
                "the points span " + std::to_string(static_cast<std::int64_t>(longest)) +
                    " voxels but a universe of depth " + std::to_string(depth) + " has " +
                    std::to_string(std::int64_t{1} << depth),
                larger_voxels(points, depth) + (depth < kMaxDepth ? " or a greater depth" : ""));
  const Eigen::Vector3d margin = ((std::ldexp(1.0, depth) - voxels.array()) / 2).floor();
  return placement(depth, (first - margin) * voxel_size, voxel_size);
}

}  // namespace blackleaf
