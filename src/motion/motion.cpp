#include "blackleaf/motion.h"

#include <cmath>
#include <string>

#include "blackleaf/error.h"

namespace blackleaf {
namespace {

__extension__ using Wide = __int128;

// Entries that the fixed-point grid cannot tell from -1, 0 or 1 are set to them, so that quarter turns are exact in
// translations computed from them as well.
Eigen::Matrix3d cleaned(Eigen::Matrix3d rotation) {
  constexpr double kTooSmallToSee = 0x1p-42;
  for (double& entry : rotation.reshaped())
    if (std::abs(entry - std::round(entry)) < kTooSmallToSee) entry = std::round(entry);
  return rotation;
}

// One step toward the nearest orthogonal matrix; quadratic convergence.
Eigen::Matrix3d orthonormalised(const Eigen::Matrix3d& rotation) {
  return rotation * (3 * Eigen::Matrix3d::Identity() - rotation.transpose() * rotation) / 2;
}

double deviation(const Eigen::Matrix3d& rotation) {
  return (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

std::int64_t fixed(double value) { return std::llround(std::ldexp(value, FixedMotion::kFractionBits)); }

// Rounds value / 2^bits to nearest, ties away from zero.
std::int64_t rounded_shift(Wide value, int bits) {
  const Wide half = Wide{1} << (bits - 1);
  return static_cast<std::int64_t>(value >= 0 ? (value + half) >> bits : -((-value + half) >> bits));
}

}  // namespace

Motion::Motion(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation)
    : rotation_(rotation), translation_(translation) {
  if (!rotation.allFinite() || !translation.allFinite())
    throw Error(ErrorCode::bad_argument, "a motion has entries that are not finite numbers");
  const double off = deviation(rotation);
  if (off > 1e-6)
    throw Error(ErrorCode::bad_argument,
                "the matrix is not a rotation: R^T R differs from the identity by " + std::to_string(off),
                "remove scale and shear from it");
  if (rotation.determinant() < 0)
    throw Error(ErrorCode::bad_argument, "the matrix is a reflection: its determinant is -1", "negate one of its rows");
  if (off > 1e-15)
    for (int step = 0; step < 3; ++step) rotation_ = orthonormalised(rotation_);
  rotation_ = cleaned(rotation_);
}

Motion Motion::translation(const Eigen::Vector3d& by) { return Motion(Eigen::Matrix3d::Identity(), by); }

Motion Motion::rotation(const Eigen::Vector3d& axis, double radians) {
  const double length = axis.norm();
  if (!std::isfinite(length) || !std::isfinite(radians))
    throw Error(ErrorCode::bad_argument, "a rotation has an axis or an angle that is not a finite number");
  if (length == 0) throw Error(ErrorCode::bad_argument, "a rotation has the axis 0,0,0", "name an axis such as 0,0,1");
  return Motion(Eigen::AngleAxisd(radians, axis / length).toRotationMatrix(), Eigen::Vector3d::Zero());
}

Motion Motion::rotation(const Eigen::Quaterniond& quaternion) {
  if (!quaternion.coeffs().allFinite() || quaternion.norm() == 0)
    throw Error(ErrorCode::bad_argument, "a quaternion is zero or has entries that are not finite numbers");
  return Motion(quaternion.normalized().toRotationMatrix(), Eigen::Vector3d::Zero());
}

Motion Motion::from(const Eigen::Isometry3d& isometry) { return Motion(isometry.linear(), isometry.translation()); }

Motion Motion::about(const Eigen::Vector3d& centre) const {
  return Motion(rotation_, centre - rotation_ * centre + translation_);
}

Motion Motion::inverse() const { return Motion(rotation_.transpose(), -(rotation_.transpose() * translation_)); }

Motion operator*(const Motion& second, const Motion& first) {
  return Motion(orthonormalised(second.rotation_ * first.rotation_),
                second.rotation_ * first.translation_ + second.translation_);
}

FixedMotion::FixedMotion(const Motion& motion) {
  if (!(motion.translation().norm() <= kMaxTranslation))
    throw Error(ErrorCode::out_of_universe,
                "the translation of a motion is longer than 2^23 voxels, which takes every solid out of its universe",
                "move it less");
  for (std::size_t i = 0; i < 3; ++i) {
    forward_translation[i] = fixed(motion.translation()[static_cast<int>(i)]);
    for (std::size_t j = 0; j < 3; ++j)
      inverse_rotation[i][j] = fixed(motion.rotation()(static_cast<int>(j), static_cast<int>(i)));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    Wide sum = 0;
    for (std::size_t j = 0; j < 3; ++j) sum += Wide{inverse_rotation[i][j]} * forward_translation[j];
    inverse_translation[i] = rounded_shift(-sum, kFractionBits);
  }
}

FixedMotion FixedMotion::shifted(const std::array<std::int64_t, 3>& by) const {
  FixedMotion result = *this;
  for (std::size_t i = 0; i < 3; ++i) {
    result.forward_translation[i] += by[i] * (std::int64_t{1} << kFractionBits);
    for (std::size_t j = 0; j < 3; ++j) result.inverse_translation[i] -= inverse_rotation[i][j] * by[j];
  }
  return result;
}

bool FixedMotion::is_lattice_symmetry() const {
  constexpr std::int64_t kOne = std::int64_t{1} << kFractionBits;
  for (const auto& row : inverse_rotation)
    for (const std::int64_t entry : row)
      if (entry != 0 && entry != kOne && entry != -kOne) return false;
  for (const std::int64_t entry : inverse_translation)
    if (entry % kOne != 0) return false;
  return true;
}

}  // namespace blackleaf
