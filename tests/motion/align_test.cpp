#include "blackleaf/align.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "blackleaf/error.h"
#include "reference/dense_offset.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;

TEST(Align, PutsEverySolidWhereItsFrameSays) {
  std::mt19937 random(31);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  Frame frame;
  frame.origin = {10.25, -20, 3e3};
  frame.axes << 0, -0.3, 0, 0.3, 0, 0, 0, 0, 0.7;
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    std::vector<Octree> octrees;
    std::vector<DenseGrid> grids;
    std::vector<std::array<int, 3>> corners;
    for (int k = pick(1, 3); k > 0; --k) {
      grids.push_back(reference::random_solid(pick(1, 4), random));
      corners.push_back(octrees.empty() ? std::array{0, 0, 0} : std::array{pick(-9, 9), pick(-9, 9), pick(-9, 9)});
      octrees.push_back(
          reference::octree(grids.back())
              .with_frame(frame.shifted(Eigen::Vector3d(corners.back()[0], corners.back()[1], corners.back()[2]))));
    }
    const std::vector<Octree> result = aligned(octrees);
    ASSERT_EQ(result.size(), octrees.size());
    const Eigen::Vector3d corner = frame.axes.inverse() * (frame.origin - result[0].frame().origin);
    for (std::size_t k = 0; k < result.size(); ++k) {
      reference::expect_valid(result[k]);
      ASSERT_EQ(result[k].depth(), result[0].depth());
      ASSERT_EQ(result[k].frame(), result[0].frame());
      ASSERT_EQ(volume(result[k]), volume(octrees[k]));  // nothing is cut off
      std::array<int, 3> at{};
      for (std::size_t i = 0; i < 3; ++i)
        at[i] = corners[k][i] + static_cast<int>(std::lround(corner[static_cast<Eigen::Index>(i)]));
      ASSERT_TRUE(result[k] == reference::octree(reference::placed(grids[k], result[k].depth(), at)));
    }
  }
}

TEST(Align, OnlyOnOneLattice) {
  Frame frame, half = frame, turned = frame, fine = frame, far = frame, other_unit = frame, rounded = frame;
  half.origin = {0.5, 0, 0};
  turned.axes << 0, 1, 0, 1, 0, 0, 0, 0, 1;
  fine.axes *= 0.5;
  far.origin = {1e9, 0, 0};
  other_unit.unit = "mm";
  rounded.origin = {7 + 1e-9, -3, 1e-8};
  for (const Frame& other : {half, turned, fine, far, other_unit}) {
    EXPECT_EQ(whole_shift(other, frame).has_value(), other == far);
    const std::array<Octree, 2> pair = {Octree(3, Colour::black, frame), Octree(3, Colour::black, other)};
    EXPECT_THROW(aligned(pair), Error);
  }
  EXPECT_EQ(whole_shift(rounded, frame), (std::array<std::int64_t, 3>{7, -3, 0}));
  EXPECT_EQ(whole_shift(frame, rounded), (std::array<std::int64_t, 3>{-7, 3, 0}));
}

}  // namespace
}  // namespace blackleaf
