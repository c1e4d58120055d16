// Distances of moved solids and of points, against all pairs of leaves.
#include "blackleaf/distance.h"

#include <gtest/gtest.h>

#include <functional>

#include "blackleaf/contact.h"
#include "blackleaf/error.h"
#include "blackleaf/move.h"
#include "contact/box_pair.h"
#include "contact/box_tree.h"
#include "reference/box_distance.h"
#include "reference/dense_motion.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
constexpr double kDegree = M_PI / 180;

detail::BoxNode box_node(const std::array<float, 3>& centre, const std::array<float, 3>& half) {
  detail::BoxNode node;
  node.centre = centre;
  node.half = half;
  node.radius = std::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]) * 1.001F;
  return node;
}

TEST(PreparedSolid, LeavesAreTheSolid) {
  std::mt19937 random(3);
  int planes = 0;
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 5, random);
    const PreparedSolid solid(reference::octree(grid));
    ASSERT_EQ(solid.depth(), grid.depth);
    DenseGrid filled(grid.depth);
    const auto& nodes = detail::boxes(solid).nodes;
    const auto lows = [&](const detail::BoxNode& n, std::size_t i) {
      return static_cast<int>(n.centre[i] - n.half[i]);
    };
    const auto highs = [&](const detail::BoxNode& n, std::size_t i) {
      return static_cast<int>(n.centre[i] + n.half[i]);
    };
    for (const detail::BoxNode& node : nodes) {
      ASSERT_GE(double{node.radius}, detail::half_of(node).norm());
      if (node.is_leaf()) {
        for (int z = lows(node, 2); z < highs(node, 2); ++z)
          for (int y = lows(node, 1); y < highs(node, 1); ++y)
            for (int x = lows(node, 0); x < highs(node, 0); ++x) filled.set(x, y, z);
        continue;
      }
      // The tight box of the children.
      for (std::size_t i = 0; i < 3; ++i) {
        int low = 1 << 20, high = 0;
        for (std::uint32_t k = 0; k < node.count(); ++k) {
          low = std::min(low, lows(nodes[node.first() + k], i));
          high = std::max(high, highs(nodes[node.first() + k], i));
        }
        ASSERT_EQ(low, lows(node, i));
        ASSERT_EQ(high, highs(node, i));
      }
    }
    ASSERT_EQ(filled, grid);
    // No black voxel crosses a plane.
    const std::function<void(std::uint32_t, const detail::BoxNode&)> below = [&](std::uint32_t index,
                                                                                 const detail::BoxNode& above) {
      const detail::BoxNode& node = nodes[index];
      if (node.is_leaf()) {
        double most = 0;
        for (std::size_t i = 0; i < 3; ++i)
          most += double{above.normal[i]} * (double{node.centre[i]} - double{above.centre[i]}) +
                  std::abs(double{above.normal[i]}) * double{node.half[i]};
        ASSERT_LE(most, above.reach);
      }
      for (std::uint32_t k = 0; k < node.count(); ++k) below(node.first() + k, above);
    };
    for (std::uint32_t index = 0; index < nodes.size(); ++index) {
      if (!nodes[index].has_plane()) continue;
      ++planes;
      below(index, nodes[index]);
    }
  }
  EXPECT_GT(planes, 1000);
  EXPECT_EQ(detail::BoxTree(PreparedSolid(box(6, {3, 5, 7}, {60, 6, 61}))).nodes.size(), 1u);
  EXPECT_TRUE(PreparedSolid(Octree(4)).is_empty());
}

TEST(BoxPair, NearestPointsAgreeWithAllFeatures) {
  std::mt19937 random(1988);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  const auto real = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  int apart = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    SCOPED_TRACE(trial);
    const auto halves = [&](int low, int high) { return static_cast<float>(pick(low, high)) / 2; };
    const auto half = [&] { return std::array{halves(1, 16), halves(1, 16), halves(1, 16)}; };
    const auto centre = [&] { return std::array{halves(0, 20), halves(0, 20), halves(0, 20)}; };
    const detail::BoxNode a = box_node(centre(), half()), b = box_node(centre(), half());
    Motion motion = reference::random_motion(4, random);
    if (trial % 3 == 0) motion = Motion::translation({real(-20, 20), real(-20, 20), real(-20, 20)}) * motion;
    if (trial % 7 == 0)
      motion = Motion::translation({20 + std::pow(10.0, -pick(1, 12)), 0, 0}) *
               Motion::rotation({0, 0, 1}, real(-1e-7, 1e-7));
    const detail::RigidMap map{motion.rotation(), motion.translation()};
    const auto tilted = [](const detail::BoxNode& node, const reference::WideMap& to) {
      return reference::TiltedBox{to.rotation * detail::centre_of(node).cast<long double>() + to.shift,
                                  to.rotation * detail::half_of(node).cast<long double>().asDiagonal()};
    };
    const reference::TiltedBox wide_a = tilted(a, {}),
                               wide_b = tilted(b, {map.rotation.cast<long double>(), map.shift.cast<long double>()});
    const auto expected = static_cast<double>(reference::distance(wide_a, wide_b));
    const auto gap = static_cast<double>(reference::separation(wide_a, wide_b));
    const detail::NearestPoints found = detail::nearest_points(a, b, map);
    ASSERT_NEAR(found.distance, expected, 1e-10);
    // Edges that are nearly parallel are left out: of boxes that overlap, slivers of faces.
    const double separation = detail::separation(a, b, map);
    ASSERT_LE(separation, gap + 1e-12);
    if (gap <= 0) {
      ASSERT_NEAR(separation, gap, 1e-4);
    }
    ASSERT_EQ(separation > 1e-12, gap > 1e-12);
    ASSERT_NEAR((found.on_a - found.on_b).norm(), found.distance, 1e-10);
    const Eigen::Vector3d in_a = (found.on_a - detail::centre_of(a)).cwiseAbs() - detail::half_of(a),
                          in_b =
                              (map.rotation.transpose() * (found.on_b - map.shift) - detail::centre_of(b)).cwiseAbs() -
                              detail::half_of(b);
    ASSERT_LE(in_a.maxCoeff(), 1e-10);
    ASSERT_LE(in_b.maxCoeff(), 1e-10);
    apart += expected > 0;
  }
  EXPECT_GT(apart, 5000);
  EXPECT_LT(apart, 19000);
}

