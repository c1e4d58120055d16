// The slow readable twin of draw(): one unit edge at a time, one ray at a time, over the dense grid, in whole numbers.
//
// Along a unit edge the answer can only change where the ray passes through a lattice line across the edge's axis;
// those places cut the edge into parts, and the ray from the middle of each part is followed from lattice plane to
// lattice plane. It is blocked iff the middle of some step lies in the solid's interior: every voxel that touches it is
// black.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "blackleaf/drawing.h"
#include "reference/dense_grid.h"

namespace blackleaf::reference {

__extension__ using Wide = __int128;

inline Wide floor_div(Wide a, Wide b) { return a / b - (a % b != 0 && (a < 0) != (b < 0)); }
inline Wide absolute(Wide a) { return a < 0 ? -a : a; }
inline Wide gcd_wide(Wide a, Wide b) {
  a = absolute(a), b = absolute(b);
  while (b != 0) a = std::exchange(b, a % b);
  return a;
}

class DenseDrawing {
 public:
  using Vector = std::array<Wide, 3>;

  /// The strokes of the drawing, in no particular order. `d` as View::direction() gives it.
  static std::vector<Stroke> strokes(const DenseGrid& grid, const std::array<std::int64_t, 3>& d) {
    DenseDrawing drawing(grid, {d[0], d[1], d[2]});
    for (std::size_t axis = 0; axis < 3; ++axis) drawing.draw_axis(axis);
    return drawing.united();
  }

 private:
  // A point of the picture as multiples of the unnormalised axes, over a common denominator.
  struct Point {
    Wide u, v, denominator;
    Wide numerator(bool by_v) const { return by_v ? v : u; }
  };
  using Line = std::tuple<Wide, Wide, Wide, Wide>;  // reduced direction, reduced offset (numerator, denominator)

  DenseDrawing(const DenseGrid& grid, const Vector& d) : grid_(grid), d_(d) {
    const Vector up = d[0] == 0 && d[1] == 0 ? Vector{0, 1, 0} : Vector{0, 0, 1};
    right_ = cross(up, d);
    up_ = cross(d, right_);
  }

  static Vector cross(const Vector& p, const Vector& q) {
    return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
  }
  static Wide dot(const Vector& p, const Vector& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

  bool black(std::array<int, 3> voxel) const { return grid_.at(voxel[0], voxel[1], voxel[2]); }

  bool is_feature(std::size_t axis, const std::array<int, 3>& at) const {
    const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
    std::array<std::array<bool, 2>, 2> around{};
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        auto voxel = at;
        voxel[b] -= i, voxel[c] -= j;
        around[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = black(voxel);
      }
    const bool flat_across_b = around[0] == around[1];
    const bool flat_across_c = around[0][0] == around[0][1] && around[1][0] == around[1][1];
    return !flat_across_b && !flat_across_c;
  }

  void draw_axis(std::size_t axis) {
    const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
    if (d_[b] == 0 && d_[c] == 0) return;
    const Wide q = 2 * absolute((d_[b] == 0 ? 1 : d_[b]) * (d_[c] == 0 ? 1 : d_[c]));
    const int n = grid_.side();
    std::array<int, 3> at{};
    for (at[0] = 0; at[0] <= n; ++at[0])
      for (at[1] = 0; at[1] <= n; ++at[1])
        for (at[2] = 0; at[2] <= n; ++at[2])
          if (is_feature(axis, at)) draw_edge(axis, at, q);
  }

  void draw_edge(std::size_t axis, const std::array<int, 3>& at, Wide q) {
    std::vector<Wide> cuts = {0, q};  // places along the edge in units of 1/q
    for (const std::size_t other : {(axis + 1) % 3, (axis + 2) % 3})
      for (int plane = 0; plane <= grid_.side() && d_[other] != 0; ++plane) {
        const Wide travelled = (plane - at[other]) * d_[axis] * (q / d_[other]);
        cuts.push_back(-travelled - floor_div(-travelled, q) * q);
      }
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      Vector p = {at[0] * q, at[1] * q, at[2] * q};
      p[axis] += (cuts[i - 1] + cuts[i]) / 2;
      if (is_blocked(p, q)) continue;
      Vector from = p, to = p;
      from[axis] = at[axis] * q + cuts[i - 1];
      to[axis] = at[axis] * q + cuts[i];
      add(axis, from, to, q);
    }
  }

  // Whether the open ray from p / q toward d meets the solid's interior. Times are in units of 1 / (q times).
  bool is_blocked(const Vector& p, Wide q) const {
    Wide times = 1;
    for (const Wide component : d_) times *= component == 0 ? 1 : absolute(component);
    std::vector<Wide> crossings = {0};
    for (std::size_t i = 0; i < 3; ++i)
      for (int plane = 0; plane <= grid_.side() && d_[i] != 0; ++plane)
        if (const Wide time = (plane * q - p[i]) * (times / d_[i]); time > 0) crossings.push_back(time);
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 1; i < crossings.size(); ++i) {
      if (crossings[i - 1] == crossings[i]) continue;
      Vector middle;
      for (std::size_t k = 0; k < 3; ++k) middle[k] = p[k] * 2 * times + (crossings[i - 1] + crossings[i]) * d_[k];
      if (is_interior(middle, 2 * times * q)) return true;
    }
    return false;
  }

