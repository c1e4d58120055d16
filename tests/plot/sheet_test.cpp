#include "blackleaf/sheet.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "blackleaf/error.h"
#include "blackleaf/implicit.h"
#include "blackleaf/set_operations.h"
#include "plot/pictures.h"
#include "plot/stroke_font.h"

namespace blackleaf {
namespace {

// A stair, unlike itself in the mirror: the boxes [2,12)x[2,8)x[1,4) and [2,5)x[2,8)x[4,9).
Octree stair() { return unite(box(4, {2, 2, 1}, {12, 8, 4}), box(4, {2, 2, 4}, {5, 8, 9})); }

std::array<std::vector<Layer>, 4> views_of(const Octree& octree, ProjectionAngle angle) {
  std::array<std::vector<Layer>, 4> views;
  const auto directions = sheet_views(angle);
  for (std::size_t i = 0; i < 4; ++i)
    views[i].push_back({"visible", {.width_mm = 0.5}, polylines(draw(octree, directions[i]).strokes)});
  return views;
}

// Where the solid's bounding box [2,12]x[2,8]x[1,9] lies on the page in a view.
Eigen::AlignedBox2d on_page(const PlacedView& placed) {
  Eigen::AlignedBox2d box;
  for (const double x : {2, 12})
    for (const double y : {2, 8})
      for (const double z : {1, 9}) {
        const Eigen::Vector3d p(x, y, z);
        box.extend(Eigen::Vector2d(placed.x_mm + placed.mm_per_voxel * placed.view.right().dot(p),
                                   placed.y_mm + placed.mm_per_voxel * placed.view.up().dot(p)));
      }
  return box;
}

TEST(Sheet, ViewsStandInLine) {
  for (const ProjectionAngle angle : {ProjectionAngle::first, ProjectionAngle::third}) {
    const bool third = angle == ProjectionAngle::third;
    const Picture sheet = engineering_sheet(views_of(stair(), angle), {.angle = angle});
    ASSERT_EQ(sheet.views.size(), 4u);
    const PlacedView &front = sheet.views[0], &top = sheet.views[1], &side = sheet.views[2], &iso = sheet.views[3];
    EXPECT_EQ(side.name, third ? "right" : "left");
    for (const PlacedView& v : sheet.views) EXPECT_EQ(v.mm_per_voxel, front.mm_per_voxel);
    EXPECT_DOUBLE_EQ(front.x_mm, top.x_mm);
    EXPECT_DOUBLE_EQ(front.y_mm, side.y_mm);
    const auto f = on_page(front), t = on_page(top), s = on_page(side), i = on_page(iso);
    EXPECT_GT(s.min()[0], f.max()[0]);
    if (third) {
      EXPECT_GT(t.min()[1], f.max()[1]);
      EXPECT_GT(i.min()[1], s.max()[1]);
    } else {
      EXPECT_LT(t.max()[1], f.min()[1]);
      EXPECT_LT(i.max()[1], s.min()[1]);
    }
    EXPECT_GT(i.min()[0], std::max(f.max()[0], t.max()[0]));
    // Everything inside the frame, and views above the title block.
    for (const auto& box : {f, t, s, i}) {
      EXPECT_GT(box.min()[0], 20);
      EXPECT_LT(box.max()[0], 287);
      EXPECT_GT(box.min()[1], 38);
      EXPECT_LT(box.max()[1], 200);
    }
    // What was drawn is on the page: as many lines, of the same length.
    double length = 0;
    std::size_t count = 0;
    for (const auto& view : views_of(stair(), angle))
      for (std::size_t k = 0; k < view[0].lines.size(); ++k, ++count)
        length += (view[0].lines[k].front() - view[0].lines[k].back()).norm();
    ASSERT_EQ(sheet.layers[0].name, "visible");
    EXPECT_EQ(sheet.layers[0].lines.size(), count);
    double drawn = 0;
    for (std::size_t k = 0; k < count; ++k)
      drawn += (sheet.layers[0].lines[k].front() - sheet.layers[0].lines[k].back()).norm();
    EXPECT_NEAR(drawn, length * front.mm_per_voxel, 1e-9);
    std::vector<std::string> names;
    for (const Layer& layer : sheet.layers) names.push_back(layer.name);
    EXPECT_EQ(names, (std::vector<std::string>{"visible", "frame", "title block", "text"}));
  }
}

TEST(Sheet, LargestStandardScaleThatFits) {
  std::set<std::string> seen;
  for (const double voxel : {0.001, 0.013, 0.2, 1.0, 7.0, 30.0, 999.0, 12345.0}) {
    SCOPED_TRACE(voxel);
    const auto views = views_of(stair(), ProjectionAngle::third);
    const Picture sheet = engineering_sheet(views, {.voxel_mm = voxel});
    const double scale = sheet.views[0].mm_per_voxel / voxel;
    const std::string text = scale_text(scale);
    seen.insert(text);
    const std::size_t colon = text.find(':');
    const double a = std::stod(text.substr(0, colon)), b = std::stod(text.substr(colon + 1));
    EXPECT_TRUE(a == 1 || b == 1);
    const double decade = std::pow(10.0, std::floor(std::log10(a * b) + 1e-9));
    EXPECT_TRUE(std::set<double>({1, 2, 5}).count(std::round(a * b / decade)) == 1) << text;
    EXPECT_NEAR(scale, a / b, 1e-12 * scale);
    // The next larger one, twice or two and a half times as large, does not fit.
    EXPECT_NO_THROW(engineering_sheet(views, {.voxel_mm = voxel, .scale = scale}));
    EXPECT_THROW(engineering_sheet(views, {.voxel_mm = voxel, .scale = 2.5 * scale}), Error);
  }
  EXPECT_GT(seen.size(), 5u);
  EXPECT_EQ(scale_text(1), "1:1");
  EXPECT_EQ(scale_text(0.4), "1:2.5");
  EXPECT_EQ(scale_text(50), "50:1");
}

TEST(Sheet, Refusals) {
  const auto views = views_of(stair(), ProjectionAngle::third);
  for (const SheetOptions& bad :
       {SheetOptions{.width_mm = 209}, SheetOptions{.height_mm = 60}, SheetOptions{.width_mm = NAN},
        SheetOptions{.voxel_mm = 0}, SheetOptions{.scale = -1}, SheetOptions{.scale = HUGE_VAL},
        SheetOptions{.pen_width_mm = 0}, SheetOptions{.height_mm = 1e6}})
    EXPECT_THROW(engineering_sheet(views, bad), Error);
  EXPECT_NO_THROW(engineering_sheet(views, {.width_mm = 210, .height_mm = 148}));
  try {
    engineering_sheet(views, {.scale = 100});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("at scale 100:1 the views take"), std::string::npos) << error.what();
  }
}

TEST(Sheet, OfNothing) {
  const Picture sheet = engineering_sheet({}, {.title = "empty", .date = "2026-11-22"});
  EXPECT_EQ(sheet.views.size(), 4u);
  EXPECT_EQ(sheet.layers.size(), 3u);
  for (const PlacedView& view : sheet.views) EXPECT_TRUE(std::isfinite(view.x_mm) && std::isfinite(view.y_mm));
}

TEST(StrokeFont, EveryLetterIsDrawnAndDiffers) {
  std::set<std::vector<std::array<double, 4>>> seen;
  for (char c = '!'; c <= '~'; ++c) {
    SCOPED_TRACE(c);
    Polylines lines;
    detail::write_text(lines, std::string(1, c), {0, 0}, 6);
    EXPECT_FALSE(lines.empty());
    for (const Eigen::Vector2d& p : lines.points()) {
      EXPECT_GE(p[0], 0);
      EXPECT_LE(p[0], 4);
      EXPECT_GE(p[1], -2);
      EXPECT_LE(p[1], 7);
    }
    for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_GE(lines[i].size(), 2u);
    EXPECT_TRUE(seen.insert(test::pieces(lines)).second);
  }
  // Not a letter: one box a character, however many bytes.
  Polylines box;
  detail::write_text(box, "\xe2\x82\xac", {0, 0}, 6);
  EXPECT_EQ(box.size(), 1u);
}

TEST(StrokeFont, Lines) {
  Polylines lines;
  detail::write_text(lines, "LL", {10, 20}, 3);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].front(), Eigen::Vector2d(10, 23));
  EXPECT_EQ(lines[0].back(), Eigen::Vector2d(12, 20));
  EXPECT_EQ(lines[1].front(), Eigen::Vector2d(13, 23));
  EXPECT_DOUBLE_EQ(detail::text_width("LL", 3), 5);
  EXPECT_DOUBLE_EQ(detail::text_width("", 3), 0);
  EXPECT_EQ(detail::shortened("short", 3, 100), "short");
  for (const double room : {4.0, 10.0, 25.0, 50.0}) {
    const std::string text = detail::shortened("a long line of text with \xc3\xa9 in it that goes on", 3, room);
    EXPECT_LE(detail::text_width(text, 3), room);
    EXPECT_TRUE(text.ends_with("..."));
  }
}

}  // namespace
}  // namespace blackleaf
