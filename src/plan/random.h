// Random numbers that are the same with every library: OMPL's own come from its source of seeds, these from here.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace blackleaf::detail {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + uniform() * (high - low); }
  Eigen::Vector3d vector(double low, double high) {
    const double x = uniform(low, high), y = uniform(low, high), z = uniform(low, high);
    return {x, y, z};
  }
  /// Evenly over all rotations (Shoemake, Uniform random rotations, Graphics Gems III).
  Eigen::Quaterniond rotation() {
    constexpr double kTurn = 2 * std::numbers::pi;
    const double u = uniform(), v = kTurn * uniform(), w = kTurn * uniform();
    const double a = std::sqrt(1 - u), b = std::sqrt(u);
    return {a * std::sin(v), a * std::cos(v), b * std::sin(w), b * std::cos(w)};
  }
  /// A turn about an axis of any direction by up to `radians`.
  Eigen::Quaterniond small_rotation(double radians) {
    Eigen::Vector3d axis;
    do axis = vector(-1, 1);
    while (axis.squaredNorm() > 1 || axis.squaredNorm() < 1e-6);
    return Eigen::Quaterniond(Eigen::AngleAxisd(uniform(-radians, radians), axis.normalized()));
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace blackleaf::detail
