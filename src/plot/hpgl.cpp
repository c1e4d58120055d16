// HP-GL, the language of pen plotters.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "blackleaf/error.h"
#include "blackleaf/picture.h"
#include "plot/dashes.h"
#include "plot/text_buffer.h"

namespace blackleaf {
namespace {

using detail::TextBuffer;

constexpr double kUnitsPerMillimetre = 40;
constexpr std::int64_t kMost = 32767;      // of a coordinate
constexpr std::size_t kPens = 8;           // in a carousel
constexpr std::size_t kPointsAtOnce = 64;  // of one instruction: plotters' buffers are small

using Place = std::pair<std::int64_t, std::int64_t>;

Place place_of(const Eigen::Vector2d& point) {
  const Eigen::Vector2d units = point * kUnitsPerMillimetre;
  // Half a unit of grace: ends on the page's very edge may be rounded beyond it.
  if (!(units.minCoeff() >= -0.5 && units.maxCoeff() < static_cast<double>(kMost) + 0.5))
    throw Error(ErrorCode::bad_argument,
                fmt::format("the point ({:.1f}, {:.1f}) mm lies outside what HP-GL reaches, {} mm from the page's "
                            "lower left corner",
                            point[0], point[1], static_cast<double>(kMost) / kUnitsPerMillimetre),
                "use a smaller page");
  return {std::max<std::int64_t>(0, std::llround(units[0])), std::max<std::int64_t>(0, std::llround(units[1]))};
}

void put(TextBuffer& out, const Place& place) {
  out.put_integer(place.first);
  out.put(',');
  out.put_integer(place.second);
}

class Plotter {
 public:
  explicit Plotter(TextBuffer& out) : out_(out) { out_.put("IN;PA;\n"); }

  void select(std::size_t pen) {
    if (pen == pen_) return;
    lift();
    out_.put(pen_ == 0 ? "SP" : "PU;SP");
    pen_ = pen;
    out_.put_integer(static_cast<std::int64_t>(pen));
    out_.put(";\n");
  }

  void draw(std::span<const Eigen::Vector2d> line) {
    const Place begin = place_of(line.front());
    if (!down_ || begin != at_) {
      lift();
      out_.put("PU");
      put(out_, begin);
      at_ = begin;
    }
    bool moved = false;
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Place next = place_of(line[i]);
      // Points in one place are one point, but a whole line in one place is a dot.
      if (next == at_ && (moved || i + 1 < line.size())) continue;
      go(next);
      moved = true;
    }
  }

  void finish() {
    lift();
    out_.put("PU;SP0;\n");
  }

 private:
  void lift() {
    if (down_ || points_ > 0) out_.put(";\n");
    down_ = false;
    points_ = 0;
  }
  void go(const Place& next) {
    if (points_ == kPointsAtOnce || !down_) {
      out_.put(";PD");
      points_ = 0;
    } else {
      out_.put(',');
    }
    put(out_, next);
    ++points_;
    down_ = true;
    at_ = next;
  }

  TextBuffer& out_;
  std::size_t pen_ = 0, points_ = 0;
  bool down_ = false;
  Place at_{-1, -1};
};

}  // namespace

std::string to_hpgl(const Picture& picture) {
  std::size_t points = 0;
  for (const Layer& layer : picture.layers) points += layer.lines.points().size();
  TextBuffer out(12 * points);
  Plotter plotter(out);
  std::vector<Pen> pens;
  for (const Layer& layer : picture.layers) {
    if (layer.lines.empty()) continue;
    const auto pen = std::find(pens.begin(), pens.end(), layer.pen);
    const std::size_t number = static_cast<std::size_t>(pen - pens.begin());
    if (pen == pens.end()) pens.push_back(layer.pen);
    plotter.select(number % kPens + 1);
    const Polylines lines = detail::dashed(layer.lines, layer.pen.dashes_mm);
    for (std::size_t i = 0; i < lines.size(); ++i) plotter.draw(lines[i]);
  }
  plotter.finish();
  return out.take();
}

}  // namespace blackleaf
