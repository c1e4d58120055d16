#include "blackleaf/offset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "blackleaf/error.h"
#include "blackleaf/set_operations.h"
#include "motion/grow_kernels.h"
#include "octree/brick.h"
#include "reference/dense_offset.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;

// Radii whose squares are whole numbers but for rounding, or lie between; from none to larger than the universe.
double random_radius(int depth, std::mt19937& random) {
  const std::array<double, 14> special = {
      0, 0.5, 0.999999, 1, std::sqrt(2.0),  std::sqrt(3.0),    1.4142135623730949, std::nextafter(2, 0),
      2, 2.5, 3,        5, std::sqrt(17.0), 3.7416573867739413};
  switch (random() % 4) {
    case 0:
      return std::uniform_real_distribution<double>(0, 2 << depth)(random);
    case 1:
      return std::sqrt(static_cast<double>(random() % (2u << (2 * depth))));
    default:
      return special[random() % special.size()];
  }
}

TEST(Offset, AgreesWithTheDenseGrid) {
  std::mt19937 random(1992);
  for (int trial = 0; trial < 1500; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 4, random);
    const Octree octree = reference::octree(grid);
    const double radius = random_radius(grid.depth, random);
    SCOPED_TRACE(radius);
    const auto check = [&](const Octree& result, const DenseGrid& expected) {
      reference::expect_valid(result);
      ASSERT_TRUE(result == reference::octree(expected));
    };
    check(offset(octree, radius, Leaving::clip), reference::grow(grid, radius));
    check(offset(octree, -radius), reference::shrink(grid, radius));
    check(opening(octree, radius), reference::grow(reference::shrink(grid, radius), radius));
    if (radius <= 12) check(closing(octree, radius), reference::closing(grid, radius));
  }
}

// Every kernel on the same sites, against distances one by one; larger radii than the dense grids above hold.
TEST(Offset, KernelsAgree) {
  std::mt19937 random(5);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    // Far enough apart for all three widths of numbers: beyond 127 and 32767 voxels.
    const int most = std::array{8, 16, 100, 400, 40000}[static_cast<std::size_t>(trial % 5)];
    const double radius = std::uniform_real_distribution<double>(0, most)(random);
    const auto squared = static_cast<std::int64_t>(radius * radius);
    const Cube cube{512, 256, 768, pick(2, 4)};
    detail::Sites sites;
    std::vector<std::array<int, 3>> black;
    for (int n = pick(1, 6); n > 0; --n) {
      // A brick about as far away as the radius, in any direction.
      Eigen::Vector3d to(pick(-100, 100), pick(-100, 100), pick(-100, 100) + 0.5);
      to *= radius / to.norm();
      const Cube at{cube.x + static_cast<int>(to.x()) + pick(-4, 4), cube.y + static_cast<int>(to.y()) + pick(-4, 4),
                    cube.z + static_cast<int>(to.z()) + pick(-4, 4), pick(0, 3) == 0 ? 3 : 2};
      std::uint64_t bits = random() | std::uint64_t{random()} << 32;
      if (pick(0, 3) == 0) bits = ~std::uint64_t{0};
      if (at.level == 2 && bits == 0) continue;
      sites.push_back(
          {at.level == 2 ? Node::from_brick(bits) : Node::uniform(3, Colour::black), detail::VoxelBox::of(at)});
      for (int z = 0; z < at.side(); ++z)
        for (int y = 0; y < at.side(); ++y)
          for (int x = 0; x < at.side(); ++x)
            if (at.level == 3 || (bits >> detail::brick_bit(static_cast<unsigned>(x), static_cast<unsigned>(y),
                                                            static_cast<unsigned>(z)) &
                                  1))
              black.push_back({at.x + x, at.y + y, at.z + z});
    }
    const detail::Tile far = detail::FarBall(squared).grow(sites, cube);
    const detail::Tile near = squared < 17 * 17 ? detail::SmallBall(squared).grow(sites, cube) : far;
    for (int z = 0; z < cube.side(); ++z)
      for (int y = 0; y < cube.side(); ++y)
        for (int x = 0; x < cube.side(); ++x) {
          const bool expected = std::any_of(black.begin(), black.end(), [&](const std::array<int, 3>& b) {
            const std::int64_t dx = b[0] - cube.x - x, dy = b[1] - cube.y - y, dz = b[2] - cube.z - z;
            return dx * dx + dy * dy + dz * dz <= squared;
          });
          const auto of = [&](const detail::Tile& tile) {
            return (tile.rows[static_cast<std::size_t>(z)][static_cast<std::size_t>(y)] >> x & 1) != 0;
          };
          ASSERT_EQ(of(far), expected) << x << ' ' << y << ' ' << z;
          ASSERT_EQ(of(near), expected) << x << ' ' << y << ' ' << z;
        }
  }
}

