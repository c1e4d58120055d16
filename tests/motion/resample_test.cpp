#include "blackleaf/resample.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "blackleaf/error.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

TEST(Resample, TakesTheColourAtEveryCentre) {
  std::mt19937 random(11);
  const auto real = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 4, target_depth = 1 + trial / 4 % 5;
    const reference::DenseGrid grid = reference::random_solid(depth, random);
    Frame from, to;
    // Voxels of other sizes, turned, mirrored and skewed.
    from.axes = Eigen::Matrix3d(Eigen::AngleAxisd(real(-3, 3), Eigen::Vector3d(1, real(-1, 1), 0.3).normalized())) *
                Eigen::Vector3d(real(0.5, 2), real(0.5, 2), -real(0.5, 2)).asDiagonal();
    to.axes << real(0.3, 2), 0.1, 0, 0, real(0.3, 2), 0, -0.2, 0, real(0.3, 2);
    from.origin = {real(-3, 3), real(-3, 3), real(-3, 3)};
    to.origin = from.origin + from.axes * Eigen::Vector3d(real(-1, 1), real(-1, 1), real(-1, 1)) * grid.side();
    const Octree found = resampled(reference::octree(grid).with_frame(from), to, target_depth);
    reference::expect_valid(found);
    EXPECT_EQ(found.frame(), to);
    const Eigen::Matrix3d inverse = from.axes.inverse();
    reference::dense(found).for_each([&](int x, int y, int z, bool black) {
      const Eigen::Vector3d at = inverse * (to.to_world({x + 0.5, y + 0.5, z + 0.5}) - from.origin);
      ASSERT_EQ(black, grid.at(std::lround(std::floor(at.x())), std::lround(std::floor(at.y())),
                               std::lround(std::floor(at.z()))));
    });
  }
}

TEST(Resample, KeepsWhatItCan) {
  std::mt19937 random(12);
  const Octree octree = reference::octree(reference::random_solid(4, random));
  EXPECT_EQ(resampled(octree, octree.frame(), 4), octree);
  // Halves of voxels and back.
  Frame fine = octree.frame();
  fine.axes /= 2;
  const Octree finer = resampled(octree, fine, 5);
  EXPECT_EQ(volume(finer), 8 * volume(octree));
  EXPECT_EQ(resampled(finer, octree.frame(), 4), octree);
  Frame other = octree.frame();
  other.unit = "mm";
  EXPECT_EQ(resampled(octree, other, 4), octree);  // of a bare octree nobody knows the unit
  Frame inches = other;
  inches.unit = "inch";
  EXPECT_THROW(resampled(octree.with_frame(inches), other, 4), Error);
  other = octree.frame();
  other.axes.col(0).setZero();
  EXPECT_THROW(resampled(octree, other, 4), Error);
}

}  // namespace
}  // namespace blackleaf
