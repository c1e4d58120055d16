// The slow readable twin of draw(): one unit edge at a time, one ray at a time, over the dense grid, in whole numbers.
//
// Along a unit edge the answer can only change where the ray passes through a lattice line across the edge's axis;
// those places cut the edge into parts, and the ray from the middle of each part is followed from lattice plane to
// lattice plane. It is blocked iff the middle of some step lies in the solid's interior: every voxel that touches it is
// black.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "blackleaf/drawing.h"
#include "reference/dense_grid.h"
#include "reference/dense_view.h"

namespace blackleaf::reference {

class DenseDrawing {
 public:
  /// The strokes of the drawing, in no particular order. `d` as View::direction() gives it.
  static std::vector<Stroke> strokes(const DenseGrid& grid, const std::array<std::int64_t, 3>& d) {
    DenseDrawing drawing(grid, d);
    for (std::size_t axis = 0; axis < 3; ++axis) drawing.draw_axis(axis);
    return drawing.united();
  }

 private:
  using Place = DenseView::Place;

  DenseDrawing(const DenseGrid& grid, const std::array<std::int64_t, 3>& d) : grid_(grid), view_(d) {}

  void draw_axis(std::size_t axis) {
    const Wide d_b = view_.d[(axis + 1) % 3], d_c = view_.d[(axis + 2) % 3];
    if (d_b == 0 && d_c == 0) return;
    const Wide q = 2 * absolute((d_b == 0 ? 1 : d_b) * (d_c == 0 ? 1 : d_c));
    const int n = grid_.side();
    std::array<int, 3> at{};
    for (at[0] = 0; at[0] <= n; ++at[0])
      for (at[1] = 0; at[1] <= n; ++at[1])
        for (at[2] = 0; at[2] <= n; ++at[2])
          if (is_feature(grid_, axis, at)) draw_edge(axis, at, q);
  }

  void draw_edge(std::size_t axis, const std::array<int, 3>& at, Wide q) {
    std::vector<Wide> cuts = view_.cuts(axis, at, grid_.side(), q);
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      WideVector p = {at[0] * q, at[1] * q, at[2] * q};
      p[axis] += (cuts[i - 1] + cuts[i]) / 2;
      if (is_blocked(p, q)) continue;
      WideVector from = p, to = p;
      from[axis] = at[axis] * q + cuts[i - 1];
      to[axis] = at[axis] * q + cuts[i];
      const auto [line, ends] = view_.place(axis, from, to, q);
      lines_[line].push_back(ends);
    }
  }

  // Whether the open ray from p / q toward d meets the solid's interior.
  bool is_blocked(const WideVector& p, Wide q) const {
    const WideVector& d = view_.d;
    std::vector<Wide> crossings = {0};
    for (std::size_t i = 0; i < 3; ++i)
      for (int plane = 0; plane <= grid_.side() && d[i] != 0; ++plane)
        if (const Wide time = (plane * q - p[i]) * (view_.times() / d[i]); time > 0) crossings.push_back(time);
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 1; i < crossings.size(); ++i)
      if (crossings[i - 1] != crossings[i] &&
          is_interior(grid_, view_.between(p, crossings[i - 1], crossings[i]), 2 * view_.times() * q))
        return true;
    return false;
  }

  std::vector<Stroke> united() const {
    std::vector<Stroke> strokes;
    for (const auto& [line, found] : lines_) {
      const bool by_v = line.by_v();
      auto pieces = found;
      std::sort(pieces.begin(), pieces.end(), [&](const auto& p, const auto& r) { return p[0].before(r[0], by_v); });
      for (std::size_t i = 0; i < pieces.size();) {
        const Place from = pieces[i][0];
        Place to = pieces[i][1];
        for (++i; i < pieces.size() && !to.before(pieces[i][0], by_v); ++i)
          if (to.before(pieces[i][1], by_v)) to = pieces[i][1];
        strokes.push_back({view_.on_screen(from), view_.on_screen(to)});
      }
    }
    return strokes;
  }

  const DenseGrid& grid_;
  DenseView view_;
  std::map<DenseView::Line, std::vector<std::array<Place, 2>>> lines_;
};

}  // namespace blackleaf::reference
