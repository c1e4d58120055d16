// VA88's own algorithm and the product's exact one draw the same picture.
#include "papers/va88.h"

#include <gtest/gtest.h>

#include <random>

#include "blackleaf/drawing.h"
#include "blackleaf/implicit.h"
#include "reference/dense_grid.h"
#include "reference/stroke_difference.h"

namespace blackleaf {
namespace {

namespace va88 = papers::va88;

void expect_same_picture(const Octree& octree, const Eigen::Vector3d& direction) {
  SCOPED_TRACE(direction.transpose());
  const LineDrawing exact = draw(octree, View(direction));
  for (const auto comparing : {va88::Comparing::every_edge, va88::Comparing::extents}) {
    const va88::Drawing printed = va88::draw(octree, direction, comparing);
    std::vector<Stroke> strokes;
    for (const va88::Segment& s : printed.segments) strokes.push_back({s.from, s.to});
    EXPECT_NEAR(printed.length(), exact.length(), 1e-6 * exact.length());
    EXPECT_EQ(reference::difference(strokes, exact.strokes, 1e-7), "");
  }
}

const std::vector<Eigen::Vector3d>& directions() {
  static const std::vector<Eigen::Vector3d> all = {
      {12, -16, 15}, {-3, 2, 7}, {-5, -4, -2}, {1, 1, 1},
      {-1, 1, -1},   {2, 1, 1},  {1, 2, 3},                 // general
      {1, 0, 0},     {0, -1, 0}, {0, 0, 1},    {0, 0, -1},  // along axes
      {0, 1, 1},     {0, -2, 3}, {3, 0, -1},   {-1, 0, -1},
      {2, 5, 0},     {-1, 1, 0}, {50, 1, 49}  // in planes, nearly so
  };
  return all;
}

TEST(Va88, AgreesOnAllSolidsOfDepthOne) {
  for (int bits = 0; bits < 256; ++bits) {
    SCOPED_TRACE("solid " + std::to_string(bits));
    const Octree solid = octree_from_classifier(1, [&](const Cube& c) {
      return c.level > 0 ? Colour::gray : bits >> (c.x + 2 * c.y + 4 * c.z) & 1 ? Colour::black : Colour::white;
    });
    for (const auto& d : directions()) expect_same_picture(solid, d);
  }
}

TEST(Va88, AgreesOnRandomSolids) {
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const Octree solid = reference::octree(reference::random_solid(seed % 3 == 0 ? 3 : 2, random));
    for (std::size_t i = seed % 3; i < directions().size(); i += 3) expect_same_picture(solid, directions()[i]);
  }
}

TEST(Va88, AgreesOnTheBall) {
  const Octree solid = ball(5, {16, 16, 16}, 8.0);
  EXPECT_NEAR(va88::draw(solid, {12, -16, 15}).length(), 453.924338, 5e-7);
  expect_same_picture(solid, {12, -16, 15});
  expect_same_picture(solid, {0, 0, 1});
  expect_same_picture(ball(6, {30.7, 33.1, 31}, 13.2), {4, 9, -7});
}

TEST(Va88, TakesQuadraticallyManyComparisons) {
  const va88::Drawing drawing = va88::draw(ball(5, {16, 16, 16}, 8.0), {12, -16, 15});
  EXPECT_EQ(drawing.comparisons, drawing.graphics_nodes * (drawing.graphics_nodes - 1) / 2);
  EXPECT_GT(drawing.graphics_nodes, 100u);
}

TEST(Va88, SkipsSurroundedBoxes) {
  // A 6^3 cube at an odd place: a shell of voxels around eight cubes of side 2, which are surrounded.
  const va88::Drawing drawing = va88::draw(box(3, {1, 1, 1}, {7, 7, 7}), {1, 2, 3});
  EXPECT_EQ(drawing.graphics_nodes, 6u * 6 * 6 - 4 * 4 * 4);
  EXPECT_EQ(drawing.segments.size(), 9u);
}

}  // namespace
}  // namespace blackleaf
