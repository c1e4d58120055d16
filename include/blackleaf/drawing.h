// Line drawings: the exact hidden-line drawing of a solid by parallel projection (VA88).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// From where a perspective picture is seen (perspective.h): voxels, radians.
struct EyePoint {
  Eigen::Vector3d eye, target;
  double field_of_view = 0;
};

/// A parallel projection. The viewer is at infinity in direction d; right u = up x d normalised, v = d x u, up is +z,
/// or +y when d is parallel to z. A point p lands at (u.p, v.p), voxel units, v upward.
class View {
 public:
  /// `direction` toward the viewer. Directions with whole-number components (up to 2^20 in size, after division by
  /// their greatest common divisor) are kept exactly; all others are rounded once to the nearest multiple of 2^-20 of
  /// their largest component. Throws Error(bad_argument) for a zero or non-finite direction.
  explicit View(const Eigen::Vector3d& direction);

  /// The direction as coprime integers, |d_i| <= 2^20.
  const std::array<std::int64_t, 3>& direction() const { return direction_; }
  const Eigen::Vector3d& right() const { return right_; }
  const Eigen::Vector3d& up() const { return up_; }
  /// For the screen of a perspective drawing, Perspective::view(): from where it is seen. Drawings tell it;
  /// draw(octree, view) takes no notice of it.
  const std::optional<EyePoint>& eye_point() const { return eye_point_; }

 private:
  friend class Perspective;
  std::array<std::int64_t, 3> direction_{};
  Eigen::Vector3d right_, up_;
  std::optional<EyePoint> eye_point_;
};

/// A maximal straight visible piece of the drawing, from end to end.
struct Stroke {
  Eigen::Vector2d from, to;

  /// Not set to anything, so that room for many costs nothing.
  Stroke() {}
  Stroke(const Eigen::Vector2d& begin, const Eigen::Vector2d& end) : from(begin), to(end) {}
};

struct LineDrawing {
  View view;
  std::vector<Stroke> strokes;  // none of zero length, no two that could be joined, none drawn twice
  double length() const;        // visible length, voxels
};

/// The set of points p on feature edges (edges of the solid's boundary where it is not flat) such that the open ray
/// p + t d, t > 0, misses the solid's interior. Edges seen end-on draw nothing; contiguous collinear pieces, also of
/// different edges that fall on one line of the picture, are one stroke. Exact: decided in integers; stroke ends are
/// rational and only rounded when written as doubles. Near-linear in the feature edges.
LineDrawing draw(const Octree& octree, const View& view, const Work& work = {});

}  // namespace blackleaf
