#include "io/page.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "blackleaf/error.h"

namespace blackleaf::detail {
namespace {

constexpr double kMost = 1e5;        // of any option: a page of 100 m
constexpr double kLongerSide = 180;  // millimetres, when the options leave both sides open

void check(const PageOptions& options) {
  const auto fail = [](const std::string& what, const char* remedy) {
    throw Error(ErrorCode::bad_argument, what, remedy);
  };
  const auto require = [&](double value, bool good, const char* name) {
    if (!std::isfinite(value) || !good)
      fail(fmt::format("a {} of {} is not possible", name, value), "give a positive number");
  };
  require(options.width_mm, options.width_mm >= 0, "page width");
  require(options.height_mm, options.height_mm >= 0, "page height");
  require(options.margin_mm, options.margin_mm >= 0, "margin");
  require(options.pen_width_mm, options.pen_width_mm > 0, "pen width");
  require(options.dots_per_inch, options.dots_per_inch > 0, "resolution");
  const double width = options.width_mm > 0 ? options.width_mm : kLongerSide;
  const double height = options.height_mm > 0 ? options.height_mm : kLongerSide;
  if (std::min(width, height) <= 2 * options.margin_mm)
    fail(fmt::format("a page of {} x {} mm is too small for margins of {} mm", width, height, options.margin_mm),
         "give a larger page or smaller margins");
}

}  // namespace

Page lay_out(const LineDrawing& drawing, const PageOptions& options) {
  check(options);
  Eigen::AlignedBox2d box;
  for (const Stroke& stroke : drawing.strokes) box.extend(stroke.from).extend(stroke.to);
  if (options.region) box = *options.region;
  const bool nothing = box.isEmpty();
  if (nothing) box = Eigen::AlignedBox2d(Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero());
  if (!box.min().allFinite() || !box.max().allFinite())
    throw Error(ErrorCode::bad_argument, "the drawing has points that are not finite");
  const Eigen::Vector2d extent = box.sizes();
  const double margins = 2 * options.margin_mm;
  const double room_x = (options.width_mm > 0 ? options.width_mm : kLongerSide) - margins;
  const double room_y = (options.height_mm > 0 ? options.height_mm : kLongerSide) - margins;
  // A side left open gives way to the other: only when both are open, or the drawing is too long, does 180 mm bind.
  Page page;
  const double fit_x = extent[0] > 0 ? room_x / extent[0] : std::numeric_limits<double>::infinity();
  const double fit_y = extent[1] > 0 ? room_y / extent[1] : std::numeric_limits<double>::infinity();
  page.scale = std::min(fit_x, fit_y);
  if (options.width_mm > 0 && options.height_mm <= 0 && std::isfinite(fit_x)) page.scale = fit_x;
  if (options.height_mm > 0 && options.width_mm <= 0 && std::isfinite(fit_y)) page.scale = fit_y;
  if (!std::isfinite(page.scale)) page.scale = 1;  // nothing to draw
  const auto side = [&](double given, double length) {
    if (given > 0) return given;
    return nothing ? kLongerSide : std::max(margins + page.scale * length, options.pen_width_mm);
  };
  page.width = side(options.width_mm, extent[0]);
  page.height = side(options.height_mm, extent[1]);
  page.left = page.width / 2 - page.scale * box.center()[0];
  page.bottom = page.height / 2 + page.scale * box.center()[1];
  return page;
}

}  // namespace blackleaf::detail
