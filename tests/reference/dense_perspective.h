// The slow readable twin of draw() in perspective, for scenes and single solids: one unit edge of one solid at a time,
// one way to the eye at a time, over dense grids, in fractions of any size.
//
// Along a unit edge the answer can only change where the way to the eye passes through a lattice line across the edge's
// axis or where the edge leaves the field of view; those places cut the edge into parts, and the way from the middle of
// each part is followed from lattice plane to lattice plane. It is blocked iff the middle of some step lies in the
// interior of the union: every voxel that touches it is black. What is seen is projected, and collected by the lines of
// the picture that it lies on. Of the pens that draw a place the first is found by asking all of them.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "blackleaf/perspective.h"
#include "reference/dense_scene.h"

namespace blackleaf::reference {

class DensePerspective {
 public:
  using Pen = std::pair<LineKind, std::size_t>;
  using Layers = std::map<Pen, std::vector<Stroke>>;

  static Layers lines(const std::vector<DenseGrid>& solids, const Perspective& perspective,
                      const SceneOptions& options) {
    DensePerspective drawing(solids, perspective, options);
    for (std::size_t solid = 0; solid < solids.size(); ++solid)
      for (std::size_t axis = 0; axis < 3; ++axis) drawing.draw_axis(solid, axis);
    return drawing.first_pens();
  }
  /// The visible strokes of one solid.
  static std::vector<Stroke> strokes(const DenseGrid& grid, const Perspective& perspective) {
    return lines({grid}, perspective, {})[{LineKind::visible, 0}];
  }

 private:
  using Vector = std::array<mpq_class, 3>;
  using Point = std::array<mpq_class, 2>;  // of the picture, as multiples of the unnormalised axes
  struct Piece {
    Point from, to;  // from < to
    Pen pen;
  };
  // A line of the picture: v = slope u + offset, or u = offset if it is upright.
  using Line = std::tuple<bool, mpq_class, mpq_class>;

  DensePerspective(const std::vector<DenseGrid>& solids, const Perspective& perspective, const SceneOptions& options)
      : solids_(solids), all_(DenseScene::union_of(solids)), view_(perspective), options_(options) {
    for (std::size_t i = 0; i < 3; ++i) {
      eye_[i] = fraction(perspective.eye()[i], 65536);
      d_[i] = fraction(perspective.view().direction()[i]);
    }
    const Vector up = d_[0] == 0 && d_[1] == 0 ? Vector{0, 1, 0} : Vector{0, 0, 1};
    right_ = cross(up, d_);
    up_ = cross(d_, right_);
  }

  static mpq_class fraction(std::int64_t num, long den = 1) {
    mpq_class q(static_cast<long>(num), den);
    q.canonicalize();
    return q;
  }
  static Vector cross(const Vector& p, const Vector& q) {
    return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
  }
  static mpq_class dot(const Vector& p, const Vector& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
  Vector from_eye(const Vector& p) const { return {p[0] - eye_[0], p[1] - eye_[1], p[2] - eye_[2]}; }
  static void sort_unique(std::vector<mpq_class>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
  }

  void draw_axis(std::size_t solid, std::size_t axis) {
    const int n = all_.side();
    std::array<int, 3> at{};
    for (at[0] = 0; at[0] <= n; ++at[0])
      for (at[1] = 0; at[1] <= n; ++at[1])
        for (at[2] = 0; at[2] <= n; ++at[2])
          if (is_feature(solids_[solid], axis, at)) draw_edge(solid, axis, at);
  }

  void draw_edge(std::size_t solid, std::size_t axis, const std::array<int, 3>& at) {
    const std::array<std::size_t, 2> others = {(axis + 1) % 3, (axis + 2) % 3};
    if (eye_[others[0]] == at[others[0]] && eye_[others[1]] == at[others[1]]) return;
    std::vector<mpq_class> cuts = {mpq_class(at[axis]), mpq_class(at[axis] + 1)};
    const auto add_cut = [&](const mpq_class& place) {
      if (place > cuts[0] && place < cuts[1]) cuts.push_back(place);
    };
    for (const std::size_t other : others) {
      // A lattice line x_axis = along, x_other = across is passed on the way, or on the way back, from the place in its
      // plane with the eye.
      const mpq_class distance = at[other] - eye_[other];
      for (int across = 0; across <= all_.side(); ++across) {
        const mpq_class to_line = across - eye_[other];
        if (to_line == 0 || distance == 0 || (to_line > 0) != (distance > 0)) continue;
        if (!options_.outline && abs(to_line) >= abs(distance)) continue;
        const mpq_class factor = distance / to_line;
        for (int along = 0; along <= all_.side(); ++along) add_cut(eye_[axis] + (along - eye_[axis]) * factor);
      }
    }
    for (const auto& side : view_.sides()) {
      const mpq_class n = fraction(side[axis]);
      if (n == 0) continue;
      mpq_class rest = 0;
      for (const std::size_t other : others) rest += fraction(side[other]) * (at[other] - eye_[other]);
      add_cut(eye_[axis] - rest / n);
    }
    sort_unique(cuts);
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      Vector from = {at[0], at[1], at[2]}, to = from, middle = from;
      from[axis] = cuts[i - 1], to[axis] = cuts[i], middle[axis] = (cuts[i - 1] + cuts[i]) / 2;
      if (!is_in_view(middle)) continue;
      if (is_blocked(middle, false)) {
        if (options_.hidden) add(from, to, {LineKind::hidden, solid});
      } else if (options_.outline && !is_blocked(middle, true)) {
        add(from, to, {LineKind::outline, solid});
      } else {
        add(from, to, {LineKind::visible, solid});
      }
    }
  }

