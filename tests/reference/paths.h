// Random paths for tests.
#pragma once

#include <random>
#include <vector>

#include "blackleaf/path.h"

namespace blackleaf::reference {

/// Paths made to be nasty: one pose, rests, straight lines along axes by whole and half voxels, turns by multiples of
/// 90 degrees, half turns, full turns in three poses, many short segments, and any; about the centre, a corner or
/// anywhere.
inline Path random_path(int depth, std::mt19937& random) {
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  const auto real = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  const double n = 1 << depth;
  const auto axis = [&]() -> Eigen::Vector3d {
    if (pick(0, 1)) return Eigen::Vector3d::Unit(pick(0, 2));
    return Eigen::Vector3d(real(-1, 1), real(-1, 1), real(0.1, 1)).normalized();
  };
  const auto vector = [&](double reach) {
    return Eigen::Vector3d(real(-reach, reach), real(-reach, reach), real(-reach, reach));
  };
  const auto turn = [&](double radians) { return Eigen::Quaterniond(Eigen::AngleAxisd(radians, axis())); };
  const Eigen::Vector3d abouts[] = {Eigen::Vector3d::Constant(n / 2), Eigen::Vector3d::Zero(), vector(n)};
  const Eigen::Vector3d about = abouts[pick(0, 2)];
  std::vector<Pose> poses;
  const int kind = pick(0, 6);
  if (kind == 0) {
    poses.push_back({0, vector(n / 4), turn(real(-3, 3))});
  } else if (kind == 1) {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
      poses.push_back({double(i), at, Eigen::Quaterniond::Identity()});
      at[pick(0, 2)] += pick(-4, 4) / 2.0;
    }
  } else if (kind == 2) {
    for (int i = 0; i < 3; ++i) poses.push_back({i * 0.5, Eigen::Vector3d::Zero(), turn(pick(-2, 2) * M_PI / 2)});
  } else if (kind == 3) {
    const Eigen::Vector3d fixed = axis();
    for (int i = 0; i < 4; ++i)
      poses.push_back({double(i), Eigen::Vector3d::Constant(i * n / 50),
                       Eigen::Quaterniond(Eigen::AngleAxisd(i * 2 * M_PI / 3, fixed))});
  } else if (kind == 4) {
    Pose pose{-1, Eigen::Vector3d::Zero(), turn(1)};
    for (int i = 0; i < 40; ++i) {
      poses.push_back(pose);
      pose.time += real(0.01, 2);
      pose.translation += vector(n / 80);
      pose.rotation = (pose.rotation * turn(real(-0.05, 0.05))).normalized();
    }
  } else {
    for (int i = pick(2, 4); i > 0; --i) poses.push_back({double(-i), vector(n / 3), turn(real(-3, 3))});
  }
  return Path(poses, about);
}

}  // namespace blackleaf::reference
