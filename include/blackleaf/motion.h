// Motion: rotation + translation, and its one rounding to fixed point (WA87, section 3).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

namespace blackleaf {

/// X' = R X + T in voxel units about the universe's corner (0,0,0), right-handed.
class Motion {
 public:
  /// The identity.
  Motion() = default;
  /// Throws Error(bad_argument) unless all entries are finite and `rotation` is a rotation: |R^T R - I| <= 1e-6 entry
  /// by entry and det R > 0. A rotation off by less is brought to the nearest one.
  Motion(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation);

  static Motion translation(const Eigen::Vector3d& by);
  /// Rotation by `radians` about `axis` through the origin (WA87's matrix). Throws Error(bad_argument) for a zero or
  /// non-finite axis or angle.
  static Motion rotation(const Eigen::Vector3d& axis, double radians);
  static Motion rotation(const Eigen::Quaterniond& quaternion);
  static Motion from(const Eigen::Isometry3d& isometry);

  /// The same motion about another point: X' = R (X - centre) + centre + T.
  Motion about(const Eigen::Vector3d& centre) const;

  const Eigen::Matrix3d& rotation() const { return rotation_; }
  const Eigen::Vector3d& translation() const { return translation_; }
  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const { return rotation_ * x + translation_; }

  Motion inverse() const;
  /// (second * first)(X) = second(first(X)): (R'R, R'T + T').
  friend Motion operator*(const Motion& second, const Motion& first);

 private:
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
};

/// A motion rounded once to a grid of 2^-38: the meaning of every motion of an octree. With A = round(2^38 R^T),
/// b = round(-2^38 R^T T), the point X of the target comes from the point (A X + b) / 2^38 of the source. Rotations by
/// multiples of 90 degrees and integer translations are represented without error.
///
/// Bound. A voxel centre is X = c / 2 with odd |c_i| < 2^21 (depth 20); 2 (A X + b) = A c + 2 b has
/// |A c| < sqrt(3) 2^(38+21) < 2^60 and, with |R^T T| <= 2^23, |2 b| <= 2^62, so all sums stay below 2^63.
struct FixedMotion {
  static constexpr int kFractionBits = 38;
  static constexpr double kMaxTranslation = 8388608.0;  // 2^23 voxels, the bound on |R^T T| per axis

  /// Rounds to nearest, ties away from zero. Throws Error(out_of_universe) when |T| is beyond kMaxTranslation: such a
  /// motion takes every universe out of itself.
  explicit FixedMotion(const Motion& motion);

  std::array<std::array<std::int64_t, 3>, 3> inverse_rotation{};  // A, rows
  std::array<std::int64_t, 3> inverse_translation{};              // b
  std::array<std::int64_t, 3> forward_translation{};  // round(2^38 T), for questions about the target's extent

  /// The same motion followed by a shift of whole voxels, without any rounding. Requires: |by_i| <= 2^20.
  FixedMotion shifted(const std::array<std::int64_t, 3>& by) const;

  /// True iff the motion only permutes and reverses axes and shifts by whole voxels: nothing is resampled.
  bool is_lattice_symmetry() const;
};

}  // namespace blackleaf
