// The slow readable twin of moving octrees: every target voxel asks for itself.
#pragma once

#include <array>
#include <vector>

#include "blackleaf/motion.h"
#include "reference/dense_grid.h"

namespace blackleaf::reference {

inline DenseGrid translate(const DenseGrid& grid, const std::array<std::int64_t, 3>& by) {
  DenseGrid result(grid.depth);
  result.for_each([&](int x, int y, int z, bool) { result.set(x, y, z, grid.at(x - by[0], y - by[1], z - by[2])); });
  return result;
}

/// Calls visit(x, y, z) for the voxels whose closed cubes hold the centre of the target voxel `at`, moved back: by the
/// definition, in 128-bit integers.
template <class Visit>
void for_each_touched(const FixedMotion& motion, const std::array<std::int64_t, 3>& at, Visit visit) {
  __extension__ using Wide = __int128;
  constexpr Wide kVoxel = Wide{1} << (FixedMotion::kFractionBits + 1);
  std::array<Wide, 3> q{};
  for (std::size_t i = 0; i < 3; ++i) {
    q[i] = 2 * Wide{motion.inverse_translation[i]};
    for (std::size_t j = 0; j < 3; ++j) q[i] += Wide{motion.inverse_rotation[i][j]} * (2 * at[j] + 1);
  }
  // On every axis, those among the voxels near by whose closed intervals hold it: one, or two.
  std::array<std::vector<std::int64_t>, 3> touched;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto near = static_cast<std::int64_t>(q[i] / kVoxel);
    for (std::int64_t v = near - 2; v <= near + 2; ++v)
      if (v * kVoxel <= q[i] && q[i] <= (v + 1) * kVoxel) touched[i].push_back(v);
  }
  for (const std::int64_t z : touched[2])
    for (const std::int64_t y : touched[1])
      for (const std::int64_t x : touched[0]) visit(x, y, z);
}

/// A target voxel is black iff its centre, moved back, lies in some closed black voxel. Voxels outside the universe are
/// dropped.
inline DenseGrid move(const DenseGrid& grid, const FixedMotion& motion) {
  DenseGrid result(grid.depth);
  result.for_each([&](int x, int y, int z, bool) {
    bool black = false;
    for_each_touched(motion, {x, y, z},
                     [&](std::int64_t i, std::int64_t j, std::int64_t k) { black = black || grid.at(i, j, k); });
    result.set(x, y, z, black);
  });
  return result;
}

/// Motions made to be nasty: identity, quarter turns about the centre and about odd points, 45 degrees, 3-4-5 and 1-2-2
/// rotations with integer and half-integer translations (centres on faces, edges and corners), tiny and general ones.
inline Motion random_motion(int depth, std::mt19937& random) {
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  const auto real = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  const double n = 1 << depth;
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  const auto axis = [&] { return Eigen::Vector3d(pick(-2, 2), pick(-2, 2), pick(-2, 2) * 2 + 1); };
  switch (pick(0, 7)) {
    case 0:
      break;
    case 1:
      r = Motion::rotation(Eigen::Vector3d::Unit(pick(0, 2)), pick(-3, 3) * M_PI / 2).rotation();
      break;
    case 2:
      r = Motion::rotation(Eigen::Vector3d::Unit(pick(0, 2)), M_PI / 4).rotation();
      break;
    case 3:
      r << 0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1;
      break;
    case 4:
      r << 1, -2, 2, 2, -1, -2, 2, 2, 1;
      r /= 3;
      break;
    case 5:
      r = Motion::rotation(Eigen::Vector3d(1, 1, 1), pick(-2, 2) * M_PI * 2 / 3).rotation();
      break;
    case 6:
      r = Motion::rotation(axis(), real(-1e-3, 1e-3)).rotation();
      break;
    default:
      r = Motion::rotation(axis(), real(-3, 3)).rotation();
      break;
  }
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  switch (pick(0, 3)) {
    case 0:
      break;
    case 1:
      t = Eigen::Vector3d(pick(-2, 2), pick(-2, 2), pick(-2, 2));
      break;
    case 2:
      t = Eigen::Vector3d(pick(-4, 4), pick(-4, 4), pick(-4, 4)) / 2;
      break;
    default:
      t = Eigen::Vector3d(real(-1, 1), real(-1, 1), real(-1, 1)) * n / 4;
      break;
  }
  const Motion motion(r, t);
  return pick(0, 3) ? motion.about(Eigen::Vector3d::Constant(n / 2)) : motion;
}

}  // namespace blackleaf::reference
