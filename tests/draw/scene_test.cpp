// Scenes: laws, and sizes that the twin cannot reach.
#include <gtest/gtest.h>

#include <random>

#include "blackleaf/error.h"
#include "blackleaf/implicit.h"
#include "blackleaf/scene.h"
#include "blackleaf/set_operations.h"
#include "directions.h"
#include "scenes.h"
#include "stroke_laws.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;

double length(const std::vector<Stroke>& strokes) {
  double sum = 0;
  for (const Stroke& stroke : strokes) sum += (stroke.to - stroke.from).norm();
  return sum;
}

SceneOptions everything(double gap = 3) {
  SceneOptions options;
  options.hidden = options.outline = true;
  options.outline_gap = gap;
  return options;
}

void expect_equal(const std::vector<SceneLines>& a, const std::vector<SceneLines>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].solid, b[i].solid);
    EXPECT_EQ(a[i].kind, b[i].kind);
    ASSERT_EQ(a[i].strokes.size(), b[i].strokes.size());
    for (std::size_t k = 0; k < a[i].strokes.size(); ++k) {
      ASSERT_EQ(a[i].strokes[k].from, b[i].strokes[k].from);
      ASSERT_EQ(a[i].strokes[k].to, b[i].strokes[k].to);
    }
  }
}

std::vector<SceneLines> shifted(std::vector<SceneLines> lines, const View& view, const Eigen::Vector3d& by) {
  const Eigen::Vector2d shift(view.right().dot(by), view.up().dot(by));
  for (SceneLines& part : lines)
    for (Stroke& stroke : part.strokes) stroke = {stroke.from + shift, stroke.to + shift};
  return lines;
}

TEST(Scene, OfOneSolidIsItsDrawing) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const DenseGrid grid = reference::random_solid(3, random);
    const View view(random_direction(random));
    const std::vector<Stroke> alone = draw(reference::octree(grid), view).strokes;
    std::vector<Stroke> together;  // outlines and other lines, which may be one stroke cut in two
    for (const SceneLines& lines : draw(scene_of({grid}), view, everything()))
      if (lines.kind != LineKind::hidden) together.insert(together.end(), lines.strokes.begin(), lines.strokes.end());
    EXPECT_NEAR(length(together), length(alone), 1e-9 * (1 + length(alone)));
    SceneOptions options;
    options.hidden = true;
    for (const SceneLines& lines : draw(scene_of({grid}), view, options))
      if (lines.kind == LineKind::visible) {
        EXPECT_EQ(reference::difference(lines.strokes, alone, 1e-9), "");
      }
  }
}

// A drawing searches what the beams of its cubes meet, a scene the whole tree.
TEST(Scene, BeamsOfLargeSolidsLoseNothing) {
  const auto noise = [](int depth, double part) {
    return octree_from_classifier(depth, [=](const Cube& cube) {
      if (cube.level > 0) return Colour::gray;
      std::mt19937 random(static_cast<unsigned>((cube.z * 1024 + cube.y) * 1024 + cube.x));
      return std::uniform_real_distribution<double>(0, 1)(random) < part ? Colour::black : Colour::white;
    });
  };
  const std::vector<Octree> solids = {ball(7, {60.3, 65, 64}, 41.0),
                                      box(7, {3, 50, 11}, {125, 57, 120}),
                                      noise(5, 0.5),
                                      noise(6, 0.003),
                                      noise(6, 0.05),
                                      unite(ball(7, {40, 40, 40}, 33.5), complement(ball(7, {64, 64, 64}, 62.0)))};
  SceneOptions options;
  options.hidden = true;
  for (const Octree& solid : solids)
    for (const Eigen::Vector3d& d : {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(12, -16, 15), Eigen::Vector3d(-3, 0, 2),
                                     Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(-1, 0.001, 0.3)}) {
      const View view(d);
      for (const SceneLines& lines : draw(Scene({solid}), view, options))
        if (lines.kind == LineKind::visible) {
          EXPECT_EQ(reference::difference(lines.strokes, draw(solid, view).strokes, 1e-9), "") << d.transpose();
        }
    }
}

