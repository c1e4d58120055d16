#include "octree/whole_direction.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace blackleaf::detail {
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

}  // namespace

std::array<std::int64_t, 3> whole_direction(const Eigen::Vector3d& direction) {
  const double largest = direction.cwiseAbs().maxCoeff();
  assert(direction.allFinite() && largest > 0);
  constexpr double kExactlyWhole = 9007199254740992.0;  // 2^53: beyond it, a double no longer tells whole numbers apart
  if (largest <= kExactlyWhole && direction == direction.unaryExpr([](double x) { return std::trunc(x); })) {
    const auto d = coprime(direction);
    if (std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])}) <= static_cast<std::int64_t>(kLargest)) return d;
  }
  Eigen::Vector3d rounded;
  for (int i = 0; i < 3; ++i) rounded[i] = std::round(direction[i] / largest * kLargest);
  return coprime(rounded);
}

}  // namespace blackleaf::detail
