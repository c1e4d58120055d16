#include "blackleaf/perspective.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "blackleaf/error.h"

namespace blackleaf {
namespace {

using Grid = std::array<std::int64_t, 3>;
constexpr double kPerVoxel = 1 << Perspective::kGridBits;
constexpr double kSidePrecision = 1 << 30;

Grid on_grid(const Eigen::Vector3d& point, const char* name) {
  if (!point.allFinite() || point.cwiseAbs().maxCoeff() > Perspective::kLargest)
    throw Error(ErrorCode::bad_argument, std::string(name) + " is not finite or more than 16777216 voxels away",
                "give a point like 300,-200,150, in voxels");
  Grid grid{};
  for (std::size_t i = 0; i < 3; ++i) grid[i] = std::llround(point[static_cast<Eigen::Index>(i)] * kPerVoxel);
  return grid;
}

Eigen::Vector3d in_voxels(const Grid& grid) {
  return Eigen::Vector3d(static_cast<double>(grid[0]), static_cast<double>(grid[1]), static_cast<double>(grid[2])) /
         kPerVoxel;
}

Eigen::Vector3d toward_eye(const Grid& eye, const Grid& target) {
  Eigen::Vector3d difference;
  for (std::size_t i = 0; i < 3; ++i)
    difference[static_cast<Eigen::Index>(i)] = static_cast<double>(eye[i] - target[i]);
  if (difference.isZero(0))
    throw Error(ErrorCode::bad_argument, "the eye and its target are the same point", "move one of them");
  return difference;
}

}  // namespace

Perspective::Perspective(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double field_of_view)
    : eye_(on_grid(eye, "the eye")), view_(toward_eye(eye_, on_grid(target, "its target"))) {
  if (!(field_of_view >= std::numbers::pi / 180 && field_of_view <= 170 * std::numbers::pi / 180))
    throw Error(ErrorCode::bad_argument, "the field of view is not from 1 to 170 degrees", "give an angle like 60");
  const Eigen::Vector3d kept = in_voxels(eye_), kept_target = in_voxels(on_grid(target, "its target"));
  distance_ = (kept - kept_target).norm();
  view_.eye_point_ = EyePoint{kept, kept_target, field_of_view};
  const double slope = std::tan(field_of_view / 2);
  const auto& d = view_.direction();
  const Eigen::Vector3d ahead =
      -Eigen::Vector3d(static_cast<double>(d[0]), static_cast<double>(d[1]), static_cast<double>(d[2])).normalized();
  const std::array<Eigen::Vector3d, 4> normals = {slope * ahead + view_.right(), slope * ahead - view_.right(),
                                                  slope * ahead + view_.up(), slope * ahead - view_.up()};
  for (std::size_t k = 0; k < 4; ++k) {
    const double scale = kSidePrecision / normals[k].cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i < 3; ++i) sides_[k][i] = std::llround(normals[k][static_cast<Eigen::Index>(i)] * scale);
  }
}

}  // namespace blackleaf
