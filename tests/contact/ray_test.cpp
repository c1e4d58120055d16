// Rays against their twin, and by hand.
#include "blackleaf/ray.h"

#include <gtest/gtest.h>

#include "blackleaf/error.h"
#include "reference/ray_twin.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;

TEST(Ray, AgreesWithItsTwin) {
  std::mt19937 random(1997);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  const auto real = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  std::size_t hits = 0, inside = 0, several = 0, in_planes = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 4, side = 1 << depth;
    const DenseGrid grid = reference::random_solid(depth, random);
    const Octree octree = reference::octree(grid);
    for (int k = 0; k < 4; ++k) {
      Ray ray;
      // Lattice points, halves and anything, in the universe and around it; lattice directions and any.
      const int kind = pick(0, 3);
      for (Eigen::Index i = 0; i < 3; ++i) {
        ray.origin[i] = kind == 0   ? pick(-2, side + 2)
                        : kind == 1 ? pick(-4, 2 * side + 4) / 2.0
                                    : real(-0.5 * side, 1.5 * side);
        ray.direction[i] = trial % 2 != 0 ? pick(-2, 2) : real(-1, 1);
      }
      if (k % 2 != 0)  // toward a point of the universe
        for (Eigen::Index i = 0; i < 3; ++i)
          ray.direction[i] = (trial % 2 != 0 ? pick(0, 2 * side) / 2.0 : real(0, side)) - ray.origin[i];
      if (ray.direction == Eigen::Vector3d::Zero()) ray.direction.x() = 1;
      if (kind == 3) ray.origin += ray.direction * pick(-3, 3);
      const auto expected = reference::crossings(grid, ray);
      const auto found = crossings(octree, ray);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        for (const auto& [point, twin] :
             {std::pair{found[i].enter, expected[i].enter}, std::pair{found[i].leave, expected[i].leave}}) {
          ASSERT_NEAR(point.time, twin.time, 1e-13 * (1 + twin.time));
          ASSERT_EQ(point.normal, twin.normal);
          const Eigen::Vector3d at = ray.origin + point.time * ray.direction;
          ASSERT_LT((point.point - at).norm(), 1e-7);
          for (Eigen::Index axis = 0; axis < 3; ++axis)
            if (point.normal[axis] != 0) {
              ASSERT_EQ(point.point[axis], std::round(point.point[axis]));
            }
        }
      }
      const auto hit = first_hit(octree, ray);
      ASSERT_EQ(hit.has_value(), !expected.empty());
      if (!hit) continue;
      ASSERT_EQ(hit->time, found.front().enter.time);
      ASSERT_EQ(hit->normal, found.front().enter.normal);
      ASSERT_TRUE(first_hit(octree, ray, hit->time));
      if (hit->time > 0) {
        ASSERT_FALSE(first_hit(octree, ray, hit->time * (1 - 1e-9)));
      }
      ++hits;
      inside += hit->time == 0;
      several += found.size() > 1;
      in_planes += (ray.direction.array() == 0).any() && (ray.origin.array() == ray.origin.array().round()).any();
    }
  }
  EXPECT_GT(hits, 2000u);
  EXPECT_GT(inside, 200u);
  EXPECT_GT(several, 200u);
  EXPECT_GT(in_planes, 100u);
}

TEST(Ray, FacesAndSides) {
  DenseGrid grid(3);
  for (int z = 2; z < 5; ++z)
    for (int y = 2; y < 5; ++y)
      for (int x = 2; x < 5; ++x) grid.set(x, y, z);
  const Octree cube = reference::octree(grid);
  const auto hit = first_hit(cube, {{-3, 2.5, 3.5}, {2, 0, 0}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->time, 2.5);
  EXPECT_EQ(hit->point, Eigen::Vector3d(2, 2.5, 3.5));
  EXPECT_EQ(hit->normal, Eigen::Vector3i(-1, 0, 0));
  // Between black voxels, but not along a face, an edge, or through an edge alone.
  EXPECT_TRUE(first_hit(cube, {{-3, 3, 3}, {1, 0, 0}}));
  EXPECT_FALSE(first_hit(cube, {{-3, 2, 3}, {1, 0, 0}}));
  EXPECT_FALSE(first_hit(cube, {{-3, 5, 3}, {1, 0, 0}}));
  EXPECT_FALSE(first_hit(cube, {{-3, 5, 5}, {1, 0, 0}}));
  EXPECT_FALSE(first_hit(cube, {{0, 4, 3.5}, {1, -1, 0}}));
  // From within there is no face; backward nothing.
  EXPECT_EQ(first_hit(cube, {{3.5, 3.5, 3.5}, {0, 1, 1}})->normal, Eigen::Vector3i(0, 0, 0));
  EXPECT_FALSE(first_hit(cube, {{6, 3.5, 3.5}, {1, 0, 0}}));
  EXPECT_FALSE(first_hit(Octree(5), {{6, 3.5, 3.5}, {1, 0, 0}}));
  EXPECT_EQ(crossings(Octree(5, Colour::black), {{-1, 3.5, 3.5}, {1, 0, 0}}).front().leave.time, 33);
  // From far away, in a deep universe.
  EXPECT_EQ(first_hit(Octree(20, Colour::black), {{-8388608, 0.5, 0.5}, {1, 0, 0}})->time, 8388608);
  EXPECT_THROW(first_hit(cube, {{0, 0, 0}, {0, 0, 0}}), Error);
  EXPECT_THROW(first_hit(cube, {{0, NAN, 0}, {1, 0, 0}}), Error);
  EXPECT_THROW(first_hit(cube, {{0, 0, 0}, {1, INFINITY, 0}}), Error);
  EXPECT_THROW(first_hit(cube, {{0, 0, 1e8}, {1, 0, 0}}), Error);
}

TEST(Ray, ManyAtOnce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> real(-1, 1);
  const Octree octree = reference::octree(reference::random_solid(4, random));
  std::vector<Ray> rays(1000);
  for (Ray& ray : rays) {
    ray.origin = Eigen::Vector3d(real(random), real(random), real(random)) * 20;
    ray.direction = {real(random), real(random), real(random)};
  }
  const auto one = first_hits(octree, rays, {1, {}}), two = first_hits(octree, rays, {2, {}});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto alone = first_hit(octree, rays[i]);
    ASSERT_EQ(one[i].has_value(), alone.has_value());
    ASSERT_EQ(two[i].has_value(), alone.has_value());
    if (!alone) continue;
    ASSERT_EQ(one[i]->time, alone->time);
    ASSERT_EQ(two[i]->point, alone->point);
  }
}

}  // namespace
}  // namespace blackleaf
