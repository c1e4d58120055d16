#include "blackleaf/drawing_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <random>

#include "blackleaf/implicit.h"
#include "file/temporary_folder.h"

namespace blackleaf {
namespace {

using test::expect_error;

LineDrawing some_drawing() {
  LineDrawing drawing{View({12, -16, 15}), {}};
  drawing.strokes = {{{-1.25, 0.1}, {2.0 / 3, 4}}, {{0, 0}, {1e-17, 1}}, {{-1.25, -3}, {6, -3}}};
  return drawing;
}

// The points of all polylines, in millimetres.
std::vector<std::array<double, 4>> polylines(const std::string& svg) {
  std::vector<std::array<double, 4>> result;
  for (std::size_t at = 0; (at = svg.find("<polyline ", at)) != std::string::npos; ++at) {
    std::array<double, 4> line{};
    EXPECT_EQ(
        std::sscanf(svg.c_str() + at, "<polyline points=\"%lf,%lf %lf,%lf\"/>", &line[0], &line[1], &line[2], &line[3]),
        4);
    result.push_back(line);
  }
  return result;
}

std::array<double, 2> page_of(const std::string& svg) {
  std::array<double, 4> sides{};
  const std::size_t at = svg.find("width=\"");
  EXPECT_NE(at, std::string::npos);
  EXPECT_EQ(std::sscanf(svg.c_str() + at, "width=\"%lfmm\" height=\"%lfmm\" viewBox=\"0 0 %lf %lf\">", &sides[0],
                        &sides[1], &sides[2], &sides[3]),
            4);
  EXPECT_EQ(sides[0], sides[2]);
  EXPECT_EQ(sides[1], sides[3]);
  return {sides[0], sides[1]};
}

TEST(DrawingFile, JsonIsAsTheContractSays) {
  const LineDrawing drawing = some_drawing();
  const auto json = nlohmann::json::parse(to_json(drawing));
  EXPECT_EQ(json.size(), 4u);
  EXPECT_EQ(json["view"], nlohmann::json({12, -16, 15}));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(json["right"][static_cast<std::size_t>(i)].get<double>(), drawing.view.right()[i]);
    EXPECT_EQ(json["up"][static_cast<std::size_t>(i)].get<double>(), drawing.view.up()[i]);
  }
  ASSERT_EQ(json["strokes"].size(), drawing.strokes.size());
  for (std::size_t i = 0; i < drawing.strokes.size(); ++i)
    for (int k = 0; k < 2; ++k) {
      EXPECT_EQ(json["strokes"][i][0][static_cast<std::size_t>(k)].get<double>(), drawing.strokes[i].from[k]);
      EXPECT_EQ(json["strokes"][i][1][static_cast<std::size_t>(k)].get<double>(), drawing.strokes[i].to[k]);
    }
  EXPECT_EQ(nlohmann::json::parse(to_json({View({0, 0, 1}), {}}))["strokes"], nlohmann::json::array());
}

TEST(DrawingFile, JsonNumbersRoundTrip) {
  std::mt19937_64 random(12);
  LineDrawing drawing{View({1, 0, 0}), {}};
  const auto number = [&] {
    return std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())), -static_cast<int>(random() % 80));
  };
  for (int i = 0; i < 2000; ++i) drawing.strokes.push_back({{number(), number()}, {number(), number()}});
  const auto json = nlohmann::json::parse(to_json(drawing));
  for (std::size_t i = 0; i < drawing.strokes.size(); ++i) {
    ASSERT_EQ(json["strokes"][i][0][0].get<double>(), drawing.strokes[i].from[0]);
    ASSERT_EQ(json["strokes"][i][1][1].get<double>(), drawing.strokes[i].to[1]);
  }
}

