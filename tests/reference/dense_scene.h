// The slow readable twin of draw(scene): one unit edge of one solid at a time over dense grids, in whole numbers, as
// dense_drawing.h does for one solid. Of the pens that draw a place the first is found by asking all of them.
#pragma once

#include <limits>
#include <set>

#include "blackleaf/scene.h"
#include "reference/dense_drawing.h"

namespace blackleaf::reference {

class DenseScene {
 public:
  using Vector = std::array<Wide, 3>;
  using Layers = std::map<std::pair<LineKind, std::size_t>, std::vector<Stroke>>;

  static Layers lines(const std::vector<DenseGrid>& solids, const std::array<std::int64_t, 3>& d,
                      const SceneOptions& options) {
    DenseScene scene(solids, {d[0], d[1], d[2]}, options);
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

  static bool is_feature(const DenseGrid& grid, std::size_t axis, const std::array<int, 3>& at) {
    const auto black = [&](int b, int c) {
      std::array<int, 3> voxel = at;
      voxel[(axis + 1) % 3] -= b;
      voxel[(axis + 2) % 3] -= c;
      return grid.at(voxel[0], voxel[1], voxel[2]);
    };
    const bool along_b = black(0, 0) == black(1, 0) && black(0, 1) == black(1, 1);
    const bool along_c = black(0, 0) == black(0, 1) && black(1, 0) == black(1, 1);
    return !along_b && !along_c;
  }

 private:
  // A place on a picture line: u and v times the unnormalised axes, over a denominator.
  struct Place {
    Wide u, v, denominator;
  };
  struct Piece {
    Place from, to;
    std::pair<LineKind, std::size_t> pen;
  };
  using Line = std::tuple<Wide, Wide, Wide, Wide>;  // reduced direction, reduced offset (numerator, denominator)

  DenseScene(const std::vector<DenseGrid>& solids, const Vector& d, const SceneOptions& options)
      : solids_(solids), all_(union_of(solids)), d_(d), options_(options) {
    const Vector up = d[0] == 0 && d[1] == 0 ? Vector{0, 1, 0} : Vector{0, 0, 1};
    right_ = cross(up, d);
    up_ = cross(d, right_);
  }

  static Vector cross(const Vector& p, const Vector& q) {
    return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
  }
  static Wide dot(const Vector& p, const Vector& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

  void draw_axis(std::size_t solid, std::size_t axis) {
    const Wide d_b = d_[(axis + 1) % 3], d_c = d_[(axis + 2) % 3];
    if (d_b == 0 && d_c == 0) return;
    const Wide scale = absolute((d_b == 0 ? 1 : d_b) * (d_c == 0 ? 1 : d_c));
    // The gap behind outlines in times of d, rounded up to 1 / scale.
    const double gap = options_.outline_gap / std::sqrt(static_cast<double>(dot(d_, d_))) * static_cast<double>(scale);
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
    std::set<Wide> cuts = {0, q};  // places along the edge in units of 1/q
    for (const std::size_t other : {(axis + 1) % 3, (axis + 2) % 3})
      for (int plane = 0; plane <= all_.side() && d_[other] != 0; ++plane) {
        const Wide travelled = (plane - at[other]) * d_[axis] * (q / d_[other]);
        cuts.insert(-travelled - floor_div(-travelled, q) * q);
      }
    if (stop >= 0) {
      const Wide travelled = -2 * stop * d_[axis];
      cuts.insert(-travelled - floor_div(-travelled, q) * q);
    }
    for (auto high = std::next(cuts.begin()); high != cuts.end(); ++high) {
      const Wide low = *std::prev(high);
      Vector p = {at[0] * q, at[1] * q, at[2] * q};
      p[axis] += (low + *high) / 2;
      Vector from = p, to = p;
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
  bool is_blocked(const Vector& p, Wide q, int sign, Wide stop) const {
    Wide times = 1;
    for (const Wide component : d_) times *= component == 0 ? 1 : absolute(component);
    std::set<Wide> crossings = {0};  // in 1 / (q times)
    for (std::size_t i = 0; i < 3; ++i)
      for (int plane = 0; plane <= all_.side() && d_[i] != 0; ++plane)
        if (const Wide time = sign * (plane * q - p[i]) * (times / d_[i]); time > 0)
          if (stop < 0 || time < stop * times) crossings.insert(time);
    if (stop >= 0 && *crossings.rbegin() < stop * times) crossings.insert(stop * times);
    for (auto high = std::next(crossings.begin()); high != crossings.end(); ++high) {
      Vector middle;
      for (std::size_t k = 0; k < 3; ++k) middle[k] = p[k] * 2 * times + sign * (*std::prev(high) + *high) * d_[k];
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
          if (!all_.at(x, y, z)) return false;
    return true;
  }

  void add(std::size_t axis, const Vector& from, const Vector& to, Wide q, std::pair<LineKind, std::size_t> pen) {
    Wide du = right_[axis], dv = up_[axis];
    const Wide divisor = gcd_wide(du, dv) * (du < 0 || (du == 0 && dv < 0) ? -1 : 1);
    du /= divisor, dv /= divisor;
    Place low = {dot(right_, from), dot(up_, from), q}, high = {dot(right_, to), dot(up_, to), q};
    if (divisor < 0) std::swap(low, high);
    const Wide offset = du * low.v - dv * low.u, common = gcd_wide(offset, q);
    lines_[{du, dv, offset / common, q / common}].push_back({low, high, pen});
  }

  Layers first_pens() const {
    Layers layers;
    for (const auto& [line, pieces] : lines_) {
      const bool by_v = std::get<0>(line) == 0;
      const auto before = [&](const Place& p, const Place& r) {
        const Wide a = by_v ? p.v : p.u, b = by_v ? r.v : r.u;
        return p.denominator == r.denominator ? a < b : a * r.denominator < b * p.denominator;
      };
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
          last->back().to = on_screen(high);
        } else {
          last_pen = first->pen;
          last = &layers[last_pen];
          last->push_back({on_screen(low), on_screen(high)});
        }
      }
    }
    return layers;
  }

  Eigen::Vector2d on_screen(const Place& p) const {
    const auto scaled = [&](Wide numerator, const Vector& axis) {
      return static_cast<double>(numerator) / static_cast<double>(p.denominator) /
             std::sqrt(static_cast<double>(dot(axis, axis)));
    };
    return {scaled(p.u, right_), scaled(p.v, up_)};
  }

  const std::vector<DenseGrid>& solids_;
  DenseGrid all_;
  Vector d_, right_, up_;
  const SceneOptions& options_;
  std::map<Line, std::vector<Piece>> lines_;
};

}  // namespace blackleaf::reference
