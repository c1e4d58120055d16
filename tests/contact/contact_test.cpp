#include "blackleaf/contact.h"

#include <gtest/gtest.h>

#include "blackleaf/error.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;

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

}  // namespace
}  // namespace blackleaf
