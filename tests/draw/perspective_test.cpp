// draw() in perspective: known drawings, laws, sizes that the twin cannot reach, refusals.
#include "blackleaf/perspective.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <random>

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

constexpr double kDegree = std::numbers::pi / 180;

ErrorCode refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "accepted";
  return ErrorCode::cancelled;
}

TEST(Perspective, KeepsPointsOnItsGrid) {
  const Perspective p({300.5, -200.25, 150 + 1.0 / 65536}, {128.5, 128, 100});
  EXPECT_EQ(p.eye(), (std::array<std::int64_t, 3>{300 * 65536 + 32768, -200 * 65536 - 16384, 150 * 65536 + 1}));
  EXPECT_DOUBLE_EQ(p.distance(), Eigen::Vector3d(172, -328.25, 50 + 1.0 / 65536).norm());
  // Directions that are multiples of small whole numbers are kept exactly, whatever the points are.
  EXPECT_EQ(Perspective({84.75, -30, 20.5}, {0.25, 16, 16.5}).view().direction(),
            (std::array<std::int64_t, 3>{169, -92, 8}));
  EXPECT_EQ(Perspective({0.1, 0, 0}, {0, 0, 0}).eye()[0], 6554);
  // The picture tells from where it is seen.
  const std::optional<EyePoint>& point = p.view().eye_point();
  ASSERT_TRUE(point);
  EXPECT_EQ(point->eye, Eigen::Vector3d(300.5, -200.25, 150 + 1.0 / 65536));
  EXPECT_EQ(point->target, Eigen::Vector3d(128.5, 128, 100));
  EXPECT_FALSE(View({1, 2, 3}).eye_point());
}

TEST(Perspective, FieldOfViewIsAPyramid) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-100, 100);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    const double angle = (1 + (i * 169) % 170) * kDegree;
    const Perspective p({any(random), any(random), any(random)}, {any(random), any(random), any(random)}, angle);
    const auto& d = p.view().direction();
    const Eigen::Vector3d ahead = -Eigen::Vector3d(double(d[0]), double(d[1]), double(d[2])).normalized();
    const std::array<Eigen::Vector3d, 4> outward = {-p.view().right(), p.view().right(), -p.view().up(), p.view().up()};
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector3d n(double(p.sides()[k][0]), double(p.sides()[k][1]), double(p.sides()[k][2]));
      EXPECT_EQ(n.cwiseAbs().maxCoeff(), 1 << 30);
      // The rim of the view on this side is at half the angle from the line of sight.
      EXPECT_LT(std::abs(n.normalized().dot(std::cos(angle / 2) * ahead + std::sin(angle / 2) * outward[k])), 2e-9);
      EXPECT_GT(n.dot(ahead), 0);
    }
  }
}

TEST(Perspective, Refuses) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d good(40, 50, 60), origin(0, 0, 0);
  for (const Eigen::Vector3d& bad : {Eigen::Vector3d(infinity, 0, 0), Eigen::Vector3d(0, nan, 0),
                                     Eigen::Vector3d(0, 0, -16777217), Eigen::Vector3d(1e300, 0, 0)}) {
    EXPECT_EQ(refusal([&] { Perspective(bad, origin); }), ErrorCode::bad_argument);
    EXPECT_EQ(refusal([&] { Perspective(origin, bad); }), ErrorCode::bad_argument);
  }
  EXPECT_EQ(refusal([&] { Perspective(good, good); }), ErrorCode::bad_argument);
  EXPECT_EQ(refusal([&] { Perspective(origin, {1e-6, 0, -1e-6}); }), ErrorCode::bad_argument);
  for (const double angle : {0.0, -1.0, 0.9 * kDegree, 171 * kDegree, nan, infinity})
    EXPECT_EQ(refusal([&] { Perspective(good, origin, angle); }), ErrorCode::bad_argument);
  EXPECT_NO_THROW(Perspective({-16777216, 16777216, 0}, origin, 170 * kDegree));
  EXPECT_NO_THROW(Perspective(good, origin, 1 * kDegree));
}

