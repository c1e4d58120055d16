// Charts of points, both axes logarithmic.
#pragma once

#include <string>
#include <vector>

namespace blackleaf::cli {

struct ChartPoint {
  double x, y;  // positive
};

struct Series {
  std::string name;
  char mark;  // 'o' circle, '+' cross, '*' full circle
  std::string colour;
  std::vector<ChartPoint> points;
};

struct Chart {
  std::string x_name, y_name;  // with units
  std::vector<Series> series;

  /// An SVG text: axes through whole powers of ten around all points, marks, and a legend. Requires: there is a point,
  /// and all coordinates are positive.
  std::string svg() const;
};

/// The exponent p of y = c x^p that fits the points best (least squares of logarithms). Requires: two different x.
double growth_exponent(const std::vector<ChartPoint>& points);

}  // namespace blackleaf::cli
