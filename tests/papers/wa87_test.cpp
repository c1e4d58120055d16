// WA87: the paper's motion against the product's and against the definition, its bounds, and its Table 2.
#include "papers/wa87.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "blackleaf/moving_object.h"
#include "motion/move_general.h"
#include "reference/dense_grid.h"
#include "reference/every_kernel.h"

namespace blackleaf::papers::wa87 {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using reference::DenseGrid;

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
int pick(std::mt19937& random, int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); }

Vector3d random_axis(std::mt19937& random) {
  Vector3d axis;
  do axis = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
  while (axis.norm() < 0.1);
  return axis;
}

/// Rotations about the origin, most of them such that centres fall on faces.
Matrix3d random_rotation(std::mt19937& random) {
  const auto shuffled = [&](Matrix3d r) {  // conjugated by a cyclic permutation of the axes
    Matrix3d cycle;
    cycle << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    for (int k = pick(random, 0, 2); k > 0; --k) r = cycle * r * cycle.transpose();
    return pick(random, 0, 1) ? r : Matrix3d(r.transpose());
  };
  const auto about_z = [](double c, double s) {
    Matrix3d r;
    r << c, -s, 0, s, c, 0, 0, 0, 1;
    return r;
  };
  Matrix3d r;
  switch (pick(random, 0, 6)) {
    case 0:
      return Matrix3d::Identity();
    case 1:
      return shuffled(about_z(0, 1)) * shuffled(about_z(-1, 0));
    case 2:
      return shuffled(about_z(std::sqrt(0.5), std::sqrt(0.5)));
    case 3:
      return shuffled(about_z(0.6, 0.8));
    case 4:
      r << 1, -2, 2, 2, -1, -2, 2, 2, 1;
      return shuffled(r / 3);
    default:
      return Motion::rotation(random_axis(random), uniform(random, -3.2, 3.2)).rotation();
  }
}

/// Rotations about the universe's centre with translations up to `reach`: whole, half, thirds, or any.
Motion random_motion(int depth, double reach, std::mt19937& random) {
  const double half = std::exp2(depth - 1);
  Vector3d by(uniform(random, -reach, reach), uniform(random, -reach, reach), uniform(random, -reach, reach));
  const double grid = std::array{0.0, 1.0, 0.5, 1.0 / 3, 0.25}[static_cast<std::size_t>(pick(random, 0, 4))];
  if (grid > 0) by = (by / grid).array().round() * grid;
  return Motion(random_rotation(random), by).about(Vector3d::Constant(half));
}

/// A random solid in the middle of a universe twice as large on every axis, so that it may be turned.
DenseGrid random_inner_solid(int depth, std::mt19937& random) {
  DenseGrid grid(depth);
  const DenseGrid inner = reference::random_solid(depth - 1, random);
  const int corner = inner.side() / 2;
  inner.for_each([&](int x, int y, int z, bool black) { grid.set(x + corner, y + corner, z + corner, black); });
  return grid;
}

/// The definition: a voxel is black iff its centre, moved back, lies in the closed solid.
DenseGrid moved_by_definition(const DenseGrid& source, const FixedMotion& motion) {
  DenseGrid target(source.depth);
  target.for_each([&](int x, int y, int z, bool) {
    const std::array<std::int64_t, 3> c = {2 * x + 1, 2 * y + 1, 2 * z + 1};
    std::array<std::int64_t, 3> low{}, high{};  // the voxels that touch the point
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& row = motion.inverse_rotation[i];
      const std::int64_t p = row[0] * c[0] + row[1] * c[1] + row[2] * c[2] + 2 * motion.inverse_translation[i];
      high[i] = p >> 39;
      low[i] = high[i] - ((p & ((std::int64_t{1} << 39) - 1)) == 0 ? 1 : 0);
    }
    for (std::int64_t i = low[0]; i <= high[0]; ++i)
      for (std::int64_t j = low[1]; j <= high[1]; ++j)
        for (std::int64_t k = low[2]; k <= high[2]; ++k)
          if (source.at(i, j, k)) target.set(x, y, z);
  });
  return target;
}

template <class Compute>
std::optional<Octree> unless_it_leaves(const Compute& compute) {
  try {
    return compute();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::out_of_universe) << error.what();
    return std::nullopt;
  }
}

TEST(Wa87Tree, KeepsInternalNodesOnlyAndLosesNothing) {
  std::mt19937 random(1987);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    const Octree octree = reference::octree(reference::random_solid(1 + i % 5, random));
    const Tree tree(octree);
    const Measures m = measure(octree);
    EXPECT_EQ(tree.octree(), octree);
    EXPECT_EQ(tree.internal_nodes(), m.internal_nodes);
    EXPECT_EQ(tree.black_leaves(), m.black_leaves);
    EXPECT_EQ(tree.volume(), m.volume);
  }
}

