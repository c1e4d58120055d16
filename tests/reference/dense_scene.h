// The slow readable twin of draw(scene): one unit edge of one solid at a time over dense grids, in whole numbers, as
// dense_drawing.h does for one solid. Of the pens that draw a place the first is found by asking all of them.
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "blackleaf/scene.h"
#include "reference/dense_view.h"

namespace blackleaf::reference {

class DenseScene {
 public:
  using Layers = std::map<std::pair<LineKind, std::size_t>, std::vector<Stroke>>;

  static Layers lines(const std::vector<DenseGrid>& solids, const std::array<std::int64_t, 3>& d,
                      const SceneOptions& options) {
    DenseScene scene(solids, d, options);
    for (std::size_t solid = 0; solid < solids.size(); ++solid)
      for (std::size_t axis = 0; axis < 3; ++axis) scene.draw_axis(solid, axis);
    return scene.first_pens();
  }

  static DenseGrid union_of(const std::vector<DenseGrid>& solids) {
    DenseGrid all(solids.front().depth);
    for (const DenseGrid& solid : solids)
      for (std::size_t i = 0; i < all.voxels.size(); ++i) all.voxels[i] = all.voxels[i] || solid.voxels[i];
    return all;
  }

 private:
  using Place = DenseView::Place;
  struct Piece {
    Place from, to;
    std::pair<LineKind, std::size_t> pen;
  };

  DenseScene(const std::vector<DenseGrid>& solids, const std::array<std::int64_t, 3>& d, const SceneOptions& options)
      : solids_(solids), all_(union_of(solids)), view_(d), options_(options) {}

  void draw_axis(std::size_t solid, std::size_t axis) {
    const WideVector& d = view_.d;
    const Wide d_b = d[(axis + 1) % 3], d_c = d[(axis + 2) % 3];
    if (d_b == 0 && d_c == 0) return;
    const Wide scale = absolute((d_b == 0 ? 1 : d_b) * (d_c == 0 ? 1 : d_c));
    // The gap behind outlines in times of d, rounded up to 1 / scale.
    const double gap = options_.outline_gap / std::sqrt(static_cast<double>(dot(d, d))) * static_cast<double>(scale);
    const Wide stop =
        gap < 1e15 ? static_cast<Wide>(static_cast<std::int64_t>(std::ceil(gap))) : Wide{-1};  // -1: never
    const int n = all_.side();
    std::array<int, 3> at{};
    for (at[0] = 0; at[0] <= n; ++at[0])
      for (at[1] = 0; at[1] <= n; ++at[1])
        for (at[2] = 0; at[2] <= n; ++at[2])
          if (is_feature(solids_[solid], axis, at)) draw_edge(solid, axis, at, scale, stop);
  }

  void draw_edge(std::size_t solid, std::size_t axis, const std::array<int, 3>& at, Wide scale, Wide stop) {
    const Wide q = 2 * scale;
    const std::vector<Wide> where = view_.cuts(axis, at, all_.side(), q);
    std::set<Wide> cuts(where.begin(), where.end());
    if (stop >= 0) {
      const Wide travelled = -2 * stop * view_.d[axis];
      cuts.insert(-travelled - floor_div(-travelled, q) * q);
    }
    for (auto high = std::next(cuts.begin()); high != cuts.end(); ++high) {
      const Wide low = *std::prev(high);
      WideVector p = {at[0] * q, at[1] * q, at[2] * q};
      p[axis] += (low + *high) / 2;
      WideVector from = p, to = p;
      from[axis] = at[axis] * q + low;
      to[axis] = at[axis] * q + *high;
      if (is_blocked(p, q, 1, -1)) {
        if (options_.hidden) add(axis, from, to, q, {LineKind::hidden, solid});
      } else if (options_.outline && !is_blocked(p, q, -1, stop < 0 ? stop : 2 * stop)) {
        add(axis, from, to, q, {LineKind::outline, solid});
      } else {
        add(axis, from, to, q, {LineKind::visible, solid});
      }
    }
  }

  // Whether the open ray from p / q along sign * d meets the interior of the union before time stop / q (-1: ever).
  bool is_blocked(const WideVector& p, Wide q, int sign, Wide stop) const {
    const WideVector& d = view_.d;
    const Wide times = view_.times();
    std::set<Wide> crossings = {0};  // in 1 / (q times)
    for (std::size_t i = 0; i < 3; ++i)
      for (int plane = 0; plane <= all_.side() && d[i] != 0; ++plane)
        if (const Wide time = sign * (plane * q - p[i]) * (times / d[i]); time > 0)
          if (stop < 0 || time < stop * times) crossings.insert(time);
    if (stop >= 0 && *crossings.rbegin() < stop * times) crossings.insert(stop * times);
    for (auto high = std::next(crossings.begin()); high != crossings.end(); ++high)
      if (is_interior(all_, view_.between(p, sign * *std::prev(high), sign * *high), 2 * times * q)) return true;
    return false;
  }

  void add(std::size_t axis, const WideVector& from, const WideVector& to, Wide q,
           std::pair<LineKind, std::size_t> pen) {
    const auto [line, ends] = view_.place(axis, from, to, q);
    lines_[line].push_back({ends[0], ends[1], pen});
  }

  Layers first_pens() const {
    Layers layers;
    for (const auto& [line, pieces] : lines_) {
      const auto before = [by_v = line.by_v()](const Place& p, const Place& r) { return p.before(r, by_v); };
      std::set<Place, decltype(before)> ends(before);
      for (const Piece& piece : pieces) ends.insert(piece.from), ends.insert(piece.to);
      std::pair<LineKind, std::size_t> last_pen;
      std::vector<Stroke>* last = nullptr;  // the layer whose last stroke ends where the next part begins
      for (auto to = std::next(ends.begin()); to != ends.end(); ++to) {
        const Place &low = *std::prev(to), &high = *to;
        const Piece* first = nullptr;
        for (const Piece& piece : pieces)
          if (!before(low, piece.from) && !before(piece.to, high) && (!first || piece.pen < first->pen)) first = &piece;
        if (!first) {
          last = nullptr;
        } else if (last && last_pen == first->pen) {
          last->back().to = view_.on_screen(high);
        } else {
          last_pen = first->pen;
          last = &layers[last_pen];
          last->push_back({view_.on_screen(low), view_.on_screen(high)});
        }
      }
    }
    return layers;
  }

  const std::vector<DenseGrid>& solids_;
  DenseGrid all_;
  DenseView view_;
  const SceneOptions& options_;
  std::map<DenseView::Line, std::vector<Piece>> lines_;
};

}  // namespace blackleaf::reference
