#include <gtest/gtest.h>

#include "blackleaf/error.h"
#include "blackleaf/implicit.h"
#include "blackleaf/lattice.h"
#include "blackleaf/move.h"
#include "reference/dense_labels.h"

namespace blackleaf {
namespace {

using reference::DenseLabels;
using Shift = std::array<std::int64_t, 3>;

DenseLabels random_grid(int depth, std::mt19937& random) {
  const std::vector<std::vector<std::uint32_t>> palettes = {{0, 1}, {0, 5, 4294967295u}, {1, 2, 3}, {0, 0, 0, 0, 9}};
  DenseLabels grid(depth);
  const std::int64_t n = grid.side();
  grid.labels = reference::random_labels({n, n, n}, palettes[random() % palettes.size()], random);
  return grid;
}

// Voxel by voxel; 0 comes in from outside.
template <class From>
DenseLabels moved(const DenseLabels& grid, const From& from) {
  DenseLabels result(grid.depth);
  for (int z = 0; z < grid.side(); ++z)
    for (int y = 0; y < grid.side(); ++y)
      for (int x = 0; x < grid.side(); ++x) {
        const std::array<std::int64_t, 3> v = from(x, y, z);
        if (std::min({v[0], v[1], v[2]}) < 0 || std::max({v[0], v[1], v[2]}) >= grid.side()) continue;
        result.at(x, y, z) = grid.at(static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2]));
      }
  return result;
}

// About a point one voxel up every axis from the centre: (1 - S) (1, 1, 1) more.
Shift off_centre(const LatticeSymmetry& symmetry) {
  return {symmetry.reversed(0) ? 2 : 0, symmetry.reversed(1) ? 2 : 0, symmetry.reversed(2) ? 2 : 0};
}

std::uint64_t labelled(const LabelMap& map) { return volume(octree_from_labels(map)); }

TEST(TranslateLabels, AgreesWithTheDenseGrid) {
  std::mt19937 random(1984);
  for (int trial = 0; trial < 600; ++trial) {
    SCOPED_TRACE(trial);
    const DenseLabels grid = random_grid(1 + trial % 5, random);
    const LabelMap map(grid.runs(), grid.depth);
    std::uniform_int_distribution<int> any(-grid.side() - 1, grid.side() + 1), small(-2, 2);
    Shift by = {any(random), small(random), small(random)};
    if (trial % 3 == 0) by = {small(random), any(random), 4 * small(random)};
    const LabelMap result = translate(map, by, Leaving::clip, {.threads = 1 + trial % 3, .progress = {}});
    const DenseLabels expected = moved(grid, [&](int x, int y, int z) {
      return Shift{x - by[0], y - by[1], z - by[2]};
    });
    ASSERT_TRUE(result == LabelMap(expected.runs(), grid.depth));
    if (labelled(result) == labelled(map))
      ASSERT_TRUE(translate(map, by) == result);
    else
      ASSERT_THROW(translate(map, by), Error);
    const LabelMap grown = translate(map, by, Leaving::grow);
    ASSERT_EQ(labelled(grown), labelled(map));
    const Eigen::Vector3d offset = -grown.frame().origin;
    for (int i = 0; i < 50; ++i) {
      const int x = static_cast<int>(random() % static_cast<unsigned>(grid.side())), y = x / 2, z = grid.side() - 1 - x;
      ASSERT_EQ(grown.label(x + by[0] + std::lround(offset.x()), y + by[1] + std::lround(offset.y()),
                            z + by[2] + std::lround(offset.z())),
                grid.at(x, y, z));
    }
    // Each label by itself is the same.
    const Octree one = octree_from_label(map, 5);
    ASSERT_TRUE(octree_from_label(result, 5) == translate(one, by, Leaving::clip));
  }
}

TEST(TranslateLabels, FarAndNowhere) {
  const LabelMap map = label_map(box(4, {1, 2, 3}, {4, 5, 6}));
  EXPECT_TRUE(translate(map, {0, 0, 0}) == map);
  EXPECT_TRUE(translate(map, {std::int64_t{1} << 60, 0, 0}, Leaving::clip) == LabelMap(4));
  EXPECT_THROW(translate(map, {std::int64_t{1} << 60, 0, 0}, Leaving::grow), Error);
  EXPECT_TRUE(translate(LabelMap(3), {100, 0, 0}) == LabelMap(3));
  const LabelMap deep = label_map(box(20, {3, 5, 7}, {70, 30, 20}));
  const LabelMap there = translate(deep, {900001, 77777, 4});
  EXPECT_TRUE(there == label_map(box(20, {900004, 77782, 11}, {900071, 77807, 24})));
}

TEST(TransformLabels, AgreesWithTheDenseGrid) {
  std::mt19937 random(48);
  for (int trial = 0; trial < 12; ++trial) {
    const DenseLabels grid = random_grid(1 + trial % 5, random);
    const LabelMap map(grid.runs(), grid.depth);
    const int n = grid.side();
    for (const LatticeSymmetry& symmetry : LatticeSymmetry::all()) {
      SCOPED_TRACE(testing::Message() << "trial " << trial << "\n" << symmetry.matrix());
      const auto from = [&](int x, int y, int z) {
        const Eigen::Vector3d centre = Eigen::Vector3d(2 * x + 1 - n, 2 * y + 1 - n, 2 * z + 1 - n);
        const Eigen::Vector3d image = symmetry.inverse().matrix() * centre;
        const auto at = [&](int i) { return (std::lround(image[i]) + n - 1) / 2; };
        return Shift{at(0), at(1), at(2)};
      };
      const LabelMap result = transform(map, symmetry, {.threads = 1 + trial % 2, .progress = {}});
      ASSERT_TRUE(result == LabelMap(moved(grid, from).runs(), grid.depth));
      ASSERT_TRUE(transform(result, symmetry.inverse()) == map);
      ASSERT_TRUE(transform(map, symmetry, Eigen::Vector3d::Constant(n / 2.0 + 1), Leaving::clip) ==
                  translate(result, off_centre(symmetry), Leaving::clip));
    }
    EXPECT_TRUE(turn(turn(map, 0), 0, -1) == map);
    EXPECT_TRUE(reflect(reflect(map, 1), 1) == map);
  }
}

}  // namespace
}  // namespace blackleaf
