// draw(): known drawings, laws, sizes that the twin cannot reach.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>

#include "blackleaf/drawing.h"
#include "blackleaf/error.h"
#include "blackleaf/implicit.h"
#include "reference/dense_grid.h"
#include "reference/placed.h"
#include "reference/stroke_difference.h"
#include "stroke_laws.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
using reference::difference;
using reference::placed;

std::vector<Stroke> shifted(std::vector<Stroke> strokes, const View& view, const Eigen::Vector3d& by,
                            double scale = 1) {
  const Eigen::Vector2d shift(view.right().dot(by), view.up().dot(by));
  for (Stroke& s : strokes) s = {scale * s.from + shift, scale * s.to + shift};
  return strokes;
}

double projected(const View& view, const Eigen::Vector3d& edge) {
  return Eigen::Vector2d(view.right().dot(edge), view.up().dot(edge)).norm();
}

// Agreed on by an exact twin and by OpenCASCADE's exact hidden-line algorithm.
TEST(Drawing, BallOfRadiusEight) {
  const Octree solid = ball(5, {16, 16, 16}, 8.0);
  EXPECT_NEAR(draw(solid, View({12, -16, 15})).length(), 453.924338, 5e-7);
}

TEST(Drawing, EmptyUniverseDrawsNothing) {
  EXPECT_TRUE(draw(Octree(1), View({1, 2, 3})).strokes.empty());
  EXPECT_TRUE(draw(Octree(20), View({0, 0, 1})).strokes.empty());
}

// A cube shows 9 edges, 7 strokes from within a coordinate plane, 4 along an axis.
TEST(Drawing, Cube) {
  for (const auto& [solid, side] :
       {std::pair{box(5, {4, 8, 12}, {12, 16, 20}), 8.0}, std::pair{box(5, {3, 7, 9}, {20, 24, 26}), 17.0},
        std::pair{Octree(1, Colour::black), 2.0}, std::pair{Octree(20, Colour::black), 1048576.0}}) {
    SCOPED_TRACE(side);
    for (const Eigen::Vector3d& d :
         {Eigen::Vector3d(12, -16, 15), Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1000, -1, 999)}) {
      const View view(d);
      const LineDrawing drawing = draw(solid, view);
      double expected = 0;
      for (int i = 0; i < 3; ++i) expected += 3 * side * projected(view, Eigen::Vector3d::Unit(i));
      EXPECT_EQ(drawing.strokes.size(), 9u);
      EXPECT_NEAR(drawing.length(), expected, 1e-9 * side);
    }
    // Along (1,1,0): the edges along z at two corners and the middle, top and bottom in the picture's two lines.
    const LineDrawing plane = draw(solid, View({1, 1, 0}));
    EXPECT_EQ(plane.strokes.size(), 5u);
    EXPECT_NEAR(plane.length(), side * (3 + 4 * std::sqrt(0.5)), 1e-9 * side);
    const LineDrawing axis = draw(solid, View({0, -1, 0}));
    EXPECT_EQ(axis.strokes.size(), 4u);
    EXPECT_NEAR(axis.length(), 4 * side, 1e-9 * side);
  }
}

// What lies behind a wall is not drawn; what stands before it is, and what it shares a plane with is not cut.
TEST(Drawing, WallHidesWhatIsBehindIt) {
  const auto solid = [](bool wall, int at) {
    return octree_from_classifier(4, [=](const Cube& c) {
      if (c.level > 0) return Colour::gray;
      const bool in_cube = c.x >= 6 && c.x < 9 && c.y >= 6 && c.y < 9 && c.z >= at && c.z < at + 2;
      return in_cube || (wall && c.z == 8) ? Colour::black : Colour::white;
    });
  };
  const View view({1, 2, 8});
  const auto wall = draw(solid(true, 8), view).strokes;  // the cube begins inside the wall and sticks out by one
  EXPECT_EQ(difference(draw(solid(true, 2), view).strokes, draw(box(4, {0, 0, 8}, {16, 16, 9}), view).strokes, 1e-12),
            "");
  EXPECT_GT(wall.size(), 9u);
  const View top({0, 0, 1});
  EXPECT_EQ(draw(solid(true, 2), top).strokes.size(), 4u);
  EXPECT_EQ(draw(solid(true, 12), top).strokes.size(), 8u);
}

// Two cubes whose faces lie in one plane along the view do not hide the line between them; glued together they do.
TEST(Drawing, RaysAlongFacesAreBlockedOnlyBetweenBlacks) {
  const auto solid = [](std::array<int, 2> tops) {
    return octree_from_classifier(3, [=](const Cube& c) {
      if (c.level > 0) return Colour::gray;
      const bool floor = c.z == 0 && c.x < 4 && c.y < 4;  // its edge x = 4 runs below the line between the others
      const bool left = c.z == tops[0] && c.x < 4 && c.y < 4, right = c.z == tops[1] && c.x >= 4 && c.y < 4;
      return floor || left || right ? Colour::black : Colour::white;
    });
  };
  const View top({0, 0, 1});
  EXPECT_EQ(draw(solid({3, 5}), top).length(), 4 * 3 + 8 * 2);
  EXPECT_EQ(draw(solid({5, 5}), top).length(), 4 * 2 + 8 * 2);
}

