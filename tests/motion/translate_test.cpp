#include <gtest/gtest.h>

#include "blackleaf/error.h"
#include "blackleaf/leaves.h"
#include "blackleaf/move.h"
#include "blackleaf/set_operations.h"
#include "octree/simd_kernels.h"
#include "reference/dense_motion.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
using Shift = std::array<std::int64_t, 3>;

Shift random_shift(int depth, std::mt19937& random) {
  const int n = 1 << depth;
  std::uniform_int_distribution<int> any(-n - 1, n + 1), small(-2, 2);
  if (random() % 2) return {small(random), small(random), small(random)};
  return {any(random), any(random), any(random)};
}

TEST(Translate, AgreesWithTheDenseGrid) {
  std::mt19937 random(1984);
  for (int trial = 0; trial < 1500; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 5, random);
    const Shift by = random_shift(grid.depth, random);
    const Octree octree = reference::octree(grid);
    const DenseGrid expected = reference::translate(grid, by);
    const Octree moved = translate(octree, by, Leaving::clip);
    reference::expect_valid(moved);
    ASSERT_TRUE(moved == reference::octree(expected));
    // Without clipping: the same, or an error iff voxels were lost.
    if (volume(moved) == volume(octree)) {
      ASSERT_TRUE(translate(octree, by) == moved);
    } else {
      ASSERT_THROW(translate(octree, by), Error);
    }
  }
}

TEST(Translate, LargerUniversesWithEveryKernel) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 50; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 6 + trial % 2;
    const DenseGrid grid = reference::random_solid(depth, random);
    Shift by = random_shift(depth, random);
    if (trial % 3 == 0)  // multiples of powers of two, not the same on every axis
      for (std::int64_t& part : by) part = part / 4 * (std::int64_t{1} << random() % 5);
    const Octree octree = reference::octree(grid), expected = reference::octree(reference::translate(grid, by));
    for (const std::string& kernel : detail::simd_kernels()) {
      SCOPED_TRACE(kernel);
      detail::use_simd_kernel(kernel);
      ASSERT_TRUE(translate(octree, by, Leaving::clip, {.threads = 1, .progress = {}}) == expected);
    }
    for (const int threads : {2, 3, 7})
      ASSERT_TRUE(translate(octree, by, Leaving::clip, {.threads = threads, .progress = {}}) == expected);
  }
  detail::use_simd_kernel("");
}

TEST(Translate, PowersOfTwoKeepTheTree) {
  // AN84: leaves not larger than the displacement's lowest set bit stay whole.
  const Octree octree = unite(ball(9, {130, 140, 150}, 101), box(9, {3, 5, 7}, {60, 61, 62}));
  for (const int level : {0, 1, 2, 3, 4, 5, 6, 7}) {
    SCOPED_TRACE(level);
    const std::int64_t by = std::int64_t{1} << level;
    const Octree moved = translate(octree, {by, 2 * by % 256, 0});
    reference::expect_valid(moved);
    EXPECT_TRUE(translate(moved, {-by, -(2 * by % 256), 0}) == octree);
    const auto before = measure(octree).black_leaves_by_level, after = measure(moved).black_leaves_by_level;
    for (std::size_t k = 0; k < static_cast<std::size_t>(level); ++k) EXPECT_EQ(after[k], before[k]) << "level " << k;
  }
  EXPECT_EQ(translate(octree, {0, 0, 0}).root().word(), octree.root().word());
}

TEST(Translate, SparseSolidsInDeepUniverses) {
  std::mt19937 random(14);
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 14 + trial % 7;
    const std::int32_t n = 1 << depth;
    const auto any = [&](std::int32_t low, std::int32_t high) {
      return std::uniform_int_distribution<std::int32_t>(low, high)(random);
    };
    Octree octree(depth);
    for (int part = 0; part < 4; ++part) {
      const std::array<std::int32_t, 3> low = {any(0, n - 40), any(0, n - 40), any(0, n - 40)};
      octree = unite(octree, box(depth, low, {low[0] + any(1, 40), low[1] + any(1, 40), low[2] + any(1, 40)}));
    }
    const Shift by = {any(-n, n), any(-n, n) / 64 * 64, any(-5, 5)};
    const Octree moved = translate(octree, by, Leaving::clip);
    reference::expect_valid(moved);
    for_each_black_leaf(octree, [&](const Leaf& leaf) {
      const Cube& c = leaf.cube;
      for (const std::int32_t end : {0, c.side() - 1}) {
        const std::int64_t x = c.x + end + by[0], y = c.y + end + by[1], z = c.z + end + by[2];
        const bool inside = std::min({x, y, z}) >= 0 && std::max({x, y, z}) < n;
        ASSERT_EQ(moved.contains(x, y, z), inside);
      }
    });
    EXPECT_LE(volume(moved), volume(octree));
    if (depth < 20) {
      EXPECT_EQ(volume(translate(octree, by, Leaving::grow)), volume(octree));
    }
  }
}

