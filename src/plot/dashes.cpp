#include "plot/dashes.h"

namespace blackleaf::detail {

Polylines dashed(const Polylines& lines, const std::vector<double>& dashes_mm) {
  if (dashes_mm.empty()) return lines;
  Polylines result;
  std::vector<Eigen::Vector2d> dash;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto line = lines[i];
    std::size_t part = 0;  // of the pattern; even parts are drawn
    double left = dashes_mm[0];
    dash.assign(1, line.front());
    const auto finish = [&] {
      if (dash.size() > 1) result.add(dash);
      dash.clear();
    };
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const Eigen::Vector2d way = line[k + 1] - line[k];
      const double length = way.norm();
      double gone = 0;
      while (length - gone > left) {
        gone += left;
        const Eigen::Vector2d turn = line[k] + way * (gone / length);
        if (part % 2 == 0) {
          dash.push_back(turn);
          finish();
        } else {
          dash.assign(1, turn);
        }
        part = (part + 1) % dashes_mm.size();
        left = dashes_mm[part];
      }
      left -= length - gone;
      if (part % 2 == 0) dash.push_back(line[k + 1]);
    }
    finish();
  }
  return result;
}

}  // namespace blackleaf::detail