  bool is_interior(const Vector& p, Wide denominator) const {
    std::array<int, 3> high{}, low{};
    for (std::size_t i = 0; i < 3; ++i) {
      high[i] = static_cast<int>(floor_div(p[i], denominator));
      low[i] = p[i] % denominator == 0 ? high[i] - 1 : high[i];
    }
    for (int x = low[0]; x <= high[0]; ++x)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int z = low[2]; z <= high[2]; ++z)
          if (!black({x, y, z})) return false;
    return true;
  }

  void add(std::size_t axis, const Vector& from, const Vector& to, Wide q) {
    Wide du = right_[axis], dv = up_[axis];
    const Wide divisor = gcd_wide(du, dv) * (du < 0 || (du == 0 && dv < 0) ? -1 : 1);
    du /= divisor, dv /= divisor;
    std::array<Point, 2> ends;
    ends[0] = {dot(right_, from), dot(up_, from), q};
    ends[1] = {dot(right_, to), dot(up_, to), q};
    if (divisor < 0) std::swap(ends[0], ends[1]);
    const Wide offset = du * ends[0].v - dv * ends[0].u, common = gcd_wide(offset, q);
    lines_[{du, dv, offset / common, q / common}].push_back(ends);
  }

  std::vector<Stroke> united() const {
    std::vector<Stroke> strokes;
    for (const auto& [line, found] : lines_) {
      const bool by_v = std::get<0>(line) == 0;
      // Only views in a coordinate plane, whose denominators are small, put different ones on one line; for equal ones
      // the products could overflow and are not needed.
      const auto before = [&](const Point& p, const Point& r) {
        if (p.denominator == r.denominator) return p.numerator(by_v) < r.numerator(by_v);
        return p.numerator(by_v) * r.denominator < r.numerator(by_v) * p.denominator;
      };
      auto pieces = found;
      std::sort(pieces.begin(), pieces.end(), [&](const auto& p, const auto& r) { return before(p[0], r[0]); });
      for (std::size_t i = 0; i < pieces.size();) {
        const Point from = pieces[i][0];
        Point to = pieces[i][1];
        for (++i; i < pieces.size() && !before(to, pieces[i][0]); ++i)
          if (before(to, pieces[i][1])) to = pieces[i][1];
        strokes.push_back({on_screen(from), on_screen(to)});
      }
    }
    return strokes;
  }

  Eigen::Vector2d on_screen(const Point& p) const {
    const auto scaled = [&](Wide numerator, const Vector& axis) {
      return static_cast<double>(numerator) / static_cast<double>(p.denominator) /
             std::sqrt(static_cast<double>(dot(axis, axis)));
    };
    return {scaled(p.u, right_), scaled(p.v, up_)};
  }

  const DenseGrid& grid_;
  Vector d_, right_, up_;
  std::map<Line, std::vector<std::array<Point, 2>>> lines_;
};

/// Empty if the two lists hold the same strokes, whatever their order and sense, ends within `tolerance`; else what
/// differs first.
inline std::string difference(std::vector<Stroke> a, std::vector<Stroke> b, double tolerance) {
  const auto show = [](const Stroke& s) {
    return "(" + std::to_string(s.from[0]) + ", " + std::to_string(s.from[1]) + ")-(" + std::to_string(s.to[0]) + ", " +
           std::to_string(s.to[1]) + ")";
  };
  const auto prepare = [&](std::vector<Stroke>& strokes) {
    for (Stroke& s : strokes) {
      const Eigen::Vector2d along = s.to - s.from;
      if (std::abs(along[0]) > tolerance ? along[0] < 0 : along[1] < 0) std::swap(s.from, s.to);
    }
    std::sort(strokes.begin(), strokes.end(), [](const Stroke& s, const Stroke& t) { return s.from[0] < t.from[0]; });
  };
  prepare(a);
  prepare(b);
  std::vector<bool> used(b.size(), false);
  std::size_t start = 0;
  for (const Stroke& s : a) {
    while (start < b.size() && b[start].from[0] < s.from[0] - tolerance) ++start;
    bool found = false;
    for (std::size_t i = start; i < b.size() && b[i].from[0] <= s.from[0] + tolerance && !found; ++i)
      if (!used[i] && (b[i].from - s.from).norm() <= tolerance && (b[i].to - s.to).norm() <= tolerance)
        used[i] = found = true;
    if (!found)
      return "only in the first of " + std::to_string(a.size()) + "/" + std::to_string(b.size()) + ": " + show(s);
  }
  for (std::size_t i = 0; i < b.size(); ++i)
    if (!used[i])
      return "only in the second of " + std::to_string(a.size()) + "/" + std::to_string(b.size()) + ": " + show(b[i]);
  return "";
}

}  // namespace blackleaf::reference