TEST(Offset, ARadiusReachesWhatItReachesExactly) {
  // One voxel in the middle: the voxels of the ball, counted by hand.
  const Octree voxel = box(5, {15, 15, 15}, {16, 16, 16});
  const auto count = [&](double radius) { return volume(offset(voxel, radius)); };
  EXPECT_EQ(count(0), 1u);
  EXPECT_EQ(count(std::nextafter(1, 0)), 1u);
  EXPECT_EQ(count(1), 7u);
  EXPECT_EQ(count(1.4142135623730949), 7u);   // the double below sqrt(2)
  EXPECT_EQ(count(1.4142135623730951), 19u);  // and the one above
  EXPECT_EQ(count(1.7320508075688772), 19u);  // the doubles around sqrt(3)
  EXPECT_EQ(count(1.7320508075688774), 27u);
  EXPECT_TRUE(offset(voxel, 5).contains(15 + 3, 15 + 4, 15));
  EXPECT_FALSE(offset(voxel, std::nextafter(5, 0)).contains(15 + 3, 15 + 4, 15));
  EXPECT_TRUE(offset(voxel, 3).contains(15 + 1, 15 + 2, 15 - 2));
}

TEST(Offset, GrowsPastTheUniverseOnRequest) {
  std::mt19937 random(8);
  Frame frame;
  frame.origin = {10, 20, 30};
  frame.axes << 0, -2, 0, 2, 0, 0, 0, 0, 2;
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 3, random);
    const Octree octree = reference::octree(grid).with_frame(frame);
    const double radius = std::uniform_real_distribution<double>(0, 1 << grid.depth)(random);
    const Octree grown = offset(octree, radius, Leaving::grow);
    reference::expect_valid(grown);
    const Eigen::Vector3d corner = frame.axes.inverse() * (frame.origin - grown.frame().origin);
    const std::array<int, 3> o = {static_cast<int>(std::lround(corner.x())), static_cast<int>(std::lround(corner.y())),
                                  static_cast<int>(std::lround(corner.z()))};
    ASSERT_TRUE(grown == reference::octree(reference::grow(reference::placed(grid, grown.depth(), o), radius)));
    // And it leaves iff the box of its voxels does.
    const auto black = bounding_box(octree);
    bool leaves = false;
    for (std::size_t i = 0; black && i < 3; ++i)
      leaves = leaves || black->min[i] - std::floor(radius) < 0 || black->max[i] + std::floor(radius) > grid.side();
    if (leaves) {
      EXPECT_THROW(offset(octree, radius), Error);
      EXPECT_GT(grown.depth(), octree.depth());
    } else {
      EXPECT_TRUE(offset(octree, radius) == grown);
    }
  }
}

TEST(Offset, LeavingSaysByHowMuchAndWhere) {
  const Octree octree = box(4, {2, 3, 4}, {10, 12, 16});
  try {
    offset(octree, 3.5);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::out_of_universe);
    EXPECT_EQ(std::string(error.what()),
              "the grown solid leaves the universe: 1 voxel below x = 0, 3 voxels beyond z = 16; grow it by less, clip "
              "it (--clip) or grow the universe (--grow)");
  }
}

// Solids of many levels in universes deep enough for stretches and threads.
Octree deep_solid(int depth, std::mt19937& random) {
  const double side = 1 << depth;
  std::uniform_real_distribution<double> any(0.25 * side, 0.75 * side);
  Octree solid = ball(depth, {any(random), any(random), any(random)}, side / 5);
  solid = symmetric_difference(solid, ball(depth, {any(random), any(random), any(random)}, side / 6));
  const auto low = static_cast<int>(any(random) / 2), high = static_cast<int>(any(random));
  return unite(solid, box(depth, {low, low, high}, {high, low + 3, high + 40}));
}

TEST(Offset, Laws) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 24; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 6 + trial % 2;
    const Octree a = deep_solid(depth, random), b = unite(a, deep_solid(depth, random));
    const double r = std::uniform_real_distribution<double>(1, trial % 3 == 0 ? 40 : 7)(random);
    SCOPED_TRACE(r);
    const auto within = [](const Octree& p, const Octree& q) { return subtract(p, q).is_empty(); };
    const Octree grown = offset(a, r, Leaving::clip), shrunk = offset(a, -r), open = opening(a, r),
                 closed = closing(a, r);
    for (const Octree& result : {grown, shrunk, open, closed}) reference::expect_valid(result);
    EXPECT_TRUE(within(shrunk, open) && within(open, a) && within(a, closed) && within(closed, grown));
    EXPECT_TRUE(opening(open, r) == open);
    EXPECT_TRUE(closing(closed, r) == closed);
    EXPECT_TRUE(within(grown, offset(b, r, Leaving::clip)) && within(shrunk, offset(b, -r)));
    EXPECT_TRUE(within(open, opening(b, r)) && within(closed, closing(b, r)));
    EXPECT_TRUE(within(grown, offset(a, r + 1, Leaving::clip)) && within(offset(a, -r - 1), shrunk));
    // A ball goes on what another leaves: the sum of both radii reaches at least as far.
    EXPECT_TRUE(within(offset(offset(a, r, Leaving::clip), 2, Leaving::clip), offset(a, r + 2, Leaving::clip)));
    // Duality, away from the walls.
    const Octree room = offset(a, 2, Leaving::grow), outside = complement(room);
    EXPECT_TRUE(within(intersect(offset(outside, r, Leaving::clip), offset(room, -r)), Octree(room.depth())));
    // Of a union: the union of the grown parts.
    EXPECT_TRUE(offset(b, r, Leaving::clip) == unite(grown, offset(subtract(b, a), r, Leaving::clip)));
    // The same for any number of threads.
    EXPECT_TRUE(offset(a, r, Leaving::clip, {.threads = 1, .progress = {}}) == grown);
    EXPECT_TRUE(offset(a, -r, Leaving::clip, {.threads = 3, .progress = {}}) == shrunk);
  }
}

