#include "blackleaf/label_map.h"

#include <gtest/gtest.h>

#include <random>

#include "blackleaf/error.h"
#include "blackleaf/implicit.h"
#include "reference/dense_grid.h"
#include "reference/dense_labels.h"

namespace blackleaf {
namespace {

using reference::DenseLabels;
using Runs = std::vector<blackleaf::Run>;  // inside a test, "Run" is a function of GoogleTest

DenseLabels random_map(int depth, std::mt19937& random) {
  DenseLabels grid(depth);
  const std::int64_t side = grid.side();
  grid.labels = reference::random_labels({side, side, side}, {0, 1, 2, 7, 4294967295u}, random);
  return grid;
}

TEST(LabelMap, TheWorkedExampleOfTheHeader) {
  const LabelMap map(Runs{{1, 0}, {1, 7}, {6, 0}}, 1);
  ASSERT_EQ(map.run_count(), 3u);
  EXPECT_EQ(map.starts()[1], 1u);
  EXPECT_EQ(map.starts()[2], 2u);
  EXPECT_EQ(map.count(2), 6u);
  EXPECT_EQ(map.label(1, 0, 0), 7u);
  EXPECT_EQ(map.label(0, 1, 0), 0u);
  EXPECT_EQ(map.label(-1, 0, 0), 0u);
  EXPECT_EQ(map.label(2, 0, 0), 0u);
}

TEST(LabelMap, IsItsDenseTwin) {
  std::mt19937 random(20);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    const DenseLabels grid = random_map(1 + i % 4, random);
    const LabelMap map(grid.runs(), grid.depth);
    EXPECT_TRUE(reference::dense(map) == grid);
    EXPECT_EQ(map.runs(), grid.runs());
    const auto facts = label_facts(map), expected = grid.facts();
    ASSERT_EQ(facts.size(), expected.size());
    for (std::size_t k = 0; k < facts.size(); ++k) {
      EXPECT_EQ(facts[k].label, expected[k].label);
      EXPECT_EQ(facts[k].volume, expected[k].volume);
      EXPECT_EQ(facts[k].bounding_box, expected[k].bounding_box);
    }
  }
}

TEST(LabelMap, CubesAreMaximalAndFillTheUniverse) {
  std::mt19937 random(21);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const DenseLabels grid = random_map(1 + i % 4, random);
    const LabelMap map(grid.runs(), grid.depth);
    std::uint64_t next = 0;
    for_each_label_cube(map, [&](const Cube& cube, std::uint32_t label) {
      EXPECT_EQ(curve::first_number(grid.depth, cube), next);
      next += std::uint64_t{1} << (3 * cube.level);
      const auto all = [&](const Cube& c) {
        for (int z = c.z; z < c.z + c.side(); ++z)
          for (int y = c.y; y < c.y + c.side(); ++y)
            for (int x = c.x; x < c.x + c.side(); ++x)
              if (grid.at(x, y, z) != label) return false;
        return true;
      };
      EXPECT_TRUE(all(cube));
      if (cube.level == grid.depth) return;
      const int mask = -2 * cube.side();
      EXPECT_FALSE(all({cube.x & mask, cube.y & mask, cube.z & mask, cube.level + 1}));
    });
    EXPECT_EQ(next, std::uint64_t{1} << (3 * grid.depth));
  }
}

TEST(LabelMap, SolidsOfLabels) {
  std::mt19937 random(22);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    const DenseLabels grid = random_map(1 + i % 4, random);
    const Frame frame{{1, 2, 3}, Eigen::Matrix3d::Identity() * 2, "mm"};
    const LabelMap map(grid.runs(), grid.depth, frame);
    const auto expect_solid = [&](const Octree& octree, auto wanted) {
      reference::expect_valid(octree);
      EXPECT_TRUE(octree.frame() == frame);
      reference::DenseGrid expected(grid.depth);
      expected.for_each([&](int x, int y, int z, bool) { expected.set(x, y, z, wanted(grid.at(x, y, z))); });
      EXPECT_TRUE(reference::dense(octree) == expected);
    };
    expect_solid(octree_from_labels(map), [](std::uint32_t label) { return label != 0; });
    expect_solid(octree_from_labels(map, [](std::uint32_t label) { return label % 2 == 1; }),
                 [](std::uint32_t label) { return label % 2 == 1; });
    for (const std::uint32_t label : {0u, 7u, 4294967295u, 12u})
      expect_solid(octree_from_label(map, label), [&](std::uint32_t other) { return other == label; });
  }
}