TEST(Perspective, RefusesAnEyeInOrOnTheSolid) {
  const Octree solid = box(4, {4, 4, 4}, {8, 12, 16});
  for (const Eigen::Vector3d& eye : {Eigen::Vector3d(6, 6.5, 7), Eigen::Vector3d(4, 6.5, 7), Eigen::Vector3d(8, 12, 16),
                                     Eigen::Vector3d(5, 5, 16), Eigen::Vector3d(4 - 1e-6, 6, 6)})
    EXPECT_EQ(refusal([&] { draw(solid, Perspective(eye, {100, 100, 90})); }), ErrorCode::bad_argument);
  for (const Eigen::Vector3d& eye : {Eigen::Vector3d(4 - 1e-4, 6.5, 7), Eigen::Vector3d(8, 12, 16.5),
                                     Eigen::Vector3d(20, 5, 5), Eigen::Vector3d(-1, 4, 4)})
    EXPECT_NO_THROW(draw(solid, Perspective(eye, {6, 8, 10})));
  EXPECT_EQ(refusal([&] {
              draw(Octree(20, Colour::black), Perspective({5, 5, 5}, {0, 0, 0}));
            }),
            ErrorCode::bad_argument);
}

TEST(Perspective, EmptyUniverseDrawsNothing) {
  EXPECT_TRUE(draw(Octree(1), Perspective({1, 1, 1}, {0, 0, 0})).strokes.empty());
  EXPECT_TRUE(draw(Octree(20), Perspective({-5, 8, 1}, {0, 0, 0})).strokes.empty());
}

// The target's plane has its true size; what is behind it is smaller and hidden here, what is before it larger.
TEST(Perspective, CubeFromTheFront) {
  const Octree solid = box(4, {4, 4, 4}, {12, 12, 12});
  const auto square = [](double half) {
    const std::array<Eigen::Vector2d, 4> c = {Eigen::Vector2d(-half, -half), Eigen::Vector2d(half, -half),
                                              Eigen::Vector2d(half, half), Eigen::Vector2d(-half, half)};
    return std::vector<Stroke>{{c[0], c[1]}, {c[1], c[2]}, {c[2], c[3]}, {c[3], c[0]}};
  };
  EXPECT_EQ(difference(draw(solid, Perspective({8, -8, 8}, {8, 4, 8})).strokes, square(4), 1e-12), "");
  // At 16 of 20 voxels.
  EXPECT_EQ(difference(draw(solid, Perspective({8, -12, 8}, {8, 8, 8})).strokes, square(5), 1e-12), "");
  EXPECT_EQ(difference(draw(solid, Perspective({8, 8, 32}, {8, 8, 8})).strokes, square(4 * 24 / 20.0), 1e-12), "");
}

// A cube shows nine edges to an eye that sees three faces, seven if it sees two, four if it sees one.
TEST(Perspective, CubeShowsItsEdges) {
  for (const auto& [solid, low, side] : {std::tuple{box(5, {4, 8, 12}, {12, 16, 20}), Eigen::Vector3d(4, 8, 12), 8.0},
                                         std::tuple{box(5, {3, 7, 9}, {20, 24, 26}), Eigen::Vector3d(3, 7, 9), 17.0},
                                         std::tuple{Octree(1, Colour::black), Eigen::Vector3d(0, 0, 0), 2.0},
                                         std::tuple{Octree(20, Colour::black), Eigen::Vector3d(0, 0, 0), 1048576.0}}) {
    SCOPED_TRACE(side);
    const Eigen::Vector3d centre = low + Eigen::Vector3d::Constant(side / 2);
    const auto strokes = [&, solid = solid](double x, double y, double z) {
      return draw(solid, Perspective(centre + side * Eigen::Vector3d(x, y, z), centre)).strokes.size();
    };
    EXPECT_EQ(strokes(1.5, -1, 2), 9u);
    EXPECT_EQ(strokes(-0.75, -0.75, -0.75), 9u);
    EXPECT_EQ(strokes(1.5, -1, 0.25), 7u);
    EXPECT_EQ(strokes(0.5, 3, 2), 6u);  // in the plane of a face: two of its edges fall together into one stroke
    EXPECT_EQ(strokes(0.25, -1, 0.125), 4u);
    EXPECT_EQ(strokes(0.5, 0.5, 2), 4u);  // in one line with an edge
  }
}