TEST(Drawing, SameInALargerUniverseAndElsewhere) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const DenseGrid grid = reference::random_solid(3, random);
    const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
    Eigen::Vector3d d(pick(-3, 3), pick(-3, 3), 1);
    std::shuffle(d.begin(), d.end(), random);
    const View view(d);
    const auto strokes = draw(reference::octree(grid), view).strokes;
    // Exactly the same strokes in a larger universe.
    const auto larger = draw(placed(grid, 6, 1, {0, 0, 0}), view).strokes;
    ASSERT_EQ(larger.size(), strokes.size());
    for (std::size_t i = 0; i < strokes.size(); ++i) {
      EXPECT_EQ(larger[i].from, strokes[i].from);
      EXPECT_EQ(larger[i].to, strokes[i].to);
    }
    // Moving cuts the solid into other cubes and shifts the picture.
    const std::array<std::int32_t, 3> by = {pick(0, 56), pick(0, 56), pick(0, 56)};
    const auto moved = draw(placed(grid, 6, 1, by), view).strokes;
    EXPECT_EQ(difference(moved, shifted(strokes, view, {double(by[0]), double(by[1]), double(by[2])}), 1e-10), "");
  }
}

// The largest universe and the largest directions, where the integers are largest: a solid of 8^3 blocks of side 2^17
// fills it, and its drawing is that of the 8^3 voxels, enlarged.
TEST(Drawing, LargestNumbers) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 100);
    const DenseGrid grid = reference::random_solid(3, random);
    Eigen::Vector3d d =
        seed % 4 == 0 ? Eigen::Vector3d(1048576, 1048575, 0) : Eigen::Vector3d(1048576, 1048575, 1048573);
    std::shuffle(d.begin(), d.end(), random);
    for (int i = 0; i < 3; ++i) d[i] *= random() % 2 ? 1 : -1;
    const View view(d);
    const auto small = shifted(draw(reference::octree(grid), view).strokes, view, {0, 0, 0}, 131072);
    EXPECT_EQ(difference(draw(placed(grid, 20, 131072, {0, 0, 0}), view).strokes, small, 1e-7), "");
  }
  // Single voxels in the far corner are drawn as precisely as anywhere.
  const auto corner = box(20, {1048572, 1048572, 1048572}, {1048576, 1048576, 1048576});
  const View view({1048573, 1048575, 1048576});
  const auto near = draw(box(2, {0, 0, 0}, {4, 4, 4}), view).strokes;
  EXPECT_EQ(difference(draw(corner, view).strokes, shifted(near, view, Eigen::Vector3d::Constant(1048572)), 1e-8), "");
}

// Mirroring the solid and the direction keeps every length.
TEST(Drawing, MirrorImagesAreEquallyLong) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 300);
    const DenseGrid grid = reference::random_solid(3, random);
    DenseGrid mirrored(3), turned(3);
    grid.for_each([&](int x, int y, int z, bool black) {
      mirrored.set(7 - x, y, z, black);
      turned.set(y, z, x, black);
    });
    const Eigen::Vector3d d(3, -1, 2);
    const LineDrawing drawing = draw(reference::octree(grid), View(d));
    const LineDrawing in_mirror = draw(reference::octree(mirrored), View({-d[0], d[1], d[2]}));
    const LineDrawing around = draw(reference::octree(turned), View({d[1], d[2], d[0]}));
    EXPECT_EQ(in_mirror.strokes.size(), drawing.strokes.size());
    EXPECT_EQ(around.strokes.size(), drawing.strokes.size());
    EXPECT_NEAR(in_mirror.length(), drawing.length(), 1e-9 * (1 + drawing.length()));
    EXPECT_NEAR(around.length(), drawing.length(), 1e-9 * (1 + drawing.length()));
  }
}

// No stroke of zero length, and none that continues another: ends meet only at an angle, and nothing is drawn twice.
TEST(Drawing, StrokesCannotBeJoined) {
  const Octree solid = ball(7, {60.3, 64.1, 66}, 47.0);
  for (const Eigen::Vector3d& d : {Eigen::Vector3d(12, -16, 15), Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0, 1, 2),
                                   Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0.3, 0.1, -0.7)}) {
    SCOPED_TRACE(d.transpose());
    const LineDrawing drawing = draw(solid, View(d));
    ASSERT_GT(drawing.strokes.size(), 100u);
    expect_cannot_be_joined(drawing.strokes, 1e-3);
  }
}

TEST(Drawing, ThreadsDoNotMatter) {
  const Octree solid = ball(7, {60.3, 64.1, 66}, 47.0);
  for (const Eigen::Vector3d& d : {Eigen::Vector3d(12, -16, 15), Eigen::Vector3d(0, 1, 1)}) {
    const auto one = draw(solid, View(d), Work{1, {}}).strokes;
    for (const int threads : {0, 2, 5}) {
      SCOPED_TRACE(threads);
      expect_same(draw(solid, View(d), Work{threads, {}}).strokes, one);
    }
  }
}

TEST(Drawing, ReportsProgressAndStopsWhenAsked) {
  const Octree solid = ball(6, {32, 32, 32}, 20.0);
  for (const int threads : {1, 2}) {
    double last = 0;
    draw(solid, View({1, 2, 3}), Work{threads, [&](double done) {
                                        EXPECT_GE(done, 0);
                                        EXPECT_LE(done, 1);
                                        last = std::max(last, done);
                                        return true;
                                      }});
    EXPECT_EQ(last, 1);
    std::atomic<int> calls{0};
    try {
      draw(solid, View({1, 2, 3}), Work{threads, [&](double) { return ++calls < 3; }});
      ADD_FAILURE() << "not cancelled";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
    }
  }
}

}  // namespace
}  // namespace blackleaf