TEST(LabelMap, OfAnOctreeAndBack) {
  std::mt19937 random(23);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const Octree octree = reference::octree(reference::random_solid(1 + i % 5, random));
    const LabelMap map = label_map(octree);
    EXPECT_EQ(map.runs(), runs(octree));
    EXPECT_TRUE(octree_from_labels(map) == octree);
    EXPECT_TRUE(octree_from_label(map, 1) == octree);
  }
  const Octree far = ball(12, {2000, 1800, 1900}, 700);
  const LabelMap map = label_map(far);
  EXPECT_TRUE(octree_from_label(map, 1) == far);
  ASSERT_EQ(label_facts(map).size(), 1u);
  EXPECT_EQ(label_facts(map)[0].volume, volume(far));
  EXPECT_EQ(label_facts(map)[0].bounding_box, *bounding_box(far));
}

TEST(LabelMap, EqualityFramesAndMemory) {
  const LabelMap a(Runs{{3, 0}, {5, 9}}, 1), b(Runs{{1, 0}, {0, 4}, {2, 0}, {4, 9}, {1, 9}}, 1);
  EXPECT_TRUE(a == b);
  EXPECT_EQ(b.run_count(), 2u);
  EXPECT_FALSE(a == LabelMap(Runs{{3, 0}, {5, 8}}, 1));
  EXPECT_FALSE(LabelMap(1) == LabelMap(2));
  EXPECT_EQ(LabelMap(20).run_count(), 1u);
  EXPECT_EQ(LabelMap(20).count(0), std::uint64_t{1} << 60);
  EXPECT_TRUE(label_facts(LabelMap(20)).empty());
  const Frame frame{{1, 0, 0}, Eigen::Matrix3d::Identity(), "cm"};
  const LabelMap moved = a.with_frame(frame);
  EXPECT_TRUE(moved == a);
  EXPECT_TRUE(moved.frame() == frame);
  EXPECT_EQ(moved.starts().data(), a.starts().data());
  EXPECT_GE(a.memory_bytes(), 24u);
}

TEST(LabelMap, RefusesStreamsThatDoNotFillTheirUniverse) {
  const auto code_of = [](const Runs& runs, int depth) {
    try {
      const LabelMap map(runs, depth);
    } catch (const Error& error) {
      return static_cast<int>(error.code());
    }
    return -1;
  };
  EXPECT_EQ(code_of({{7, 0}}, 1), static_cast<int>(ErrorCode::bad_input));
  EXPECT_EQ(code_of({{9, 0}}, 1), static_cast<int>(ErrorCode::bad_input));
  EXPECT_EQ(code_of({}, 1), static_cast<int>(ErrorCode::bad_input));
  EXPECT_EQ(code_of({{8, 0}, {18446744073709551615u, 1}}, 1), static_cast<int>(ErrorCode::bad_input));
  EXPECT_EQ(code_of({{8, 0}}, 0), static_cast<int>(ErrorCode::bad_argument));
  EXPECT_EQ(code_of({{8, 0}}, 21), static_cast<int>(ErrorCode::bad_argument));
  EXPECT_EQ(code_of({{8, 0}}, 1), -1);
}

TEST(LabelMapBuilder, IsEmptyAfterFinish) {
  LabelMapBuilder builder(1);
  builder.add(8, 3);
  EXPECT_EQ(builder.finish().label(0, 0, 0), 3u);
  EXPECT_EQ(builder.end(), 0u);
  builder.add(8, 4);
  EXPECT_EQ(builder.finish().label(0, 0, 0), 4u);
}

}  // namespace
}  // namespace blackleaf
