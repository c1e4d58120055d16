#include "blackleaf/voxel_cursor.h"

#include <gtest/gtest.h>

#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

TEST(VoxelCursor, AnswersAsTheOctree) {
  std::mt19937 random(14);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  int black = 0;
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(trial);
    const reference::DenseGrid grid = reference::random_solid(1 + trial % 6, random);
    VoxelCursor cursor(reference::octree(grid));
    VoxelCursor other = cursor;
    std::array<int, 3> at{};
    for (int step = 0; step < 300; ++step) {
      // Small steps, and now and then anywhere, outside too.
      for (int& coordinate : at) coordinate = pick(0, 9) == 0 ? pick(-2, grid.side() + 1) : coordinate + pick(-1, 1);
      const bool expected = grid.at(at[0], at[1], at[2]);
      ASSERT_EQ(cursor.contains(at[0], at[1], at[2]), expected);
      if (step % 7 == 0) {
        ASSERT_EQ(other.contains(at[0], at[1], at[2]), expected);
      }
      black += expected;
    }
  }
  EXPECT_GT(black, 10000);
  EXPECT_FALSE(VoxelCursor(Octree(20, Colour::black)).contains(-1, 0, 0));
  EXPECT_TRUE(VoxelCursor(Octree(20, Colour::black)).contains((1 << 20) - 1, 0, 5));
  EXPECT_FALSE(VoxelCursor(Octree(20, Colour::black)).contains(1 << 20, 0, 5));
}

}  // namespace
}  // namespace blackleaf
