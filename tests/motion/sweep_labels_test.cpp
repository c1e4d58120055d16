// Sweeps of label maps against the definition, and the laws that tie them to the sweeps of their labels' solids.
#include <gtest/gtest.h>

#include "blackleaf/error.h"
#include "blackleaf/sweep.h"
#include "reference/every_kernel.h"
#include "reference/moved_labels.h"
#include "reference/paths.h"

namespace blackleaf {
namespace {

using reference::DenseLabels;

DenseLabels random_grid(int depth, std::mt19937& random) {
  DenseLabels grid(depth);
  const std::int64_t side = grid.side();
  grid.labels = reference::random_labels({side, side, side}, {0, 0, 0, 1, 2, 7, 4'000'000'000}, random);
  return grid;
}
LabelMap map_of(const DenseLabels& grid) { return LabelMap(grid.runs(), grid.depth); }

/// By the definition: the largest label that any of the motions brings.
DenseLabels swept(const DenseLabels& grid, const std::vector<Motion>& motions) {
  DenseLabels result(grid.depth);
  for (const Motion& motion : motions) {
    const DenseLabels moved = reference::move(grid, FixedMotion(motion));
    for (std::size_t i = 0; i < result.labels.size(); ++i)
      result.labels[i] = std::max(result.labels[i], moved.labels[i]);
  }
  return result;
}

TEST(SweepLabels, AgreesWithTheDefinition) {
  std::mt19937 random(2093);
  std::size_t most = 0;
  for (int trial = 0; trial < 500; ++trial) {
    SCOPED_TRACE(trial);
    const DenseLabels grid = random_grid(1 + trial % 4, random);
    std::vector<Motion> motions;
    for (int count = trial % 6; count > 0; --count) motions.push_back(reference::random_motion(grid.depth, random));
    const LabelMap result = sweep(map_of(grid), motions, Leaving::clip, {.threads = 1 + trial % 3, .progress = {}});
    if (label_facts(map_of(grid)).empty()) {
      EXPECT_EQ(result, map_of(grid));
      continue;
    }
    ASSERT_EQ(result, map_of(swept(grid, motions)));
    most = std::max(most, label_facts(result).size());
  }
  EXPECT_EQ(most, 4u);
}

TEST(SweepLabels, AlongPathsWithEveryKernelAndThreadCount) {
  const reference::EveryKernel kernels;
  std::mt19937 random(2094);
  for (int trial = 0; trial < 12; ++trial) {
    SCOPED_TRACE(trial);
    const DenseLabels grid = random_grid(4, random);
    const LabelMap map = map_of(grid);
    const Path path = reference::random_path(4, random);
    const LabelMap expected = map_of(swept(grid, motions_along(octree_from_labels(map), path)));
    kernels.run([&] { EXPECT_EQ(sweep(map, path, 1, Leaving::clip, {.threads = 1, .progress = {}}), expected); });
    for (const int threads : {2, 5})
      EXPECT_EQ(sweep(map, path, 1, Leaving::clip, {.threads = threads, .progress = {}}), expected);
  }
}

TEST(SweepLabels, TheSolidOfAllLabelsIsTheSweptSolid) {
  std::mt19937 random(2095);
  int grown = 0;
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const LabelMap map = map_of(random_grid(2 + trial % 4, random));
    const Octree solid = octree_from_labels(map);
    const Path path = reference::random_path(map.depth(), random);
    EXPECT_EQ(octree_from_labels(sweep(map, path, 1, Leaving::clip)), sweep(solid, path, 1, Leaving::clip));
    if (solid.is_empty()) continue;
    const LabelMap all = sweep(map, path, 1, Leaving::grow);
    const Octree expected = sweep(solid, path, 1, Leaving::grow);
    EXPECT_EQ(octree_from_labels(all), expected);
    EXPECT_EQ(all.frame(), expected.frame());
    // One label alone sweeps at least what it keeps beside the others; the largest keeps all of it.
    const std::uint32_t largest = label_facts(map).back().label;
    if (all.depth() == map.depth()) {
      EXPECT_EQ(octree_from_label(all, largest), sweep(octree_from_label(map, largest), motions_along(solid, path)));
    }
    // The same universe for single frames.
    const std::vector<Motion> motions = motions_along(solid, path);
    const RoomForLabels room = room_for(map, motions, Leaving::grow);
    const RoomForMotions of_solid = room_for(solid, motions, Leaving::grow);
    EXPECT_EQ(octree_from_labels(room.labels), of_solid.octree);
    EXPECT_EQ(room.labels.frame(), of_solid.octree.frame());
    EXPECT_EQ(label_facts(room.labels).size(), label_facts(map).size());
    ASSERT_EQ(room.motions.size(), of_solid.motions.size());
    for (std::size_t i = 0; i < motions.size(); ++i) EXPECT_TRUE(room.motions[i] == of_solid.motions[i]);
    EXPECT_NO_THROW(move(room.labels, room.motions.back()));
    grown += room.labels.depth() > map.depth();
  }
  EXPECT_GT(grown, 10);
}

TEST(SweepLabels, LeavingIsAnError) {
  DenseLabels grid(3);
  grid.at(6, 0, 0) = 5;
  grid.at(0, 0, 0) = 9;
  const LabelMap map = map_of(grid);
  const std::vector<Motion> motions = {Motion(), Motion::translation({1, 0, 0}), Motion::translation({2.5, 0, 0})};
  try {
    sweep(map, motions);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::out_of_universe);
    EXPECT_NE(std::string(error.what()).find("1.5 voxels beyond x = 8"), std::string::npos) << error.what();
  }
  EXPECT_THROW(room_for(map, motions), Error);
  EXPECT_EQ(room_for(map, motions, Leaving::clip).labels, map);
  EXPECT_EQ(sweep(LabelMap(4), motions), LabelMap(4));
}

TEST(SweepLabels, TellsProgressAndStops) {
  std::mt19937 random(2096);
  DenseLabels grid(4);
  grid.labels = reference::random_labels({16, 16, 16}, {1, 2, 3}, random);
  const LabelMap map = map_of(grid);
  const std::vector<Motion> motions = {Motion(), Motion::translation({1, 0.3, 0})};
  double last = 0;
  const Work work{1, [&](double done) {
                    EXPECT_GE(done, last);
                    last = done;
                    return true;
                  }};
  sweep(map, motions, Leaving::clip, work);
  EXPECT_EQ(last, 1);
  EXPECT_THROW(sweep(map, motions, Leaving::clip, {1, [](double) { return false; }}), Error);
}

}  // namespace
}  // namespace blackleaf
