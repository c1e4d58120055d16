#include "blackleaf/octree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>

#include "blackleaf/error.h"
#include "blackleaf/implicit.h"
#include "blackleaf/leaves.h"
#include "octree/storage.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;

TEST(Octree, EmptyAndFullUniversesAreTrees) {
  for (int depth : {1, 2, 3, 20}) {
    const Octree empty(depth), full(depth, Colour::black);
    EXPECT_TRUE(empty.is_empty());
    EXPECT_FALSE(empty.contains(0, 0, 0));
    EXPECT_TRUE(full.contains(0, 0, (1 << depth) - 1));
    EXPECT_FALSE(full.contains(0, 0, 1 << depth));
    EXPECT_FALSE(full.contains(-1, 0, 0));
    EXPECT_FALSE(empty == full);
    reference::expect_valid(empty);
    reference::expect_valid(full);
    EXPECT_TRUE(full.root().child(3).is_black());
    EXPECT_EQ(full.root().child(3).level(), depth - 1);
  }
}

TEST(Octree, WorkedExampleOfTheHeader) {
  DenseGrid grid(3);
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) grid.set(x, y, z);
  grid.set(7, 7, 7);
  const Octree octree = reference::octree(grid);
  ASSERT_EQ(octree.words(3).size(), 1u);
  EXPECT_EQ(octree.words(3)[0], 0x8001u);
  ASSERT_EQ(octree.words(2).size(), 1u);
  EXPECT_EQ(octree.words(2)[0], 0x8000'0000'0000'0000u);
}

TEST(Octree, AgreesWithTheDenseGrid) {
  std::mt19937 random(1984);
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 6, random);
    const Octree octree = reference::octree(grid);
    reference::expect_valid(octree);
    ASSERT_TRUE(reference::dense(octree) == grid);
  }
}

TEST(Octree, EqualSolidsHaveEqualWordsWhoeverMadeThem) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 6, random);
    const Octree octree = reference::octree(grid);
    // A classifier that answers for whole cubes, and several threads.
    const auto classify = [&](const Cube& c) {
      bool black = false, white = false;
      for (int z = c.z; z < c.z + c.side(); ++z)
        for (int y = c.y; y < c.y + c.side(); ++y)
          for (int x = c.x; x < c.x + c.side(); ++x) (grid.at(x, y, z) ? black : white) = true;
      return black && white ? Colour::gray : black ? Colour::black : Colour::white;
    };
    for (int threads : {1, 2, 5}) {
      const Octree other = octree_from_classifier(grid.depth, classify, {}, {.threads = threads, .progress = {}});
      ASSERT_TRUE(octree == other);
      for (int level = 0; level <= kMaxDepth; ++level)
        ASSERT_TRUE(std::ranges::equal(octree.words(level), other.words(level)));
    }
    DenseGrid changed = grid;
    changed.voxels[random() % changed.voxels.size()] ^= 1;
    ASSERT_FALSE(octree == reference::octree(changed));
  }
}

TEST(Octree, CursorReachesEveryLevel) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 60; ++trial) {
    const DenseGrid grid = reference::random_solid(1 + trial % 4, random);
    const Octree octree = reference::octree(grid);
    const auto check = [&](const auto& self, const Node& node, const Cube& cube) -> void {
      bool black = false, white = false;
      for (int z = cube.z; z < cube.z + cube.side(); ++z)
        for (int y = cube.y; y < cube.y + cube.side(); ++y)
          for (int x = cube.x; x < cube.x + cube.side(); ++x) (grid.at(x, y, z) ? black : white) = true;
      ASSERT_EQ(node.level(), cube.level);
      ASSERT_EQ(node.colour(), black && white ? Colour::gray : black ? Colour::black : Colour::white);
      if (cube.level > 0)
        for (int octant = 0; octant < 8; ++octant) self(self, node.child(octant), cube.child(octant));
    };
    check(check, octree.root(), octree.universe());
  }
}

TEST(Octree, ContainsAgreesWithTheGridAndWithTheCursorInsideAndOutside) {
  std::mt19937 random(17);
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 5, random);
    const Octree octree = reference::octree(grid);
    grid.for_each([&](int x, int y, int z, bool black) {
      Node node = octree.root();
      for (int bit = grid.depth - 1; bit >= 0; --bit)
        node = node.child((x >> bit & 1) + 2 * (y >> bit & 1) + 4 * (z >> bit & 1));
      ASSERT_EQ(node.is_black(), black);
      ASSERT_EQ(octree.contains(x, y, z), black);
    });
    const std::int64_t far[] = {-1, grid.side(), INT64_MIN, INT64_MAX, std::int64_t{1} << 32};
    for (const std::int64_t at : far) {
      EXPECT_FALSE(octree.contains(at, 0, 0));
      EXPECT_FALSE(octree.contains(0, at, 0));
      EXPECT_FALSE(octree.contains(0, 0, at));
    }
  }
}