TEST(MovedDistance, AgreesWithAllPairsOfLeaves) {
  std::mt19937 random(256);
  std::uniform_real_distribution<double> real(-1, 1);
  int apart = 0, touching = 0, nothing = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 3;
    const Octree a = reference::octree(reference::random_solid(depth, random)),
                 b = reference::octree(reference::random_solid(depth, random));
    Motion motion = reference::random_motion(depth, random);
    if (trial % 2)
      motion = Motion::translation(Eigen::Vector3d(real(random), real(random), real(random)) * (2 << depth)) * motion;
    const auto expected = static_cast<double>(
        reference::distance(reference::cubes(a), {}, reference::cubes(b), reference::exact_map(motion)));
    const PreparedSolid p(a), q(b);
    const std::optional<MovedDistance> found = distance(p, q, motion);
    ASSERT_EQ(found.has_value(), !a.is_empty() && !b.is_empty());
    if (!found) {
      ++nothing;
      ASSERT_TRUE(farther_than(0, p, q, motion));
      continue;
    }
    ASSERT_NEAR(found->voxels, expected, 1e-9);
    ASSERT_NEAR((found->on_a - found->on_b).norm(), found->voxels, 1e-9);
    if (interferes(a, b, motion, Meaning::exact)) {
      ASSERT_EQ(found->voxels, 0);
    }
    // The points are in the solids.
    ASSERT_LE(closest(p, found->on_a)->voxels, 1e-9);
    ASSERT_LE(closest(q, motion.inverse()(found->on_b))->voxels, 1e-6);
    // Limits.
    apart += expected > 1e-9;
    touching += found->voxels == 0;
    if (expected > 1e-6) {
      ASSERT_TRUE(farther_than(expected * 0.999, p, q, motion));
      ASSERT_FALSE(distance(p, q, motion, expected * 0.999));
    }
    ASSERT_FALSE(farther_than(expected * 1.001 + 1e-6, p, q, motion));
    const auto within = distance(p, q, motion, expected * 1.001 + 1e-6);
    ASSERT_TRUE(within);
    ASSERT_EQ(within->voxels, found->voxels);
    // The other way round.
    ASSERT_NEAR(distance(q, p, motion.inverse())->voxels, expected, 1e-7);
  }
  EXPECT_GT(apart, 300);
  EXPECT_GT(touching, 300);
  EXPECT_GT(nothing, 50);
}

// Balls and shells of some thousand voxels: what planes are good for.
TEST(MovedDistance, SmoothSolidsAgreeWithAllPairsOfLeaves) {
  std::mt19937 random(512);
  std::uniform_real_distribution<double> real(-1, 1);
  const auto ball = [](const std::array<int, 3>& centre, int radius, int hollow) {
    return octree_from_classifier(5, [=](const Cube& c) {
      if (c.level > 0) return Colour::gray;
      const int x = 2 * c.x + 1 - centre[0], y = 2 * c.y + 1 - centre[1], z = 2 * c.z + 1 - centre[2];
      const int squared = x * x + y * y + 2 * z * z;
      return squared <= 4 * radius * radius && squared >= 4 * hollow * hollow ? Colour::black : Colour::white;
    });
  };
  const Octree a = ball({32, 31, 32}, 11, 0), b = ball({31, 34, 32}, 9, 6);
  const PreparedSolid p(a), q(b);
  const auto cubes_a = reference::cubes(a), cubes_b = reference::cubes(b);
  int apart = 0;
  for (int trial = 0; trial < 16; ++trial) {
    SCOPED_TRACE(trial);
    const Eigen::Vector3d way = Eigen::Vector3d(real(random), real(random), real(random)).normalized();
    const Motion motion = Motion::translation(way * (18 + 4 * real(random))) *
                          Motion::rotation(Eigen::Vector3d(real(random), real(random), 1), 3 * real(random))
                              .about(Eigen::Vector3d::Constant(16));
    const auto expected = static_cast<double>(reference::distance(cubes_a, {}, cubes_b, reference::exact_map(motion)));
    const auto found = distance(p, q, motion);
    ASSERT_TRUE(found);
    ASSERT_NEAR(found->voxels, expected, 1e-9);
    apart += expected > 0;
  }
  EXPECT_GT(apart, 4);
  EXPECT_LT(apart, 16);
}

