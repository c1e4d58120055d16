#include "blackleaf/move.h"

#include <gtest/gtest.h>

#include "blackleaf/error.h"
#include "motion/centre_kernel.h"
#include "reference/dense_motion.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
constexpr double kDegree = M_PI / 180;

TEST(Move, AgreesWithTheDenseGrid) {
  std::mt19937 random(1987);
  for (int trial = 0; trial < 1500; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 5, random);
    const Motion motion = reference::random_motion(grid.depth, random);
    const Octree moved = move(reference::octree(grid), motion, Leaving::clip);
    reference::expect_valid(moved);
    ASSERT_TRUE(moved == reference::octree(reference::move(grid, FixedMotion(motion))));
  }
}

TEST(Move, DepthSixAndThreads) {
  std::mt19937 random(36);
  for (int trial = 0; trial < 25; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(6, random);
    const Motion motion = reference::random_motion(6, random);
    const Octree octree = reference::octree(grid);
    const Octree moved = move(octree, motion, Leaving::clip, {.threads = 1, .progress = {}});
    ASSERT_TRUE(moved == reference::octree(reference::move(grid, FixedMotion(motion))));
    for (int threads : {2, 3, 8})
      ASSERT_TRUE(moved == move(octree, motion, Leaving::clip, {.threads = threads, .progress = {}}));
  }
}

TEST(Move, EveryKernelGivesTheSame) {
  const auto kernels = detail::centre_kernels();
  ASSERT_EQ(kernels.back(), "scalar");
  std::mt19937 random(77);
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 3 + trial % 4;
    const DenseGrid grid = reference::random_solid(depth, random);
    const Octree octree = reference::octree(grid);
    const Motion motion = reference::random_motion(depth, random);
    const Octree expected = reference::octree(reference::move(grid, FixedMotion(motion)));
    for (const std::string& kernel : kernels) {
      SCOPED_TRACE(kernel);
      detail::use_centre_kernel(kernel);
      EXPECT_TRUE(move(octree, motion, Leaving::clip) == expected);
    }
  }
  detail::use_centre_kernel("");
}

TEST(Move, LeavesExactlyWhenACornerDoes) {
  std::mt19937 random(77);
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 4, random);
    const Motion motion = reference::random_motion(grid.depth, random);
    double outside = 0;
    grid.for_each([&](int x, int y, int z, bool black) {
      for (int corner = 0; black && corner < 8; ++corner) {
        const Eigen::Vector3d p = motion(Eigen::Vector3d(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2)));
        outside = std::max({outside, -p.minCoeff(), p.maxCoeff() - grid.side()});
      }
    });
    const Octree octree = reference::octree(grid);
    if (outside > 0x1p-15) {
      EXPECT_THROW(move(octree, motion), Error);
    } else if (outside < 0x1p-17) {
      EXPECT_TRUE(move(octree, motion) == move(octree, motion, Leaving::clip));
    }
    if (!octree.is_empty()) {
      const Octree grown = move(octree, motion, Leaving::grow);
      reference::expect_valid(grown);
      // World coordinates stay: every voxel centre of the old universe has the colour it has when clipping.
      const Octree clipped = move(octree, motion, Leaving::clip);
      const Eigen::Vector3d offset = -grown.frame().origin;
      for (int z = 0; z < grid.side(); ++z)
        for (int y = 0; y < grid.side(); ++y)
          for (int x = 0; x < grid.side(); ++x)
            ASSERT_EQ(
                clipped.contains(x, y, z),
                grown.contains(x + std::lround(offset.x()), y + std::lround(offset.y()), z + std::lround(offset.z())));
    }
  }
}

TEST(Move, LessThanAVoxelOutIsStillOut) {
  const Octree full(3, Colour::black);
  try {
    move(full, Motion::translation({0.25, 0, 0}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::out_of_universe);
    EXPECT_NE(std::string(error.what()).find("0.25 voxels beyond x = 8"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(move(full, Motion::translation({0.25, 0, 0}), Leaving::clip) == full);
}

TEST(Move, QuarterTurnsAreLosslessAndFormAGroup) {
  std::mt19937 random(24);
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 5;
    const Octree octree = reference::octree(reference::random_solid(depth, random));
    const Eigen::Vector3d centre = Eigen::Vector3d::Constant((1 << depth) / 2.0);
    const auto turn = [&](int axis, int quarters) {
      return Motion::rotation(Eigen::Vector3d::Unit(axis), quarters * 90 * kDegree).about(centre);
    };
    for (int axis = 0; axis < 3; ++axis) {
      const Octree once = move(octree, turn(axis, 1));
      EXPECT_EQ(measure(once).black_leaves_by_level, measure(octree).black_leaves_by_level);
      EXPECT_TRUE(move(once, turn(axis, 3)) == octree);
      EXPECT_TRUE(move(move(once, turn(axis, 1)), turn(axis, 2)) == octree);
      EXPECT_TRUE(move(once, turn((axis + 1) % 3, 1)) == move(octree, turn((axis + 1) % 3, 1) * turn(axis, 1)));
    }
  }
}

TEST(Move, IntegerTranslationsAreThoseOfTranslate) {
  std::mt19937 random(13);
  std::uniform_int_distribution<int> shift(-9, 9);
  for (int trial = 0; trial < 200; ++trial) {
    const Octree octree = reference::octree(reference::random_solid(1 + trial % 4, random));
    const std::array<std::int64_t, 3> by = {shift(random), shift(random), shift(random)};
    const Motion motion =
        Motion::translation({static_cast<double>(by[0]), static_cast<double>(by[1]), static_cast<double>(by[2])});
    EXPECT_TRUE(move(octree, motion, Leaving::clip) == translate(octree, by, Leaving::clip));
  }
}

TEST(Move, DoesNotMakeHoles) {
  // WA87, section 3: a voxel wholly inside the moved solid is black, one wholly outside is white.
  std::mt19937 random(2);
  for (int trial = 0; trial < 30; ++trial) {
    SCOPED_TRACE(trial);
    const Motion motion = reference::random_motion(6, random);
    const Octree moved = move(ball(6, {32, 32, 32}, 20), motion, Leaving::clip);
    const Eigen::Vector3d centre = motion(Eigen::Vector3d(32, 32, 32));
    for (int z = 0; z < 64; ++z)
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
          const double radius = (Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5) - centre).norm();
          if (radius < 19 || radius > 21) {
            ASSERT_EQ(moved.contains(x, y, z), radius < 20);
          }
        }
  }
}

TEST(Move, DepthTwenty) {
  const Octree speck = box(20, {524288, 524288, 524288}, {524300, 524291, 524289});
  const Octree turned = move(speck, Motion::rotation({0, 0, 1}, 90 * kDegree).about(Eigen::Vector3d::Constant(524288)));
  EXPECT_EQ(*bounding_box(turned), (Box{{524285, 524288, 524288}, {524288, 524300, 524289}}));
  EXPECT_EQ(volume(turned), volume(speck));
}

TEST(Move, FarAwayIsOutOfEveryUniverse) {
  const Octree speck = box(5, {1, 1, 1}, {2, 2, 2});
  const Motion far = Motion::translation({1e9, 0, 0});
  EXPECT_TRUE(move(speck, far, Leaving::clip).is_empty());
  EXPECT_THROW(move(speck, far), Error);
  EXPECT_THROW(move(speck, far, Leaving::grow), Error);
}

}  // namespace
}  // namespace blackleaf