TEST(Wa87Move, EqualsTheProductAndTheDefinition) {
  std::mt19937 random(11);
  int inside = 0, left = 0;
  for (int i = 0; i < 700; ++i) {
    SCOPED_TRACE(i);
    const int depth = 2 + i % 4;
    const DenseGrid grid = i % 10 ? random_inner_solid(depth, random) : reference::random_solid(depth, random);
    const Octree octree = reference::octree(grid);
    const Motion motion = random_motion(depth, std::exp2(depth) * 0.1, random);
    const FixedMotion fixed(motion);
    const Tree source(octree);
    std::size_t internal = 0, peak = 0;
    const auto papers = unless_it_leaves([&] {
      const Tree target = move(source, fixed);
      internal = target.internal_nodes();
      peak = target.peak_internal_nodes();
      EXPECT_EQ(target.black_leaves(), measure(target.octree()).black_leaves) << "not condensed";
      return target.octree();
    });
    const auto products = unless_it_leaves([&] { return blackleaf::move(octree, motion); });
    ASSERT_EQ(papers.has_value(), products.has_value());
    if (!papers) {
      ++left;
      continue;
    }
    ++inside;
    EXPECT_EQ(*papers, reference::octree(moved_by_definition(grid, fixed))) << "the paper's";
    EXPECT_EQ(*papers, *products) << "the product's";
    EXPECT_EQ(internal, measure(*products).internal_nodes) << "not condensed";
    EXPECT_GE(peak, internal);
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(left, 10);
}

// The printed algorithm is one witness for every kernel and every number of threads; move_by_look_up is the product's
// general engine also where relabelling alone would do.
TEST(Wa87Move, EqualsTheProductWithEveryKernelAndThreadCount) {
  const reference::EveryKernel kernels;
  std::mt19937 random(16);
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(i);
    const int depth = 3 + i % 4;
    const Octree octree = reference::octree(random_inner_solid(depth, random));
    const Motion motion = random_motion(depth, std::exp2(depth) * 0.1, random);
    const auto papers = unless_it_leaves([&] { return move(Tree(octree), FixedMotion(motion)).octree(); });
    if (!papers) continue;
    ++compared;
    kernels.run([&] {
      EXPECT_TRUE(blackleaf::detail::move_by_look_up(octree, motion, Leaving::error) == *papers);
      for (const int threads : {1, 2, 5})
        EXPECT_TRUE(blackleaf::move(octree, motion, Leaving::error, {threads, {}}) == *papers) << threads;
    });
  }
  EXPECT_GT(compared, 250);
}

TEST(Wa87Move, LargerSolidsEqualTheProduct) {
  const reference::EveryKernel kernels;
  std::mt19937 random(12);
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    const int depth = 7;
    const Octree octree = blackleaf::ball(depth, {60 + 0.5 * i, 64, 70}, 20 + i);
    const Motion motion = random_motion(depth, 10, random);
    const Octree papers = move(Tree(octree), FixedMotion(motion)).octree();
    kernels.run([&] { EXPECT_EQ(blackleaf::move(octree, motion), papers); });
  }
}

TEST(Wa87Move, QuarterTurnsAreLossless) {
  std::mt19937 random(13);
  Matrix3d quarter;
  quarter << 0, 0, -1, 0, 1, 0, 1, 0, 0;  // (0,1,0), -90 degrees
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const int depth = 1 + i % 5;
    const DenseGrid grid = reference::random_solid(depth, random);
    const Tree source(reference::octree(grid));
    const Motion turn(quarter, {std::exp2(depth), 0, 0});
    const Tree target = move(source, FixedMotion(turn));
    EXPECT_EQ(target.volume(), source.volume());
    EXPECT_EQ(target.internal_nodes(), source.internal_nodes());
    EXPECT_EQ(target.black_leaves(), source.black_leaves());
    DenseGrid expected(depth);
    grid.for_each([&](int x, int y, int z, bool black) { expected.set(grid.side() - 1 - z, y, x, black); });
    EXPECT_EQ(target.octree(), reference::octree(expected));
  }
}

TEST(Wa87Move, ComposedMotionsNeverAddUpErrors) {
  std::mt19937 random(14);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    const int depth = 5;
    const Octree octree = reference::octree(random_inner_solid(depth, random));
    const Tree source(octree);
    const Motion step = Motion::rotation(random_axis(random), std::numbers::pi / 6).about(Vector3d::Constant(16));
    MovingObject object(octree);
    for (int k = 0; k < 12; ++k) {
      object = object.moved(step);
      EXPECT_EQ(move(source, FixedMotion(object.motion())).octree(), object.octree()) << "step " << k;
    }
    EXPECT_EQ(object.octree(), octree) << "a full turn";
  }
}

