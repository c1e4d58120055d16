// Frame: where an octree's universe lies in the world.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace blackleaf {

/// The affine map from universe (voxel) coordinates p to world coordinates: world = origin + axes * p.
/// Column i of `axes` is the world displacement of one voxel along universe axis i: its direction times the voxel's
/// size. Axes need be neither orthogonal nor right-handed. Volumes read through ITK use its LPS convention.
struct Frame {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  std::string unit = "voxel";

  Eigen::Vector3d to_world(const Eigen::Vector3d& voxels) const { return origin + axes * voxels; }

  /// The frame of a universe whose corner lies at voxel coordinates `corner` of this one.
  Frame shifted(const Eigen::Vector3d& corner) const { return {to_world(corner), axes, unit}; }

  /// Equal up to rounding: origins within `tolerance` voxels of each other, axes relatively alike, units the same.
  bool same_as(const Frame& other, double tolerance = 1e-6) const;

  friend bool operator==(const Frame&, const Frame&) = default;
};

/// Where voxel (0,0,0) of a universe in frame `from` lies in frame `to`, in whole voxels: the same place of the world
/// is p there and p + shift here. None unless the axes and the unit are the same and the shift is one of whole voxels,
/// up to the rounding of file headers (1e-3 voxels), of less than 2^40.
std::optional<std::array<std::int64_t, 3>> whole_shift(const Frame& from, const Frame& to);

}  // namespace blackleaf
