// Directions of every kind for tests of drawings.
#pragma once

#include <Eigen/Core>
#include <array>
#include <random>
#include <string>

namespace blackleaf {

inline std::string show(const Eigen::Vector3d& d) {
  return std::to_string(d[0]) + "," + std::to_string(d[1]) + "," + std::to_string(d[2]);
}

/// One of the kinds of direction that differ in how edges, rays and picture lines fall together.
inline Eigen::Vector3d random_direction(std::mt19937& random) {
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  const auto sign = [&] { return pick(0, 1) ? 1.0 : -1.0; };
  Eigen::Vector3d d(0, 0, 0);
  switch (pick(0, 6)) {
    case 0:  // along an axis
      d[pick(0, 2)] = sign();
      break;
    case 1: {  // in a coordinate plane
      const int zero = pick(0, 2);
      for (int i = 0; i < 3; ++i) d[i] = i == zero ? 0 : sign() * pick(1, 5);
      break;
    }
    case 2:  // isometric
      for (int i = 0; i < 3; ++i) d[i] = sign();
      break;
    case 3: {  // nearly in a plane or along an axis
      const std::array<double, 4> sizes = {1, 999, 1000, 31};
      for (int i = 0; i < 3; ++i) d[i] = sign() * sizes[static_cast<std::size_t>(pick(0, 3))];
      break;
    }
    case 4:  // decimals
      for (int i = 0; i < 3; ++i) d[i] = std::uniform_real_distribution<double>(-1, 1)(random);
      break;
    default:  // small whole numbers, with many coincidences
      do
        for (int i = 0; i < 3; ++i) d[i] = pick(-4, 4);
      while (d.isZero());
  }
  return d;
}

}  // namespace blackleaf