TEST(Offset, DoesNotDependOnWhereTheSolidLies) {
  std::mt19937 random(9);
  for (int trial = 0; trial < 12; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(4, random);
    const auto pick = [&] { return std::uniform_int_distribution<int>(0, 23)(random); };
    const Octree octree = reference::octree(reference::placed(grid, 7, {48, 48, 48}));
    const std::array<std::int64_t, 3> by = {pick() - 12, pick() - 12, pick() - 12};
    const double r = std::uniform_real_distribution<double>(1, 24)(random);
    SCOPED_TRACE(r);
    EXPECT_TRUE(offset(translate(octree, by), r) == translate(offset(octree, r), by));
    EXPECT_TRUE(offset(translate(octree, by), -r) == translate(offset(octree, -r), by));
    EXPECT_TRUE(opening(translate(octree, by), r) == translate(opening(octree, r), by));
    EXPECT_TRUE(closing(translate(octree, by), r) == translate(closing(octree, r), by));
  }
}

TEST(Offset, OfABallIsNearlyTheLargerBall) {
  // Voxels whose centre is within R - 1 of the middle come from the ball of radius R - r grown by r, and all of those
  // lie within R: a check of large radii that no dense grid holds.
  for (const double r : {100.0, 140.0, 250.5}) {
    const Eigen::Vector3d middle(512, 512, 512);
    const Octree grown = offset(ball(10, middle, 50), r);
    reference::expect_valid(grown);
    EXPECT_TRUE(subtract(grown, ball(10, middle, 50 + r)).is_empty());
    EXPECT_TRUE(subtract(ball(10, middle, 50 + r - 1), grown).is_empty());
    EXPECT_TRUE(subtract(ball(10, middle, 49), offset(grown, -r)).is_empty());
  }
}

TEST(Offset, HugeAndTrivialRadii) {
  const Octree empty(4), full(4, Colour::black), solid = box(4, {3, 3, 3}, {9, 9, 9});
  constexpr double kHuge = 1e300;
  for (const double r : {0.0, 0.3, 2.0, 100.0, kHuge}) {
    SCOPED_TRACE(r);
    EXPECT_TRUE(offset(empty, r) == empty);
    EXPECT_TRUE(offset(empty, -r) == empty);
    EXPECT_TRUE(closing(empty, r) == empty);
    EXPECT_TRUE(opening(empty, r) == empty);
    EXPECT_TRUE(offset(full, r, Leaving::clip) == full);
  }
  EXPECT_TRUE(offset(solid, kHuge, Leaving::clip) == full);
  EXPECT_TRUE(offset(solid, -kHuge).is_empty());
  EXPECT_TRUE(offset(full, -3) == box(4, {3, 3, 3}, {13, 13, 13}));
  EXPECT_TRUE(offset(full, -8).is_empty());
  EXPECT_TRUE(closing(full, 5) == full);
  EXPECT_THROW(offset(solid, kHuge, Leaving::grow), Error);
  EXPECT_THROW(closing(solid, kHuge), Error);
  EXPECT_THROW(offset(solid, std::numeric_limits<double>::quiet_NaN()), Error);
  EXPECT_THROW(offset(solid, -std::numeric_limits<double>::infinity()), Error);
  EXPECT_THROW(opening(solid, -1), Error);
  EXPECT_THROW(closing(solid, -1), Error);
}

TEST(Offset, CanBeInterrupted) {
  const Octree solid = ball(7, {60, 60, 60}, 40);
  const Work work{.threads = 1, .progress = [](double done) { return done < 0.3; }};
  EXPECT_THROW(offset(solid, 3, Leaving::error, work), Error);
  EXPECT_THROW(offset(solid, -3, Leaving::error, work), Error);
  EXPECT_THROW(opening(solid, 3, work), Error);
  EXPECT_THROW(closing(solid, 3, work), Error);
}

}  // namespace
}  // namespace blackleaf
