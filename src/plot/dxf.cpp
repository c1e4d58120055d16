// DXF in the form of AutoCAD Release 12, the one that every program reads.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>

#include "blackleaf/picture.h"
#include "plot/text_buffer.h"

namespace blackleaf {
namespace {

using detail::TextBuffer;

// A file is pairs of lines: a group code, which says what follows, and a value.
void put(TextBuffer& out, int code, std::string_view text) {
  out.put_integer(code);
  out.put('\n');
  out.put(text);
  out.put('\n');
}
void put(TextBuffer& out, int code, std::int64_t value) {
  out.put_integer(code);
  out.put('\n');
  out.put_integer(value);
  out.put('\n');
}
void put(TextBuffer& out, int code, double value) {
  out.put_integer(code);
  out.put('\n');
  out.put_decimal(value);
  out.put('\n');
}
void put(TextBuffer& out, int code, const Eigen::Vector2d& point) {
  put(out, code, point[0]);
  put(out, code + 10, point[1]);
}

// AutoCAD's colour numbers 1 to 9.
std::int64_t colour_number(const PenColour& colour) {
  static constexpr std::array<PenColour, 9> kColours{{{255, 0, 0},
                                                      {255, 255, 0},
                                                      {0, 255, 0},
                                                      {0, 255, 255},
                                                      {0, 0, 255},
                                                      {255, 0, 255},
                                                      {0, 0, 0},
                                                      {128, 128, 128},
                                                      {192, 192, 192}}};
  const auto difference = [&](const PenColour& c) {
    const int r = colour.red - c.red, g = colour.green - c.green, b = colour.blue - c.blue;
    return r * r + g * g + b * b;
  };
  std::size_t best = 6;
  for (std::size_t i = 0; i < kColours.size(); ++i)
    if (difference(kColours[i]) < difference(kColours[best])) best = i;
  return static_cast<std::int64_t>(best) + 1;
}

// Release 12 allows 31 letters, digits, $, - and _; names of layers must differ.
std::vector<std::string> layer_names(const Picture& picture) {
  std::vector<std::string> names;
  std::set<std::string> taken{"0"};  // a layer that is always there
  for (const Layer& layer : picture.layers) {
    std::string name;
    for (const char c : layer.name.substr(0, 24)) {
      if (c >= 'a' && c <= 'z')
        name += static_cast<char>(c - 'a' + 'A');
      else
        name += (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ? c : '_';
    }
    if (name.empty()) name = "LAYER";
    std::string unique = name;
    for (int i = 2; !taken.insert(unique).second; ++i) unique = fmt::format("{}_{}", name, i);
    names.push_back(unique);
  }
  return names;
}

std::string line_type(const Picture& picture, std::size_t layer) {
  return picture.layers[layer].pen.dashes_mm.empty() ? "CONTINUOUS" : fmt::format("DASHES{}", layer + 1);
}

void put_line_type(TextBuffer& out, std::string_view name, std::string_view description,
                   const std::vector<double>& dashes) {
  put(out, 0, "LTYPE");
  put(out, 2, name);
  put(out, 70, std::int64_t{0});
  put(out, 3, description);
  put(out, 72, std::int64_t{65});
  put(out, 73, static_cast<std::int64_t>(dashes.size()));
  double length = 0;
  for (const double dash : dashes) length += dash;
  put(out, 40, length);
  // Gaps are negative.
  for (std::size_t i = 0; i < dashes.size(); ++i) put(out, 49, i % 2 == 0 ? dashes[i] : -dashes[i]);
}

void put_head(TextBuffer& out, const Picture& picture, const std::vector<std::string>& names) {
  put(out, 0, "SECTION");
  put(out, 2, "HEADER");
  put(out, 9, "$ACADVER");
  put(out, 1, "AC1009");
  for (const auto& [low, high] : {std::pair{"$EXTMIN", "$EXTMAX"}, std::pair{"$LIMMIN", "$LIMMAX"}}) {
    put(out, 9, low);
    put(out, 10, Eigen::Vector2d(0, 0));
    put(out, 9, high);
    put(out, 10, Eigen::Vector2d(picture.width_mm, picture.height_mm));
  }
  put(out, 0, "ENDSEC");
  put(out, 0, "SECTION");
  put(out, 2, "TABLES");
  std::int64_t types = 1;
  for (const Layer& layer : picture.layers) types += layer.pen.dashes_mm.empty() ? 0 : 1;
  put(out, 0, "TABLE");
  put(out, 2, "LTYPE");
  put(out, 70, types);
  put_line_type(out, "CONTINUOUS", "Solid line", {});
  for (std::size_t i = 0; i < picture.layers.size(); ++i)
    if (!picture.layers[i].pen.dashes_mm.empty())
      put_line_type(out, line_type(picture, i), "Dashes", picture.layers[i].pen.dashes_mm);
  put(out, 0, "ENDTAB");
  put(out, 0, "TABLE");
  put(out, 2, "LAYER");
  put(out, 70, static_cast<std::int64_t>(picture.layers.size() + 1));
  const auto put_layer = [&](std::string_view name, std::int64_t colour, std::string_view type) {
    put(out, 0, "LAYER");
    put(out, 2, name);
    put(out, 70, std::int64_t{0});
    put(out, 62, colour);
    put(out, 6, type);
  };
  put_layer("0", 7, "CONTINUOUS");
  for (std::size_t i = 0; i < picture.layers.size(); ++i)
    put_layer(names[i], colour_number(picture.layers[i].pen.colour), line_type(picture, i));
  put(out, 0, "ENDTAB");
  put(out, 0, "ENDSEC");
}

void put_entity(TextBuffer& out, std::span<const Eigen::Vector2d> line, std::string_view layer) {
  if (line.size() == 2) {
    put(out, 0, "LINE");
    put(out, 8, layer);
    put(out, 10, line[0]);
    put(out, 11, line[1]);
    return;
  }
  put(out, 0, "POLYLINE");
  put(out, 8, layer);
  put(out, 66, std::int64_t{1});  // vertices follow
  put(out, 10, Eigen::Vector2d(0, 0));
  put(out, 70, std::int64_t{0});
  for (const Eigen::Vector2d& point : line) {
    put(out, 0, "VERTEX");
    put(out, 8, layer);
    put(out, 10, point);
  }
  put(out, 0, "SEQEND");
  put(out, 8, layer);
}

}  // namespace

std::string to_dxf(const Picture& picture) {
  TextBuffer out;
  const std::vector<std::string> names = layer_names(picture);
  put_head(out, picture, names);
  put(out, 0, "SECTION");
  put(out, 2, "ENTITIES");
  for (std::size_t i = 0; i < picture.layers.size(); ++i)
    for (std::size_t k = 0; k < picture.layers[i].lines.size(); ++k)
      put_entity(out, picture.layers[i].lines[k], names[i]);
  put(out, 0, "ENDSEC");
  put(out, 0, "EOF");
  return out.take();
}

}  // namespace blackleaf