TEST(DrawingFile, SvgMapsTheDrawingOntoThePage) {
  const LineDrawing drawing = some_drawing();  // 7.25 wide, 7 high
  for (const PageOptions& options :
       {PageOptions{}, PageOptions{.width_mm = 210, .height_mm = 297}, PageOptions{.width_mm = 100},
        PageOptions{.height_mm = 50, .margin_mm = 0}, PageOptions{.width_mm = 297, .height_mm = 30}}) {
    const std::string svg = to_svg(drawing, options);
    const auto lines = polylines(svg);
    const auto page = page_of(svg);
    ASSERT_EQ(lines.size(), 3u);
    double min_x = 1e9, max_x = -1e9, min_y = 1e9, max_y = -1e9;
    for (const auto& l : lines) {
      min_x = std::min({min_x, l[0], l[2]});
      max_x = std::max({max_x, l[0], l[2]});
      min_y = std::min({min_y, l[1], l[3]});
      max_y = std::max({max_y, l[1], l[3]});
    }
    // Inside the margins, centred, touching them on one axis at least, one scale for both, y downward.
    const double m = options.margin_mm;
    EXPECT_GE(min_x, m - 1e-3);
    EXPECT_GE(min_y, m - 1e-3);
    EXPECT_NEAR(min_x + max_x, page[0], 1e-3);
    EXPECT_NEAR(min_y + max_y, page[1], 1e-3);
    EXPECT_NEAR(std::min(min_x, min_y), m, 1e-3);
    EXPECT_NEAR((max_x - min_x) / 7.25, (max_y - min_y) / 7, 1e-3);
    EXPECT_GT(lines[0][1], lines[0][3]);
    if (options.width_mm > 0) {
      EXPECT_EQ(page[0], options.width_mm);
    }
    if (options.height_mm > 0) {
      EXPECT_EQ(page[1], options.height_mm);
    }
  }
  EXPECT_EQ(page_of(to_svg(drawing))[0], 180);
  EXPECT_NEAR(page_of(to_svg(drawing))[1], 20 + 160 * 7 / 7.25, 1e-3);
}

TEST(DrawingFile, SvgNumbersAreCompact) {
  LineDrawing drawing{View({0, 0, 1}), {{{0, 0}, {1, 0}}, {{0, 0}, {0.5, 0.25}}, {{0, 0}, {1.0 / 3, 1}}}};
  const std::string svg = to_svg(drawing, {.width_mm = 1, .height_mm = 1, .margin_mm = 0});
  EXPECT_NE(svg.find("points=\"0,1 1,1\""), std::string::npos) << svg;
  EXPECT_NE(svg.find("points=\"0,1 0.5,0.75\""), std::string::npos) << svg;
  EXPECT_NE(svg.find("points=\"0,1 0.3333,0\""), std::string::npos) << svg;
  EXPECT_EQ(svg.find("-0"), std::string::npos);
}

TEST(DrawingFile, SvgTellsWhatItIs) {
  const std::string svg = to_svg(some_drawing(), {.title = "a <solid> & \"its\" shape\n\x01"});
  EXPECT_NE(svg.find("<title>a &lt;solid&gt; &amp; &quot;its&quot; shape</title>"), std::string::npos) << svg;
  EXPECT_NE(svg.find("view=\"12 -16 15\""), std::string::npos);
  EXPECT_NE(svg.find("stroke-linecap=\"round\""), std::string::npos);
}

