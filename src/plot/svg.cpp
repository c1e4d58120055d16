// SVG: one group a layer, one polyline a polyline.
#include <fmt/format.h>

#include "blackleaf/picture.h"
#include "plot/markup.h"
#include "plot/text_buffer.h"
#include "plot/utf8.h"

namespace blackleaf {
namespace {

using detail::TextBuffer;

// Text as XML may hold it: markup escaped, control characters dropped.
std::string escaped(std::string_view text) {
  std::string result = detail::valid_utf8(text);
  std::erase_if(result, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  return detail::markup_text(result);
}

void put_header(TextBuffer& out, const Picture& picture) {
  out.put("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"");
  out.put_decimal(picture.width_mm);
  out.put("mm\" height=\"");
  out.put_decimal(picture.height_mm);
  out.put("mm\" viewBox=\"0 0 ");
  out.put_decimal(picture.width_mm);
  out.put(' ');
  out.put_decimal(picture.height_mm);
  out.put("\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\">\n");
  if (!picture.title.empty()) out.put(fmt::format("<title>{}</title>\n", escaped(picture.title)));
  out.put("<metadata><rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">");
  for (const PlacedView& placed : picture.views) {
    const auto& d = placed.view.direction();
    const Eigen::Vector3d &u = placed.view.right(), &v = placed.view.up();
    out.put("<rdf:Description><drawing xmlns=\"urn:blackleaf\"");
    if (!placed.name.empty()) out.put(fmt::format(" name=\"{}\"", escaped(placed.name)));
    if (!picture.source.empty()) out.put(fmt::format(" source=\"{}\"", escaped(picture.source)));
    // Adding 0 turns -0 into 0.
    if (placed.view.eye_point()) {
      const Eigen::Vector3d &eye = placed.view.eye_point()->eye, &target = placed.view.eye_point()->target;
      out.put(fmt::format(" eye=\"{} {} {}\" target=\"{} {} {}\"", eye[0] + 0, eye[1] + 0, eye[2] + 0, target[0] + 0,
                          target[1] + 0, target[2] + 0));
    }
    out.put(
        fmt::format(" view=\"{} {} {}\" right=\"{} {} {}\" up=\"{} {} {}\" millimetres-per-voxel=\"{}\" "
                    "origin=\"{} {}\"/></rdf:Description>",
                    d[0], d[1], d[2], u[0] + 0, u[1] + 0, u[2] + 0, v[0] + 0, v[1] + 0, v[2] + 0, placed.mm_per_voxel,
                    placed.x_mm + 0, picture.height_mm - placed.y_mm + 0));
  }
  out.put("</rdf:RDF></metadata>\n");
}

void put_layer(TextBuffer& out, const Picture& picture, std::size_t index) {
  const Layer& layer = picture.layers[index];
  const PenColour& c = layer.pen.colour;
  out.put(fmt::format(
      "<g id=\"layer{}\" inkscape:groupmode=\"layer\" inkscape:label=\"{}\" fill=\"none\" "
      "stroke=\"#{:02x}{:02x}{:02x}\" stroke-linecap=\"{}\" stroke-linejoin=\"round\" stroke-width=\"",
      index + 1, escaped(layer.name), c.red, c.green, c.blue, layer.pen.dashes_mm.empty() ? "round" : "butt"));
  out.put_decimal(layer.pen.width_mm);
  const char* separator = "\" stroke-dasharray=\"";
  for (const double length : layer.pen.dashes_mm) {
    out.put(separator);
    out.put_decimal(length);
    separator = " ";
  }
  out.put("\">\n");
  const double top = picture.height_mm;
  for (std::size_t i = 0; i < layer.lines.size(); ++i) {
    char before = '"';
    out.put("<polyline points=");
    for (const Eigen::Vector2d& point : layer.lines[i]) {
      out.put(before);
      out.put_decimal(point[0]);
      out.put(',');
      out.put_decimal(top - point[1]);
      before = ' ';
    }
    out.put("\"/>\n");
  }
  out.put("</g>\n");
}

}  // namespace

std::string to_svg(const Picture& picture) {
  std::size_t points = 0;
  for (const Layer& layer : picture.layers) points += layer.lines.points().size();
  // About 18 characters a point and 23 a polyline.
  TextBuffer out(32 * points + 4096);
  put_header(out, picture);
  for (std::size_t i = 0; i < picture.layers.size(); ++i) put_layer(out, picture, i);
  out.put("</svg>\n");
  return out.take();
}

std::string to_svg(const LineDrawing& drawing, const PageOptions& page) { return to_svg(lay_out(drawing, page)); }

}  // namespace blackleaf
