// Cutting scenes open and hatching them, against slow twins.
#include <gtest/gtest.h>

#include <random>

#include "blackleaf/error.h"
#include "blackleaf/hatch.h"
#include "directions.h"
#include "reference/dense_hatch.h"
#include "scenes.h"

namespace blackleaf {
namespace {

using reference::DenseCutScene;
using reference::DenseGrid;
using reference::DenseHatch;

// Boxes as cuts have them: unbounded on some sides.
std::vector<Box> random_boxes(int side, std::mt19937& random) {
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  std::vector<Box> boxes;
  for (int i = pick(0, 2); i > 0; --i) {
    Box box{{0, 0, 0}, {side, side, side}};
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (pick(0, 1)) (pick(0, 1) ? box.min : box.max)[axis] = pick(0, side);
    boxes.push_back(box);
  }
  return boxes;
}

TEST(Hatch, CutScenesAreLikeDenseOnes) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const std::vector<DenseGrid> grids = random_scene(2, random);
    std::vector<Box> boxes = random_boxes(4, random);
    const DenseCutScene expected(grids, boxes);
    Scene scene = scene_of(grids);
    if (boxes.size() == 2 && seed % 2 == 0) {  // one after the other
      scene = scene.without(std::span(boxes).first(1));
      boxes.erase(boxes.begin());
    }
    scene = scene.without(boxes);
    EXPECT_EQ(scene.all(), reference::octree(reference::DenseScene::union_of(expected.kept)));
    for (std::size_t solid = 0; solid < grids.size(); ++solid) {
      EXPECT_EQ(scene.solids()[solid], reference::octree(expected.kept[solid]));
      for (unsigned axis = 0; axis < 3; ++axis)
        for (const bool upward : {false, true}) {
          DenseGrid cut(2);
          cut.for_each([&](int x, int y, int z, bool) {
            cut.set(x, y, z, expected.is_cut(solid, {x, y, z}, axis, upward));
          });
          EXPECT_EQ(scene.cut_voxels(solid, axis, upward), reference::octree(cut)) << axis << upward;
        }
    }
  }
}

TEST(Hatch, LikeTwin) {
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 1000);
    const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
    const int depth = seed % 40 == 0 ? 3 : seed % 3 == 0 ? 1 : 2;
    const std::vector<DenseGrid> grids = random_scene(depth, random);
    const std::vector<Box> boxes = random_boxes(1 << depth, random);
    Eigen::Vector3d direction = random_direction(random);
    // Decimals are beyond the twin's numbers.
    while (View(direction).direction()[0] > 1000 || (direction - direction.array().round().matrix()).norm() > 0)
      direction = random_direction(random);
    SCOPED_TRACE("view " + show(direction));
    const View view(direction);
    HatchOptions options;
    options.faces = pick(0, 3) ? 0.3 * pick(1, 6) : 0;
    options.cuts = pick(0, 3) ? 0.25 * pick(1, 6) : 0;
    options.tone = {1, 0.5 * pick(0, 3), 0.7};
    expect_same_layers(hatch(scene_of(grids).without(boxes), view, options),
                       DenseHatch::lines(DenseCutScene(grids, boxes), view.direction(), options));
  }
}

// One face of a cube: its lines are as long together as its area says, and are drawn in one piece across the octree's
// cubes.
TEST(Hatch, LinesHaveTheLengthThatTheirDistanceSays) {
  const Scene scene({box(7, {21, 13, 7}, {71, 113, 107})});
  for (const Eigen::Vector3d& d : {Eigen::Vector3d(3, -4, 2), Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0, 3, 1),
                                   Eigen::Vector3d(1048575, 1048576, 3), Eigen::Vector3d(-0.3, 0.1, -0.77)}) {
    SCOPED_TRACE(show(d));
    const View view(d);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      HatchOptions options;
      options.faces = 1.5;
      options.tone = {0, 0, 0};
      options.tone[axis] = 1;
      const std::array<double, 3> sides = {50, 100, 100};
      const double area =
          sides[(axis + 1) % 3] * sides[(axis + 2) % 3] * std::abs(d[static_cast<int>(axis)]) / d.norm();
      double length = 0;
      std::size_t strokes = 0;
      for (const SceneLines& lines : hatch(scene, view, options)) {
        EXPECT_EQ(lines.kind, LineKind::hatch);
        strokes += lines.strokes.size();
        for (const Stroke& stroke : lines.strokes) length += (stroke.to - stroke.from).norm();
      }
      EXPECT_NEAR(length * options.faces, area, 0.03 * area + 1);
      EXPECT_LT(strokes, 1000u);
    }
  }
}

TEST(Hatch, TheSameForAllThreadsAndInALargerUniverse) {
  const Octree small = ball(6, {30.3, 34.1, 33}, 20.0);
  const Octree large = ball(8, {30.3, 34.1, 33}, 20.0);
  const View view({12, -16, 15});
  HatchOptions options;
  options.faces = 1.3;
  options.cuts = 1;
  const std::vector<Box> boxes = {{{40, 0, 0}, {64, 64, 64}}};
  const auto one = hatch(Scene({small, small}).without(boxes), view, options, Work{1, {}});
  EXPECT_EQ(one.size(), 2u);  // nothing is left for the second
  for (const auto& other : {hatch(Scene({small, small}).without(boxes), view, options, Work{2, {}}),
                            hatch(Scene({large}).without(boxes), view, options)}) {
    ASSERT_EQ(other.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      ASSERT_EQ(other[i].strokes.size(), one[i].strokes.size());
      for (std::size_t k = 0; k < one[i].strokes.size(); ++k) {
        EXPECT_EQ(other[i].strokes[k].from, one[i].strokes[k].from);
        EXPECT_EQ(other[i].strokes[k].to, one[i].strokes[k].to);
      }
    }
  }
}

TEST(Hatch, RefusesWhatCannotBeDrawn) {
  const Scene scene({ball(6, {32, 32, 32}, 20.0)});
  const View view({1, 2, 3});
  HatchOptions options;
  for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e-9}) {
    options.faces = bad;
    EXPECT_THROW(hatch(scene, view, options), Error) << bad;
  }
  options.faces = 1e12;
  EXPECT_LE(hatch(scene, view, options).size(), 1u);
  options.faces = 1;
  EXPECT_TRUE(hatch(Scene({Octree(3)}), view, options).empty());
}

}  // namespace
}  // namespace blackleaf
