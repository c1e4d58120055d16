#include "blackleaf/motion.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "blackleaf/error.h"
#include "exact_motion.h"

namespace blackleaf {

namespace detail {
namespace {

// Half of pi in three doubles; a fourth would begin below 2^-160.
constexpr std::array<double, 3> kHalfPi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110};

struct SineCosine {
  DoubleDouble sine, cosine;

  SineCosine turned(double quarters) const {
    switch (static_cast<int>(std::fmod(quarters, 4.0)) & 3) {
      case 1:
        return {cosine, -sine};
      case 2:
        return {-sine, -cosine};
      case 3:
        return {-cosine, sine};
      default:
        return *this;
    }
  }
};

// For |radians| <= 0.8: 27 terms of Taylor's series reach 2^-100.
SineCosine small_sine_and_cosine(const DoubleDouble& radians) {
  SineCosine result{0, 1};
  DoubleDouble term = 1;
  for (int k = 1; k <= 27; ++k) {
    term = term * radians / DoubleDouble(k);
    DoubleDouble& sum = k % 2 == 0 ? result.cosine : result.sine;
    sum = k % 4 >= 2 ? sum - term : sum + term;
  }
  return result;
}

SineCosine sine_and_cosine(const DoubleDouble& radians) {
  const double quarters = std::round(radians.high / kHalfPi[0]);
  DoubleDouble rest = radians;
  for (const double part : kHalfPi) rest = rest - DoubleDouble::product(part, quarters);
  return small_sine_and_cosine(rest).turned(quarters);
}

// WA87, section 3: cos I + (1 - cos) n n^T + sin [n].
ExactMatrix rotation_matrix(const ExactVector& axis, const SineCosine& angle) {
  const DoubleDouble scale = inverse_square_root(dot(axis, axis));
  const ExactVector n = {axis[0] * scale, axis[1] * scale, axis[2] * scale};
  const DoubleDouble rest = DoubleDouble(1) - angle.cosine;
  ExactMatrix result;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    result[i][i] = n[i] * n[i] * rest + angle.cosine;
    result[i][j] = n[i] * n[j] * rest - n[k] * angle.sine;
    result[i][k] = n[i] * n[k] * rest + n[j] * angle.sine;
  }
  return orthonormalised(result);
}

// A rotation whose entries are all within `tolerance` of 0, 1 or -1 is taken for one of quarter turns.
ExactMatrix cleaned(const ExactMatrix& rotation, double tolerance) {
  ExactMatrix result;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const double nearest = std::round(rotation[i][j].high);
      if (std::abs((rotation[i][j] - nearest).high) > tolerance) return rotation;
      result[i][j] = nearest + 0.0;  // no -0
    }
  return result;
}

ExactVector exact(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// The axis in length near 1, so that its square neither overflows nor vanishes.
ExactVector checked_axis(const Eigen::Vector3d& axis, double angle) {
  if (!axis.allFinite() || !std::isfinite(angle))
    throw Error(ErrorCode::bad_argument, "a rotation has an axis or an angle that is not a finite number");
  const double largest = axis.cwiseAbs().maxCoeff();
  if (largest == 0) throw Error(ErrorCode::bad_argument, "a rotation has the axis 0,0,0", "name an axis such as 0,0,1");
  int exponent = 0;
  std::frexp(largest, &exponent);
  const auto scaled = [&](double x) { return std::ldexp(x, -exponent); };  // axes keep their direction to the last bit
  return {scaled(axis.x()), scaled(axis.y()), scaled(axis.z())};
}

}  // namespace

ExactMatrix orthonormalised(const ExactMatrix& rotation) {
  ExactMatrix step = transposed(rotation) * rotation;  // R (3 I - R^T R) / 2
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) step[i][j] = (DoubleDouble(i == j ? 3 : 0) - step[i][j]) * 0.5;
  return rotation * step;
}

ExactMotion ExactMotion::of(const Motion& motion) {
  ExactMotion result;
  for (int i = 0; i < 3; ++i) {
    const auto u = static_cast<std::size_t>(i);
    result.translation[u] = {motion.translation_[i], motion.translation_rest_[i]};
    for (int j = 0; j < 3; ++j)
      result.rotation[u][static_cast<std::size_t>(j)] = {motion.rotation_(i, j), motion.rotation_rest_(i, j)};
  }
  return result;
}

