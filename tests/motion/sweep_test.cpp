#include "blackleaf/sweep.h"

#include <gtest/gtest.h>

#include "blackleaf/error.h"
#include "blackleaf/implicit.h"
#include "blackleaf/leaves.h"
#include "blackleaf/set_operations.h"
#include "motion/motion_groups.h"
#include "reference/dense_motion.h"
#include "reference/every_kernel.h"
#include "reference/paths.h"

namespace blackleaf {
namespace {

using Eigen::Vector3d;
using reference::DenseGrid;

/// The readable twin: every moved solid made, and all united.
Octree union_of_moves(const Octree& octree, const std::vector<Motion>& motions, Leaving leaving = Leaving::clip) {
  Octree all(octree.depth(), Colour::white, octree.frame());
  for (const Motion& motion : motions) all = unite(all, move(octree, motion, leaving));
  return all;
}

DenseGrid dense_union(const DenseGrid& grid, const std::vector<Motion>& motions) {
  DenseGrid all(grid.depth);
  for (const Motion& motion : motions) {
    const DenseGrid moved = reference::move(grid, FixedMotion(motion));
    for (std::size_t i = 0; i < all.voxels.size(); ++i) all.voxels[i] = all.voxels[i] || moved.voxels[i];
  }
  return all;
}

TEST(Sweep, EveryKernelGivesTheSame) {
  const reference::EveryKernel kernels;
  std::mt19937 random(2086);
  for (int trial = 0; trial < 150; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(2 + trial % 4, random);
    std::vector<Motion> motions;
    for (int count = 1 + trial % 5; count > 0; --count) motions.push_back(reference::random_motion(grid.depth, random));
    const Octree octree = reference::octree(grid), expected = reference::octree(dense_union(grid, motions));
    kernels.run([&] { EXPECT_TRUE(sweep(octree, motions, Leaving::clip) == expected); });
  }
}

TEST(Sweep, EqualsTheDenseUnionOfAnyMotions) {
  std::mt19937 random(2087);
  int black = 0;
  for (int trial = 0; trial < 900; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 4, random);
    std::vector<Motion> motions;
    for (int count = trial % 7; count > 0; --count) motions.push_back(reference::random_motion(grid.depth, random));
    const Octree swept = sweep(reference::octree(grid), motions, Leaving::clip);
    reference::expect_valid(swept);
    ASSERT_TRUE(swept == reference::octree(dense_union(grid, motions)));
    black += !swept.is_empty();
  }
  EXPECT_GT(black, 500);
}

TEST(Sweep, EqualsTheUnionOfMovesAlongPaths) {
  std::mt19937 random(2088);
  std::size_t most = 0;
  for (int trial = 0; trial < 150; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 2 + trial % 4;
    const Octree octree = reference::octree(reference::random_solid(depth, random));
    const Path path = reference::random_path(depth, random);
    const double step = std::array{1.0, 0.4, 2.5}[static_cast<std::size_t>(trial % 3)];
    const std::vector<Motion> motions = motions_along(octree, path, step);
    most = std::max(most, motions.size());
    const Octree swept = sweep(octree, path, step, Leaving::clip, {.threads = 1 + trial % 3, .progress = {}});
    reference::expect_valid(swept);
    ASSERT_TRUE(swept == union_of_moves(octree, motions));
  }
  EXPECT_GT(most, 100u);
}

TEST(Sweep, LargerSolidsAndThreads) {
  std::mt19937 random(2089);
  for (int trial = 0; trial < 4; ++trial) {
    SCOPED_TRACE(trial);
    const Octree ball_and_box = unite(ball(6, {25, 30, 32}, 8.5), box(6, {20, 30, 30}, {45, 34, 33}));
    const Path path = reference::random_path(6, random);
    const std::vector<Motion> motions = motions_along(ball_and_box, path);
    const Octree expected = union_of_moves(ball_and_box, motions);
    for (const int threads : {1, 2, 5})
      ASSERT_TRUE(sweep(ball_and_box, path, 1, Leaving::clip, {.threads = threads, .progress = {}}) == expected);
  }
}

TEST(Sweep, LeavesAsMovesDo) {
  std::mt19937 random(2090);
  int left = 0;
  for (int trial = 0; trial < 240; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 2 + trial % 2;
    const DenseGrid grid = reference::random_solid(depth, random);
    const Octree octree = reference::octree(grid);
    std::vector<Motion> motions;
    for (int count = 1 + trial % 3; count > 0; --count) motions.push_back(reference::random_motion(depth, random));
    bool leaves = false;
    for (const Motion& motion : motions) {
      try {
        move(octree, motion);
      } catch (const Error& error) {
        ASSERT_EQ(error.code(), ErrorCode::out_of_universe);
        leaves = true;
      }
    }
    left += leaves;
    if (!leaves) {
      EXPECT_TRUE(room_for(octree, motions).octree == octree);
      EXPECT_TRUE(sweep(octree, motions) == sweep(octree, motions, Leaving::clip));
      EXPECT_EQ(sweep(octree, motions, Leaving::grow).depth(), depth);
      continue;
    }
    EXPECT_THROW(room_for(octree, motions), Error);
    EXPECT_TRUE(room_for(octree, motions, Leaving::clip).octree == octree);
    EXPECT_THROW(sweep(octree, motions), Error);
    // Grown: the same as in a universe that was large enough from the start, at the place that the frame tells.
    const Octree grown = sweep(octree, motions, Leaving::grow);
    reference::expect_valid(grown);
    ASSERT_GT(grown.depth(), depth);
    const std::array<int, 3> offset = {static_cast<int>(-grown.frame().origin[0]),
                                       static_cast<int>(-grown.frame().origin[1]),
                                       static_cast<int>(-grown.frame().origin[2])};
    DenseGrid expected(grown.depth());
    for (const Motion& motion : motions) {
      DenseGrid large(grown.depth());
      grid.for_each([&](int x, int y, int z, bool black) {
        if (black) large.set(x + offset[0], y + offset[1], z + offset[2]);
      });
      const FixedMotion fixed = FixedMotion(motion);
      FixedMotion in_large = fixed.shifted({offset[0], offset[1], offset[2]});
      // The source lies at the offset too: x = A y + b + offset.
      for (std::size_t i = 0; i < 3; ++i)
        in_large.inverse_translation[i] += std::int64_t{offset[i]} << FixedMotion::kFractionBits;
      const DenseGrid moved = reference::move(large, in_large);
      for (std::size_t i = 0; i < moved.voxels.size(); ++i) expected.voxels[i] = expected.voxels[i] || moved.voxels[i];
    }
    ASSERT_TRUE(grown == reference::octree(expected));
    // The solid in that universe needs no more room.
    const RoomForMotions room = room_for(octree, motions, Leaving::grow);
    EXPECT_EQ(room.octree.depth(), grown.depth());
    EXPECT_EQ(room.octree.frame(), grown.frame());
    EXPECT_EQ(volume(room.octree), volume(octree));
    EXPECT_TRUE(room.octree.contains(offset[0], offset[1], offset[2]) == octree.contains(0, 0, 0));
    EXPECT_NO_THROW(sweep(room.octree, room.motions));
  }
  EXPECT_GT(left, 60);
}

TEST(Sweep, MotionsFarOutsideAreClippedAway) {
  const Octree cube = box(5, {4, 4, 4}, {9, 9, 9});
  const std::vector<Motion> motions = {Motion::translation({1e7, 0, 0}), Motion::translation({3, 0, 0}),
                                       Motion::translation({0, -400, 0})};
  EXPECT_TRUE(sweep(cube, motions, Leaving::clip) == translate(cube, {3, 0, 0}));
  EXPECT_THROW(sweep(cube, motions), Error);
  EXPECT_TRUE(sweep(cube, std::vector<Motion>{}).is_empty());
  EXPECT_TRUE(sweep(Octree(4), motions).is_empty());
}

TEST(Sweep, StraightLineOfACube) {
  const Octree cube = box(6, {3, 20, 30}, {7, 24, 35});
  const Path path({{0, {0, 0, 0}, Eigen::Quaterniond::Identity()}, {1, {50, 0, 0}, Eigen::Quaterniond::Identity()}});
  EXPECT_TRUE(sweep(cube, path) == box(6, {3, 20, 30}, {57, 24, 35}));
}

TEST(Sweep, FullTurnOfABallAboutAnAxisIsATorus) {
  // Black voxels' centres lie in the torus; voxels whose centres lie more than half a step deep in it, and as deep in a
  // ball of voxels as its surface is rough, are black.
  const double r = 6, ring = 20;
  const Octree solid = ball(6, {32 + ring, 32, 32}, r);
  std::vector<Pose> poses;
  for (int i = 0; i <= 3; ++i)
    poses.push_back(
        {double(i), Vector3d::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(i * 2 * M_PI / 3, Vector3d::UnitZ()))});
  const Octree torus = sweep(solid, Path(poses, {32, 32, 32}));
  for (int z = 0; z < 64; ++z)
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const double across = std::hypot(x - 31.5, y - 31.5) - ring;
        const double distance = std::hypot(across, z - 31.5);
        if (torus.contains(x, y, z)) {
          EXPECT_LE(distance, r + std::sqrt(0.75)) << x << ' ' << y << ' ' << z;
        } else {
          EXPECT_GE(distance, r - std::sqrt(0.75) - 0.5) << x << ' ' << y << ' ' << z;
        }
      }
}