TEST(Translate, AddsUp) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    // In the middle of a universe of depth 5 everything has room.
    const DenseGrid solid = reference::random_solid(3, random);
    DenseGrid grid(5);
    grid.for_each([&](int x, int y, int z, bool) { grid.set(x, y, z, solid.at(x - 12, y - 12, z - 12)); });
    const Octree a = reference::octree(grid);
    const Shift s = random_shift(2, random), t = random_shift(2, random);
    EXPECT_TRUE(translate(translate(a, s), t) == translate(a, {s[0] + t[0], s[1] + t[1], s[2] + t[2]}));
    EXPECT_TRUE(translate(translate(a, s), {-s[0], -s[1], -s[2]}) == a);
  }
}

TEST(Translate, GrowingKeepsTheSolidAndItsPlaceInTheWorld) {
  std::mt19937 random(6);
  Frame frame;
  frame.origin = {10, 20, 30};
  frame.axes << 0, -2, 0, 2, 0, 0, 0, 0, 2;
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 4, random);
    const Octree octree = reference::octree(grid).with_frame(frame);
    const Shift by = random_shift(grid.depth, random);
    const Octree grown = translate(octree, by, Leaving::grow);
    reference::expect_valid(grown);
    ASSERT_EQ(volume(grown), volume(octree));
    // Where world coordinates put a voxel of the grown universe in the old one.
    const Eigen::Vector3d offset = frame.axes.inverse() * (frame.origin - grown.frame().origin);
    const std::array<int, 3> o = {static_cast<int>(std::lround(offset.x())), static_cast<int>(std::lround(offset.y())),
                                  static_cast<int>(std::lround(offset.z()))};
    grid.for_each([&](int x, int y, int z, bool black) {
      ASSERT_EQ(grown.contains(x + by[0] + o[0], y + by[1] + o[1], z + by[2] + o[2]), black);
    });
  }
}

TEST(Translate, LeavingSaysByHowMuchAndWhere) {
  const Octree octree = box(4, {2, 3, 4}, {10, 12, 16});
  try {
    translate(octree, {-5, 0, 7});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::out_of_universe);
    EXPECT_EQ(
        std::string(error.what()),
        "the moved solid leaves the universe: 3 voxels below x = 0, 7 voxels beyond z = 16; move it less, clip it "
        "(--clip) or grow the universe (--grow)");
  }
  EXPECT_TRUE(translate(octree, {std::numeric_limits<std::int64_t>::max(), 0, 0}, Leaving::clip).is_empty());
  EXPECT_THROW(translate(octree, {std::numeric_limits<std::int64_t>::min(), 0, 0}, Leaving::grow), Error);
  EXPECT_EQ(translate(octree, {1000000, 0, 0}, Leaving::grow).depth(), 20);
}

TEST(Translate, DepthTwentyAndThreads) {
  const Octree a = box(20, {3, 5, 7}, {7000, 300, 20});
  const Octree b = translate(a, {900001, 77777, 4});
  EXPECT_EQ(volume(b), volume(a));
  EXPECT_EQ(*bounding_box(b), (Box{{900004, 77782, 11}, {907001, 78077, 24}}));
  EXPECT_TRUE(translate(b, {-900001, -77777, -4}, Leaving::error, {.threads = 1, .progress = {}}) == a);
  EXPECT_TRUE(translate(b, {-900001, -77777, -4}, Leaving::error, {.threads = 2, .progress = {}}) == a);
}

TEST(Translate, TheEmptySolidGoesAnywhere) {
  EXPECT_TRUE(translate(Octree(3), {100, 0, 0}).is_empty());
  EXPECT_TRUE(translate(Octree(3, Colour::black), {0, 0, 0}) == Octree(3, Colour::black));
}

}  // namespace
}  // namespace blackleaf
