#include "chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "canvas.h"

namespace blackleaf::cli {
namespace {

constexpr double kLeft = 24, kTop = 4, kWidth = 130, kHeight = 90, kBelow = 16, kMark = 1.1;  // millimetres

// An axis through whole powers of ten.
struct Axis {
  int low = std::numeric_limits<int>::max(), high = std::numeric_limits<int>::min();
  void hold(double value) {
    assert(value > 0);
    const double power = std::log10(value);
    low = std::min(low, static_cast<int>(std::floor(power)));
    high = std::max(high, static_cast<int>(std::ceil(power)));
    if (low == high) ++high;
  }
  double operator()(double value) const { return (std::log10(value) - low) / (high - low); }
};

std::string power_of_ten(int power) {
  return power >= -3 && power <= 4 ? fmt::format("{:g}", std::pow(10, power)) : fmt::format("1e{}", power);
}

void put_mark(Canvas& canvas, char mark, const Eigen::Vector2d& at, const std::string& colour) {
  if (mark == '+') {
    canvas.line(at - Eigen::Vector2d(kMark, 0), at + Eigen::Vector2d(kMark, 0), colour, 0.35);
    canvas.line(at - Eigen::Vector2d(0, kMark), at + Eigen::Vector2d(0, kMark), colour, 0.35);
  } else {
    canvas.circle(at, kMark, mark == '*' ? colour : "none", colour, 0.35);
  }
}

}  // namespace

std::string Chart::svg() const {
  Axis x, y;
  for (const Series& one : series)
    for (const ChartPoint& point : one.points) {
      x.hold(point.x);
      y.hold(point.y);
    }
  assert(x.low < x.high && y.low < y.high);
  const auto at = [&](double along, double up) {
    return Eigen::Vector2d(kLeft + kWidth * along, kTop + kHeight * (1 - up));
  };

  Canvas canvas(kLeft + kWidth + 70, kTop + kHeight + kBelow);
  for (int power = x.low; power <= x.high; ++power) {
    const double place = x(std::pow(10, power));
    canvas.line(at(place, 0), at(place, 1), "#ddd", 0.2);
    canvas.text(at(place, 0) + Eigen::Vector2d(0, 5), power_of_ten(power), 3.5, Canvas::Anchor::middle);
  }
  for (int power = y.low; power <= y.high; ++power) {
    const double place = y(std::pow(10, power));
    canvas.line(at(0, place), at(1, place), "#ddd", 0.2);
    canvas.text(at(0, place) + Eigen::Vector2d(-2, 1.2), power_of_ten(power), 3.5, Canvas::Anchor::end);
  }
  canvas.line(at(0, 0), at(1, 0));
  canvas.line(at(0, 0), at(0, 1));
  canvas.text(at(0.5, 0) + Eigen::Vector2d(0, 12), x_name, 4, Canvas::Anchor::middle);
  canvas.upward_text(at(0, 0.5) - Eigen::Vector2d(18, 0), y_name, 4);
  double row = kTop + 4;
  for (const Series& one : series) {
    for (const ChartPoint& point : one.points) put_mark(canvas, one.mark, at(x(point.x), y(point.y)), one.colour);
    put_mark(canvas, one.mark, {kLeft + kWidth + 6, row - 1.1}, one.colour);
    canvas.text({kLeft + kWidth + 10, row}, one.name);
    row += 6;
  }
  return canvas.svg();
}

double growth_exponent(const std::vector<ChartPoint>& points) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const ChartPoint& point : points) {
    const double x = std::log(point.x), y = std::log(point.y);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double spread = n * sxx - sx * sx;
  assert(spread > 0);
  return (n * sxy - sx * sy) / spread;
}

}  // namespace blackleaf::cli
