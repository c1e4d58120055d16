// Label maps in arbitrary motion against the definition, and the laws that tie them to the solids of their labels.
#include <gtest/gtest.h>

#include "blackleaf/error.h"
#include "blackleaf/label_map.h"
#include "blackleaf/move.h"
#include "reference/moved_labels.h"

namespace blackleaf {
namespace {

using reference::DenseLabels;

DenseLabels random_grid(int depth, std::mt19937& random) {
  DenseLabels grid(depth);
  const std::int64_t side = grid.side();
  grid.labels = reference::random_labels({side, side, side}, {0, 0, 1, 2, 7, 4'000'000'000}, random);
  return grid;
}
LabelMap map_of(const DenseLabels& grid, Frame frame = {}) {
  return LabelMap(grid.runs(), grid.depth, std::move(frame));
}

TEST(MoveLabels, AgreesWithTheDefinition) {
  std::mt19937 random(1992);
  for (int trial = 0; trial < 800; ++trial) {
    SCOPED_TRACE(trial);
    const DenseLabels grid = random_grid(1 + trial % 5, random);
    const Motion motion = reference::random_motion(grid.depth, random);
    const LabelMap expected = map_of(reference::move(grid, FixedMotion(motion)));
    for (const int threads : {1, 2, 7})
      ASSERT_EQ(move(map_of(grid), motion, Leaving::clip, {.threads = threads, .progress = {}}), expected) << threads;
  }
}

TEST(MoveLabels, TheSolidOfAllLabelsIsTheMovedSolid) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 100; ++trial) {
    SCOPED_TRACE(trial);
    const LabelMap map = map_of(random_grid(1 + trial % 6, random));
    const Motion motion = reference::random_motion(map.depth(), random);
    const LabelMap target = move(map, motion, Leaving::clip);
    EXPECT_EQ(octree_from_labels(target), move(octree_from_labels(map), motion, Leaving::clip));
    // The labels one by one, in increasing order, each painted over what is there.
    LabelMap painted(map.depth());
    for (const LabelFacts& facts : label_facts(map)) {
      DenseLabels canvas = reference::dense(painted);
      for_each_label_cube(label_map(move(octree_from_label(map, facts.label), motion, Leaving::clip)),
                          [&](const Cube& c, std::uint32_t inside) {
                            for (int z = c.z; inside != 0 && z < c.z + c.side(); ++z)
                              for (int y = c.y; y < c.y + c.side(); ++y)
                                for (int x = c.x; x < c.x + c.side(); ++x) canvas.at(x, y, z) = facts.label;
                          });
      painted = map_of(canvas);
    }
    EXPECT_EQ(target, painted);
  }
}

TEST(MoveLabels, OneLabelMovesAsItsSolid) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const Octree solid = reference::octree(reference::random_solid(1 + trial % 6, random));
    const Motion motion = reference::random_motion(solid.depth(), random);
    EXPECT_EQ(move(label_map(solid), motion, Leaving::clip), label_map(move(solid, motion, Leaving::clip)));
    if (solid.is_empty()) continue;
    const LabelMap grown = move(label_map(solid), motion, Leaving::grow);
    const Octree expected = move(solid, motion, Leaving::grow);
    EXPECT_EQ(grown, label_map(expected));
    EXPECT_EQ(grown.frame().origin, expected.frame().origin);
  }
}

TEST(MoveLabels, LeavingIsAnError) {
  DenseLabels grid(3);
  grid.at(7, 0, 0) = 5;
  const LabelMap map = map_of(grid);
  try {
    move(map, Motion::translation({0.25, 0, 0}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::out_of_universe);
    EXPECT_NE(std::string(error.what()).find("0.25 voxels beyond x = 8"), std::string::npos) << error.what();
  }
  EXPECT_EQ(move(map, Motion::translation({0.25, 0, 0}), Leaving::clip), map);
  EXPECT_EQ(move(map, Motion::translation({1e9, 0, 0}), Leaving::clip), LabelMap(3));
  EXPECT_EQ(move(LabelMap(4), Motion::translation({1e9, 0, 0})), LabelMap(4));
}

}  // namespace
}  // namespace blackleaf