// Trees of depth 6 and more are looked up from a directory, which several threads may make at once.
TEST(Octree, ContainsBeginsAtTheDirectoryOfLargerTrees) {
  for (int depth = 5; depth <= 9; ++depth) {
    SCOPED_TRACE(depth);
    const double side = 1 << depth;
    const Octree octree = ball(depth, {0.45 * side, 0.5 * side, 0.6 * side}, 0.39 * side);
    const auto check = [&](unsigned seed) {
      std::mt19937 random(seed);
      std::uniform_int_distribution<int> coordinate(0, octree.side() - 1);
      for (int i = 0; i < 20000; ++i) {
        const int x = coordinate(random), y = coordinate(random), z = coordinate(random);
        Node node = octree.root();
        for (int bit = depth - 1; bit >= 0; --bit)
          node = node.child((x >> bit & 1) + 2 * (y >> bit & 1) + 4 * (z >> bit & 1));
        ASSERT_EQ(octree.contains(x, y, z), node.is_black());
      }
    };
    std::thread other([&] { check(1); });
    check(2);
    other.join();
  }
}

TEST(Octree, CopiesShareAndFramesTravel) {
  Frame frame;
  frame.origin = {1, 2, 3};
  frame.unit = "mm";
  const Octree a = ball(5, {16, 16, 16}, 9, frame);
  const Octree b = a.with_frame({});
  EXPECT_TRUE(a == b);
  EXPECT_EQ(a.frame(), frame);
  EXPECT_EQ(b.frame(), Frame{});
  EXPECT_EQ(a.words(5).data(), b.words(5).data());
}

TEST(Octree, DepthTwenty) {
  const Octree speck = box(20, {1048575, 0, 524288}, {1048576, 1, 524289});
  reference::expect_valid(speck);
  EXPECT_TRUE(speck.contains(1048575, 0, 524288));
  EXPECT_EQ(volume(speck), 1u);
  EXPECT_EQ(measure(speck).internal_nodes, 20u);
}

TEST(Leaves, AreDisjointIncreasingIntervals) {
  std::mt19937 random(8);
  for (int trial = 0; trial < 100; ++trial) {
    const DenseGrid grid = reference::random_solid(1 + trial % 5, random);
    const Octree octree = reference::octree(grid);
    DenseGrid drawn(grid.depth);
    std::uint64_t end = 0;
    for_each_leaf(octree, [&](const Leaf& leaf, bool black) {
      ASSERT_EQ(leaf.first, end);
      end = leaf.first + (std::uint64_t{1} << (3 * leaf.cube.level));
      for (int z = 0; z < leaf.cube.side(); ++z)
        for (int y = 0; y < leaf.cube.side(); ++y)
          for (int x = 0; x < leaf.cube.side(); ++x)
            drawn.set(leaf.cube.x + x, leaf.cube.y + y, leaf.cube.z + z, black);
    });
    EXPECT_EQ(end, std::uint64_t{1} << (3 * grid.depth));
    EXPECT_TRUE(drawn == grid);
  }
}

TEST(Classifier, RefusesImpossibleDepths) {
  const auto white = [](const Cube&) { return Colour::white; };
  EXPECT_THROW(octree_from_classifier(0, white), Error);
  EXPECT_THROW(octree_from_classifier(21, white), Error);
}

TEST(Classifier, CanBeInterrupted) {
  const auto noise = [](const Cube& c) {
    return c.level ? Colour::gray : (c.x ^ c.y ^ c.z) & 1 ? Colour::black : Colour::white;
  };
  for (int threads : {1, 2}) {
    int calls = 0;
    double last = 0;
    const Work work{threads, [&](double fraction) {
                      last = fraction;
                      return ++calls < 10;
                    }};
    try {
      octree_from_classifier(6, noise, {}, work);
      FAIL() << "not interrupted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
    }
    EXPECT_GT(last, 0);
    EXPECT_LT(last, 1);
  }
}

// Builds an octree from raw words, so that validate() has something to find.
Octree forged(int depth, std::vector<std::vector<std::uint64_t>> levels_from_root) {
  auto tree = std::make_shared<detail::Words>();
  for (std::size_t i = 0; i < levels_from_root.size(); ++i) {
    const std::size_t level = static_cast<std::size_t>(depth) - i;
    tree->of_level[level].append(levels_from_root[i].data(), levels_from_root[i].size());
    tree->levels[level] = tree->of_level[level].data();
  }
  return Octree(std::make_shared<const Octree::Storage>(Octree::Storage{depth, Colour::gray, std::move(tree), {}}));
}

TEST(Validate, NamesTheFirstBrokenInvariant) {
  EXPECT_EQ(validate(forged(3, {{0x8001}, {0x8000'0000'0000'0000}})), "");
  EXPECT_EQ(validate(forged(3, {{0x8001}, {0}})), "a brick of one colour at level 2");
  EXPECT_EQ(validate(forged(3, {{0x8001}, {~std::uint64_t{0}}})), "a brick of one colour at level 2");
  EXPECT_EQ(validate(forged(3, {{0x0101}, {1}})), "a child both black and gray at level 3");
  EXPECT_EQ(validate(forged(3, {{0x00FF}, {}})), "a gray node of one colour at level 3");
  EXPECT_EQ(validate(forged(3, {{0x8001}, {}})), "a child index beyond the words of the level below at level 3");
  EXPECT_EQ(validate(forged(3, {{0x18001}, {1, 1}})), "a group of children out of curve order at level 3");
  EXPECT_EQ(validate(forged(3, {{0x8001}, {1, 1}})), "level 2 holds words that the root does not reach");
  EXPECT_EQ(validate(forged(3, {{0x10001}, {}})), "a child index without gray children at level 3");
  EXPECT_EQ(validate(forged(1, {{0x1FF}})), "a byte has more than eight bits at level 1");
  EXPECT_EQ(validate(forged(1, {{0xFF}})), "a byte of one colour at level 1");
}

}  // namespace
}  // namespace blackleaf
