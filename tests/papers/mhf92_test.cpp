// MHF92: the appendix against the tables that the product derives, the curve's continuity, the walk, and the octree.
#include "papers/mhf92.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "blackleaf/curve.h"
#include "blackleaf/measures.h"
#include "blackleaf/runs.h"
#include "reference/dense_grid.h"

namespace blackleaf::papers::mhf92 {
namespace {

// The curve of the given order that starts with a table: its voxels in order.
std::vector<Coordinates> curve_of(int order, std::size_t first_table, const Tables& tables) {
  std::vector<Coordinates> voxels;
  const auto visit = [&](const auto& self, int level, std::size_t table, Coordinates at) -> void {
    if (level == 0) {
      voxels.push_back(at);
      return;
    }
    for (const Row& row : tables[table - 1])
      self(self, level - 1, row.next, Coordinates{at.x << 1 | row.x, at.y << 1 | row.y, at.z << 1 | row.z});
  };
  visit(visit, order, first_table, {});
  return voxels;
}

std::size_t jumps(const std::vector<Coordinates>& voxels) {
  const auto apart = [](std::uint32_t a, std::uint32_t b) { return a < b ? b - a : a - b; };
  std::size_t count = 0;
  for (std::size_t i = 1; i < voxels.size(); ++i) {
    const Coordinates &a = voxels[i - 1], &b = voxels[i];
    if (apart(a.x, b.x) + apart(a.y, b.y) + apart(a.z, b.z) != 1) ++count;
  }
  return count;
}

TEST(Mhf92Tables, TheProductDerivesTheAppendixRowByRow) {
  for (std::size_t t = 0; t < 24; ++t)
    for (std::size_t digits = 0; digits < 8; ++digits) {
      const Row printed = kPrintedTables[t][digits];
      const curve::Step derived = curve::kSteps[t][digits];
      EXPECT_EQ(derived.octant, printed.x + 2 * printed.y + 4 * printed.z) << "table " << t + 1 << " row " << digits;
      if (t + 1 == 23 && digits == 7) {
        EXPECT_EQ(printed.next, 1) << "the slip of the print";
        EXPECT_EQ(derived.table + 1, 19);
      } else {
        EXPECT_EQ(derived.table + 1, printed.next) << "table " << t + 1 << " row " << digits;
      }
      EXPECT_EQ(derived.table + 1, kTables[t][digits].next);
    }
}

TEST(Mhf92Tables, AllTwentyFourCurvesAreContinuous) {
  for (std::size_t table = 1; table <= 24; ++table)
    for (int order = 1; order <= 4; ++order)
      EXPECT_EQ(jumps(curve_of(order, table, kTables)), 0u) << "table " << table << " order " << order;
}

TEST(Mhf92Tables, ThePrintedSlipTearsTheCurve) {
  EXPECT_EQ(jumps(curve_of(1, 23, kPrintedTables)), 0u);
  EXPECT_GT(jumps(curve_of(2, 23, kPrintedTables)), 0u);
  // The curve proper starts with table 1 and needs four more levels to come by.
  EXPECT_EQ(jumps(curve_of(4, 1, kPrintedTables)), 0u);
  EXPECT_GT(jumps(curve_of(5, 1, kPrintedTables)), 0u);
  EXPECT_EQ(jumps(curve_of(5, 1, kTables)), 0u);
}

TEST(Mhf92Tables, OneOrderForEachUnorderedOrientation) {
  // Section 2.2: 48 orders of M_1 are 24 orientations, each traversed in two directions; the tables hold one of the
  // two.
  const auto in_the_tables = [](const std::vector<Coordinates>& voxels) {
    int found = 0;
    for (std::size_t table = 1; table <= 24; ++table) found += curve_of(1, table, kTables) == voxels ? 1 : 0;
    return found;
  };
  for (std::size_t table = 1; table <= 24; ++table) {
    std::vector<Coordinates> voxels = curve_of(1, table, kTables);
    EXPECT_EQ(in_the_tables(voxels), 1) << "table " << table;
    std::reverse(voxels.begin(), voxels.end());
    EXPECT_EQ(in_the_tables(voxels), 0) << "table " << table;
  }
}

TEST(Mhf92Tables, FirstAndLastRowsLeadBackWhereTheyCameFrom) {
  // The first and the last copy are reflections of their parent, so that doing it twice changes nothing. The printed
  // last row of table (23) is the only one that breaks this.
  int broken = 0;
  for (std::size_t table = 1; table <= 24; ++table)
    for (const std::size_t row : {std::size_t{0}, std::size_t{7}}) {
      const std::size_t next = kTables[table - 1][row].next;
      EXPECT_EQ(kTables[next - 1][row].next, table) << "table " << table << " row " << row;
      const std::size_t printed = kPrintedTables[table - 1][row].next;
      broken += kPrintedTables[printed - 1][row].next != table ? 1 : 0;
    }
  EXPECT_EQ(broken, 2);  // 23 does not lead back to 19, nor does 19 come back from 23
}

TEST(Mhf92Curve, WorkedExamples) {
  EXPECT_EQ(node_no_to_xyz(2, 30), (Coordinates{0, 1, 3}));
  EXPECT_EQ(xyz_to_node_no(2, {0, 1, 3}), 30u);
  EXPECT_EQ(curve::voxel(2, 30), (curve::Voxel{0, 1, 3}));
  EXPECT_EQ(curve::number(2, {0, 1, 3}), 30u);
}

TEST(Mhf92Curve, BothWaysAndAsTheProduct) {
  for (int order = 1; order <= 4; ++order)
    for (std::uint64_t number = 0; number < std::uint64_t{1} << (3 * order); ++number) {
      const Coordinates at = node_no_to_xyz(order, number);
      ASSERT_EQ(xyz_to_node_no(order, at), number);
      const curve::Voxel voxel = curve::voxel(order, number);
      ASSERT_EQ(voxel, (curve::Voxel{static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)}));
    }
  std::mt19937_64 random(1992);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t number = random() >> 4;  // 60 bits: order 20
    const Coordinates at = node_no_to_xyz(20, number);
    ASSERT_EQ(xyz_to_node_no(20, at), number);
    const curve::Voxel voxel{static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)};
    ASSERT_EQ(curve::voxel(20, number), voxel);
    ASSERT_EQ(curve::number(20, voxel), number);
  }
}