TEST(Sweep, FinerStepsOnlyAddVoxelsThatWereGrazed) {
  std::mt19937 random(2091);
  for (int trial = 0; trial < 20; ++trial) {
    SCOPED_TRACE(trial);
    const Octree octree = ball(6, {30, 33, 31}, 9);
    const Path path = reference::random_path(6, random);
    const double step = 1;
    const std::vector<Motion> coarse = motions_along(octree, path, step);
    const std::vector<Motion> fine = motions_along(octree, path, step / 7);
    const Octree swept = sweep(octree, path, step, Leaving::clip);
    // What fine steps alone find is within step / 2 of the coarse ones' solids: a cube around it as large, moved back
    // by some motion, meets the solid.
    const Octree missed = subtract(sweep(octree, path, step / 7, Leaving::clip), swept);
    for_each_black_leaf(missed, [&](const Leaf& leaf) {
      for (int i = 0; i < 1 << (3 * leaf.cube.level); ++i) {
        const int side = leaf.cube.side();
        const Vector3d centre(leaf.cube.x + i % side + 0.5, leaf.cube.y + i / side % side + 0.5,
                              leaf.cube.z + i / side / side + 0.5);
        bool near = false;
        for (const Motion& motion : coarse) {
          const Vector3d p = motion.inverse()(centre);
          const auto low = [&](int axis) { return static_cast<std::int64_t>(std::floor(p[axis] - 0.5001)); };
          const auto high = [&](int axis) { return static_cast<std::int64_t>(std::floor(p[axis] + 0.5001)); };
          for (std::int64_t z = low(2); z <= high(2) && !near; ++z)
            for (std::int64_t y = low(1); y <= high(1) && !near; ++y)
              for (std::int64_t x = low(0); x <= high(0) && !near; ++x) near = octree.contains(x, y, z);
          if (near) break;
        }
        EXPECT_TRUE(near) << centre.transpose();
      }
    });
  }
}

