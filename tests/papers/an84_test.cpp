// AN84: the paper's tables and worked examples, and its translation against a shift voxel by voxel.
#include "papers/an84.h"

#include <gtest/gtest.h>

#include <random>

#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "reference/dense_grid.h"

namespace blackleaf::papers::an84 {
namespace {

using reference::DenseGrid;

Path path(std::initializer_list<int> labels) {
  Path p;
  for (const int label : labels) p.push(label);
  return p;
}

TEST(An84Tables, Table2AsPrinted) {
  // Final label after a unit displacement along +x, +y, +z; a leading 1 is the carry (so 10 is label 0 with a carry).
  constexpr int kPrinted[8][3] = {{1, 2, 4},  {10, 3, 5},  {3, 10, 6},  {12, 11, 7},
                                  {5, 6, 10}, {14, 7, 11}, {7, 14, 12}, {16, 15, 13}};
  for (std::size_t label = 0; label < 8; ++label)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int printed = kPrinted[label][axis];
      const Transition expected{static_cast<std::uint8_t>(printed % 10), printed >= 10};
      EXPECT_EQ(kTransitions[label][axis], expected) << "label " << label << " axis " << axis;
    }
}

TEST(An84Tables, TheOctantMovesByOneAlongItsAxis) {
  for (std::size_t label = 0; label < 8; ++label)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Transition next = kTransitions[label][axis];
      EXPECT_EQ(next.label, label ^ 1u << axis);
      EXPECT_EQ(next.carry, (label >> axis & 1) == 1);
    }
}

TEST(An84Labels, WorkedExamples) {
  const Sum one = add(path({0, 5, 7}), 1, Axis::y);
  EXPECT_EQ(one.path, path({0, 7, 5}));
  EXPECT_FALSE(one.carry_lost);
  const Sum five = add(path({0, 5, 7}), 5, Axis::y);
  EXPECT_EQ(five.path, path({2, 7, 5}));
  EXPECT_FALSE(five.carry_lost);
  const Sum back = add(path({2, 7, 5}), -5, Axis::y);
  EXPECT_EQ(back.path, path({0, 5, 7}));
  EXPECT_TRUE(back.carry_lost);
}

TEST(An84Labels, AdditionIsAdditionOfOneCoordinate) {
  std::mt19937 random(1984);
  for (int i = 0; i < 20000; ++i) {
    const int length = std::uniform_int_distribution<int>(1, kMaxDepth)(random);
    const std::int64_t side = std::int64_t{1} << length;
    auto coordinate = std::uniform_int_distribution<std::int64_t>(0, side - 1);
    std::array<std::int64_t, 3> at = {coordinate(random), coordinate(random), coordinate(random)};
    const std::size_t axis = random() % 3;
    const std::int64_t by = std::uniform_int_distribution<std::int64_t>(1 - side, side - 1)(random);
    const auto path_of = [&](const std::array<std::int64_t, 3>& p) {
      Path result;
      for (int bit = length - 1; bit >= 0; --bit)
        result.push(static_cast<int>((p[0] >> bit & 1) + 2 * (p[1] >> bit & 1) + 4 * (p[2] >> bit & 1)));
      return result;
    };
    const Sum sum = add(path_of(at), by, static_cast<Axis>(axis));
    const std::int64_t moved = at[axis] + by;
    at[axis] = moved & (side - 1);  // wraps around when it leaves the universe
    EXPECT_EQ(sum.path, path_of(at));
    const bool inside = moved >= 0 && moved < side;
    if (by != 0) {
      EXPECT_EQ(sum.carry_lost == (by < 0), inside) << "by " << by << " in 2^" << length;
    }
  }
}

DenseGrid shifted(const DenseGrid& grid, const std::array<int, 3>& by) {
  DenseGrid result(grid.depth);
  grid.for_each([&](int x, int y, int z, bool black) {
    if (black) result.set(x + by[0], y + by[1], z + by[2]);
  });
  return result;
}

// Nodes of the tree of black leaves: every gray node, every black leaf, and the root even of an empty universe.
std::size_t expected_nodes(const Octree& octree) {
  const Measures m = measure(octree);
  return octree.is_empty() ? 1 : m.internal_nodes + m.black_leaves;
}

TEST(An84Tree, KeepsOnlyBlackLeavesAndLosesNothing) {
  std::mt19937 random(7);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    const Octree octree = reference::octree(reference::random_solid(1 + i % 5, random));
    const Tree tree(octree);
    EXPECT_EQ(tree.octree(), octree);
    EXPECT_EQ(tree.nodes(), expected_nodes(octree));
  }
}

