#include "blackleaf/pen_order.h"

#include <gtest/gtest.h>

#include "plot/pictures.h"

namespace blackleaf {
namespace {

using test::lattice_lines;
using test::page_of;
using test::pieces;
using test::scattered_lines;

TEST(PenTravel, OfASquare) {
  Polylines lines;
  lines.add({10, 0}, {20, 0});
  lines.add({20, 0}, {20, 10});  // on without a lift
  lines.add({10, 10}, {20, 10});
  lines.add({10, 0}, {10, 10});
  const PenTravel travel = pen_travel(page_of(lines));
  EXPECT_EQ(travel.strokes, 4u);
  EXPECT_DOUBLE_EQ(travel.down_mm, 40);
  EXPECT_DOUBLE_EQ(travel.up_mm, 10 + 10 + std::sqrt(200.0));
  EXPECT_EQ(travel.lifts, 3u);
  const Picture ordered = in_pen_order(page_of(lines));
  const PenTravel after = pen_travel(ordered);
  EXPECT_EQ(after.strokes, 4u);
  EXPECT_DOUBLE_EQ(after.down_mm, 40);
  EXPECT_DOUBLE_EQ(after.up_mm, 10);
  EXPECT_EQ(after.lifts, 1u);
  ASSERT_EQ(ordered.layers[0].lines.size(), 1u);
  EXPECT_EQ(ordered.layers[0].lines[0].size(), 5u);
  EXPECT_EQ(pen_travel(Picture{}).lifts, 0u);
}

TEST(PenTravel, EveryLayerTakesThePenAnew) {
  Picture picture{100, 100, {}, {}};
  for (const char* name : {"a", "b"}) {
    picture.layers.push_back({name, {}, {}});
    picture.layers.back().lines.add({0, 0}, {30, 40});
  }
  const PenTravel travel = pen_travel(picture);
  EXPECT_EQ(travel.lifts, 2u);
  EXPECT_DOUBLE_EQ(travel.up_mm, 50);
  EXPECT_DOUBLE_EQ(pen_travel(in_pen_order(picture)).up_mm, 0);
}

TEST(PenOrder, SameLinesAndNeverFarther) {
  std::mt19937_64 random(61);
  for (int round = 0; round < 400; ++round) {
    SCOPED_TRACE(round);
    const std::size_t count = 1 + random() % 120;
    Picture picture = page_of(round % 2 == 0 ? lattice_lines(random, count, 3 + static_cast<unsigned>(random() % 30))
                                             : scattered_lines(random, count));
    picture.layers.push_back({"hidden", {.dashes_mm = {2, 1}}, scattered_lines(random, random() % 20)});
    picture.title = "t";
    for (const Joining joining : {Joining::chains, Joining::strokes}) {
      const Picture ordered = in_pen_order(picture, joining);
      const PenTravel before = pen_travel(picture), after = pen_travel(ordered);
      EXPECT_EQ(after.strokes, before.strokes);
      EXPECT_NEAR(after.down_mm, before.down_mm, 1e-6);
      EXPECT_LE(after.up_mm, before.up_mm);
      ASSERT_EQ(ordered.layers.size(), 2u);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(pieces(ordered.layers[i].lines), pieces(picture.layers[i].lines));
        EXPECT_EQ(ordered.layers[i].pen, picture.layers[i].pen);
      }
      if (joining == Joining::strokes) {
        EXPECT_EQ(ordered.layers[0].lines.size(), count);
      }
      EXPECT_EQ(ordered.layers[1].lines.size(), picture.layers[1].lines.size());
      EXPECT_EQ(ordered.title, "t");
    }
    // Strokes in a row are drawn as chains are.
    EXPECT_EQ(pen_travel(in_pen_order(picture, Joining::strokes)).lifts, pen_travel(in_pen_order(picture)).lifts);
  }
}

TEST(PenOrder, ShortWays) {
  std::mt19937_64 random(62);
  const Picture picture = page_of(scattered_lines(random, 3000));
  const PenTravel before = pen_travel(picture), after = pen_travel(in_pen_order(picture));
  // Random lines are a hundred millimetres apart, those in order about as far as their density says.
  EXPECT_LT(after.up_mm, 0.04 * before.up_mm);
}

TEST(PenOrder, AnOrderThatIsBestStays) {
  Polylines lines;
  for (int i = 0; i < 50; ++i) lines.add({2.0 * i, 0}, {2.0 * i + 1, 0});
  const Picture picture = page_of(lines);
  EXPECT_DOUBLE_EQ(pen_travel(in_pen_order(picture)).up_mm, 49);
}

TEST(PenOrder, ClosedChainsBeginWhereThePenComesFrom) {
  Polylines lines;
  const std::vector<Eigen::Vector2d> square{{60, 60}, {50, 60}, {50, 50}, {60, 50}, {60, 60}};
  lines.add(square);
  lines.add({10, 10}, {20, 20});
  const Picture ordered = in_pen_order(page_of(lines));
  EXPECT_NEAR(pen_travel(ordered).up_mm, std::sqrt(200.0) + std::sqrt(1800.0), 1e-9);
}

}  // namespace
}  // namespace blackleaf
