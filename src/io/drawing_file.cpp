#include "blackleaf/drawing_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/atomic_write.h"
#include "io/cairo_page.h"
#include "io/image_io.h"
#include "io/page.h"

namespace blackleaf {
namespace {

// A number of millimetres with at most four decimals, no trailing zeros and no "-0". Requires: |value| < 1e14.
void put_mm(fmt::memory_buffer& out, double value) {
  auto ticks = static_cast<std::int64_t>(std::llround(value * 1e4));
  if (ticks < 0) {
    out.push_back('-');
    ticks = -ticks;
  }
  fmt::format_to(fmt::appender(out), "{}", ticks / 10000);
  std::int64_t rest = ticks % 10000;
  if (rest == 0) return;
  int digits = 4;
  for (; rest % 10 == 0; rest /= 10) --digits;
  fmt::format_to(fmt::appender(out), ".{:0{}}", rest, digits);
}

// Text as XML may hold it: markup escaped, control characters dropped.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else if (static_cast<unsigned char>(c) >= 0x20 && c != 0x7F)
      result += c;
  }
  return result;
}

void put_text(fmt::memory_buffer& out, std::string_view text) { out.append(text.data(), text.data() + text.size()); }

}  // namespace

std::string to_svg(const LineDrawing& drawing, const PageOptions& options) {
  const detail::Page page = detail::lay_out(drawing, options);
  fmt::memory_buffer out;
  put_text(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"");
  put_mm(out, page.width);
  put_text(out, "mm\" height=\"");
  put_mm(out, page.height);
  put_text(out, "mm\" viewBox=\"0 0 ");
  put_mm(out, page.width);
  put_text(out, " ");
  put_mm(out, page.height);
  put_text(out, "\">\n");
  if (!options.title.empty()) fmt::format_to(fmt::appender(out), "<title>{}</title>\n", escaped(options.title));
  const auto& d = drawing.view.direction();
  const Eigen::Vector3d &u = drawing.view.right(), &v = drawing.view.up();
  fmt::format_to(fmt::appender(out),
                 "<metadata><drawing xmlns=\"urn:blackleaf\" view=\"{} {} {}\" right=\"{} {} {}\" up=\"{} {} {}\" "
                 "millimetres-per-voxel=\"{}\" strokes=\"{}\"/></metadata>\n",
                 d[0], d[1], d[2], u[0], u[1], u[2], v[0], v[1], v[2], page.scale, drawing.strokes.size());
  put_text(out, "<g fill=\"none\" stroke=\"#000\" stroke-linecap=\"round\" stroke-linejoin=\"round\" stroke-width=\"");
  put_mm(out, options.pen_width_mm);
  put_text(out, "\">\n");
  for (const Stroke& stroke : drawing.strokes) {
    put_text(out, "<polyline points=\"");
    put_mm(out, page.x(stroke.from));
    out.push_back(',');
    put_mm(out, page.y(stroke.from));
    out.push_back(' ');
    put_mm(out, page.x(stroke.to));
    out.push_back(',');
    put_mm(out, page.y(stroke.to));
    put_text(out, "\"/>\n");
  }
  put_text(out, "</g>\n</svg>\n");
  return fmt::to_string(out);
}

std::string to_json(const LineDrawing& drawing) {
  fmt::memory_buffer out;
  const auto& d = drawing.view.direction();
  const Eigen::Vector3d &u = drawing.view.right(), &v = drawing.view.up();
  // "{}" writes the shortest text that gives the same double back; adding 0 turns -0 into 0.
  fmt::format_to(fmt::appender(out),
                 "{{\"view\": [{}, {}, {}], \"right\": [{}, {}, {}], \"up\": [{}, {}, {}],\n\"strokes\": [", d[0], d[1],
                 d[2], u[0] + 0, u[1] + 0, u[2] + 0, v[0] + 0, v[1] + 0, v[2] + 0);
  const char* separator = "\n";
  for (const Stroke& s : drawing.strokes) {
    if (!s.from.allFinite() || !s.to.allFinite())
      throw Error(ErrorCode::bad_argument, "the drawing has points that are not finite");
    fmt::format_to(fmt::appender(out), "{}[[{}, {}], [{}, {}]]", separator, s.from[0] + 0, s.from[1] + 0, s.to[0] + 0,
                   s.to[1] + 0);
    separator = ",\n";
  }
  put_text(out, "]}\n");
  return fmt::to_string(out);
}

void write_drawing(const LineDrawing& drawing, const std::filesystem::path& path, const PageOptions& page) {
  const std::string suffix = detail::image_suffix(path);
  if (suffix == ".svg")
    detail::write_atomically(path, to_svg(drawing, page));
  else if (suffix == ".json")
    detail::write_atomically(path, to_json(drawing));
  else if (suffix == ".png")
    detail::write_atomically(path, detail::png_bytes(drawing, page));
  else if (suffix == ".pdf")
    detail::write_atomically(path, detail::pdf_bytes(drawing, page));
  else
    throw Error(ErrorCode::bad_argument, fmt::format("{}: drawings are not written as '{}'", path.string(), suffix),
                "use .svg, .json, .png or .pdf");
}

}  // namespace blackleaf
