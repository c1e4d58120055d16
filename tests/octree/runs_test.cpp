#include "blackleaf/runs.h"

#include <gtest/gtest.h>

#include "blackleaf/curve.h"
#include "blackleaf/error.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;

// The stream by the paper's definition: one look-up a voxel.
std::vector<blackleaf::Run> walk(const DenseGrid& grid) {
  std::vector<blackleaf::Run> result;
  for (std::uint64_t i = 0; i < grid.voxels.size(); ++i) {
    const curve::Voxel v = curve::voxel(grid.depth, i);
    const std::uint32_t colour = grid.at(v.x, v.y, v.z) ? 1 : 0;
    if (result.empty() || result.back().colour != colour) result.push_back({0, colour});
    ++result.back().count;
  }
  return result;
}

TEST(Runs, StreamOctreeAndBack) {
  std::mt19937 random(1992);
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 6, random);
    const Octree octree = reference::octree(grid);
    const std::vector<blackleaf::Run> expected = walk(grid);
    ASSERT_EQ(runs(octree), expected);
    ASSERT_TRUE(octree_from_runs(expected, grid.depth) == octree);
    const auto counts = monochrome(octree);
    ASSERT_EQ(counts.size(), expected.size() + (expected[0].colour ? 0 : 1));
    ASSERT_TRUE(octree_from_monochrome(counts, grid.depth) == octree);
    ASSERT_EQ(measure(octree).runs, expected.size());
    // Runs cut into pieces, with empty ones among them, tell the same.
    std::vector<blackleaf::Run> pieces;
    for (const blackleaf::Run& run : expected) {
      const std::uint64_t cut = random() % (run.count + 1);
      pieces.push_back({cut, run.colour * 7});
      pieces.push_back({0, 3});
      pieces.push_back({run.count - cut, run.colour * 9});
    }
    ASSERT_TRUE(octree_from_runs(pieces, grid.depth) == octree);
  }
}

TEST(Runs, ColoursAreChosenByThePredicate) {
  const std::vector<blackleaf::Run> labels = {{16, 23}, {16, 25}, {7, 24}, {25, 23}};
  const Octree octree = octree_from_runs(labels, 2, {}, [](std::uint32_t colour) { return colour == 23; });
  EXPECT_EQ(volume(octree), 41u);
  EXPECT_EQ(runs(octree), (std::vector<blackleaf::Run>{{16, 1}, {23, 0}, {25, 1}}));
}

TEST(Runs, WorkedExampleOfThePaper) {
  const std::vector<blackleaf::Run> stream = {{16, 23}, {16, 25}, {7, 24}, {25, 23}};
  std::vector<CubeRun> expected = {{1, 23}, {1, 23}, {1, 25}, {1, 25}};
  for (int i = 0; i < 7; ++i) expected.push_back({0, 24});
  expected.push_back({0, 23});
  for (int i = 0; i < 3; ++i) expected.push_back({1, 23});
  EXPECT_EQ(cubes(stream), expected);
}

TEST(Runs, MonochromeStartsWithForeground) {
  EXPECT_EQ(monochrome(Octree(2)), (std::vector<std::uint64_t>{0, 64}));
  EXPECT_EQ(monochrome(Octree(2, Colour::black)), (std::vector<std::uint64_t>{64}));
}

TEST(Runs, StreamsOfTheWrongLengthAreRefused) {
  const auto refused = [](const std::vector<blackleaf::Run>& stream, int depth) {
    try {
      octree_from_runs(stream, depth);
      return false;
    } catch (const Error& error) {
      return error.code() == ErrorCode::bad_input;
    }
  };
  EXPECT_FALSE(refused({{3, 1}, {5, 0}}, 1));
  EXPECT_TRUE(refused({{3, 1}, {4, 0}}, 1));
  EXPECT_TRUE(refused({{3, 1}, {6, 0}}, 1));
  EXPECT_TRUE(refused({{8, 1}, {1, 0}}, 1));
  EXPECT_TRUE(refused({{8, 1}, {0, 0}, {1, 1}}, 1));
  EXPECT_TRUE(refused({}, 1));
  EXPECT_TRUE(refused({{63, 1}}, 2));
  EXPECT_TRUE(refused({{~std::uint64_t{0}, 1}, {1, 1}, {64, 1}}, 2));
  EXPECT_TRUE(refused({{~std::uint64_t{0}, 1}, {65, 1}}, 20));
  EXPECT_FALSE(refused({{std::uint64_t{1} << 60, 1}}, 20));
  EXPECT_THROW(octree_from_runs(std::vector<blackleaf::Run>{{1, 1}}, 0), Error);
  EXPECT_THROW(octree_from_runs(std::vector<blackleaf::Run>{{1, 1}}, 21), Error);
}

}  // namespace
}  // namespace blackleaf
