#include "blackleaf/lattice.h"

#include <gtest/gtest.h>

#include <set>

#include "blackleaf/error.h"
#include "motion/lattice_labels.h"
#include "motion/move_general.h"
#include "reference/dense_motion.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;

// Every voxel by itself: X' = S (X - C) + C on twice the centres.
DenseGrid transformed(const DenseGrid& grid, const LatticeSymmetry& symmetry) {
  DenseGrid result(grid.depth);
  const int n = grid.side();
  grid.for_each([&](int x, int y, int z, bool black) {
    const Eigen::Vector3d centre = Eigen::Vector3d(2 * x + 1 - n, 2 * y + 1 - n, 2 * z + 1 - n);
    const Eigen::Vector3d image = symmetry.matrix() * centre;
    const auto at = [&](int i) { return (static_cast<int>(image[i]) + n - 1) / 2; };
    result.set(at(0), at(1), at(2), black);
  });
  return result;
}

TEST(LatticeSymmetry, TheGroupOfTheCube) {
  const auto& all = LatticeSymmetry::all();
  EXPECT_TRUE(all[0] == LatticeSymmetry());
  int reflections = 0;
  for (const LatticeSymmetry& a : all) {
    EXPECT_EQ(a.matrix().determinant(), a.is_reflection() ? -1 : 1);
    reflections += a.is_reflection() ? 1 : 0;
    EXPECT_TRUE(a * a.inverse() == LatticeSymmetry());
    EXPECT_TRUE(LatticeSymmetry::from(a.matrix()) == a);
    int same = 0;
    for (const LatticeSymmetry& b : all) {
      EXPECT_EQ((a * b).matrix(), a.matrix() * b.matrix());
      same += a == b ? 1 : 0;
      for (unsigned octant = 0; octant < 8; ++octant) EXPECT_EQ((a * b).octant(octant), a.octant(b.octant(octant)));
    }
    EXPECT_EQ(same, 1);
  }
  EXPECT_EQ(reflections, 24);
}

TEST(LatticeSymmetry, TurnsAreRightHandedQuarters) {
  for (int axis = 0; axis < 3; ++axis)
    for (int quarters = -9; quarters <= 9; ++quarters)
      EXPECT_EQ(LatticeSymmetry::turn(axis, quarters).matrix(),
                Motion::rotation_degrees(Eigen::Vector3d::Unit(axis), 90.0 * quarters).rotation());
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d diagonal = Eigen::Vector3d::Ones();
    diagonal[axis] = -1;
    EXPECT_EQ(LatticeSymmetry::reflection(axis).matrix(), Eigen::Matrix3d(diagonal.asDiagonal()));
  }
}

TEST(LatticeSymmetry, OtherMatricesAreNone) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m(0, 0) = 1 - 1e-16;
  EXPECT_FALSE(LatticeSymmetry::from(m));
  m << 1, 0, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_FALSE(LatticeSymmetry::from(m));
  m << 1, 1, 0, 0, 1, 0, 0, 0, 1;
  EXPECT_FALSE(LatticeSymmetry::from(m));
  EXPECT_FALSE(LatticeSymmetry::from(Eigen::Matrix3d::Zero()));
}

TEST(LatticeLabels, BricksByExchangesAreBricksByVoxels) {
  std::mt19937_64 random(48);
  for (const LatticeSymmetry& symmetry : LatticeSymmetry::all()) {
    const detail::LatticeLabels labels(symmetry);
    for (int trial = 0; trial < 20; ++trial) {
      const std::uint64_t bits = trial == 0 ? ~std::uint64_t{0} : random();
      std::uint64_t expected = 0;
      for (unsigned bit = 0; bit < 64; ++bit)
        expected |= (bits >> bit & 1) << (8 * symmetry.octant(bit >> 3) + symmetry.octant(bit & 7));
      EXPECT_EQ(labels.brick(bits), expected);
    }
  }
}

TEST(Transform, AllSymmetriesAgreeWithTheDenseGridAndWithTheLookUp) {
  std::mt19937 random(4848);
  for (int trial = 0; trial < 12; ++trial) {
    const int depth = 1 + trial % 6;
    const DenseGrid grid = reference::random_solid(depth, random);
    const Octree octree = reference::octree(grid);
    const Eigen::Vector3d centre = Eigen::Vector3d::Constant(octree.side() / 2.0);
    for (const LatticeSymmetry& symmetry : LatticeSymmetry::all()) {
      SCOPED_TRACE(testing::Message() << "trial " << trial << "\n" << symmetry.matrix());
      const Octree result = transform(octree, symmetry);
      reference::expect_valid(result);
      ASSERT_TRUE(result == reference::octree(transformed(grid, symmetry)));
      ASSERT_TRUE(transform(result, symmetry.inverse()) == octree);
      ASSERT_TRUE(transform(octree, symmetry, centre) == result);
      if (symmetry.is_reflection()) continue;
      const Motion motion = Motion(symmetry.matrix(), {0, 0, 0}).about(centre);
      ASSERT_TRUE(move(octree, motion) == result);
      ASSERT_TRUE(detail::move_by_look_up(octree, motion) == result);
    }
  }
}

