#include "blackleaf/measures.h"

#include <gtest/gtest.h>

#include "blackleaf/leaves.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;

TEST(Measures, AgreeWithTheDenseGrid) {
  std::mt19937 random(1987);
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 5, random);
    const Octree octree = reference::octree(grid);
    const Measures m = measure(octree);
    std::uint64_t voxels = 0, faces = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Box box{{99, 99, 99}, {-1, -1, -1}};
    grid.for_each([&](int x, int y, int z, bool black) {
      if (!black) return;
      ++voxels;
      sum += Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
      for (const auto& d : {std::array{1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
        for (int sign : {-1, 1}) faces += !grid.at(x + sign * d[0], y + sign * d[1], z + sign * d[2]);
      const std::array<int, 3> p = {x, y, z};
      for (std::size_t i = 0; i < 3; ++i) {
        box.min[i] = std::min(box.min[i], p[i]);
        box.max[i] = std::max(box.max[i], p[i] + 1);
      }
    });
    EXPECT_EQ(m.volume, voxels);
    EXPECT_EQ(volume(octree), voxels);
    EXPECT_EQ(m.surface_area, faces);
    ASSERT_EQ(m.bounding_box.has_value(), voxels > 0);
    ASSERT_EQ(m.centroid.has_value(), voxels > 0);
    if (voxels > 0) {
      EXPECT_EQ(*m.bounding_box, box);
      EXPECT_LT((*m.centroid - sum / static_cast<double>(voxels)).norm(), 1e-12);
    }
    std::uint64_t black = 0, white = 0;
    std::vector<std::uint64_t> by_level(static_cast<std::size_t>(grid.depth) + 1);
    for_each_leaf(octree, [&](const Leaf& leaf, bool is_black) {
      (is_black ? black : white)++;
      if (is_black) ++by_level[static_cast<std::size_t>(leaf.cube.level)];
    });
    EXPECT_EQ(m.black_leaves, black);
    EXPECT_EQ(m.white_leaves, white);
    EXPECT_EQ(m.black_leaves_by_level, by_level);
    const std::uint64_t total = m.black_leaves + m.white_leaves + m.internal_nodes;
    EXPECT_EQ(8 * m.internal_nodes, total - 1);  // WA87, lemma
  }
}

TEST(Measures, LargeSolidsDoNotOverflow) {
  const Measures m = measure(Octree(20, Colour::black));
  EXPECT_EQ(m.volume, std::uint64_t{1} << 60);
  EXPECT_EQ(m.surface_area, std::uint64_t{6} << 40);
  EXPECT_EQ(*m.centroid, Eigen::Vector3d::Constant(524288));
  EXPECT_EQ(m.black_leaves, 1u);
  EXPECT_EQ(m.internal_nodes, 0u);
  EXPECT_EQ(m.runs, 1u);
  // Three quarters of a huge universe: still a handful of nodes.
  const Measures slab = measure(box(20, {0, 0, 0}, {1 << 20, 1 << 20, 3 << 18}));
  EXPECT_EQ(slab.surface_area, (std::uint64_t{2} << 40) + std::uint64_t{4} * (std::uint64_t{3} << 38));
  EXPECT_EQ(slab.internal_nodes, 5u);
  EXPECT_DOUBLE_EQ(slab.centroid->z(), 3 * 131072.0);
}

TEST(Measures, BallOfTheNotes) { EXPECT_EQ(volume(ball(5, {16, 16, 16}, 8)), 2176u); }

}  // namespace
}  // namespace blackleaf