// From inside a hollow cube all twelve edges of the hollow are seen, as far as the field of view reaches.
TEST(Perspective, Hollow) {
  DenseGrid grid(4);
  grid.for_each([&](int x, int y, int z, bool) {
    const auto in = [](int i) { return i >= 4 && i < 12; };
    grid.set(x, y, z, !(in(x) && in(y) && in(z)));
  });
  const Octree solid = reference::octree(grid);
  const Eigen::Vector3d middle(8, 8, 8);
  // The far square at 4 voxels, true size; with 120 degrees the window reaches to 4 sqrt(3) where the edges that come
  // nearer leave it: they run on the picture's diagonals.
  const double reach = 4 * std::sqrt(3.0);
  EXPECT_NEAR(draw(solid, Perspective(middle, {8, 12, 8})).length(), 4 * 8 + 4 * (reach - 4) * std::sqrt(2.0), 1e-7);
  EXPECT_EQ(draw(solid, Perspective(middle, {8, 12, 8})).strokes.size(), 8u);
  EXPECT_EQ(draw(solid, Perspective(middle, {8, 12, 8}, 90 * kDegree)).strokes.size(), 4u);
  EXPECT_EQ(draw(solid, Perspective(middle, {8, 12, 8}, 89 * kDegree)).strokes.size(), 0u);
}

// What lies behind the eye is not drawn, and an eye among parts of the solid sees what is before it.
TEST(Perspective, NothingBehindTheEye) {
  DenseGrid grid(4);
  grid.for_each([&](int x, int y, int z, bool) { grid.set(x, y, z, (x < 3 || x >= 12) && y >= 3 && y < 9 && z < 5); });
  const Octree both = reference::octree(grid), right = box(4, {12, 3, 0}, {16, 9, 5});
  const Perspective p({7.3, 6.2, 2.7}, {14, 6, 2.5});
  EXPECT_GT(draw(right, p).strokes.size(), 3u);
  expect_same(draw(both, p).strokes, draw(right, p).strokes);
}

TEST(Perspective, SameInALargerUniverseAndElsewhere) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const DenseGrid grid = reference::random_solid(3, random);
    const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
    const Eigen::Vector3d eye(pick(-16, 40) / 2.0, pick(-16, 40) / 2.0, pick(18, 40) / 2.0), target(4, 3.5, 4.25);
    const auto strokes = draw(reference::octree(grid), Perspective(eye, target)).strokes;
    expect_same(draw(placed(grid, 6, 1, {0, 0, 0}), Perspective(eye, target)).strokes, strokes);
    const std::array<std::int32_t, 3> by = {pick(0, 56), pick(0, 56), pick(0, 56)};
    const Eigen::Vector3d shift(by[0], by[1], by[2]);
    expect_same(draw(placed(grid, 6, 1, by), Perspective(eye + shift, target + shift)).strokes, strokes);
  }
}

// The largest universe and the farthest eyes, where the numbers are largest: a solid of 8^3 blocks of side 2^17.
TEST(Perspective, LargestNumbers) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 100);
    const DenseGrid grid = reference::random_solid(3, random);
    const auto pick = [&](double reach) {
      return std::ldexp(std::round(std::ldexp(std::uniform_real_distribution<double>(-reach, reach)(random), 16)), -16);
    };
    // Eyes on the grid in both universes; every other one as far away as can be.
    Eigen::Vector3d eye(pick(20), pick(20), 8 + std::abs(pick(20)));
    if (seed % 2) eye = Eigen::Vector3d(127.75, -127.5, 128) + Eigen::Vector3d(pick(0.25), pick(0.25), 0);
    const Eigen::Vector3d target(4, 4.5, 3.25);
    auto strokes = draw(reference::octree(grid), Perspective(eye, target)).strokes;
    for (Stroke& s : strokes) s = {131072 * s.from, 131072 * s.to};
    const auto large = draw(placed(grid, 20, 131072, {0, 0, 0}), Perspective(131072 * eye, 131072 * target)).strokes;
    EXPECT_EQ(difference(large, strokes, 1e-5), "");
  }
}

