#include "blackleaf/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "blackleaf/error.h"

namespace blackleaf {
namespace {

constexpr double kMost = 1e5;        // of any option: a page of 100 m
constexpr double kLongerSide = 180;  // millimetres, when the options leave both sides open

void check(const PageOptions& options) {
  const auto require = [&](double value, bool good, const char* name) {
    if (!std::isfinite(value) || !good || value > kMost)
      throw Error(ErrorCode::bad_argument, fmt::format("a {} of {} is not possible", name, value),
                  fmt::format("give a positive number up to {}", kMost));
  };
  require(options.width_mm, options.width_mm >= 0, "page width");
  require(options.height_mm, options.height_mm >= 0, "page height");
  require(options.margin_mm, options.margin_mm >= 0, "margin");
  require(options.pen_width_mm, options.pen_width_mm > 0, "pen width");
  require(options.dots_per_inch, options.dots_per_inch > 0, "resolution");
  const double width = options.width_mm > 0 ? options.width_mm : kLongerSide;
  const double height = options.height_mm > 0 ? options.height_mm : kLongerSide;
  if (std::min(width, height) <= 2 * options.margin_mm)
    throw Error(ErrorCode::bad_argument,
                fmt::format("a page of {} x {} mm is too small for margins of {} mm", width, height, options.margin_mm),
                "give a larger page or smaller margins");
}

}  // namespace

void Polylines::reserve(std::size_t polylines, std::size_t points) {
  ends_.reserve(polylines);
  points_.reserve(points);
}

Polylines polylines(std::span<const Stroke> strokes) {
  Polylines lines;
  lines.reserve(strokes.size(), 2 * strokes.size());
  for (const Stroke& stroke : strokes) lines.add(stroke.from, stroke.to);
  return lines;
}

Picture lay_out(std::vector<Layer> layers, const View& view, const PageOptions& options) {
  check(options);
  Eigen::AlignedBox2d box;
  for (const Layer& layer : layers)
    for (const Eigen::Vector2d& point : layer.lines.points()) {
      if (!point.allFinite()) throw Error(ErrorCode::bad_argument, "the drawing has points that are not finite");
      box.extend(point);
    }
  if (options.region) box = *options.region;
  const bool nothing = box.isEmpty();
  if (nothing) box = Eigen::AlignedBox2d(Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero());
  const Eigen::Vector2d extent = box.sizes();
  const double margins = 2 * options.margin_mm;
  const double room_x = (options.width_mm > 0 ? options.width_mm : kLongerSide) - margins;
  const double room_y = (options.height_mm > 0 ? options.height_mm : kLongerSide) - margins;
  // A side left open gives way to the other: only when both are open, or the drawing is too long, does 180 mm bind.
  const double fit_x = extent[0] > 0 ? room_x / extent[0] : std::numeric_limits<double>::infinity();
  const double fit_y = extent[1] > 0 ? room_y / extent[1] : std::numeric_limits<double>::infinity();
  double scale = std::min(fit_x, fit_y);
  if (options.width_mm > 0 && options.height_mm <= 0 && std::isfinite(fit_x)) scale = fit_x;
  if (options.height_mm > 0 && options.width_mm <= 0 && std::isfinite(fit_y)) scale = fit_y;
  if (!std::isfinite(scale)) scale = 1;  // nothing to draw
  const auto side = [&](double given, double length) {
    if (given > 0) return given;
    return nothing ? kLongerSide : std::max(margins + scale * length, options.pen_width_mm);
  };

  Picture picture{side(options.width_mm, extent[0]), side(options.height_mm, extent[1]), std::move(layers), {}};
  picture.title = options.title;
  const Eigen::Vector2d corner = Eigen::Vector2d(picture.width_mm, picture.height_mm) / 2 - scale * box.center();
  picture.views.push_back({{}, view, scale, corner[0], corner[1]});
  for (Layer& layer : picture.layers)
    for (Eigen::Vector2d& point : layer.lines.points()) point = corner + scale * point;
  return picture;
}

Picture lay_out(const LineDrawing& drawing, const PageOptions& options) {
  std::vector<Layer> layers;
  layers.push_back({"visible", {.width_mm = options.pen_width_mm}, polylines(drawing.strokes)});
  return lay_out(std::move(layers), drawing.view, options);
}

}  // namespace blackleaf