Motion ExactMotion::motion() const {
  Motion result;
  for (int i = 0; i < 3; ++i) {
    const auto u = static_cast<std::size_t>(i);
    result.translation_[i] = translation[u].high;
    result.translation_rest_[i] = translation[u].low;
    for (int j = 0; j < 3; ++j) {
      result.rotation_(i, j) = rotation[u][static_cast<std::size_t>(j)].high;
      result.rotation_rest_(i, j) = rotation[u][static_cast<std::size_t>(j)].low;
    }
  }
  if (!result.rotation_.allFinite() || !result.translation_.allFinite() || !result.translation_rest_.allFinite())
    throw Error(ErrorCode::bad_argument, "a motion has entries that are not finite numbers",
                "keep its translation below 1e300 voxels");
  return result;
}

}  // namespace detail

namespace {

using detail::DoubleDouble;
using detail::ExactMatrix;
using detail::ExactMotion;

constexpr double kTolerance = 1e-6;

std::string text(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.6g", value);
  return buffer.data();
}

[[noreturn]] void refuse_matrix(const std::string& why, const std::string& remedy) {
  throw Error(ErrorCode::bad_argument, "the matrix is not a rotation: " + why, remedy);
}

// The mirrored axes of a matrix that only reverses axes: "x", "x and y", "x, y and z".
std::string reversed_axes(const Eigen::Matrix3d& m) {
  if ((m - Eigen::Matrix3d(m.diagonal().asDiagonal())).cwiseAbs().maxCoeff() > kTolerance) return {};
  std::string axes;
  for (int i = 0; i < 3; ++i)
    if (m(i, i) < 0) axes += (axes.empty() ? "" : ",") + std::string(1, static_cast<char>('x' + i));
  return axes;
}

void check_rotation(const Eigen::Matrix3d& m) {
  if (!m.allFinite()) refuse_matrix("it has entries that are not finite numbers", "write finite numbers");
  const Eigen::Vector3d lengths = m.colwise().norm();
  const std::string rigid = "give a rotation and a translation only; scaling and shearing are no motions";
  const bool scales = !((lengths.array() - 1).abs().maxCoeff() <= kTolerance / 2);
  std::string angle;  // of the first two columns that are not square to each other
  for (int i = 0; i < 3; ++i)
    for (int j = i + 1; j < 3; ++j) {
      const double cosine = m.col(i).dot(m.col(j)) / (lengths[i] * lengths[j]);  // not a number for no lengths
      if (angle.empty() && std::abs(cosine) > kTolerance)
        angle = "columns " + std::to_string(i + 1) + " and " + std::to_string(j + 1) + " meet at " +
                text(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / M_PI) + " degrees";
    }
  if (scales)
    refuse_matrix(std::string(angle.empty() ? "it scales" : "it scales and shears") + ": its columns have lengths " +
                      text(lengths[0]) + ", " + text(lengths[1]) + ", " + text(lengths[2]) +
                      (angle.empty() ? "" : ", and " + angle),
                  rigid);
  if (!angle.empty()) refuse_matrix("it shears: " + angle, rigid);
  if (m.determinant() > 0) return;
  const std::string axes = reversed_axes(m);
  if (axes.empty())
    refuse_matrix("it is a reflection: its determinant is -1",
                  "reflect the solid along one axis (--reflect x), then give the rotation that is left");
  refuse_matrix("it is a reflection along " + axes + ": its determinant is -1",
                "that is another operation: --reflect " + axes);
}

}  // namespace

