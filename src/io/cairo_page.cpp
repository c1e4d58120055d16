// Pixels and PDF pages by Cairo, in memory. Only this file sees Cairo.

#include <cairo-pdf.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "blackleaf/drawing_file.h"
#include "blackleaf/error.h"

namespace blackleaf {
namespace detail {
namespace {

constexpr double kPointsPerMillimetre = 72 / 25.4;
constexpr double kMostPixels = 32767;  // Cairo's limit for a side
// Lines are painted in groups: Cairo's cost for one path grows faster than its length.
constexpr std::size_t kPointsAtOnce = 512;

struct Destroy {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, Destroy>;
using Context = std::unique_ptr<cairo_t, Destroy>;

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(ErrorCode::io, fmt::format("the picture cannot be made: {}", cairo_status_to_string(status)),
                "make it smaller");
}

cairo_status_t append(void* closure, const unsigned char* data, unsigned length) {
  try {
    auto& bytes = *static_cast<std::vector<std::uint8_t>*>(closure);
    bytes.insert(bytes.end(), data, data + length);
    return CAIRO_STATUS_SUCCESS;
  } catch (const std::bad_alloc&) {
    return CAIRO_STATUS_NO_MEMORY;
  }
}

void paint(cairo_surface_t* surface, const Picture& picture, double units_per_mm) {
  const Context context(cairo_create(surface));
  cairo_t* c = context.get();
  cairo_scale(c, units_per_mm, units_per_mm);
  cairo_set_source_rgb(c, 1, 1, 1);
  cairo_paint(c);
  cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
  for (const Layer& layer : picture.layers) {
    const Pen& pen = layer.pen;
    cairo_set_source_rgb(c, pen.colour.red / 255.0, pen.colour.green / 255.0, pen.colour.blue / 255.0);
    cairo_set_line_width(c, pen.width_mm);
    cairo_set_line_cap(c, pen.dashes_mm.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    cairo_set_dash(c, pen.dashes_mm.data(), static_cast<int>(pen.dashes_mm.size()), 0);
    std::size_t waiting = 0;
    for (std::size_t i = 0; i < layer.lines.size(); ++i) {
      cairo_new_sub_path(c);
      for (const Eigen::Vector2d& point : layer.lines[i]) cairo_line_to(c, point[0], picture.height_mm - point[1]);
      waiting += layer.lines[i].size();
      if (waiting >= kPointsAtOnce) {
        cairo_stroke(c);
        waiting = 0;
      }
    }
    cairo_stroke(c);
  }
  check(cairo_status(c));
}

}  // namespace
}  // namespace detail

std::vector<std::uint8_t> to_png(const Picture& picture, double dots_per_inch) {
  using namespace detail;
  const double dots_per_mm = dots_per_inch / 25.4;
  const double width = std::max(1.0, std::round(picture.width_mm * dots_per_mm));
  const double height = std::max(1.0, std::round(picture.height_mm * dots_per_mm));
  if (!(std::max(width, height) <= kMostPixels))
    throw Error(ErrorCode::bad_argument, fmt::format("a picture of {} x {} pixels is too large", width, height),
                fmt::format("use at most {} pixels a side: a smaller page or fewer dots per inch", kMostPixels));
  const Surface surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height)));
  check(cairo_surface_status(surface.get()));
  paint(surface.get(), picture, dots_per_mm);
  std::vector<std::uint8_t> bytes;
  check(cairo_surface_write_to_png_stream(surface.get(), append, &bytes));
  return bytes;
}

std::vector<std::uint8_t> to_pdf(const Picture& picture) {
  using namespace detail;
  std::vector<std::uint8_t> bytes;
  {
    const Surface surface(cairo_pdf_surface_create_for_stream(append, &bytes, picture.width_mm * kPointsPerMillimetre,
                                                              picture.height_mm * kPointsPerMillimetre));
    check(cairo_surface_status(surface.get()));
    if (!picture.title.empty())
      cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, picture.title.c_str());
    if (!picture.source.empty())
      cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_SUBJECT, picture.source.c_str());
    // A fixed date: the same drawing gives the same bytes.
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
    paint(surface.get(), picture, kPointsPerMillimetre);
    cairo_surface_finish(surface.get());
    check(cairo_surface_status(surface.get()));
  }
  return bytes;
}

}  // namespace blackleaf
