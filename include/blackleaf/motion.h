// Motion: rotation + translation, and its one rounding to fixed point (WA87, section 3).
//
// A motion keeps its 12 numbers to 106 bits. Composing k motions whose translations stay below t loses less than
// k 2^-97 (1 + t): nothing that the grid of FixedMotion (2^-38) could see, in any number of compositions that can be
// carried out. So a motion followed by its inverse is the motion before, and what thousands of steps end in differs
// from what they mean only by what their numbers, as typed, differ from it (docs/MOTION.md, "Errors do not add up").
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

namespace blackleaf {

namespace detail {
struct ExactMotion;
}

/// X' = R X + T in voxel units about the universe's corner (0,0,0), right-handed. An immutable value.
class Motion {
 public:
  /// The identity.
  Motion() = default;
  /// Throws Error(bad_argument) unless all entries are finite and `rotation` is a rotation: |R^T R - I| <= 1e-6 entry
  /// by entry and det R > 0; the error says whether the matrix scales, shears or reflects. A rotation off by less is
  /// brought to the nearest one; one within 2^-48 of a matrix of 0, 1 and -1 is taken for that.
  Motion(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation);

  static Motion translation(const Eigen::Vector3d& by);
  /// Rotation by `radians` about `axis` through the origin, right-handed (WA87's matrix). A quarter turn, which no
  /// number of radians is, is what comes within (|radians| + 1) 2^-51 of one. Throws Error(bad_argument) for a zero or
  /// non-finite axis or angle.
  static Motion rotation(const Eigen::Vector3d& axis, double radians);
  /// The same in degrees, to 106 bits: turns that add up to 360 degrees come back to the identity as nearly as those
  /// bits can tell, eight of 45 degrees for instance.
  static Motion rotation_degrees(const Eigen::Vector3d& axis, double degrees);
  /// Throws Error(bad_argument) for a quaternion that is zero or not finite; any other is normalised.
  static Motion rotation(const Eigen::Quaterniond& quaternion);
  /// As the constructor from rotation and translation.
  static Motion from(const Eigen::Isometry3d& isometry);
  /// The same from a 4x4 matrix whose last row must be 0 0 0 1.
  static Motion from(const Eigen::Matrix4d& matrix);

  /// The same motion about another point: X' = R (X - centre) + centre + T.
  Motion about(const Eigen::Vector3d& centre) const;

  /// R and T in double precision.
  const Eigen::Matrix3d& rotation() const { return rotation_; }
  const Eigen::Vector3d& translation() const { return translation_; }
  /// The unit quaternion of R, w >= 0.
  Eigen::Quaterniond quaternion() const;
  /// R and T as a 4x4 matrix; Eigen::Isometry3d(motion.matrix()) is an isometry.
  Eigen::Matrix4d matrix() const;
  /// Where the motion takes a point, in double precision.
  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const { return rotation_ * x + translation_; }

  Motion inverse() const;
  /// (second * first)(X) = second(first(X)): (R'R, R'T + T').
  friend Motion operator*(const Motion& second, const Motion& first);
  /// Equal bit for bit, in all 106 bits.
  friend bool operator==(const Motion& a, const Motion& b) {
    return a.rotation_ == b.rotation_ && a.rotation_rest_ == b.rotation_rest_ && a.translation_ == b.translation_ &&
           a.translation_rest_ == b.translation_rest_;
  }

 private:
  friend struct detail::ExactMotion;
  // R = rotation_ + rotation_rest_, T = translation_ + translation_rest_.
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity(), rotation_rest_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d translation_ = Eigen::Vector3d::Zero(), translation_rest_ = Eigen::Vector3d::Zero();
};

/// `motion` done `exponent` times. For whole numbers that is repeated composition, 0 the identity and -1 the inverse,
/// to 106 bits. Every motion is a screw: a turn by an angle of at most 180 degrees about an axis and a shift along it;
/// for other numbers the angle and the shift are multiplied, about the same axis, so that power(m, s + t) = power(m, s)
/// * power(m, t) and power(m, t) goes smoothly from the identity to m. What comes after the whole number is computed in
/// double precision: translations to about 2^-48 of the motion's. A turn by 180 degrees, which goes both ways, goes the
/// way of the axis whose first coordinate other than 0 is positive. Throws Error(bad_argument) for an exponent that is
/// not finite or beyond 2^53. O(log |exponent|).
Motion power(const Motion& motion, double exponent);

/// Between two motions: the point that both move as `about` goes straight from from(about) to to(about) while the
/// rotation turns at a constant rate about one axis, the shorter way (slerp). t = 0 gives `from` and t = 1 gives `to`,
/// bit for bit; between them rotations are good to about 2^-50. When the rotations are opposite (180 degrees apart) the
/// way is that of power(). Requires: 0 <= t <= 1.
Motion interpolate(const Motion& from, const Motion& to, double t,
                   const Eigen::Vector3d& about = Eigen::Vector3d::Zero());

/// A motion rounded once to a grid of 2^-38: the meaning of every motion of an octree. With A = round(2^38 R^T),
/// t = round(2^38 T), b = round(-2^-38 A t), the point X of the target comes from the point (A X + b) / 2^38 of the
/// source. Rotations by multiples of 90 degrees and integer translations are represented without error.
///
/// Rounding is to nearest. What lies within 2^-20 steps of the middle between two counts as the middle and goes away
/// from zero: so numbers that are the middle by their meaning, such as 2^-39, are rounded alike however they were
/// computed.
///
/// Bound on the sums. A voxel centre is X = c / 2 with odd |c_i| < 2^21 (depth 20); 2 (A X + b) = A c + 2 b has
/// |A c| < sqrt(3) 2^(38+21) < 2^60 and, with |R^T T| <= 2^23, |2 b| <= 2^62, so all sums stay below 2^63.
///
/// Bound on the rounding. Entries of A are off by at most e = 2^-39 (1 + 2^-19) of R, entries of t likewise, and b by
/// half a step. So no point X with |X_i - T_i| <= s comes from farther than e (3 s + 3) voxels, on any axis, from where
/// the motion itself takes it from: less than 2^-26 voxels at depth 10 and 2^-16 at depth 20 when |T_i| is at most a
/// universe's side. In fractions of the universe's side that is 2^-36 at every depth.
struct FixedMotion {
  static constexpr int kFractionBits = 38;
  static constexpr double kMaxTranslation = 8388608.0;  // 2^23 voxels, the bound on |R^T T| per axis

  /// Throws Error(out_of_universe) when |T| is beyond kMaxTranslation: such a motion takes every universe out of
  /// itself.
  explicit FixedMotion(const Motion& motion);

  std::array<std::array<std::int64_t, 3>, 3> inverse_rotation{};  // A, rows
  std::array<std::int64_t, 3> inverse_translation{};              // b
  std::array<std::int64_t, 3> forward_translation{};  // round(2^38 T), for questions about the target's extent

  /// The same motion followed by a shift of whole voxels, without any rounding. Requires: |by_i| <= 2^20.
  FixedMotion shifted(const std::array<std::int64_t, 3>& by) const;

  /// True iff the motion only permutes and reverses axes and shifts by whole voxels: nothing is resampled.
  bool is_lattice_symmetry() const;

  friend bool operator==(const FixedMotion&, const FixedMotion&) = default;
};

}  // namespace blackleaf
