#include "io/cairo_page.h"

#include <cairo-pdf.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "blackleaf/error.h"

namespace blackleaf::detail {
namespace {

constexpr double kPointsPerMillimetre = 72 / 25.4;
constexpr double kMostPixels = 32767;  // Cairo's limit for a side
// Strokes are painted in groups: Cairo's cost for one path grows faster than its length.
constexpr std::size_t kStrokesAtOnce = 256;

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

void paint(cairo_surface_t* surface, const LineDrawing& drawing, const Page& page, double pen_width_mm,
           double units_per_mm) {
  const Context context(cairo_create(surface));
  cairo_t* c = context.get();
  cairo_scale(c, units_per_mm, units_per_mm);
  cairo_set_source_rgb(c, 1, 1, 1);
  cairo_paint(c);
  cairo_set_source_rgb(c, 0, 0, 0);
  cairo_set_line_width(c, pen_width_mm);
  cairo_set_line_cap(c, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
  std::size_t waiting = 0;
  for (const Stroke& stroke : drawing.strokes) {
    cairo_move_to(c, page.x(stroke.from), page.y(stroke.from));
    cairo_line_to(c, page.x(stroke.to), page.y(stroke.to));
    if (++waiting == kStrokesAtOnce) {
      cairo_stroke(c);
      waiting = 0;
    }
  }
  cairo_stroke(c);
  check(cairo_status(c));
}

}  // namespace

std::vector<std::uint8_t> png_bytes(const LineDrawing& drawing, const PageOptions& options) {
  const Page page = lay_out(drawing, options);
  const double dots_per_mm = options.dots_per_inch / 25.4;
  const double width = std::max(1.0, std::round(page.width * dots_per_mm));
  const double height = std::max(1.0, std::round(page.height * dots_per_mm));
  if (std::max(width, height) > kMostPixels)
    throw Error(ErrorCode::bad_argument, fmt::format("a picture of {} x {} pixels is too large", width, height),
                fmt::format("use at most {} pixels a side: a smaller page or fewer dots per inch", kMostPixels));
  const Surface surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height)));
  check(cairo_surface_status(surface.get()));
  paint(surface.get(), drawing, page, options.pen_width_mm, dots_per_mm);
  std::vector<std::uint8_t> bytes;
  check(cairo_surface_write_to_png_stream(surface.get(), append, &bytes));
  return bytes;
}

std::vector<std::uint8_t> pdf_bytes(const LineDrawing& drawing, const PageOptions& options) {
  const Page page = lay_out(drawing, options);
  std::vector<std::uint8_t> bytes;
  {
    const Surface surface(cairo_pdf_surface_create_for_stream(append, &bytes, page.width * kPointsPerMillimetre,
                                                              page.height * kPointsPerMillimetre));
    check(cairo_surface_status(surface.get()));
    if (!options.title.empty())
      cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, options.title.c_str());
    // A fixed date: the same drawing gives the same bytes.
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
    paint(surface.get(), drawing, page, options.pen_width_mm, kPointsPerMillimetre);
    cairo_surface_finish(surface.get());
    check(cairo_surface_status(surface.get()));
  }
  return bytes;
}

}  // namespace blackleaf::detail