// The mirror image of the solid, seen by the mirrored eye, is the mirrored drawing.
TEST(Perspective, MirrorImages) {
  for (unsigned seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 300);
    const DenseGrid grid = reference::random_solid(3, random);
    DenseGrid mirrored(3), turned(3);
    grid.for_each([&](int x, int y, int z, bool black) {
      mirrored.set(7 - x, y, z, black);
      turned.set(7 - y, x, z, black);
    });
    const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random) / 4.0; };
    const Eigen::Vector3d eye(pick(-60, 90), pick(-60, 90), pick(36, 90)),
        target(pick(0, 32), pick(0, 32), pick(0, 32));
    const auto strokes = draw(reference::octree(grid), Perspective(eye, target)).strokes;
    auto in_mirror = draw(reference::octree(mirrored),
                          Perspective({8 - eye[0], eye[1], eye[2]}, {8 - target[0], target[1], target[2]}))
                         .strokes;
    if (eye[0] != target[0] || eye[1] != target[1]) {  // straight down, up is +y and the quarter turn turns the picture
      for (Stroke& s : in_mirror) s.from[0] = -s.from[0], s.to[0] = -s.to[0];
      EXPECT_EQ(difference(in_mirror, strokes, 1e-9), "");
      const auto around = draw(reference::octree(turned),
                               Perspective({8 - eye[1], eye[0], eye[2]}, {8 - target[1], target[0], target[2]}));
      EXPECT_EQ(difference(around.strokes, strokes, 1e-9), "");
    }
  }
}

// From farther and farther away the drawing becomes the parallel one. A point within r of the target is drawn within
// r^2 / (D - r) of its place there, so a stroke of the same edges differs by twice that in length and, ends of strokes
// being crossings of lines that meet at an angle, by a fixed multiple of it at its ends.
TEST(Perspective, FarEyesDrawAsParallelProjection) {
  const std::array<Eigen::Vector3d, 3> directions = {Eigen::Vector3d(1048573, -700001, 900007),
                                                     Eigen::Vector3d(-500009, 1048571, 300007),
                                                     Eigen::Vector3d(-800011, -600101, -1048361)};
  const Eigen::Vector3d target(4, 4, 4);
  const double r = std::sqrt(48.0);
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 700);
    const Octree solid = reference::octree(reference::random_solid(3, random));
    const Eigen::Vector3d& d = directions[seed % 3];
    const View view(d);
    LineDrawing parallel = draw(solid, view);
    const Eigen::Vector2d at(view.right().dot(target), view.up().dot(target));
    for (Stroke& s : parallel.strokes) s = {s.from - at, s.to - at};
    for (const double times : {1.0, 12.0}) {
      const LineDrawing drawing = draw(solid, Perspective(target + times * d, target));
      const double displaced = r * r / (times * d.norm() - r);
      EXPECT_EQ(difference(drawing.strokes, parallel.strokes, 8 * displaced), "");
      EXPECT_LE(std::abs(drawing.length() - parallel.length()), 16 * displaced * double(parallel.strokes.size()));
    }
  }
}

// No stroke of zero length, and none that continues another: ends meet only at an angle, and nothing is drawn twice.
TEST(Perspective, StrokesCannotBeJoined) {
  const Octree solid = ball(7, {60.3, 64.1, 66}, 47.0);
  for (const Eigen::Vector3d& eye : {Eigen::Vector3d(400, -300, 200), Eigen::Vector3d(200, 64, 64),
                                     Eigen::Vector3d(2, 70.5, 20), Eigen::Vector3d(-40, -40, 168)}) {
    SCOPED_TRACE(eye.transpose());
    const LineDrawing drawing = draw(solid, Perspective(eye, {64, 64, 64}));
    ASSERT_GT(drawing.strokes.size(), 100u);
    expect_cannot_be_joined(drawing.strokes, 1e-4);
  }
}

TEST(Perspective, ThreadsDoNotMatter) {
  const Octree solid = ball(7, {60.3, 64.1, 66}, 47.0);
  for (const Eigen::Vector3d& eye : {Eigen::Vector3d(300, -211.3, 200.7), Eigen::Vector3d(200, 64, 64)}) {
    const Perspective p(eye, {64, 64, 64});
    const auto one = draw(solid, p, Work{1, {}}).strokes;
    for (const int threads : {0, 2, 5}) expect_same(draw(solid, p, Work{threads, {}}).strokes, one);
  }
}

TEST(Perspective, ReportsProgressAndStopsWhenAsked) {
  const Octree solid = ball(6, {32, 32, 32}, 20.0);
  const Perspective p({100, 120, 130}, {32, 32, 32});
  for (const int threads : {1, 2}) {
    double last = 0;
    draw(solid, p, Work{threads, [&](double done) {
                          EXPECT_GE(done, 0);
                          EXPECT_LE(done, 1);
                          last = std::max(last, done);
                          return true;
                        }});
    EXPECT_EQ(last, 1);
    std::atomic<int> calls{0};
    EXPECT_EQ(refusal([&] {
                draw(solid, p, Work{threads, [&](double) { return ++calls < 3; }});
              }),
              ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace blackleaf