TEST(Wa87Bounds, Table1AsPrinted) {
  struct Printed {
    int m;
    double black, internal, all, last_black, last_internal, last_all;  // and one unit of each one's last digit
  };
  const Printed table[] = {{8, 0.092, 0.0228, 0.186, 1e-3, 1e-4, 1e-3},
                           {10, 0.024, 0.0057, 0.047, 1e-3, 1e-4, 1e-3},
                           {12, 0.0060, 0.0015, 0.012, 1e-4, 1e-4, 1e-3},
                           {14, 0.0015, 0.00036, 0.0029, 1e-4, 1e-5, 1e-4}};
  for (const Printed& row : table) {
    SCOPED_TRACE(row.m);
    const double volume = std::exp2(3 * row.m);
    const int n = 5 * row.m;
    const auto is_printed_as = [](double bound, double printed, double unit) {
      EXPECT_LE(bound, printed + 0.5 * unit);  // rounded to nearest or up
      EXPECT_GT(bound, printed - unit);
    };
    is_printed_as(black_leaf_bound(row.m) / volume, row.black, row.last_black);
    is_printed_as(internal_node_bound(row.m, n) / volume, row.internal, row.last_internal);
    is_printed_as(node_bound(row.m, n) / volume, row.all, row.last_all);
  }
}

TEST(Wa87Bounds, CorollaryFollowsFromTheLemma) {
  for (int m = 0; m <= 15; ++m)
    for (int n = std::max(m, 1); n <= 20; ++n) {
      const double exact = 8 * internal_node_bound(m, n) + 1;
      EXPECT_GE(node_bound(m, n), exact) << m << ' ' << n;
      EXPECT_LE(node_bound(m, n), exact * 1.05 + 1) << m << ' ' << n;  // 46.08 became 47
    }
}

