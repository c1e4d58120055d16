#include "blackleaf/set_operations.h"

#include <gtest/gtest.h>

#include "blackleaf/error.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;

TEST(SetOperations, AgreeWithTheDenseGrid) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 600; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 6;
    const DenseGrid a = reference::random_solid(depth, random), b = reference::random_solid(depth, random);
    const Octree p = reference::octree(a), q = reference::octree(b);
    const auto check = [&](const Octree& result, auto operation) {
      DenseGrid expected(depth);
      expected.for_each(
          [&](int x, int y, int z, bool) { expected.set(x, y, z, operation(a.at(x, y, z), b.at(x, y, z))); });
      reference::expect_valid(result);
      ASSERT_TRUE(result == reference::octree(expected));
    };
    check(unite(p, q), [](bool u, bool v) { return u || v; });
    check(intersect(p, q), [](bool u, bool v) { return u && v; });
    check(subtract(p, q), [](bool u, bool v) { return u && !v; });
    check(symmetric_difference(p, q), [](bool u, bool v) { return u != v; });
    check(complement(p), [](bool u, bool) { return !u; });
  }
}

TEST(SetOperations, Laws) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const int depth = 1 + trial % 5;
    const auto solid = [&] { return reference::octree(reference::random_solid(depth, random)); };
    const Octree a = solid(), b = solid(), c = solid();
    EXPECT_TRUE(intersect(a, b) == intersect(b, a));
    EXPECT_TRUE(unite(a, unite(b, c)) == unite(unite(a, b), c));
    EXPECT_TRUE(complement(unite(a, b)) == intersect(complement(a), complement(b)));
    EXPECT_TRUE(complement(complement(a)) == a);
    EXPECT_TRUE(subtract(a, b) == intersect(a, complement(b)));
    EXPECT_TRUE(symmetric_difference(symmetric_difference(a, b), b) == a);
    EXPECT_TRUE(symmetric_difference(a, a).is_empty());
    EXPECT_TRUE(unite(a, b, {.threads = 1, .progress = {}}) == unite(a, b, {.threads = 3, .progress = {}}));
  }
}

TEST(SetOperations, KeepTheFirstFrameAndRefuseOtherDepths) {
  Frame frame;
  frame.unit = "mm";
  EXPECT_EQ(unite(Octree(3, Colour::black, frame), Octree(3)).frame(), frame);
  EXPECT_THROW(unite(Octree(3), Octree(4)), Error);
}

}  // namespace
}  // namespace blackleaf
