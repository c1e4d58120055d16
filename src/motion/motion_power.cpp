// Powers and interpolation of motions: screws (Chasles), by the exponential map of rigid motions.
#include <cassert>
#include <cmath>

#include "blackleaf/error.h"
#include "blackleaf/motion.h"
#include "exact_motion.h"

namespace blackleaf {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// Axis times angle, the angle in [0, pi].
Vector3d rotation_vector(const Motion& motion) {
  Eigen::Quaterniond q = motion.quaternion();
  if (q.w() > 0.5) {
    // Small angles keep all their digits: 4 w (x, y, z) are differences of entries, taken in 106 bits.
    const auto r = detail::ExactMotion::of(motion).rotation;
    const auto difference = [&](std::size_t i, std::size_t j) { return (r[i][j] - r[j][i]).high / (4 * q.w()); };
    q.vec() = Vector3d(difference(2, 1), difference(0, 2), difference(1, 0));
  }
  const double sine = q.vec().norm();
  if (sine == 0) return Vector3d::Zero();
  constexpr double kOpposite = 0x1p-50;  // a turn by 180 degrees as far as double precision can tell
  if (q.w() < kOpposite) {
    const Vector3d& v = q.vec();
    const double first = std::abs(v.x()) > kOpposite ? v.x() : std::abs(v.y()) > kOpposite ? v.y() : v.z();
    if (first < 0) q.vec() = -q.vec();
  }
  return 2 * std::atan2(sine, q.w()) / sine * q.vec();
}

// The part of a screw's turn in its shift: T = left(w) u for the motion exp(w, u).
Matrix3d left(const Vector3d& w) {
  const double angle = w.norm(), square = angle * angle;
  const Matrix3d k = cross_matrix(w);
  double a = 0.5 - square / 24, b = 1.0 / 6 - square / 120;  // good to 2^-60 below 2^-13
  if (angle > 0x1p-13) {
    const double half = std::sin(angle / 2);
    a = 2 * half * half / square;
    b = (angle - std::sin(angle)) / (square * angle);
  }
  return Matrix3d::Identity() + a * k + b * k * k;
}

Motion fractional_power(const Motion& motion, double t) {
  const Vector3d w = rotation_vector(motion);
  const Vector3d shift = left(t * w) * (t * left(w).inverse() * motion.translation());
  const double angle = w.norm();
  return Motion::translation(shift) * (angle == 0 ? Motion() : Motion::rotation(w, t * angle));
}

Motion whole_power(Motion motion, std::uint64_t exponent) {
  if (exponent == 0) return {};
  for (; exponent % 2 == 0; exponent /= 2) motion = motion * motion;
  Motion result = motion;
  while (exponent /= 2) {
    motion = motion * motion;
    if (exponent % 2 != 0) result = motion * result;
  }
  return result;
}

}  // namespace

Motion power(const Motion& motion, double exponent) {
  constexpr double kMost = 0x1p53;
  if (!(std::abs(exponent) <= kMost))
    throw Error(ErrorCode::bad_argument, "a motion is raised to a power that is not a number up to 2^53",
                "give a finite exponent");
  const double whole = std::floor(std::abs(exponent)), rest = std::abs(exponent) - whole;
  Motion result = whole_power(motion, static_cast<std::uint64_t>(whole));
  if (rest != 0) result = result * fractional_power(motion, rest);
  return exponent < 0 ? result.inverse() : result;
}

Motion interpolate(const Motion& from, const Motion& to, double t, const Eigen::Vector3d& about) {
  assert(t >= 0 && t <= 1);
  if (t == 0) return from;
  if (t == 1) return to;
  // Relative to `about` both are a rotation and then a translation.
  const auto back = [&](const Motion& motion) { return motion.about(-about); };
  const Motion first = back(from), last = back(to);
  const auto rotation_of = [](const Motion& motion) {
    detail::ExactMotion exact = detail::ExactMotion::of(motion);
    exact.translation = {};
    return exact.motion();
  };
  const Motion turn = fractional_power(rotation_of(last) * rotation_of(first).inverse(), t);
  const Eigen::Vector3d shift = first.translation() + t * (last.translation() - first.translation());
  return (Motion::translation(shift) * turn * rotation_of(first)).about(about);
}

}  // namespace blackleaf