TEST(DrawingFile, EmptyAndDegenerateDrawings) {
  const test::TemporaryFolder folder;
  const LineDrawing empty{View({1, 2, 3}), {}};
  const LineDrawing upright{View({1, 2, 3}), {{{3, 0}, {3, 5}}}};
  for (const LineDrawing& drawing : {empty, upright})
    for (const PageOptions& options :
         {PageOptions{}, PageOptions{.width_mm = 50}, PageOptions{.height_mm = 50, .margin_mm = 0}}) {
      const std::string svg = to_svg(drawing, options);
      EXPECT_EQ(polylines(svg).size(), drawing.strokes.size());
      EXPECT_EQ(svg.find("nan"), std::string::npos);
      EXPECT_EQ(svg.find("inf"), std::string::npos);
      for (const char* name : {"a.svg", "a.json", "a.png", "a.pdf"}) write_drawing(drawing, folder / name, options);
      EXPECT_TRUE(test::read_text(folder / "a.png").starts_with("\x89PNG\r\n\x1A\n"));
      EXPECT_TRUE(test::read_text(folder / "a.pdf").starts_with("%PDF-"));
    }
  EXPECT_EQ(folder.names().size(), 4u);
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

TEST(DrawingFile, PicturesHaveTheirSizeAndAlwaysTheSameBytes) {
  const test::TemporaryFolder folder;
  const LineDrawing drawing = draw(ball(5, {16, 16, 16}, 8), View({12, -16, 15}));
  ASSERT_GT(drawing.strokes.size(), 10u);
  const PageOptions page{.width_mm = 127, .height_mm = 50.8, .dots_per_inch = 100, .title = "ball"};
  for (const char* name : {"a.png", "b.png", "a.pdf", "b.pdf", "a.svg", "b.svg"})
    write_drawing(drawing, folder / name, page);
  const std::string png = test::read_text(folder / "a.png");
  EXPECT_EQ(big_endian(png, 16), 500u);
  EXPECT_EQ(big_endian(png, 20), 200u);
  EXPECT_NE(test::read_text(folder / "a.pdf").find("MediaBox [ 0 0 360 144 ]"), std::string::npos);
  EXPECT_EQ(png, test::read_text(folder / "b.png"));
  EXPECT_EQ(test::read_text(folder / "a.pdf"), test::read_text(folder / "b.pdf"));
  EXPECT_EQ(test::read_text(folder / "a.svg"), test::read_text(folder / "b.svg"));
  // Strokes make a picture different from a blank one.
  write_drawing({drawing.view, {}}, folder / "blank.png", page);
  EXPECT_NE(png, test::read_text(folder / "blank.png"));
}

TEST(DrawingFile, OptionsThatAreNotPossible) {
  const test::TemporaryFolder folder;
  const LineDrawing drawing = some_drawing();
  const auto refuse = [&](const PageOptions& options, const std::string& piece) {
    expect_error(ErrorCode::bad_argument, {piece}, [&] { write_drawing(drawing, folder / "a.svg", options); });
    expect_error(ErrorCode::bad_argument, {piece}, [&] { write_drawing(drawing, folder / "a.png", options); });
  };
  refuse({.width_mm = 20, .height_mm = 100}, "too small for margins of 10 mm");
  refuse({.height_mm = 15}, "too small for margins");
  refuse({.margin_mm = 90}, "too small for margins of 90 mm");
  refuse({.width_mm = -1}, "page width of -1");
  refuse({.height_mm = NAN}, "page height of nan");
  refuse({.width_mm = HUGE_VAL}, "page width of inf");
  refuse({.margin_mm = -1}, "margin of -1");
  refuse({.pen_width_mm = 0}, "pen width of 0");
  refuse({.dots_per_inch = 0}, "resolution of 0");
  expect_error(ErrorCode::bad_argument, {"pixels"},
               [&] { write_drawing(drawing, folder / "a.png", {.width_mm = 10000, .height_mm = 10000}); });
  expect_error(ErrorCode::bad_argument, {"a.bmp", "use .svg"}, [&] { write_drawing(drawing, folder / "a.bmp"); });
  expect_error(ErrorCode::bad_argument, {"use .svg"}, [&] { write_drawing(drawing, folder / "svg"); });
  for (const char* name : {"a.svg", "a.json", "a.png", "a.pdf", "a.hpgl", "a.dxf"})
    expect_error(ErrorCode::io, {"cannot be written"}, [&] { write_drawing(drawing, folder / "no" / name); });
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace blackleaf