Motion::Motion(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  check_rotation(rotation);
  ExactMotion exact;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      exact.rotation[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = rotation(i, j);
  // A deviation of 1e-6 is 1e-12, 1e-24, 1e-48 after three steps.
  for (int step = 0; step < 4; ++step) exact.rotation = detail::orthonormalised(exact.rotation);
  exact.rotation = detail::cleaned(exact.rotation, 0x1p-48);
  exact.translation = detail::exact(translation);
  *this = exact.motion();
}

Motion Motion::translation(const Eigen::Vector3d& by) {
  ExactMotion exact = ExactMotion::of(Motion());
  exact.translation = detail::exact(by);
  return exact.motion();
}

Motion Motion::rotation(const Eigen::Vector3d& axis, double radians) {
  const detail::ExactVector direction = detail::checked_axis(axis, radians);
  // Beyond 2^20 the library's functions reduce the angle; what they lose is less than the angle's own last bit.
  constexpr double kFar = 0x1p20;
  if (std::abs(radians) > kFar) radians = std::atan2(std::sin(radians), std::cos(radians));
  ExactMotion exact = ExactMotion::of(Motion());
  exact.rotation = detail::cleaned(detail::rotation_matrix(direction, detail::sine_and_cosine(radians)),
                                   (std::abs(radians) + 1) * 0x1p-51);
  return exact.motion();
}

Motion Motion::rotation_degrees(const Eigen::Vector3d& axis, double degrees) {
  const detail::ExactVector direction = detail::checked_axis(axis, degrees);
  // Both are exact.
  const double turn = std::fmod(degrees, 360.0), rest = std::remainder(turn, 90.0);
  const DoubleDouble degree(0x1.1df46a2529d39p-6, 0x1.5c1d8becdd291p-62);
  const detail::SineCosine angle = detail::small_sine_and_cosine(degree * rest).turned(std::round((turn - rest) / 90));
  ExactMotion exact = ExactMotion::of(Motion());
  exact.rotation = detail::cleaned(detail::rotation_matrix(direction, angle), 0x1p-90);
  return exact.motion();
}

Motion Motion::rotation(const Eigen::Quaterniond& quaternion) {
  const double largest = quaternion.coeffs().cwiseAbs().maxCoeff();
  if (!quaternion.coeffs().allFinite() || largest == 0)
    throw Error(ErrorCode::bad_argument, "a quaternion is zero or has entries that are not finite numbers",
                "give w,x,y,z of a rotation, such as 1,0,0,0");
  int exponent = 0;
  std::frexp(largest, &exponent);
  const auto scaled = [&](double x) { return DoubleDouble(std::ldexp(x, -exponent)); };
  const DoubleDouble w = scaled(quaternion.w());
  const detail::ExactVector v = {scaled(quaternion.x()), scaled(quaternion.y()), scaled(quaternion.z())};
  const DoubleDouble vv = detail::dot(v, v), ww = w * w, scale = DoubleDouble(1) / (ww + vv);
  ExactMotion exact = ExactMotion::of(Motion());
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    exact.rotation[i][i] = (ww - vv + v[i] * v[i] * 2) * scale;
    exact.rotation[i][j] = (v[i] * v[j] - w * v[k]) * 2 * scale;
    exact.rotation[i][k] = (v[i] * v[k] + w * v[j]) * 2 * scale;
  }
  exact.rotation = detail::cleaned(detail::orthonormalised(exact.rotation), 0x1p-48);
  return exact.motion();
}

Motion Motion::from(const Eigen::Isometry3d& isometry) { return Motion(isometry.linear(), isometry.translation()); }

Motion Motion::from(const Eigen::Matrix4d& matrix) {
  if (!matrix.allFinite())
    throw Error(ErrorCode::bad_argument, "a motion's matrix has entries that are not finite numbers");
  const auto row = matrix.row(3);
  if (row[0] != 0 || row[1] != 0 || row[2] != 0 || row[3] != 1)
    throw Error(ErrorCode::bad_argument,
                "the last row of a motion's matrix is " + text(row[0]) + " " + text(row[1]) + " " + text(row[2]) + " " +
                    text(row[3]) + ", not 0 0 0 1",
                "write the translation into the last column");
  return Motion(matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>());
}

Motion Motion::about(const Eigen::Vector3d& centre) const { return translation(centre) * *this * translation(-centre); }

Eigen::Quaterniond Motion::quaternion() const {
  Eigen::Quaterniond result(rotation_);
  result.normalize();
  if (result.w() < 0) result.coeffs() = -result.coeffs();
  return result;
}

Eigen::Matrix4d Motion::matrix() const {
  Eigen::Matrix4d result = Eigen::Matrix4d::Identity();
  result.topLeftCorner<3, 3>() = rotation_;
  result.topRightCorner<3, 1>() = translation_;
  return result;
}

Motion Motion::inverse() const {
  ExactMotion exact = ExactMotion::of(*this);
  exact.rotation = detail::transposed(exact.rotation);
  exact.translation = -(exact.rotation * exact.translation);
  return exact.motion();
}

Motion operator*(const Motion& second, const Motion& first) {
  const ExactMotion a = ExactMotion::of(second), b = ExactMotion::of(first);
  return ExactMotion{detail::orthonormalised(a.rotation * b.rotation), a.rotation * b.translation + a.translation}
      .motion();
}

}  // namespace blackleaf
