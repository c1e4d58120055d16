// Where a drawing lies on its page.
#pragma once

#include "blackleaf/drawing_file.h"

namespace blackleaf::detail {

/// A page in millimetres, its corner at the upper left, y downward, and the map from drawing to page:
/// x = left + scale * u, y = bottom - scale * v.
struct Page {
  double width = 0, height = 0;
  double scale = 1, left = 0, bottom = 0;

  double x(const Eigen::Vector2d& point) const { return left + scale * point[0]; }
  double y(const Eigen::Vector2d& point) const { return bottom - scale * point[1]; }
};

/// The drawing as large as fits inside the margins, centred. A side of the page that is not given follows from the
/// drawing's shape. Throws Error(bad_argument) for options out of range.
Page lay_out(const LineDrawing& drawing, const PageOptions& options);

}  // namespace blackleaf::detail