  bool is_in_view(const Vector& p) const {
    return std::all_of(view_.sides().begin(), view_.sides().end(), [&](const auto& n) {
      return dot(from_eye(p), {fraction(n[0]), fraction(n[1]), fraction(n[2])}) >= 0;
    });
  }

  // Whether the open segment from p to the eye meets the interior of the union, or what is behind p, seen from it.
  bool is_blocked(const Vector& p, bool behind) const {
    std::vector<mpq_class> crossings = {0};
    if (!behind) crossings.push_back(1);
    for (std::size_t i = 0; i < 3; ++i) {
      const mpq_class way = behind ? p[i] - eye_[i] : eye_[i] - p[i];
      if (way == 0) continue;
      for (int plane = 0; plane <= all_.side(); ++plane)
        if (const mpq_class time = (plane - p[i]) / way; time > 0 && (behind || time < 1)) crossings.push_back(time);
    }
    sort_unique(crossings);
    for (std::size_t i = 1; i < crossings.size(); ++i) {
      const mpq_class time = (crossings[i - 1] + crossings[i]) / 2 * (behind ? -1 : 1);
      Vector middle;
      for (std::size_t k = 0; k < 3; ++k) middle[k] = p[k] + time * (eye_[k] - p[k]);
      if (is_interior(middle)) return true;
    }
    return false;
  }

  bool is_interior(const Vector& p) const {
    std::array<int, 3> high{}, low{};
    for (std::size_t i = 0; i < 3; ++i) {
      mpz_class floor;
      mpz_fdiv_q(floor.get_mpz_t(), p[i].get_num_mpz_t(), p[i].get_den_mpz_t());
      high[i] = static_cast<int>(floor.get_si());
      low[i] = p[i] == floor ? high[i] - 1 : high[i];
    }
    for (int x = low[0]; x <= high[0]; ++x)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int z = low[2]; z <= high[2]; ++z)
          if (!all_.at(x, y, z)) return false;
    return true;
  }

  Point projected(const Vector& p) const {
    const Vector seen = from_eye(p);
    const mpq_class depth = -dot(seen, d_);
    return {dot(seen, right_) / depth, dot(seen, up_) / depth};
  }

  void add(const Vector& p, const Vector& q, const Pen& pen) {
    Point from = projected(p), to = projected(q);
    if (to < from) std::swap(from, to);
    const bool upright = from[0] == to[0];
    mpq_class slope = 0, offset = from[0];
    if (!upright) {
      slope = (to[1] - from[1]) / (to[0] - from[0]);
      offset = from[1] - slope * from[0];
    }
    lines_[{upright, slope, offset}].push_back({from, to, pen});
  }

  Layers first_pens() const {
    Layers layers;
    for (const auto& [line, pieces] : lines_) {
      std::set<Point> ends;
      for (const Piece& piece : pieces) ends.insert(piece.from), ends.insert(piece.to);
      const Piece* last = nullptr;  // whose stroke ends where the next part begins
      for (auto to = std::next(ends.begin()); to != ends.end(); ++to) {
        const Point &low = *std::prev(to), &high = *to;
        const Piece* first = nullptr;
        for (const Piece& piece : pieces)
          if (piece.from <= low && high <= piece.to && (!first || piece.pen < first->pen)) first = &piece;
        if (first && last && first->pen == last->pen)
          layers[first->pen].back().to = on_screen(high);
        else if (first)
          layers[first->pen].push_back({on_screen(low), on_screen(high)});
        last = first;
      }
    }
    return layers;
  }

  Eigen::Vector2d on_screen(const Point& p) const {
    const auto scaled = [&](const mpq_class& value, const Vector& axis) {
      return value.get_d() * view_.distance() * std::sqrt(mpq_class(dot(d_, d_)).get_d()) /
             std::sqrt(mpq_class(dot(axis, axis)).get_d());
    };
    return {scaled(p[0], right_), scaled(p[1], up_)};
  }

  const std::vector<DenseGrid>& solids_;
  DenseGrid all_;
  const Perspective& view_;
  const SceneOptions& options_;
  Vector eye_, d_, right_, up_;
  std::map<Line, std::vector<Piece>> lines_;
};

}  // namespace blackleaf::reference
