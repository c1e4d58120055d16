#include "blackleaf/contact.h"

#include <gtest/gtest.h>

#include "blackleaf/error.h"
#include "blackleaf/move.h"
#include "reference/dense_motion.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
constexpr double kDegree = M_PI / 180;

TEST(Interference, AgreesWithTheDenseGrid) {
  std::mt19937 random(1984);
  int hits = 0;
  for (int trial = 0; trial < 800; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 5;
    const DenseGrid a = reference::random_solid(depth, random), b = reference::random_solid(depth, random);
    std::uint64_t common = 0;
    a.for_each([&](int x, int y, int z, bool black) { common += black && b.at(x, y, z); });
    const Octree p = reference::octree(a), q = reference::octree(b);
    ASSERT_EQ(overlap_volume(p, q), common);
    ASSERT_EQ(interferes(p, q), common > 0);
    ASSERT_EQ(interferes(q, p), common > 0);
    hits += common > 0;
  }
  EXPECT_GT(hits, 100);
  EXPECT_LT(hits, 790);
  EXPECT_THROW(interferes(Octree(3), Octree(4)), Error);
  EXPECT_THROW(overlap_volume(Octree(3), Octree(4)), Error);
  EXPECT_THROW(distance(Octree(3), Octree(4)), Error);
}

TEST(Distance, AgreesWithTheDenseGrid) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 3;
    const DenseGrid a = reference::random_solid(depth, random), b = reference::random_solid(depth, random);
    std::int64_t best = -1;
    a.for_each([&](int x, int y, int z, bool black) {
      if (!black) return;
      b.for_each([&](int u, int v, int w, bool other) {
        if (!other) return;
        const auto gap = [](int p, int q) { return std::max(0, std::abs(p - q) - 1); };
        const std::int64_t d = gap(x, u) * gap(x, u) + gap(y, v) * gap(y, v) + gap(z, w) * gap(z, w);
        if (best < 0 || d < best) best = d;
      });
    });
    const auto found = distance(reference::octree(a), reference::octree(b));
    ASSERT_EQ(found.has_value(), best >= 0);
    if (!found) continue;
    ASSERT_EQ(found->squared, best);
    EXPECT_DOUBLE_EQ(found->voxels * found->voxels, static_cast<double>(best));
    // The witnesses are that far apart and belong to the closed solids.
    std::int64_t apart = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t d = found->on_a[i] - found->on_b[i];
      apart += d * d;
    }
    EXPECT_EQ(apart, best);
    const auto on = [](const DenseGrid& grid, const std::array<std::int32_t, 3>& p) {
      for (int corner = 0; corner < 8; ++corner)
        if (grid.at(p[0] - (corner & 1), p[1] - (corner >> 1 & 1), p[2] - (corner >> 2))) return true;
      return false;
    };
    EXPECT_TRUE(on(a, found->on_a));
    EXPECT_TRUE(on(b, found->on_b));
  }
}

TEST(ExactInterference, LatticeMotionsAgreeWithMoving) {
  std::mt19937 random(90);
  int hits = 0;
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 3;
    const Octree a = reference::octree(reference::random_solid(depth, random));
    const Octree b = reference::octree(reference::random_solid(depth, random));
    std::uniform_int_distribution<int> small(-3, 3);
    const Motion motion = (Motion::translation({static_cast<double>(small(random)), static_cast<double>(small(random)),
                                                static_cast<double>(small(random))}) *
                           Motion::rotation(Eigen::Vector3d::Unit(trial % 3), small(random) * 90 * kDegree))
                              .about(Eigen::Vector3d::Constant((1 << depth) / 2.0));
    const bool expected = interferes(a, move(b, motion, Leaving::clip));
    ASSERT_EQ(interferes_exactly(a, b, motion), expected);
    hits += expected;
  }
  EXPECT_GT(hits, 50);
  EXPECT_LT(hits, 390);
}

TEST(ExactInterference, TiltedCubesAtTheThreshold) {
  const Octree a = box(4, {7, 7, 7}, {8, 8, 8}), b = a;
  const auto at = [&](const Eigen::Vector3d& axis, double degrees, const Eigen::Vector3d& shift) {
    return interferes_exactly(
        a, b, (Motion::translation(shift) * Motion::rotation(axis, degrees * kDegree)).about({7.5, 7.5, 7.5}));
  };
  // Touching faces do not interfere, a hair closer does.
  EXPECT_FALSE(at({0, 0, 1}, 0, {1, 0, 0}));
  EXPECT_TRUE(at({0, 0, 1}, 0, {1 - 1e-9, 0, 0}));
  // An edge of a cube turned by 45 degrees reaches sqrt(1/2) from its centre.
  const double edge = 0.5 + std::sqrt(0.5);
  EXPECT_TRUE(at({0, 0, 1}, 45, {edge - 1e-9, 0, 0}));
  EXPECT_FALSE(at({0, 0, 1}, 45, {edge + 1e-9, 0, 0}));
  // Edge against edge, separated by a crossed axis alone: turned 45 degrees about x and about y.
  const double cross = std::sqrt(0.5) * 2;
  const Octree c = box(4, {7, 7, 7}, {8, 8, 8});
  const Motion about_x = Motion::rotation({1, 0, 0}, 45 * kDegree), about_z = Motion::rotation({0, 0, 1}, 45 * kDegree);
  for (const double hair : {-1e-9, 1e-9}) {
    // Seen from a cube turned about x: its upper edge runs along x; the other's lower edge runs along y.
    const Motion other = Motion::translation({0, 0, cross + hair}) * Motion::rotation({0, 1, 0}, 45 * kDegree);
    EXPECT_EQ(interferes_exactly(a, c, (about_x.inverse() * other).about({7.5, 7.5, 7.5})), hair < 0);
  }
  EXPECT_TRUE(interferes_exactly(a, c, about_z.about({7.5, 7.5, 7.5})));
  EXPECT_FALSE(interferes_exactly(a, c, Motion::translation({1e9, 0, 0})));
}

TEST(ExactInterference, NoSampledPointIsMissedAndItIsSymmetric) {
  std::mt19937 random(31);
  std::uniform_real_distribution<double> real(0, 1);
  int hits = 0;
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid_a = reference::random_solid(3, random), grid_b = reference::random_solid(3, random);
    const Octree a = reference::octree(grid_a), b = reference::octree(grid_b);
    const Motion motion = reference::random_motion(3, random);
    const bool found = interferes_exactly(a, b, motion);
    hits += found;
    const Motion back = motion.inverse();
    int sampled = 0;
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d p = Eigen::Vector3d(real(random), real(random), real(random)) * 8, q = back(p);
      if (!grid_a.at(std::lround(std::floor(p.x())), std::lround(std::floor(p.y())), std::lround(std::floor(p.z()))))
        continue;
      sampled +=
          grid_b.at(std::lround(std::floor(q.x())), std::lround(std::floor(q.y())), std::lround(std::floor(q.z())));
    }
    ASSERT_TRUE(found || sampled == 0) << sampled;
    if (trial % 2) {
      // With a generic motion no two cubes touch without interfering, so rounding cannot tell the two ways apart.
      const Motion generic = Motion::rotation({1, 0.3, -0.7}, real(random) * 6).about({4.1, 3.3, 4.7});
      EXPECT_EQ(interferes_exactly(a, b, generic), interferes_exactly(b, a, generic.inverse()));
    }
  }
  EXPECT_GT(hits, 50);
  EXPECT_LT(hits, 300);
}

}  // namespace
}  // namespace blackleaf