TEST(Mhf92Stream, SectionThreeExample) {
  const std::vector<Tuple> stream = {{16, 23}, {16, 25}, {7, 24}, {25, 23}};
  std::vector<CubicTuple> expected = {{1, 23}, {1, 23}, {1, 25}, {1, 25}};
  expected.insert(expected.end(), 7, {0, 24});
  expected.push_back({0, 23});
  expected.insert(expected.end(), 3, {1, 23});
  EXPECT_EQ(cubic_numbers(stream), expected);

  const std::vector<blackleaf::Run> runs = {{16, 23}, {16, 25}, {7, 24}, {25, 23}};
  std::vector<CubicTuple> product;
  for (const CubeRun& cube : cubes(runs)) product.push_back({cube.level, cube.colour});
  EXPECT_EQ(product, expected);

  // Figure 8: the root and one node of single voxels.
  const Tree tree(2, stream);
  EXPECT_EQ(tree.internal_nodes(), 2u);
  EXPECT_EQ(tree.datum(0, 1, 3), 25u);  // node 30
}

// A volume of several colours: solids painted over each other.
std::vector<std::uint32_t> random_volume(int order, int colours, std::mt19937& random) {
  std::vector<std::uint32_t> volume(std::size_t{1} << (3 * order), 0);
  for (std::uint32_t colour = 1; colour <= static_cast<std::uint32_t>(colours); ++colour) {
    const reference::DenseGrid grid = reference::random_solid(order, random);
    for (std::size_t i = 0; i < volume.size(); ++i)
      if (grid.voxels[i]) volume[i] = colour % static_cast<std::uint32_t>(colours);
  }
  return volume;
}

auto database(const std::vector<std::uint32_t>& volume, int order) {
  return [&volume, order](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return volume[((z << order | y) << order) | x];
  };
}

TEST(Mhf92Stream, ProcessorsJoinTheirTuplesAtTheSeams) {
  std::mt19937 random(4);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const int order = 1 + i % 4;
    const std::vector<std::uint32_t> volume = random_volume(order, 2 + i % 5, random);
    const std::uint64_t nodes = std::uint64_t{1} << (3 * order);
    const std::vector<Tuple> whole = walkround(order, 0, nodes - 1, database(volume, order));
    for (const unsigned processors : {1u, 2u, 3u, 5u, 8u}) {
      SCOPED_TRACE(processors);
      EXPECT_EQ(walkround_in_parallel(order, processors, database(volume, order)), whole);
    }
    std::uint64_t sum = 0;
    for (std::size_t k = 0; k < whole.size(); ++k) {
      sum += whole[k].count;
      if (k > 0) {
        EXPECT_NE(whole[k].datum, whole[k - 1].datum);
      }
    }
    EXPECT_EQ(sum, nodes);
  }
}

TEST(Mhf92Tree, SameOctreeAsTheProductFromRandomVolumes) {
  std::mt19937 random(8);
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(i);
    const int order = 1 + i % 5;
    const int colours = 2 + i % 3;
    const std::vector<std::uint32_t> volume = random_volume(order, colours, random);
    const std::vector<Tuple> stream =
        walkround(order, 0, (std::uint64_t{1} << (3 * order)) - 1, database(volume, order));
    const Tree tree(order, stream);
    EXPECT_EQ(tree.peak_internal_nodes(), tree.internal_nodes()) << "temporary nodes";

    std::vector<blackleaf::Run> runs;
    for (const Tuple& tuple : stream) runs.push_back({tuple.count, tuple.datum});
    std::vector<CubicTuple> product_cubes;
    for (const CubeRun& cube : cubes(runs)) product_cubes.push_back({cube.level, cube.colour});
    EXPECT_EQ(cubic_numbers(stream), product_cubes);

    for (std::uint32_t colour = 0; colour < static_cast<std::uint32_t>(colours); ++colour) {
      const auto is_black = [&](std::uint32_t datum) { return datum == colour; };
      reference::DenseGrid grid(order);
      for (std::size_t v = 0; v < volume.size(); ++v) grid.voxels[v] = is_black(volume[v]);
      const Octree expected = reference::octree(grid);
      EXPECT_EQ(tree.octree(is_black), expected);
      EXPECT_EQ(octree_from_runs(runs, order, {}, is_black), expected);
      if (colours == 2) {
        EXPECT_EQ(tree.internal_nodes(), measure(expected).internal_nodes);
      }
    }
    for (std::uint32_t z = 0; z < 1u << order; ++z)
      for (std::uint32_t y = 0; y < 1u << order; ++y)
        for (std::uint32_t x = 0; x < 1u << order; ++x)
          ASSERT_EQ(tree.datum(x, y, z), database(volume, order)(x, y, z));
  }
}

}  // namespace
}  // namespace blackleaf::papers::mhf92