TEST(An84Tree, TranslatesAsVoxelsDo) {
  std::mt19937 random(57);
  int moved = 0;
  for (int i = 0; i < 600; ++i) {
    SCOPED_TRACE(i);
    const int depth = 1 + i % 5;
    DenseGrid grid = reference::random_solid(depth, random);
    // Often halve the solid, so that there is room to move.
    if (depth > 1 && i % 4 != 0) {
      DenseGrid small(depth);
      grid.for_each([&](int x, int y, int z, bool black) {
        if (black && x % 2 == 0 && y % 2 == 0 && z % 2 == 0)
          small.set((x + grid.side() * (i % 2)) / 2, (y + grid.side() * (i % 3 % 2)) / 2, z / 2);
      });
      grid = small;
    }
    const Octree octree = reference::octree(grid);
    const auto box = bounding_box(octree);
    std::array<int, 3> by{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int low = box ? -box->min[axis] : -3, high = box ? grid.side() - box->max[axis] : 3;
      by[axis] = std::uniform_int_distribution<int>(low, high)(random);
      if (random() % 4 == 0) by[axis] = by[axis] / 2 * 2;  // an even displacement need not split to voxels
    }
    Tree tree(octree);
    tree.translate({by[0], by[1], by[2]});
    const Octree expected = reference::octree(shifted(grid, by));
    EXPECT_EQ(tree.octree(), expected);
    EXPECT_EQ(tree.nodes(), expected_nodes(expected)) << "not compacted";
    if (expected != octree) ++moved;
    tree.translate({-by[0], -by[1], -by[2]});
    EXPECT_EQ(tree.octree(), octree);
    EXPECT_EQ(tree.nodes(), expected_nodes(octree));
  }
  EXPECT_GT(moved, 200);
}

TEST(An84Tree, RefusesToLeaveTheUniverseAndStaysAsItWas) {
  const Octree octree = box(4, {3, 4, 5}, {9, 12, 14});
  const std::vector<std::array<std::int64_t, 3>> outside = {{-4, 0, 0},  {8, 0, 0},       {0, -5, 0},  {0, 5, 0},
                                                            {0, 0, -6},  {0, 0, 3},       {-3, 4, -6}, {16, 0, 0},
                                                            {0, -16, 0}, {0, 0, 1 << 20}, {7, 4, 16}};
  for (const auto& by : outside) {
    Tree tree(octree);
    try {
      tree.translate(by);
      ADD_FAILURE() << by[0] << ' ' << by[1] << ' ' << by[2];
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::out_of_universe);
    }
    EXPECT_EQ(tree.octree(), octree);
  }
  Tree tree(octree);
  tree.translate({7, 4, 2});
  EXPECT_EQ(tree.octree(), box(4, {10, 8, 7}, {16, 16, 16}));
}

TEST(An84Tree, AnEmptyObjectGoesAnywhere) {
  Tree tree{Octree(3)};
  tree.translate({100, -100, 1});
  EXPECT_TRUE(tree.octree().is_empty());
}

TEST(An84Tree, SplitsNoDeeperThanTheLowestSetBit) {
  Tree even(box(6, {0, 0, 0}, {32, 32, 32}));
  even.translate({16, 0, 0});
  EXPECT_LE(even.peak_nodes(), 32u);  // 8 nodes of side 16, their new places, and what leads to them
  Tree odd(box(6, {0, 0, 0}, {32, 32, 32}));
  odd.translate({1, 0, 0});
  EXPECT_GT(odd.peak_nodes(), 32u * 32u * 32u);
}

TEST(An84Tree, InterferenceIsASharedVoxel) {
  std::mt19937 random(3);
  int yes = 0, no = 0;
  for (int i = 0; i < 600; ++i) {
    SCOPED_TRACE(i);
    const int depth = 1 + i % 4;
    const DenseGrid a = reference::random_solid(depth, random);
    DenseGrid b = reference::random_solid(depth, random);
    if (i % 2 != 0)  // cut a out of b, so that they touch but do not interfere
      for (std::size_t v = 0; v < b.voxels.size(); ++v) b.voxels[v] = b.voxels[v] && (!a.voxels[v] || v % 61 == 60);
    bool shared = false;
    for (std::size_t v = 0; v < a.voxels.size(); ++v) shared = shared || (a.voxels[v] && b.voxels[v]);
    const Tree ta(reference::octree(a)), tb(reference::octree(b));
    EXPECT_EQ(interferes(ta, tb), shared);
    EXPECT_EQ(interferes(tb, ta), shared);
    (shared ? yes : no)++;
  }
  EXPECT_GT(yes, 100);
  EXPECT_GT(no, 100);
}

}  // namespace
}  // namespace blackleaf::papers::an84
