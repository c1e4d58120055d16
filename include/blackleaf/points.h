// Octrees from point clouds: a voxel is black iff points lie in it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <span>

#include "blackleaf/mesh.h"
#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// The points' box centred in a universe of the given depth, its longest side `fraction` of the universe's side.
/// Throws Error(bad_argument) unless 0 < fraction <= 1 and 1 <= depth <= 20, Error(bad_input) for a box that is empty,
/// not finite or a single place.
MeshPlacement place_points_by_fraction(const Eigen::AlignedBox3d& points, int depth, double fraction);
/// A universe whose voxels have the given side in the points' units and whose walls between voxels lie at whole
/// multiples of it, as OctoMap's do, so that clouds of one scene share their voxels. The points' box is in the middle,
/// to a voxel; depth 0 takes the smallest universe that holds it. Throws as above, Error(bad_input) for coordinates of
/// 2^50 voxels or more, and Error(out_of_universe) for a box that is larger than the universe.
MeshPlacement place_points_by_voxel_size(const Eigen::AlignedBox3d& points, double voxel_size, int depth = 0);

struct PointOptions {
  std::uint64_t min_points = 1;  // a voxel is black iff it holds at least as many, 1 to 2^32 - 1
  bool clip = false;             // drop points outside the universe instead of refusing them
};

/// Gathers points, as many as there may be and in any order, and makes the octree of the voxels that hold them. Memory
/// grows with the voxels, not with the points: 8 bytes a voxel and up to as many again, 12 with min_points above 1, and
/// 32 MB for what is not yet sorted. Not to be used from several threads at once; the work itself is parallel.
class PointGatherer {
 public:
  /// Throws Error(bad_argument) for a depth outside 1..20, axes that do not span space, or min_points out of range.
  explicit PointGatherer(const MeshPlacement& placement, const PointOptions& options = {}, int threads = 0);
  ~PointGatherer();
  PointGatherer(PointGatherer&&) noexcept;
  PointGatherer& operator=(PointGatherer&&) noexcept;

  /// Adds points in world coordinates. Each is mapped to the universe and rounded once to a grid of 2^(depth-40)
  /// voxels; those outside by at most 2^-16 voxels are put on the wall. A voxel holds its lower walls, not its upper
  /// ones, but the universe's upper walls belong to the last voxels. Points that are not finite are counted and
  /// dropped. O(points log points) in total.
  void add(std::span<const Eigen::Vector3d> points);

  std::uint64_t points() const;      // added, all of them
  std::uint64_t not_finite() const;  // of these
  std::uint64_t outside() const;     // of these, outside the universe

  /// The octree of all points so far. Throws Error(out_of_universe) if there were points outside, unless they are to be
  /// clipped. O(voxels).
  Octree octree(const Work& work = {});

 private:
  class Gathered;
  std::unique_ptr<Gathered> gathered_;
};

/// All at once, through a PointGatherer. Throws as its functions do.
Octree octree_from_points(std::span<const Eigen::Vector3d> points, const MeshPlacement& placement,
                          const PointOptions& options = {}, const Work& work = {});

}  // namespace blackleaf