TEST(Transform, IsAGroupActionOnAnyNumberOfThreads) {
  std::mt19937 random(5);
  const Octree octree = reference::octree(reference::random_solid(7, random));
  for (int trial = 0; trial < 40; ++trial) {
    const LatticeSymmetry a = LatticeSymmetry::all()[random() % 48], b = LatticeSymmetry::all()[random() % 48];
    const Octree both = transform(octree, a * b, {.threads = 1, .progress = {}});
    EXPECT_TRUE(both ==
                transform(transform(octree, b, {.threads = 2, .progress = {}}), a, {.threads = 7, .progress = {}}));
  }
  EXPECT_TRUE(turn(turn(octree, 1), 1, 3) == octree);
  EXPECT_TRUE(reflect(reflect(octree, 2), 2) == octree);
}

TEST(Transform, AboutOtherPoints) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 5;
    const Octree octree = reference::octree(reference::random_solid(depth, random));
    const LatticeSymmetry symmetry = LatticeSymmetry::all()[random() % 48];
    // Corners and centres of voxels, in the universe and out of it.
    std::uniform_int_distribution<int> any(-2, (1 << depth) + 2);
    const Eigen::Vector3d about =
        Eigen::Vector3d(any(random), any(random), any(random)).array() + (random() % 2 != 0 ? 0.5 : 0.0);
    const Octree clipped = transform(octree, symmetry, about, Leaving::clip);
    reference::expect_valid(clipped);
    for (int i = 0; i < 300; ++i) {
      std::uniform_int_distribution<int> inside(0, (1 << depth) - 1);
      const Eigen::Vector3d x = Eigen::Vector3d(inside(random), inside(random), inside(random)).array() + 0.5;
      const Eigen::Vector3d from = symmetry.inverse().matrix() * (x - about) + about;
      const auto floor = [](double value) { return static_cast<std::int64_t>(std::floor(value)); };
      ASSERT_EQ(clipped.contains(floor(x.x()), floor(x.y()), floor(x.z())),
                octree.contains(floor(from.x()), floor(from.y()), floor(from.z())));
    }
    if (!symmetry.is_reflection()) {
      ASSERT_TRUE(clipped ==
                  detail::move_by_look_up(octree, Motion(symmetry.matrix(), {0, 0, 0}).about(about), Leaving::clip));
    }
    EXPECT_EQ(volume(transform(octree, symmetry, about, Leaving::grow)), volume(octree));
  }
}

TEST(Transform, RefusesPointsThatDoNotKeepVoxels) {
  const Octree octree = box(4, {1, 2, 3}, {5, 9, 4});
  EXPECT_THROW(transform(octree, LatticeSymmetry::turn(2, 1), {0.5, 0, 0}), Error);
  EXPECT_THROW(transform(octree, LatticeSymmetry::reflection(0), {0.25, 0, 0}), Error);
  EXPECT_THROW(transform(octree, LatticeSymmetry::reflection(0), {std::nan(""), 0, 0}), Error);
  EXPECT_TRUE(transform(octree, LatticeSymmetry::reflection(0), {8.5, 0.25, 1e300}) ==
              translate(reflect(octree, 0), {1, 0, 0}));
  EXPECT_THROW(transform(octree, LatticeSymmetry::reflection(0), {1e300, 0, 0}), Error);
  EXPECT_TRUE(transform(octree, LatticeSymmetry::reflection(0), {1e300, 0, 0}, Leaving::clip).is_empty());
}

TEST(Move, ByLatticeMovesIsMoveByLookUp) {
  // Fractions of a voxel too: short of, beyond and in the middle between whole shifts.
  std::mt19937 random(90);
  for (int trial = 0; trial < 1000; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 5;
    const Octree octree = reference::octree(reference::random_solid(depth, random));
    std::uniform_int_distribution<int> any(-(1 << depth), 1 << depth);
    const std::array<double, 8> parts = {0, 0, 0.25, 0.5, -0.5, 0.4999999, 0.5 - 0x1p-38, 0x1p-39};
    const auto shift = [&] { return any(random) / 2 + parts[random() % parts.size()]; };
    LatticeSymmetry symmetry = LatticeSymmetry::all()[random() % 48];
    if (symmetry.is_reflection()) symmetry = symmetry * LatticeSymmetry::reflection(0);
    const Motion motion = Motion::translation({shift(), shift(), shift()}) *
                          Motion(symmetry.matrix(), {0, 0, 0}).about(Eigen::Vector3d::Constant(octree.side() / 2.0));
    EXPECT_TRUE(move(octree, motion, Leaving::clip) == detail::move_by_look_up(octree, motion, Leaving::clip));
    if (!octree.is_empty()) {
      const Octree grown = move(octree, motion, Leaving::grow);
      EXPECT_TRUE(grown == detail::move_by_look_up(octree, motion, Leaving::grow));
      EXPECT_EQ(grown.frame(), detail::move_by_look_up(octree, motion, Leaving::grow).frame());
    }
  }
}

TEST(Transform, DepthTwenty) {
  const Octree octree = box(20, {3, 5, 7}, {7000, 300, 20});
  const Octree turned = turn(octree, 2);
  EXPECT_EQ(*bounding_box(turned), (Box{{(1 << 20) - 300, 3, 7}, {(1 << 20) - 5, 7000, 20}}));
  EXPECT_EQ(*bounding_box(reflect(octree, 0)), (Box{{(1 << 20) - 7000, 5, 7}, {(1 << 20) - 3, 300, 20}}));
  EXPECT_TRUE(turn(turned, 2, -1) == octree);
}

}  // namespace
}  // namespace blackleaf
