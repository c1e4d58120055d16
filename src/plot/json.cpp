// JSON: strokes with names and pens, as exact numbers.
#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/picture.h"
#include "plot/text_buffer.h"
#include "plot/utf8.h"

namespace blackleaf {
namespace {

using detail::TextBuffer;

void put_string(TextBuffer& out, std::string_view text) {
  out.put('"');
  for (const char c : detail::valid_utf8(text)) {
    if (c == '"' || c == '\\') {
      out.put('\\');
      out.put(c);
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out.put(fmt::format("\\u{:04x}", static_cast<unsigned>(c)));
    } else {
      out.put(c);
    }
  }
  out.put('"');
}

template <class Vector>
void put_numbers(TextBuffer& out, const Vector& numbers) {
  const char* separator = "[";
  for (const auto number : numbers) {
    out.put(separator);
    out.put_exact(static_cast<double>(number));
    separator = ", ";
  }
  out.put(']');
}

void put_view(TextBuffer& out, const View& view) {
  out.put("\"view\": ");
  put_numbers(out, view.direction());
  out.put(", \"right\": ");
  put_numbers(out, view.right());
  out.put(", \"up\": ");
  put_numbers(out, view.up());
  if (!view.eye_point()) return;
  out.put(", \"eye\": ");
  put_numbers(out, view.eye_point()->eye);
  out.put(", \"target\": ");
  put_numbers(out, view.eye_point()->target);
}

void put_strokes(TextBuffer& out, const Polylines& lines) {
  out.put("\"strokes\": [");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    out.put(i == 0 ? "\n" : ",\n");
    const char* separator = "[";
    for (const Eigen::Vector2d& point : lines[i]) {
      if (!point.allFinite()) throw Error(ErrorCode::bad_argument, "the drawing has points that are not finite");
      out.put(separator);
      put_numbers(out, point);
      separator = ", ";
    }
    out.put(']');
  }
  out.put(']');
}

void put_layers(TextBuffer& out, std::span<const Layer> layers) {
  out.put("\"layers\": [");
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Layer& layer = layers[i];
    const PenColour& c = layer.pen.colour;
    out.put(i == 0 ? "\n{\"name\": " : ",\n{\"name\": ");
    put_string(out, layer.name);
    out.put(fmt::format(", \"colour\": \"#{:02x}{:02x}{:02x}\", \"width\": ", c.red, c.green, c.blue));
    out.put_exact(layer.pen.width_mm);
    if (!layer.pen.dashes_mm.empty()) {
      out.put(", \"dashes\": ");
      put_numbers(out, layer.pen.dashes_mm);
    }
    out.put(", ");
    put_strokes(out, layer.lines);
    out.put('}');
  }
  out.put(']');
}

}  // namespace

std::string to_json(const LineDrawing& drawing) { return to_json(polylines(drawing.strokes), drawing.view); }

std::string to_json(const Polylines& strokes, const View& view) {
  TextBuffer out(80 * strokes.size() + 512);
  out.put('{');
  put_view(out, view);
  out.put(",\n");
  put_strokes(out, strokes);
  out.put("}\n");
  return out.take();
}

std::string to_json(std::span<const Layer> layers, const View& view) {
  TextBuffer out;
  out.put('{');
  put_view(out, view);
  out.put(",\n");
  put_layers(out, layers);
  out.put("}\n");
  return out.take();
}

std::string to_json(const Picture& picture) {
  TextBuffer out;
  out.put("{\"page\": ");
  put_numbers(out, std::array{picture.width_mm, picture.height_mm});
  out.put(", \"unit\": \"mm\"");
  if (!picture.title.empty()) {
    out.put(", \"title\": ");
    put_string(out, picture.title);
  }
  if (!picture.source.empty()) {
    out.put(", \"source\": ");
    put_string(out, picture.source);
  }
  out.put(",\n\"views\": [");
  for (std::size_t i = 0; i < picture.views.size(); ++i) {
    const PlacedView& placed = picture.views[i];
    out.put(i == 0 ? "\n{\"name\": " : ",\n{\"name\": ");
    put_string(out, placed.name);
    out.put(", ");
    put_view(out, placed.view);
    out.put(", \"mm_per_voxel\": ");
    out.put_exact(placed.mm_per_voxel);
    out.put(", \"origin\": ");
    put_numbers(out, std::array{placed.x_mm, placed.y_mm});
    out.put('}');
  }
  out.put("],\n");
  put_layers(out, picture.layers);
  out.put("}\n");
  return out.take();
}

}  // namespace blackleaf