// From a direction in which no two edges of different places fall on each other, every edge is drawn once, in full.
TEST(Scene, VisibleAndHiddenLinesAreAllFeatureEdges) {
  const std::vector<Octree> solids = {ball(6, {30, 33, 31}, 24.0), box(6, {0, 20, 20}, {64, 40, 40})};
  const View view({1009, -997, 641});
  std::vector<DenseGrid> grids;
  for (const Octree& solid : solids) grids.push_back(reference::dense(solid));
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}}) {
    double expected = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
      const double seen = Eigen::Vector2d(view.right().dot(unit), view.up().dot(unit)).norm();
      for (int x = 0; x <= 64; ++x)
        for (int y = 0; y <= 64; ++y)
          for (int z = 0; z <= 64; ++z) {
            const auto is_feature = [&](const DenseGrid& grid) {
              const auto black = [&](int b, int c) {
                std::array<int, 3> at = {x, y, z};
                at[static_cast<std::size_t>((axis + 1) % 3)] -= b;
                at[static_cast<std::size_t>((axis + 2) % 3)] -= c;
                return grid.at(at[0], at[1], at[2]);
              };
              return (black(0, 0) != black(1, 0) || black(0, 1) != black(1, 1)) &&
                     (black(0, 0) != black(0, 1) || black(1, 0) != black(1, 1));
            };
            if (is_feature(grids[0]) || (count == 2 && is_feature(grids[1]))) expected += seen;
          }
    }
    double drawn = 0;
    const Scene scene(std::vector<Octree>(solids.begin(), solids.begin() + static_cast<std::ptrdiff_t>(count)));
    for (const SceneLines& lines : draw(scene, view, everything())) drawn += length(lines.strokes);
    EXPECT_NEAR(drawn, expected, 1e-9 * expected);
  }
}

TEST(Scene, SameInALargerUniverseElsewhereAndInTheMirror) {
  for (unsigned seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 100);
    const std::vector<DenseGrid> grids = random_scene(2, random);
    const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
    const std::array<int, 3> by = {pick(0, 28), pick(0, 28), pick(0, 28)};
    std::vector<DenseGrid> larger, elsewhere, mirrored;
    for (const DenseGrid& grid : grids) {
      larger.emplace_back(5), elsewhere.emplace_back(5), mirrored.emplace_back(2);
      grid.for_each([&](int x, int y, int z, bool black) {
        larger.back().set(x, y, z, black);
        elsewhere.back().set(x + by[0], y + by[1], z + by[2], black);
        mirrored.back().set(3 - x, y, z, black);
      });
    }
    const Eigen::Vector3d d(pick(-3, 3), pick(-3, 3), pick(1, 3));
    const View view(d);
    const auto lines = draw(scene_of(grids), view, everything());
    expect_equal(draw(scene_of(larger), view, everything()), lines);
    const auto there = draw(scene_of(elsewhere), view, everything());
    const auto moved = shifted(lines, view, {double(by[0]), double(by[1]), double(by[2])});
    const auto in_mirror = draw(scene_of(mirrored), View({-d[0], d[1], d[2]}), everything());
    ASSERT_EQ(there.size(), moved.size());
    ASSERT_EQ(in_mirror.size(), lines.size());
    for (std::size_t i = 0; i < moved.size(); ++i) {
      EXPECT_EQ(reference::difference(there[i].strokes, moved[i].strokes, 1e-10), "");
      EXPECT_EQ(in_mirror[i].kind, lines[i].kind);
      EXPECT_EQ(in_mirror[i].strokes.size(), lines[i].strokes.size());
      EXPECT_NEAR(length(in_mirror[i].strokes), length(lines[i].strokes), 1e-9 * (1 + length(lines[i].strokes)));
    }
  }
}

// Ends of one pen's strokes meet only at an angle.
TEST(Scene, StrokesCannotBeJoined) {
  const Octree round = ball(7, {60.3, 64.1, 66}, 47.0);
  const Scene scene({intersect(round, box(7, {0, 0, 0}, {64, 128, 128})),
                     subtract(round, box(7, {0, 0, 0}, {64, 128, 128})), box(7, {50, 10, 30}, {70, 120, 60})});
  for (const Eigen::Vector3d& d :
       {Eigen::Vector3d(12, -16, 15), Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0, 1, 2), Eigen::Vector3d(-1, 0, 0)}) {
    SCOPED_TRACE(d.transpose());
    for (const SceneLines& lines : draw(scene, View(d), everything())) expect_cannot_be_joined(lines.strokes, 1e-3);
  }
}