TEST(Wa87Bounds, TheoremsHoldForMovedCubes) {
  std::mt19937 random(15);
  int tested = 0;
  double closest = 0;
  for (int i = 0; i < 4000; ++i) {
    SCOPED_TRACE(i);
    const int m = i % 6;
    const int n = std::min(8, m + 1 + pick(random, 0, 3));
    const int places = 1 << (n - m);
    const auto corner = [&] { return pick(random, 0, places - 1) << m; };
    const std::array<std::int32_t, 3> low = {corner(), corner(), corner()};
    const Octree cube = blackleaf::box(n, low, {low[0] + (1 << m), low[1] + (1 << m), low[2] + (1 << m)});
    // Anywhere: the cube's own centre goes to a random point of the middle of the universe.
    const Vector3d centre = Vector3d(low[0], low[1], low[2]).array() + std::exp2(m - 1);
    const double reach = std::max(0.0, std::exp2(n - 1) - 0.5 * std::sqrt(3) * std::exp2(m));
    Vector3d to = Vector3d::Constant(std::exp2(n - 1)) +
                  reach * Vector3d(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
    if (i % 3 == 0) to = to.array().round() + (i % 2) * 0.5;  // centres on faces, and cubes across the middle
    if (i % 9 == 0) to = Vector3d::Constant(std::exp2(n - 1));
    const Matrix3d rotation = random_rotation(random);
    const auto target =
        unless_it_leaves([&] { return blackleaf::move(cube, Motion(rotation, to - rotation * centre)); });
    if (!target) continue;
    ++tested;
    const Measures measures = measure(*target);
    const auto black = static_cast<double>(measures.black_leaves);
    const auto internal = static_cast<double>(measures.internal_nodes);
    EXPECT_LE(black, black_leaf_bound(m)) << "Theorem 1, m = " << m;
    EXPECT_LE(internal, internal_node_bound(m, n)) << "Theorem 2, m = " << m << ", n = " << n;
    EXPECT_LE(8 * internal + 1, node_bound(m, n)) << "corollary, m = " << m << ", n = " << n;
    if (n > 1) closest = std::max(closest, internal / internal_node_bound(m, n));
  }
  EXPECT_GT(tested, 3000);
  EXPECT_EQ(closest, 1.0) << "the bound of one voxel is reached: eight voxels about the universe's centre";
}

// Theorem 3 supposes that black leaves of level m are as frequent as places of that level, 8^(n-m), and concludes that
// one of them costs at most 10 n + 1 internal nodes on the average.
TEST(Wa87Bounds, Theorem3FollowsFromTheorem2) {
  for (int n = 3; n <= 20; ++n) {
    double places = 0, internal = 0;
    for (int m = 0; m < n; ++m) {
      places += std::exp2(3 * (n - m));
      internal += std::exp2(3 * (n - m)) * internal_node_bound(m, n);
    }
    EXPECT_LE(internal / places, 10 * n + 1) << n;
    EXPECT_GT(internal / places, 8 * n - 4) << "not by a wide margin, n = " << n;
  }
}

TEST(Wa87Bounds, Theorem3HoldsForLeavesOfRandomTrees) {
  std::mt19937 random(33);
  for (int n = 3; n <= 9; ++n) {
    double internal = 0;
    int moved = 0;
    while (moved < 400) {
      int m = 0;  // one place in eight, at any level, belongs to the next larger cubes
      while (m < n - 2 && pick(random, 0, 7) == 0) ++m;
      const int places = 1 << (n - m);
      const auto corner = [&] { return pick(random, 0, places - 1) << m; };
      const std::array<std::int32_t, 3> low = {corner(), corner(), corner()};
      const Octree cube = blackleaf::box(n, low, {low[0] + (1 << m), low[1] + (1 << m), low[2] + (1 << m)});
      const Vector3d middle = Vector3d::Constant(std::exp2(n - 1));
      const Vector3d shift(uniform(random, -2, 2), uniform(random, -2, 2), uniform(random, -2, 2));
      const Matrix3d rotation = random_rotation(random);
      const auto target =
          unless_it_leaves([&] { return blackleaf::move(cube, Motion(rotation, middle + shift - rotation * middle)); });
      if (!target) continue;
      internal += static_cast<double>(measure(*target).internal_nodes);
      ++moved;
    }
    EXPECT_LE(internal / moved, 10 * n + 1) << n;
  }
}

// Table 2's object (a) is drawn in Figure 5 without coordinates. A search over all unions of two boxes of twelve equal
// cubes with 7 internal nodes found one that has every number of the table that can still be read: a plate of 3 x 1 x 4
// cubes of side 2^(n-3). The peak M depends on the order in which nodes are visited; here it comes to 1 to 3 less than
// the paper's.
Octree object_a(int n) {
  const int s = 1 << (n - 3);
  return blackleaf::box(n, {1 * s, 3 * s, 2 * s}, {4 * s, 4 * s, 6 * s});
}

struct Printed {
  int n;
  std::optional<std::size_t> black, internal, peak;  // where they can be read
  double ratio;                                      // I/V, two digits
};

void expect_table_2(const Motion& motion_at_4, const std::vector<Printed>& rows) {
  for (const Printed& row : rows) {
    SCOPED_TRACE(row.n);
    const Tree source(object_a(row.n));
    EXPECT_EQ(source.volume(), 96u << (3 * (row.n - 4)));
    EXPECT_EQ(source.black_leaves(), 12u);
    EXPECT_EQ(source.internal_nodes(), 7u);
    const Motion motion(motion_at_4.rotation(), motion_at_4.translation() * std::exp2(row.n - 4));
    const Tree target = move(source, FixedMotion(motion));
    if (row.black) {
      EXPECT_EQ(target.black_leaves(), *row.black);
    }
    if (row.internal) {
      EXPECT_EQ(target.internal_nodes(), *row.internal);
    }
    const double ratio = static_cast<double>(target.internal_nodes()) / static_cast<double>(source.volume());
    EXPECT_NEAR(ratio, row.ratio, row.ratio * 0.05);
    if (row.peak) {
      EXPECT_LE(target.peak_internal_nodes(), *row.peak);
      EXPECT_GE(target.peak_internal_nodes() + 3, *row.peak);
    }
    EXPECT_LE(target.peak_internal_nodes(), target.internal_nodes() + 5);
    EXPECT_EQ(target.octree(), blackleaf::move(object_a(row.n), motion));
  }
}

TEST(Wa87Table2, ObjectATurnedByMinus90Degrees) {
  Matrix3d quarter;
  quarter << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  expect_table_2(Motion(quarter, {16, 0, 0}),
                 {{4, 12, 7, 11, 0.073}, {5, 12, 7, {}, 0.0091}, {6, 12, 7, 13, 0.0011}, {7, 12, 7, 14, 0.00014}});
}

TEST(Wa87Table2, ObjectATurnedByMinus30Degrees) {
  const Motion turn = Motion::rotation({0, 1, 0}, -std::numbers::pi / 6);
  expect_table_2(Motion::translation({8, 0, 0}) * turn,
                 {{4, 47, {}, 25, 0.22}, {5, {}, {}, 69, 0.083}, {6, 739, {}, 242, 0.038}, {7, {}, 922, 929, 0.019}});
}

TEST(Wa87Table2, ObjectATurnedBy30DegreesAboutTheDiagonal) {
  const Motion turn = Motion::rotation({1, 1, 1}, std::numbers::pi / 6);
  expect_table_2(
      Motion::translation({2, 2, 0}) * turn,
      {{4, 85, {}, 42, 0.41}, {5, 441, {}, 174, 0.22}, {6, 2042, 673, 676, 0.11}, {7, {}, 2713, 2718, 0.055}});
}

}  // namespace
}  // namespace blackleaf::papers::wa87
