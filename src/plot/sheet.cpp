#include "blackleaf/sheet.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "blackleaf/error.h"
#include "plot/title_block.h"

namespace blackleaf {
namespace {

using Box = Eigen::AlignedBox2d;
using Point = Eigen::Vector2d;

constexpr double kLeastGap = 8;  // millimetres beside and between views
constexpr double kMost = 1e5;    // of any length
enum : std::size_t { kFront, kTop, kSide, kIsometric };

void require(double value, bool good, const char* name) {
  if (!std::isfinite(value) || !good || value > kMost)
    throw Error(ErrorCode::bad_argument, fmt::format("a {} of {} is not possible", name, value),
                fmt::format("give a positive number up to {}", kMost));
}

void check(const SheetOptions& options) {
  require(options.width_mm, options.width_mm > 0, "page width");
  require(options.height_mm, options.height_mm > 0, "page height");
  require(options.voxel_mm, options.voxel_mm > 0, "voxel size");
  require(options.scale, options.scale >= 0, "scale");
  require(options.pen_width_mm, options.pen_width_mm > 0, "pen width");
  const double width = detail::kLeftMargin + detail::kMargin + detail::kBlockWidth;
  const double height = 2 * detail::kMargin + detail::kBlockHeight + 3 * kLeastGap;
  if (options.width_mm < width || options.height_mm <= height)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("a page of {} x {} mm is too small for a sheet", options.width_mm, options.height_mm),
        fmt::format("make it at least {} mm wide and more than {} mm high, like A5 lying on its side", width, height));
}

Box bounds(const std::vector<Layer>& layers) {
  Box box;
  for (const Layer& layer : layers)
    for (const Point& point : layer.lines.points()) {
      if (!point.allFinite()) throw Error(ErrorCode::bad_argument, "the drawing has points that are not finite");
      box.extend(point);
    }
  return box.isEmpty() ? Box(Point::Zero(), Point::Zero()) : box;
}

// The places for views: two columns and two rows in voxels, the front view in the first column.
struct Cells {
  Box front, side, top, isometric;  // of the views in voxels; those in line have equal ranges
  double columns[2], rows[2];       // widths and heights; row 0 is the upper one
};

Cells cells_of(const std::array<std::vector<Layer>, 4>& views, ProjectionAngle angle) {
  Cells cells{bounds(views[kFront]), bounds(views[kSide]), bounds(views[kTop]), bounds(views[kIsometric]), {}, {}};
  const auto align = [](Box& a, Box& b, Eigen::Index axis) {
    const double low = std::min(a.min()[axis], b.min()[axis]), high = std::max(a.max()[axis], b.max()[axis]);
    a.min()[axis] = b.min()[axis] = low;
    a.max()[axis] = b.max()[axis] = high;
  };
  align(cells.front, cells.top, 0);
  align(cells.front, cells.side, 1);
  const Point front = cells.front.sizes(), side = cells.side.sizes(), top = cells.top.sizes(),
              isometric = cells.isometric.sizes();
  cells.columns[0] = front[0];
  cells.columns[1] = std::max(side[0], isometric[0]);
  const double beside_top = std::max(top[1], isometric[1]);
  cells.rows[0] = angle == ProjectionAngle::third ? beside_top : front[1];
  cells.rows[1] = angle == ProjectionAngle::third ? front[1] : beside_top;
  return cells;
}

// The largest of ... 1/5, 1/2, 1, 2, 5, 10 ... (ISO 5455) that is not above `most`. Requires: positive and finite.
double standard_scale(double most) {
  // A little grace: views that fit exactly fit.
  most *= 1 + 1e-12;
  const int decade = static_cast<int>(std::floor(std::log10(most)));
  // One step of ten is an integer or one over an integer; so scales are equal however they come about.
  const auto power = [](int exponent) {
    double value = 1;
    for (int i = 0; i < std::abs(exponent); ++i) value *= 10;
    return value;
  };
  double best = 0;
  for (int exponent = decade - 1; exponent <= decade + 1; ++exponent)
    for (const double step : {1.0, 2.0, 5.0}) {
      const double scale = exponent >= 0 ? step * power(exponent) : step / power(exponent);
      if (scale <= most) best = std::max(best, scale);
    }
  return best;
}

// Adds lines to the layer of that name and pen.
void add_layer(std::vector<Layer>& layers, const Layer& layer, const Point& corner, double scale) {
  auto same = std::find_if(layers.begin(), layers.end(),
                           [&](const Layer& l) { return l.name == layer.name && l.pen == layer.pen; });
  if (same == layers.end()) same = layers.insert(layers.end(), {layer.name, layer.pen, {}});
  std::vector<Point> line;
  for (std::size_t i = 0; i < layer.lines.size(); ++i) {
    line.clear();
    for (const Point& point : layer.lines[i]) line.push_back(corner + scale * point);
    same->lines.add(line);
  }
}

}  // namespace

