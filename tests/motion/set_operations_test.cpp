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

// Deep universes, where whole subtrees are copied and stretches are cut: solids of many levels, compared voxel by voxel
// at random places and where their own surfaces are.
Octree deep_solid(int depth, std::mt19937& random) {
  const double side = 1 << depth;
  std::uniform_real_distribution<double> any(0, side);
  Octree solid(depth);
  for (int part = 0; part < 3; ++part) {
    const Octree one = part % 2 ? box(depth, {static_cast<int>(any(random)), static_cast<int>(any(random)), 0},
                                      {static_cast<int>(side), static_cast<int>(side), static_cast<int>(any(random))})
                                : ball(depth, {any(random), any(random), any(random)}, any(random) / 3);
    solid = octree_from_classifier(depth, [&, old = solid](const Cube& cube) {
      if (cube.level > 0) return Colour::gray;
      return old.contains(cube.x, cube.y, cube.z) != one.contains(cube.x, cube.y, cube.z) ? Colour::black
                                                                                          : Colour::white;
    });
  }
  return solid;
}

TEST(SetOperations, DeepSolidsOnAnyNumberOfThreads) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 6; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 6 + trial % 2;
    const Octree a = deep_solid(depth, random), b = deep_solid(depth, random);
    const auto check = [&](auto operation, auto of_voxels) {
      const Octree result = operation(Work{.threads = 1, .progress = {}});
      reference::expect_valid(result);
      const Octree expected = octree_from_classifier(depth, [&](const Cube& c) {
        if (c.level > 0) return Colour::gray;
        return of_voxels(a.contains(c.x, c.y, c.z), b.contains(c.x, c.y, c.z)) ? Colour::black : Colour::white;
      });
      ASSERT_TRUE(result == expected);
      ASSERT_TRUE(operation(Work{.threads = 4, .progress = {}}) == expected);
    };
    check([&](const Work& work) { return unite(a, b, work); }, [](bool u, bool v) { return u || v; });
    check([&](const Work& work) { return intersect(a, b, work); }, [](bool u, bool v) { return u && v; });
    check([&](const Work& work) { return subtract(a, b, work); }, [](bool u, bool v) { return u && !v; });
    check([&](const Work& work) { return symmetric_difference(a, b, work); }, [](bool u, bool v) { return u != v; });
    check([&](const Work& work) { return complement(a, work); }, [](bool u, bool) { return !u; });
  }
}

TEST(SetOperations, OfManyEqualsThoseOfTwoInTurn) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    std::vector<Octree> octrees;
    const int depth = 1 + trial % 5, count = 1 + static_cast<int>(random() % 6);
    for (int i = 0; i < count; ++i) octrees.push_back(reference::octree(reference::random_solid(depth, random)));
    Octree any = octrees[0], every = octrees[0], odd = octrees[0];
    for (std::size_t i = 1; i < octrees.size(); ++i) {
      any = unite(any, octrees[i]);
      every = intersect(every, octrees[i]);
      odd = symmetric_difference(odd, octrees[i]);
    }
    const Work work{.threads = 1 + trial % 3, .progress = {}};
    reference::expect_valid(unite(octrees, work));
    EXPECT_TRUE(unite(octrees, work) == any);
    EXPECT_TRUE(intersect(octrees, work) == every);
    EXPECT_TRUE(symmetric_difference(octrees, work) == odd);
  }
}

TEST(SetOperations, KeepTheFirstFrameAndRefuseOtherDepths) {
  Frame frame;
  frame.unit = "mm";
  EXPECT_EQ(unite(Octree(3, Colour::black, frame), Octree(3)).frame(), frame);
  EXPECT_THROW(unite(Octree(3), Octree(4)), Error);
  const std::array<Octree, 3> mixed = {Octree(3, Colour::black, frame), Octree(3), Octree(4)};
  EXPECT_THROW(unite(mixed), Error);
  EXPECT_THROW(intersect(mixed), Error);
  EXPECT_THROW(symmetric_difference(mixed), Error);
  EXPECT_EQ(unite(std::span(mixed).first(2)).frame(), frame);
  EXPECT_EQ(complement(mixed[0]).frame(), frame);
}

TEST(SetOperations, CanBeInterrupted) {
  const Octree a = ball(7, {60, 60, 60}, 40), b = ball(7, {70, 60, 60}, 40);
  const Work work{.threads = 1, .progress = [](double) { return false; }};
  EXPECT_THROW(unite(a, b, work), Error);
}

}  // namespace
}  // namespace blackleaf