TEST(Sweep, TellsProgressAndStops) {
  const Octree octree = ball(7, {40, 64, 64}, 20);
  const Path path({{0, {0, 0, 0}, Eigen::Quaterniond::Identity()}, {1, {40, 0, 0}, Eigen::Quaterniond::Identity()}});
  double last = 0;
  const Work work{1, [&](double done) {
                    EXPECT_GE(done, last);
                    last = done;
                    return true;
                  }};
  sweep(octree, path, 1, Leaving::error, work);
  EXPECT_EQ(last, 1);
  EXPECT_THROW(sweep(octree, path, 1, Leaving::error, {1, [](double) { return false; }}), Error);
}

// The law that the sweep rests on: by every motion of a group, a centre that falls into the source's box lies in the
// group's box.
TEST(MotionGroups, BoxHoldsTheCentresOfEveryMotion) {
  std::mt19937 random(2092);
  std::size_t held = 0;
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 5;
    const Box source{{9, 12, 3}, {20, 25, 30}};
    const Path path = reference::random_path(depth, random);
    std::vector<FixedMotion> motions;
    for (const double time : path.times(source, 3)) motions.emplace_back(path.motion_at(time));
    const detail::MotionGroups groups(motions, source, depth);
    if (groups.empty()) continue;
    for (int k = 0; k < 100; ++k) {
      const int level = std::uniform_int_distribution<int>(0, 3)(random);
      const auto place = [&] { return std::uniform_int_distribution<int>(0, (32 >> level) - 1)(random) << level; };
      const Cube cube{place(), place(), place(), level};
      std::uint32_t index = detail::MotionGroups::kAll;
      while (true) {
        const auto& group = groups[index];
        const detail::SourceBox whole = groups.box(group, cube);
        for (std::uint32_t motion = group.first; motion <= group.last; ++motion) {
          bool inside = true, in_box = true;
          const detail::SourcePoint q = groups.motion(motion).centre(cube.x, cube.y, cube.z);
          for (std::size_t i = 0; i < 3; ++i) {
            inside = inside && q[i] >= std::int64_t{source.min[i]} << detail::kSourceBits &&
                     q[i] <= std::int64_t{source.max[i]} << detail::kSourceBits;
            in_box = in_box && whole.low[i] <= q[i] && q[i] <= whole.high[i];
          }
          EXPECT_TRUE(!inside || (in_box && groups.reaches(group, cube)));
          held += inside;
        }
        if (group.single()) break;
        index = k % 2 ? index + 1 : group.second_half;
      }
    }
  }
  EXPECT_GT(held, 1000u);
}

}  // namespace
}  // namespace blackleaf
