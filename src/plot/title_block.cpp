#include "plot/title_block.h"

#include <cmath>
#include <numbers>

#include "plot/stroke_font.h"

namespace blackleaf::detail {
namespace {

using Point = Eigen::Vector2d;

constexpr double kLabelHeight = 2.2, kTextHeight = 3.5, kTitleHeight = 5, kPadding = 2;

void add_box(Polylines& lines, const Point& low, const Point& high) {
  const std::vector<Point> box{low, {high[0], low[1]}, high, {low[0], high[1]}, low};
  lines.add(box);
}

// The sign of the projection angle (ISO 5456-2): a cone without its tip, from the side and from its thin end. As the
// thin end is to the left, first angle puts the second view to the right, third angle to the left.
void add_symbol(Polylines& lines, const Point& middle, ProjectionAngle angle) {
  constexpr double kRadius = 4, kApart = 7;
  const double side = angle == ProjectionAngle::first ? -kApart : kApart;
  const Point cone = middle + Point(side, 0), rings = middle - Point(side, 0);
  const std::vector<Point> outline{cone + Point(-kRadius, -kRadius / 2), cone + Point(kRadius, -kRadius),
                                   cone + Point(kRadius, kRadius), cone + Point(-kRadius, kRadius / 2),
                                   cone + Point(-kRadius, -kRadius / 2)};
  lines.add(outline);
  constexpr int kSides = 48;
  for (const double radius : {kRadius, kRadius / 2}) {
    std::vector<Point> circle;
    for (int i = 0; i < kSides; ++i) {
      const double turn = 2 * std::numbers::pi * i / kSides;
      circle.push_back(rings + radius * Point(std::cos(turn), std::sin(turn)));
    }
    circle.push_back(circle.front());
    lines.add(circle);
  }
}

// A cell of the block: its walls, what it is and what it says.
class Cells {
 public:
  Cells(Polylines& walls, Polylines& text) : walls_(walls), text_(text) {}

  void add(const Point& low, const Point& high, std::string_view label, std::string_view text, double height) {
    add_box(walls_, low, high);
    write_text(text_, label, {low[0] + kPadding, high[1] - kPadding - kLabelHeight}, kLabelHeight);
    const double room = high[0] - low[0] - 2 * kPadding;
    // Text that is a little too long is written smaller before it is cut.
    const double width = text_width(text, height);
    const double smaller = width > room ? std::max(height * room / width, 0.6 * height) : height;
    write_text(text_, shortened(text, smaller, room), {low[0] + kPadding, low[1] + kPadding}, smaller);
  }

 private:
  Polylines& walls_;
  Polylines& text_;
};

}  // namespace

std::vector<Layer> title_block(const SheetOptions& options, double scale) {
  Layer frame{"frame", {.width_mm = 2 * options.pen_width_mm}, {}};
  Layer walls{"title block", {.width_mm = options.pen_width_mm}, {}};
  Layer text{"text", {.width_mm = 0.7 * options.pen_width_mm}, {}};
  const Point low(kLeftMargin, kMargin), high(options.width_mm - kMargin, options.height_mm - kMargin);
  add_box(frame.lines, low, high);
  const Point corner(high[0] - kBlockWidth, low[1]);
  const auto at = [&](double x, double y) -> Point { return corner + Point(x, y); };
  Cells cells(walls.lines, text.lines);
  cells.add(at(0, 12), at(100, kBlockHeight), "Title", options.title, kTitleHeight);
  cells.add(at(0, 0), at(100, 12), "Source", options.source, kTextHeight);
  const std::string note = options.scale_note.empty() ? "" : " (" + options.scale_note + ")";
  cells.add(at(100, 12), at(145, kBlockHeight), "Scale", scale_text(scale) + note, kTextHeight);
  cells.add(at(100, 0), at(145, 12), "Date", options.date, kTextHeight);
  cells.add(at(145, 12), at(kBlockWidth, kBlockHeight), "", "", kTextHeight);
  add_symbol(walls.lines, at(145 + (kBlockWidth - 145) / 2, 12 + (kBlockHeight - 12) / 2), options.angle);
  cells.add(at(145, 0), at(kBlockWidth, 12), "Size", options.size_name, kTextHeight);
  std::vector<Layer> layers;
  layers.push_back(std::move(frame));
  layers.push_back(std::move(walls));
  layers.push_back(std::move(text));
  return layers;
}

}  // namespace blackleaf::detail
