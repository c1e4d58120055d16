#include "blackleaf/curve.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "octree/brick.h"
#include "reference/curve_steps.h"

namespace blackleaf {
namespace {

TEST(Curve, TwentyFourTablesAreDistinctPermutations) {
  for (unsigned t = 0; t < 24; ++t) {
    unsigned seen = 0;
    for (const curve::Step step : curve::kSteps[t]) {
      seen |= 1u << step.octant;
      ASSERT_LT(step.table, 24);
    }
    EXPECT_EQ(seen, 0xFFu);
    for (unsigned u = 0; u < t; ++u) {
      bool same = true;
      for (unsigned d = 0; d < 8; ++d) same = same && curve::kSteps[t][d].octant == curve::kSteps[u][d].octant;
      EXPECT_FALSE(same) << "tables " << t + 1 << " and " << u + 1;
    }
  }
}

TEST(Curve, WorkedExampleOfThePaper) {
  EXPECT_EQ(curve::voxel(2, 30), (curve::Voxel{0, 1, 3}));
  EXPECT_EQ(curve::number(2, {0, 1, 3}), 30u);
}

TEST(Curve, ConsecutiveVoxelsShareAFaceAndNumbersInvert) {
  for (int order = 1; order <= 5; ++order) {
    curve::Voxel last{};
    for (std::uint64_t i = 0; i < std::uint64_t{1} << (3 * order); ++i) {
      const curve::Voxel v = curve::voxel(order, i);
      ASSERT_EQ(curve::number(order, v), i);
      const int step = std::abs(v.x - last.x) + std::abs(v.y - last.y) + std::abs(v.z - last.z);
      ASSERT_EQ(step, i > 0 ? 1 : 0) << "order " << order << ", number " << i;
      last = v;
    }
  }
}

TEST(Curve, EqualsOneStepALevelEverywhereUpToOrderSix) {
  for (int order = 1; order <= 6; ++order)
    for (std::uint64_t i = 0; i < std::uint64_t{1} << (3 * order); ++i) {
      const curve::Voxel v = reference::voxel_by_steps(order, i);
      ASSERT_EQ(curve::voxel(order, i), v) << "order " << order << ", number " << i;
      ASSERT_EQ(reference::number_by_steps(order, v), i);
      ASSERT_EQ(curve::number(order, v), i) << "order " << order << ", number " << i;
    }
}

TEST(Curve, EqualsOneStepALevelAtRandomUpToOrderTwenty) {
  std::mt19937_64 random(24);
  for (int order = 7; order <= 20; ++order)
    for (int trial = 0; trial < 3000; ++trial) {
      const std::uint64_t all = std::uint64_t{1} << (3 * order);
      const std::uint64_t i = trial == 0 ? 0 : trial == 1 ? all - 1 : random() % all;
      const curve::Voxel v = reference::voxel_by_steps(order, i);
      ASSERT_EQ(curve::voxel(order, i), v) << "order " << order << ", number " << i;
      ASSERT_EQ(curve::number(order, v), i) << "order " << order << ", number " << i;
      const int level = static_cast<int>(random() % static_cast<unsigned>(order + 1));
      const auto corner = [level](std::int32_t at) { return at >> level << level; };
      const Cube cube{corner(v.x), corner(v.y), corner(v.z), level};
      ASSERT_EQ(curve::cube(order, i, level), cube) << "order " << order << ", number " << i << ", level " << level;
      ASSERT_EQ(curve::first_number(order, cube), i >> (3 * level) << (3 * level));
    }
}

TEST(Curve, WalkingVisitsTheStretchInOrder) {
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 300; ++trial) {
    const int order = 1 + trial % 20;
    const std::uint64_t all = std::uint64_t{1} << (3 * order);
    const std::uint64_t first = trial < 20 ? 0 : random() % all;
    const std::uint64_t last = std::min(all, first + random() % 700);
    std::uint64_t next = first;
    curve::walk(order, first, last,
                [&](const curve::Voxel& v) { ASSERT_EQ(v, reference::voxel_by_steps(order, next++)); });
    EXPECT_EQ(next, last);
  }
  for (int order = 1; order <= 5; ++order) {
    const std::uint64_t all = std::uint64_t{1} << (3 * order);
    std::uint64_t next = 0;
    curve::walk(order, 0, all, [&](const curve::Voxel& v) { ASSERT_EQ(v, reference::voxel_by_steps(order, next++)); });
    EXPECT_EQ(next, all);
  }
}

TEST(Curve, InverseAtDepthTwenty) {
  std::mt19937_64 random(1992);
  for (int order : {1, 7, 13, 19, 20})
    for (int trial = 0; trial < 2000; ++trial) {
      const std::uint64_t i = random() >> (64 - 3 * order);
      ASSERT_EQ(curve::number(order, curve::voxel(order, i)), i);
    }
  EXPECT_EQ(curve::number(20, curve::voxel(20, (std::uint64_t{1} << 60) - 1)), (std::uint64_t{1} << 60) - 1);
}

TEST(Curve, NodesAreIntervals) {
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 2000; ++trial) {
    const int order = 1 + static_cast<int>(random() % 20),
              level = static_cast<int>(random() % static_cast<unsigned>(order + 1));
    const std::uint64_t i = random() >> (64 - 3 * order);
    const Cube cube = curve::cube(order, i, level);
    const std::uint64_t first = curve::first_number(order, cube);
    EXPECT_EQ(first, i >> (3 * level) << (3 * level));
    EXPECT_EQ(cube.level, level);
    // Its corners' numbers are all in the interval.
    const std::int32_t far = cube.side() - 1;
    for (int corner = 0; corner < 8; ++corner) {
      const std::uint64_t number = curve::number(
          order, {cube.x + (corner & 1) * far, cube.y + (corner >> 1 & 1) * far, cube.z + (corner >> 2) * far});
      EXPECT_EQ(number >> (3 * level), first >> (3 * level));
    }
  }
}

TEST(Brick, CurveOrderIsThatOfTheCurve) {
  for (unsigned i = 0; i < 64; ++i) {
    const curve::Voxel v = curve::voxel(2, i);
    EXPECT_EQ(detail::kBrickOrder[0][i],
              detail::brick_bit(static_cast<unsigned>(v.x), static_cast<unsigned>(v.y), static_cast<unsigned>(v.z)));
  }
  for (unsigned bit = 0; bit < 64; ++bit)
    EXPECT_EQ(detail::brick_bit(detail::brick_x(bit), detail::brick_y(bit), detail::brick_z(bit)), bit);
  std::mt19937_64 random(3);
  for (unsigned table = 0; table < 24; ++table) {
    const std::uint64_t bits = random();
    EXPECT_EQ(detail::from_curve_order(detail::to_curve_order(bits, table), table), bits);
  }
}

}  // namespace
}  // namespace blackleaf
