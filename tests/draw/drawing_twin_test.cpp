// draw() against its slow twin, over random solids and directions of every kind.
#include <gtest/gtest.h>

#include <random>

#include "blackleaf/drawing.h"
#include "directions.h"
#include "reference/dense_drawing.h"
#include "reference/stroke_difference.h"

namespace blackleaf {
namespace {

using reference::DenseDrawing;
using reference::DenseGrid;

void expect_like_twin(const DenseGrid& grid, const Eigen::Vector3d& direction, double tolerance = 1e-10) {
  SCOPED_TRACE("view " + show(direction));
  const View view(direction);
  const LineDrawing drawing = draw(reference::octree(grid), view);
  EXPECT_EQ(reference::difference(drawing.strokes, DenseDrawing::strokes(grid, view.direction()), tolerance), "");
}

TEST(DrawingTwin, AllSolidsOfDepthOneFromEverySide) {
  for (int bits = 0; bits < 256; ++bits) {
    SCOPED_TRACE("solid " + std::to_string(bits));
    DenseGrid grid(1);
    for (int i = 0; i < 8; ++i) grid.set(i & 1, i >> 1 & 1, i >> 2, bits >> i & 1);
    for (const Eigen::Vector3d& d :
         {Eigen::Vector3d(12, -16, 15), Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, 1, 0),
          Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0, 1, 1), Eigen::Vector3d(-2, 0, 1), Eigen::Vector3d(1, -3, 0)})
      expect_like_twin(grid, d);
  }
}

TEST(DrawingTwin, RandomSolids) {
  for (unsigned seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const int depth = seed % 40 == 0 ? 4 : seed % 3 == 0 ? 3 : 2;
    const DenseGrid grid = reference::random_solid(depth, random);
    expect_like_twin(grid, random_direction(random), 1e-9);
  }
}

// Few voxels far apart: long flights, much of the picture decided far from where the ray started.
TEST(DrawingTwin, ScatteredVoxels) {
  for (unsigned seed = 0; seed < 250; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 5000);
    DenseGrid grid(4);
    for (int i = 0; i < 40; ++i) {
      const auto at = [&] { return std::uniform_int_distribution<int>(0, 15)(random); };
      const int x = at(), y = at(), z = at();
      grid.set(x, y, z);
    }
    expect_like_twin(grid, random_direction(random), 1e-9);
  }
}

// Directions at the limit of the exact integers.
TEST(DrawingTwin, LargestDirections) {
  for (unsigned seed = 0; seed < 250; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 9000);
    const DenseGrid grid = reference::random_solid(seed % 3 == 0 ? 3 : 2, random);
    Eigen::Vector3d d(1048576, 1048575, 1048573);
    std::shuffle(d.begin(), d.end(), random);
    for (int i = 0; i < 3; ++i) d[i] *= random() % 2 ? 1 : -1;
    expect_like_twin(grid, d, 1e-9);
  }
}

}  // namespace
}  // namespace blackleaf