std::array<View, 4> sheet_views(ProjectionAngle angle) {
  const double side = angle == ProjectionAngle::third ? 1 : -1;
  return {View({0, -1, 0}), View({0, 0, 1}), View({side, 0, 0}), View({1, -1, 1})};
}

std::string scale_text(double scale) {
  if (scale >= 1) return fmt::format("{:.6g}:1", scale);
  return fmt::format("1:{:.6g}", 1 / scale);
}

Picture engineering_sheet(const std::array<std::vector<Layer>, 4>& views, const SheetOptions& options) {
  check(options);
  const Cells cells = cells_of(views, options.angle);
  const Point low(detail::kLeftMargin, detail::kMargin + detail::kBlockHeight);
  const Point room = Point(options.width_mm, options.height_mm) - Point::Constant(detail::kMargin) - low;
  const Point need(cells.columns[0] + cells.columns[1], cells.rows[0] + cells.rows[1]);
  const Point free = room - Point::Constant(3 * kLeastGap);
  // From voxels on the page; both sides of nothing are 0.
  double scale = options.scale;
  if (const double most = std::min(free[0] / std::max(need[0], 1e-300), free[1] / std::max(need[1], 1e-300));
      scale == 0) {
    scale = need.maxCoeff() > 0 ? standard_scale(most / options.voxel_mm) : 1;
  } else if (scale * options.voxel_mm > most * (1 + 1e-12)) {
    const Point size = need * (scale * options.voxel_mm);
    throw Error(ErrorCode::bad_argument,
                fmt::format("at scale {} the views take {:.0f} x {:.0f} mm, the page has {:.0f} x {:.0f}",
                            scale_text(scale), size[0], size[1], free[0], free[1]),
                fmt::format("use a larger page or {}", scale_text(standard_scale(most / options.voxel_mm))));
  }
  const double mm = scale * options.voxel_mm;
  const Point gap = (room - mm * need) / 3;
  const bool third = options.angle == ProjectionAngle::third;
  // Middles of columns and rows.
  const double x[2] = {low[0] + gap[0] + mm * cells.columns[0] / 2,
                       low[0] + 2 * gap[0] + mm * (cells.columns[0] + cells.columns[1] / 2)};
  const double y[2] = {low[1] + 2 * gap[1] + mm * (cells.rows[1] + cells.rows[0] / 2),
                       low[1] + gap[1] + mm * cells.rows[1] / 2};
  const std::size_t front_row = third ? 1 : 0;

  Picture sheet{options.width_mm, options.height_mm, {}, {}, options.title, options.source};
  const std::array<View, 4> directions = sheet_views(options.angle);
  const auto place = [&](std::size_t view, const char* name, const Box& box, std::size_t column, std::size_t row) {
    const Point corner = Point(x[column], y[row]) - mm * box.center();
    sheet.views.push_back({name, directions[view], mm, corner[0], corner[1]});
    for (const Layer& layer : views[view]) add_layer(sheet.layers, layer, corner, mm);
  };
  place(kFront, "front", cells.front, 0, front_row);
  place(kTop, "top", cells.top, 0, 1 - front_row);
  place(kSide, third ? "right" : "left", cells.side, 1, front_row);
  place(kIsometric, "isometric", cells.isometric, 1, 1 - front_row);
  for (Layer& layer : detail::title_block(options, scale)) sheet.layers.push_back(std::move(layer));
  return sheet;
}

}  // namespace blackleaf