// What an illustrator wants of outlines: a cube's six outer edges, whatever lies far behind; none where it stands on
// another.
TEST(Scene, OutlinesOfCubes) {
  const auto outline = [](const Scene& scene, std::size_t solid, const Eigen::Vector3d& d, double gap) {
    double sum = 0;
    for (const SceneLines& lines : draw(scene, View(d), everything(gap)))
      if (lines.kind == LineKind::outline && lines.solid == solid) sum += length(lines.strokes);
    return sum;
  };
  const Octree cube = box(6, {50, 50, 20}, {60, 60, 30}), plate = box(6, {0, 0, 0}, {64, 64, 4});
  const double side = 10 * std::sqrt(2.0 / 3);  // from (1,1,1)
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(outline(Scene({cube}), 0, {1, 1, 1}, infinity), 6 * side, 1e-9);
  EXPECT_NEAR(outline(Scene({cube}), 0, {1, 1, 1}, 1), 6 * side, 1e-9);
  EXPECT_NEAR(outline(Scene({cube, plate}), 0, {1, 1, 1}, 5), 6 * side, 1e-9);
  EXPECT_LT(outline(Scene({cube, plate}), 0, {1, 1, 1}, infinity), 5 * side);
  EXPECT_NEAR(outline(Scene({cube}), 0, {0, -1, 0}, 5), 40, 1e-9);
  // On the plate, the lower edges are no outline, and the plate close behind takes some of the others.
  const Octree standing = box(6, {20, 20, 4}, {30, 30, 14});
  EXPECT_NEAR(outline(Scene({standing, plate}), 0, {0, -1, 0}, infinity), 30, 1e-9);
}

TEST(Scene, ThreadsDoNotMatter) {
  const Scene scene({ball(7, {60.3, 64.1, 66}, 47.0), ball(7, {90, 64.1, 66}, 31.0)});
  for (const Eigen::Vector3d& d : {Eigen::Vector3d(12, -16, 15), Eigen::Vector3d(0, 1, 1)}) {
    const auto one = draw(scene, View(d), everything(), Work{1, {}});
    expect_equal(draw(scene, View(d), everything(), Work{2, {}}), one);
  }
}

TEST(Scene, SolidsOfLabels) {
  std::mt19937 random(1);
  for (int depth = 1; depth <= 4; ++depth)
    for (int colours : {1, 2, 40}) {
      std::vector<blackleaf::Run> runs;
      const auto voxels = std::uint64_t{1} << (3 * depth);
      for (std::uint64_t at = 0; at < voxels;) {
        const auto count = std::min<std::uint64_t>(voxels - at, random() % 9);
        runs.push_back({count, static_cast<std::uint32_t>(random() % static_cast<unsigned>(colours + 1)) * 7});
        at += count;
      }
      const LabelMap map(runs, depth, Frame{{1, 2, 3}});
      const std::vector<LabelFacts> facts = label_facts(map);
      const std::vector<LabelledSolid> solids = solids_of_labels(map);
      ASSERT_EQ(solids.size(), facts.size());
      for (std::size_t i = 0; i < facts.size(); ++i) {
        EXPECT_EQ(solids[i].label, facts[i].label);
        EXPECT_EQ(solids[i].octree, octree_from_label(map, facts[i].label));
        EXPECT_EQ(solids[i].octree.frame(), map.frame());
      }
    }
  EXPECT_TRUE(solids_of_labels(LabelMap(3)).empty());
}

TEST(Scene, Refusals) {
  EXPECT_THROW(Scene({Octree(2), Octree(3)}), Error);
  for (const double gap : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(draw(Scene({Octree(2)}), View({1, 2, 3}), everything(gap)), Error);
  EXPECT_TRUE(draw(Scene({Octree(2), Octree(2)}), View({1, 2, 3}), everything()).empty());
}

}  // namespace
}  // namespace blackleaf