TEST(MovedDistance, WithoutRoundingItIsTheDistanceOfOctrees) {
  std::mt19937 random(8);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  int touching = 0, apart = 0;
  for (int trial = 0; trial < 600; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 4;
    const auto small = [&] {
      const std::array<std::int32_t, 3> low = {pick(0, 12), pick(0, 12), pick(0, 12)};
      return box(depth, low, {low[0] + pick(1, 4), low[1] + pick(1, 4), low[2] + pick(1, 4)});
    };
    const Octree a = small(), b = small();
    const Motion motion = Motion::rotation(Eigen::Vector3d::Unit(trial % 3), pick(-3, 3) * 90 * kDegree)
                              .about(Eigen::Vector3d::Constant(8));
    const auto expected = distance(a, move(b, motion));
    const auto found = distance(a, b, motion);
    ASSERT_TRUE(expected && found);
    ASSERT_NEAR(found->voxels, expected->voxels, 1e-12);
    // Touching is decided exactly.
    ASSERT_EQ(found->voxels == 0, expected->squared == 0);
    touching += expected->squared == 0;
    apart += expected->squared > 0;
  }
  EXPECT_GT(touching, 30);
  EXPECT_GT(apart, 100);
}

TEST(MovedDistance, TouchingAndAHairApart) {
  const Octree a = box(4, {4, 4, 4}, {8, 8, 8}), b = a;
  const auto at = [&](double degrees, double x) {
    return distance(a, b,
                    (Motion::translation({x, 0, 0}) * Motion::rotation({0, 0, 1}, degrees * kDegree)).about({6, 6, 6}))
        ->voxels;
  };
  EXPECT_EQ(at(0, 4), 0);
  EXPECT_NEAR(at(0, 4 + 0x1p-36), 0x1p-36, 1e-13);
  EXPECT_GT(at(0, 4 + 0x1p-38), 0);
  EXPECT_EQ(at(90, 4), 0);
  EXPECT_NEAR(at(45, 5), 3 - std::sqrt(8), 1e-11);
  EXPECT_NEAR(at(45, 1e9), 1e9 - 2 - std::sqrt(8), 1e-5);  // anywhere
}

TEST(MovedDistance, ManyAtOnceAndRefusals) {
  std::mt19937 random(4);
  const PreparedSolid a(box(5, {3, 3, 3}, {9, 8, 7})), b(box(5, {20, 20, 20}, {22, 29, 24}));
  std::vector<Motion> motions;
  for (int i = 0; i < 300; ++i) motions.push_back(reference::random_motion(5, random));
  for (const int threads : {1, 2}) {
    const auto found = distances(a, b, motions, {threads, {}});
    ASSERT_EQ(found.size(), motions.size());
    for (std::size_t i = 0; i < motions.size(); ++i) EXPECT_EQ(found[i]->voxels, distance(a, b, motions[i])->voxels);
  }
  EXPECT_THROW(distance(Octree(3), Octree(4), Motion()), Error);
  EXPECT_THROW(farther_than(1, PreparedSolid(Octree(3)), PreparedSolid(Octree(4)), Motion()), Error);
}

TEST(Closest, AgreesWithAllLeaves) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> real(-1, 2);
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 4;
    const DenseGrid grid = reference::random_solid(depth, random);
    const PreparedSolid solid(reference::octree(grid));
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 20; ++i)
      points.push_back(Eigen::Vector3d(real(random), real(random), real(random)) * (1 << depth));
    points.push_back(points[0].array().floor());  // a corner of the lattice
    const auto found = closest(solid, points, {1 + trial % 2, {}});
    if (solid.is_empty()) {
      ASSERT_TRUE(found.empty());
      ASSERT_FALSE(closest(solid, points[0]));
      continue;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      double least = 1e300;
      grid.for_each([&](int x, int y, int z, bool black) {
        if (!black) return;
        const Eigen::Vector3d low(x, y, z);
        const Eigen::Vector3d nearest = points[i].cwiseMax(low).cwiseMin(low + Eigen::Vector3d::Ones());
        least = std::min(least, (nearest - points[i]).norm());
      });
      ASSERT_EQ(found[i].voxels, least);
      ASSERT_EQ((found[i].point - points[i]).norm(), least);
      ASSERT_EQ(closest(solid, points[i])->point, found[i].point);
    }
  }
}

}  // namespace
}  // namespace blackleaf
