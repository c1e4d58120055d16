// Perspective line drawings: what an eye at a point sees, as exactly as parallel projection draws it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "blackleaf/drawing.h"
#include "blackleaf/scene.h"

namespace blackleaf {

/// A perspective projection. The eye looks from one point to another, the target. Right and up are those of the View
/// from the target toward the eye. A point x in front of the eye e lands at
///
///   u = D (right . (x - e)) / depth,  v = D (up . (x - e)) / depth,  depth = -direction . (x - e),
///
/// with D the distance from eye to target: what lies in the target's plane, square to the line of sight, is drawn in
/// its true size in voxels, with the target at (0, 0). Only what lies inside the field of view is drawn, a pyramid
/// whose opposite sides meet in the eye at an angle of `field_of_view`: |u|, |v| <= D tan(field_of_view / 2).
class Perspective {
 public:
  static constexpr int kGridBits = 16;                   // coordinates are kept in units of 2^-16 voxel
  static constexpr double kLargest = 1 << 24;            // and are at most this large
  static constexpr double kWidest = 2.0943951023931953;  // 120 degrees in radians

  /// Points in voxels, the angle in radians. Rounded once, then exact: eye and target to the nearest multiples of
  /// 2^-16 voxel, the direction from target to eye as View says (not at all if it is a small multiple of coprime
  /// integers up to 2^20), the normals of the pyramid's sides to 2^-30 of their largest component. Throws
  /// Error(bad_argument) for points that are not finite, beyond +-2^24 or (rounded) the same, and for an angle outside
  /// [pi / 180, 170 pi / 180].
  Perspective(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double field_of_view = kWidest);

  /// The eye in units of 2^-16 voxel.
  const std::array<std::int64_t, 3>& eye() const { return eye_; }
  /// The picture's axes; direction() points from target to eye.
  const View& view() const { return view_; }
  /// From eye to target, voxels.
  double distance() const { return distance_; }
  /// The field of view is where (x - eye) . n >= 0 for all four normals n: seen from the left, right, lower, upper side
  /// inward. |n_i| <= 2^30.
  const std::array<std::array<std::int64_t, 3>, 4>& sides() const { return sides_; }

 private:
  std::array<std::int64_t, 3> eye_;
  View view_;
  double distance_;
  std::array<std::array<std::int64_t, 3>, 4> sides_;
};

/// The set of points p on feature edges inside the field of view such that the open segment from p to the eye misses
/// the solid's interior. Edges in one line with the eye draw nothing; contiguous collinear pieces are one stroke.
/// Exact, as draw(octree, view) is. The strokes are given on the screen of perspective.view(). Throws
/// Error(bad_argument) if the eye lies in or on the solid, Error(cancelled). Near-linear in the feature edges.
LineDrawing draw(const Octree& octree, const Perspective& perspective, const Work& work = {});

/// The same for scenes, by kind and solid as draw(scene, view) has them, inside the field of view. Outlines are told
/// from the background only: a visible point is on the outline iff the sight line through it, followed away from the
/// eye, meets no interior. Throws Error(bad_argument) if the eye lies in or on a solid and for a finite
/// options.outline_gap, Error(cancelled).
std::vector<SceneLines> draw(const Scene& scene, const Perspective& perspective, const SceneOptions& options = {},
                             const Work& work = {});

}  // namespace blackleaf
