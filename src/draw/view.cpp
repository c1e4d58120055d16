#include <algorithm>
#include <cmath>
#include <numeric>

#include "blackleaf/drawing.h"
#include "blackleaf/error.h"
#include "screen.h"

namespace blackleaf {
namespace {

constexpr double kLargest = 1 << 20;

// The components divided by their greatest common divisor.
std::array<std::int64_t, 3> coprime(const Eigen::Vector3d& whole) {
  std::array<std::int64_t, 3> d{};
  for (int i = 0; i < 3; ++i) d[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(whole[i]);
  const std::int64_t divisor = std::gcd(std::gcd(d[0], d[1]), d[2]);
  for (auto& component : d) component /= divisor;
  return d;
}

std::array<std::int64_t, 3> whole_direction(const Eigen::Vector3d& direction) {
  const double largest = direction.cwiseAbs().maxCoeff();
  if (!direction.allFinite() || largest == 0)
    throw Error(ErrorCode::bad_argument, "the view direction is zero or not finite", "give a vector like 12,-16,15");
  constexpr double kExactlyWhole = 9007199254740992.0;  // 2^53: beyond it, a double no longer tells whole numbers apart
  if (largest <= kExactlyWhole && direction == direction.unaryExpr([](double x) { return std::trunc(x); })) {
    const auto d = coprime(direction);
    if (std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])}) <= static_cast<std::int64_t>(kLargest)) return d;
  }
  Eigen::Vector3d rounded;
  for (int i = 0; i < 3; ++i) rounded[i] = std::round(direction[i] / largest * kLargest);
  return coprime(rounded);
}

}  // namespace

View::View(const Eigen::Vector3d& direction) : direction_(whole_direction(direction)) {
  const detail::Screen screen(direction_);
  for (int i = 0; i < 3; ++i) {
    right_[i] = static_cast<double>(screen.u[static_cast<std::size_t>(i)]) / screen.u_norm;
    up_[i] = static_cast<double>(screen.v[static_cast<std::size_t>(i)]) / screen.v_norm;
  }
}

double LineDrawing::length() const {
  double sum = 0;
  for (const Stroke& stroke : strokes) sum += (stroke.to - stroke.from).norm();
  return sum;
}

}  // namespace blackleaf
