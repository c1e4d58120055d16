// Pictures as SVG, HP-GL, DXF and JSON, read back by readers of the tests' own.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "blackleaf/error.h"
#include "blackleaf/picture.h"
#include "plot/dashes.h"
#include "plot/pictures.h"
#include "plot/text_buffer.h"
#include "plot/utf8.h"

namespace blackleaf {
namespace {

using test::pieces;

Picture some_picture() {
  Picture picture{210, 148, {}, {}};
  picture.title = "a <solid> & \"its\" shape\n\x01";
  picture.source = "b\xffunny.octree";
  picture.views.push_back({"front", View({12, -16, 15}), 0.5, 10, 20});
  std::mt19937_64 random(81);
  picture.layers.push_back(
      {"visible", {.colour = {255, 0, 16}, .width_mm = 0.35}, test::lattice_lines(random, 40, 140)});
  picture.layers.push_back({"hidden & such", {.dashes_mm = {2, 1.25}}, test::scattered_lines(random, 9)});
  for (Eigen::Vector2d& point : picture.layers[1].lines.points()) point = (point / 2).cwiseMax(0);
  const std::vector<Eigen::Vector2d> bent{{1, 2}, {3, 4}, {100.12345, 5}};
  picture.layers[0].lines.add(bent);
  return picture;
}

TEST(TextBuffer, DecimalsAgainstPrintf) {
  std::mt19937_64 random(82);
  for (int round = 0; round < 20000; ++round) {
    // Whole ten-thousandths, so that printf has nothing to round.
    const auto ticks = static_cast<std::int64_t>(random() % (std::uint64_t{1} << (1 + random() % 45)));
    const double value = (random() % 2 == 0 ? 1 : -1) * static_cast<double>(ticks) / 1e4;
    std::array<char, 64> expected{};
    std::snprintf(expected.data(), expected.size(), "%.4f", value);
    std::string text = expected.data();
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    if (text == "-0") text = "0";
    detail::TextBuffer out;
    out.put_decimal(value);
    EXPECT_EQ(out.take(), text);
  }
  detail::TextBuffer out;
  for (const double value : {-0.00004, 0.00005, -0.00005, 12.34567, -0.0, 999.99996}) {
    out.put_decimal(value);
    out.put(' ');
  }
  EXPECT_EQ(out.take(), "0 0.0001 -0.0001 12.3457 0 1000 ");
}

TEST(Utf8, OnlyWhatIsUtf8Stays) {
  for (const char* good : {"", "plain", "\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x90\xb0", "\xf4\x8f\xbf\xbf"})
    EXPECT_EQ(detail::valid_utf8(good), good);
  EXPECT_EQ(detail::valid_utf8("\xff"
                               "a"),
            "?a");
  EXPECT_EQ(detail::valid_utf8("\xc3"), "?");
  EXPECT_EQ(detail::valid_utf8("\xc0\x80"), "??");
  EXPECT_EQ(detail::valid_utf8("\xed\xa0\x80"), "???");
  EXPECT_EQ(detail::valid_utf8("\xf4\x90\x80\x80"), "????");
  EXPECT_EQ(detail::valid_utf8("\xe2\x82"
                               "b"),
            "??b");
}

TEST(Formats, SvgHasLayersPensAndMetadata) {
  const Picture picture = some_picture();
  const std::string svg = to_svg(picture);
  for (const char* part :
       {"<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"210mm\" height=\"148mm\" viewBox=\"0 0 210 148\"",
        "<title>a &lt;solid&gt; &amp; &quot;its&quot; shape</title>", "source=\"b?unny.octree\"", "name=\"front\"",
        "view=\"12 -16 15\"", "millimetres-per-voxel=\"0.5\"", "origin=\"10 128\"",
        "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"",
        "inkscape:groupmode=\"layer\" inkscape:label=\"visible\"", "inkscape:label=\"hidden &amp; such\"",
        "stroke=\"#ff0010\"", "stroke-width=\"0.35\"", "stroke-dasharray=\"2 1.25\"",
        "<polyline points=\"1,146 3,144 100.1235,143\"/>"})
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  std::size_t count = 0;
  for (std::size_t at = 0; (at = svg.find("<polyline", at)) != std::string::npos; ++at) ++count;
  EXPECT_EQ(count, 50u);
}

TEST(Formats, JsonHasAllNumbers) {
  const Picture picture = some_picture();
  const auto json = nlohmann::json::parse(to_json(picture));
  EXPECT_EQ(json["page"], nlohmann::json({210, 148}));
  EXPECT_EQ(json["source"], "b?unny.octree");
  EXPECT_EQ(json["title"], picture.title);
  EXPECT_EQ(json["views"][0]["view"], nlohmann::json({12, -16, 15}));
  EXPECT_EQ(json["views"][0]["origin"], nlohmann::json({10, 20}));
  ASSERT_EQ(json["layers"].size(), 2u);
  EXPECT_EQ(json["layers"][0]["colour"], "#ff0010");
  EXPECT_EQ(json["layers"][1]["dashes"], nlohmann::json({2, 1.25}));
  for (std::size_t l = 0; l < 2; ++l) {
    const Polylines& lines = picture.layers[l].lines;
    ASSERT_EQ(json["layers"][l]["strokes"].size(), lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (std::size_t k = 0; k < lines[i].size(); ++k)
        EXPECT_EQ(json["layers"][l]["strokes"][i][k], nlohmann::json({lines[i][k][0], lines[i][k][1]}));
  }
  const auto layers = nlohmann::json::parse(to_json(picture.layers, View({0, 0, 1})));
  EXPECT_EQ(layers["layers"], json["layers"]);
  EXPECT_EQ(layers["up"], nlohmann::json({0, 1, 0}));
  Picture bad = picture;
  bad.layers[0].lines.points()[0][0] = std::nan("");
  EXPECT_THROW(to_json(bad), Error);
}

// What a plotter draws with each pen, in plotter units.
std::map<int, Polylines> plotted(const std::string& hpgl) {
  std::map<int, Polylines> result;
  int pen = 0;
  std::vector<Eigen::Vector2d> line;
  Eigen::Vector2d at(0, 0);
  std::istringstream in(hpgl);
  std::string instruction;
  const auto lift = [&] {
    if (line.size() > 1) result[pen].add(line);
    line.clear();
  };
  bool first = true, down = false;
  while (std::getline(in >> std::ws, instruction, ';')) {
    const std::string name = instruction.substr(0, 2);
    EXPECT_EQ(first, name == "IN");
    first = false;
    std::vector<double> numbers;
    std::istringstream rest(instruction.substr(2));
    for (std::string number; std::getline(rest, number, ',');) numbers.push_back(std::stod(number));
    if (name == "SP") {
      EXPECT_FALSE(down) << "the pen is lifted before it is changed";
      lift();
      pen = static_cast<int>(numbers.at(0));
    } else if (name == "PU") {
      lift();
      down = false;
      if (!numbers.empty()) at = {numbers.at(0), numbers.at(1)};
    } else if (name == "PD") {
      if (line.empty()) line.push_back(at);
      down = true;
      EXPECT_EQ(numbers.size() % 2, 0u);
      for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) line.push_back(at = {numbers[i], numbers[i + 1]});
    } else {
      EXPECT_TRUE(name == "IN" || name == "PA") << name;
    }
  }
  lift();
  EXPECT_EQ(pen, 0);
  return result;
}

Polylines in_units(const Polylines& lines) {
  Polylines result;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::vector<Eigen::Vector2d> line;
    for (const Eigen::Vector2d& p : lines[i]) line.push_back({std::round(p[0] * 40), std::round(p[1] * 40)});
    result.add(line);
  }
  return result;
}

TEST(Formats, HpglDrawsTheSameLines) {
  const Picture picture = some_picture();
  const auto pens = plotted(to_hpgl(picture));
  ASSERT_EQ(pens.size(), 2u);
  EXPECT_EQ(pieces(pens.at(1)), pieces(in_units(picture.layers[0].lines)));
  EXPECT_EQ(pieces(pens.at(2)), pieces(in_units(detail::dashed(picture.layers[1].lines, {2, 1.25}))));
}

TEST(Formats, HpglPens) {
  Picture picture{100, 100, {}, {}};
  for (int i = 0; i < 10; ++i) {
    picture.layers.push_back({std::to_string(i), {.width_mm = 0.1 + 0.1 * (i / 2 * 2)}, {}});
    picture.layers.back().lines.add({1.0 * i, 0}, {1.0 * i, 10});
  }
  // Layers of one pen are drawn without fetching it again.
  EXPECT_EQ(plotted(to_hpgl(picture)).size(), 5u);
  for (int i = 0; i < 10; ++i) picture.layers[static_cast<std::size_t>(i)].pen.width_mm = 1 + i;
  const auto pens = plotted(to_hpgl(picture));
  EXPECT_EQ(pens.size(), 8u);  // as many as a carousel holds
  EXPECT_EQ(pens.at(1).size(), 2u);
  EXPECT_EQ(to_hpgl(Picture{100, 100, {}, {}}), "IN;PA;\nPU;SP0;\n");
}

TEST(Formats, HpglLongLinesDotsAndLimits) {
  Picture picture = test::page_of({});
  std::vector<Eigen::Vector2d> spiral;
  for (int i = 0; i < 1000; ++i) spiral.push_back({100 + 0.1 * i * std::cos(i), 100 + 0.1 * i * std::sin(i)});
  picture.layers[0].lines.add(spiral);
  picture.layers[0].lines.add({7, 7}, {7.001, 7.001});
  const auto pens = plotted(to_hpgl(picture));
  ASSERT_EQ(pens.at(1).size(), 2u);
  EXPECT_EQ(pens.at(1)[1].size(), 2u) << "a dot stays";
  EXPECT_EQ(pens.at(1)[1].front(), pens.at(1)[1].back());
  for (const Eigen::Vector2d& bad : {Eigen::Vector2d(820, 0), Eigen::Vector2d(0, -1), Eigen::Vector2d(NAN, 0)}) {
    Picture outside = test::page_of({});
    outside.layers[0].lines.add({0, 0}, bad);
    EXPECT_THROW(to_hpgl(outside), Error);
  }
}

TEST(Formats, DxfReadBack) {
  Picture picture = some_picture();
  picture.layers.push_back(picture.layers[0]);  // a second layer of the same name
  std::istringstream in(to_dxf(picture));
  std::vector<std::pair<int, std::string>> groups;
  for (std::string code, value; std::getline(in, code) && std::getline(in, value);)
    groups.emplace_back(std::stoi(code), value);
  ASSERT_GT(groups.size(), 10u);
  EXPECT_EQ(groups.back(), (std::pair{0, std::string("EOF")}));
  std::map<std::string, Polylines> lines;
  std::map<std::string, std::pair<std::string, std::string>> layers;  // colour, line type
  std::vector<std::string> sections;
  std::string version;
  std::vector<Eigen::Vector2d> polyline;
  for (std::size_t i = 0; i < groups.size();) {
    const std::string what = groups[i].second;
    EXPECT_EQ(groups[i].first, 0);
    std::map<int, std::string> fields;
    const std::size_t begin = ++i;
    for (; i < groups.size() && groups[i].first != 0; ++i) {
      // Only gaps of line types and variables of the header come more than once.
      EXPECT_TRUE(fields.insert(groups[i]).second || groups[i].first == 49 || what == "SECTION") << what << begin;
      if (groups[i].second == "$ACADVER") version = groups[i + 1].second;
    }
    const auto point = [&](int code) {
      return Eigen::Vector2d(std::stod(fields.at(code)), std::stod(fields.at(code + 10)));
    };
    if (what == "SECTION") sections.push_back(fields.at(2));
    if (what == "LAYER") layers[fields.at(2)] = {fields.at(62), fields.at(6)};
    if (what == "LINE") lines[fields.at(8)].add(point(10), point(11));
    if (what == "VERTEX") polyline.push_back(point(10));
    if (what == "SEQEND") {
      lines[fields.at(8)].add(polyline);
      polyline.clear();
    }
  }
  EXPECT_EQ(version, "AC1009");
  EXPECT_EQ(sections, (std::vector<std::string>{"HEADER", "TABLES", "ENTITIES"}));
  EXPECT_EQ(layers.size(), 4u);
  EXPECT_EQ(layers.at("VISIBLE"), (std::pair<std::string, std::string>{"1", "CONTINUOUS"}));
  EXPECT_EQ(layers.at("HIDDEN___SUCH"), (std::pair<std::string, std::string>{"7", "DASHES2"}));
  const auto close = [](const Polylines& a, const Polylines& b) {
    const auto x = pieces(a), y = pieces(b);
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(x[i][k], y[i][k], 5.1e-5);
  };
  close(lines.at("VISIBLE"), picture.layers[0].lines);
  close(lines.at("HIDDEN___SUCH"), picture.layers[1].lines);
  close(lines.at("VISIBLE_2"), picture.layers[2].lines);
}

}  // namespace
}  // namespace blackleaf
