// The slow readable twin of hatch(): every hatch line of the picture is cut where it crosses the image of any lattice
// edge, and between two such places one sight line is followed from the viewer to the first black voxel of a dense
// grid. Whole numbers only; directions up to 1000 in size.
#pragma once

#include "blackleaf/hatch.h"
#include "reference/dense_scene.h"

namespace blackleaf::reference {

/// Dense solids of a scene, and what boxes took away of them.
struct DenseCutScene {
  std::vector<DenseGrid> kept;
  DenseGrid lost;  // by the union

  DenseCutScene(const std::vector<DenseGrid>& solids, const std::vector<Box>& boxes)
      : kept(solids), lost(solids.front().depth) {
    for (DenseGrid& grid : kept)
      for (const Box& box : boxes)
        for (int z = std::max(0, box.min[2]); z < std::min(grid.side(), box.max[2]); ++z)
          for (int y = std::max(0, box.min[1]); y < std::min(grid.side(), box.max[1]); ++y)
            for (int x = std::max(0, box.min[0]); x < std::min(grid.side(), box.max[0]); ++x) {
              if (grid.at(x, y, z)) lost.set(x, y, z);
              grid.set(x, y, z, false);
            }
  }
  /// Whether the face of a voxel across an axis, on its upper or lower side, is a cut face of a solid.
  bool is_cut(std::size_t solid, std::array<int, 3> voxel, std::size_t axis, bool upward) const {
    if (!kept[solid].at(voxel[0], voxel[1], voxel[2])) return false;
    voxel[axis] += upward ? 1 : -1;
    return lost.at(voxel[0], voxel[1], voxel[2]);
  }
};

class DenseHatch {
 public:
  using Layers = DenseScene::Layers;

  static Layers lines(const DenseCutScene& scene, const std::array<std::int64_t, 3>& d, const HatchOptions& options) {
    DenseHatch twin(scene, d);
    for (std::size_t n = 0; n < 3; ++n) {
      if (d[n] == 0) continue;
      if (options.faces > 0 && options.tone[n] > 0) twin.draw(n, false, false, options.faces * options.tone[n]);
      if (options.cuts > 0)
        for (const bool odd : {false, true}) twin.draw(n, true, odd, options.cuts);
    }
    return twin.layers_;
  }

 private:
  struct Fraction {
    Wide numerator, denominator;  // above 0
    bool operator<(const Fraction& b) const { return numerator * b.denominator < b.numerator * denominator; }
  };
  struct Face {  // what a sight line sees
    std::size_t solid = 0, axis = 0;
    bool cut = false;
  };

  DenseHatch(const DenseCutScene& scene, const std::array<std::int64_t, 3>& d)
      : scene_(scene), view_(d), n_(scene.kept.front().side()) {}

  void draw(std::size_t n, bool cut, bool odd, double distance) {
    const std::size_t b = (n + 1) % 3, c = (n + 2) % 3;
    WideVector h{};
    h[b] = h[c] = 1;
    const bool rises = (dot(view_.right, h) > 0) == (dot(view_.up, h) > 0);
    if (rises != (cut && !odd)) h[c] = -1;
    WideVector w = cross(h, view_.d);
    const Wide common = gcd_wide(gcd_wide(w[0], w[1]), w[2]);
    for (Wide& component : w) component /= common;
    const double length = std::sqrt(static_cast<double>(dot(w, w)));
    const Wide m = std::max<std::int64_t>(1, std::llround(distance * length * 256));
    const Wide reach = 512 * n_ * (absolute(w[0]) + absolute(w[1]) + absolute(w[2]));
    for (Wide j = -reach / (2 * m) - 1; j <= reach / (2 * m) + 1; ++j)
      draw_line(n, cut, odd, w, dot(view_.right, h) != 0 ? view_.right : view_.up, 2 * m * j + 1);
  }

  // The line w.p = k / 512, with places on it named by s.p.
  void draw_line(std::size_t n, bool cut, bool odd, const WideVector& w, const WideVector& s, Wide k) {
    std::set<Fraction> places;
    for (int x = 0; x <= n_; ++x)
      for (int y = 0; y <= n_; ++y)
        for (int z = 0; z <= n_; ++z)
          for (std::size_t j = 0; j < 3; ++j) {
            const WideVector v = {x, y, z};
            const Wide part = k - 512 * dot(w, v), all = 512 * w[j];  // the edge is crossed at part / all of it
            if (w[j] == 0 || (part < 0) != (all < 0) || absolute(part) > absolute(all)) continue;
            const Wide sign = all < 0 ? -1 : 1;
            places.insert({sign * (all * dot(s, v) + s[j] * part), sign * all});
          }
    std::vector<Stroke>* last = nullptr;
    for (auto high = places.begin(); high != places.end(); ++high) {
      if (high == places.begin()) continue;
      const Fraction &low = *std::prev(high), between = between_two(low, *high);
      std::optional<Face> face = seen(n, w, s, k, between);
      if (!face || face->axis != n || face->cut != cut || (cut && (face->solid % 2 == 1) != odd)) {
        last = nullptr;
        continue;
      }
      std::vector<Stroke>& strokes = layers_[{cut ? LineKind::cut : LineKind::hatch, face->solid}];
      if (last == &strokes)
        last->back().to = on_screen(n, w, s, k, *high);
      else
        strokes.push_back({on_screen(n, w, s, k, low), on_screen(n, w, s, k, *high)});
      last = &strokes;
    }
  }

  // A fraction with a power of two as denominator between two others.
  static Fraction between_two(const Fraction& a, const Fraction& b) {
    for (Wide denominator = 1;; denominator *= 2) {
      const Fraction f{floor_div(a.numerator * denominator, a.denominator) + 1, denominator};
      if (f < b) return f;
    }
  }

  // The point p / q with w.p = k / 512, s.p as said and p_n = 0.
  std::pair<WideVector, Wide> point(std::size_t n, const WideVector& w, const WideVector& s, Wide k,
                                    const Fraction& at) const {
    const std::size_t b = (n + 1) % 3, c = (n + 2) % 3;
    const Wide determinant = w[b] * s[c] - w[c] * s[b];
    Wide q = 512 * at.denominator * determinant;
    WideVector p{};
    p[b] = k * at.denominator * s[c] - w[c] * at.numerator * 512;
    p[c] = w[b] * at.numerator * 512 - s[b] * k * at.denominator;
    if (q < 0) q = -q, p[b] = -p[b], p[c] = -p[c];
    return {p, q};
  }

  Eigen::Vector2d on_screen(std::size_t n, const WideVector& w, const WideVector& s, Wide k, const Fraction& at) const {
    const auto [p, q] = point(n, w, s, k, at);
    return view_.on_screen({dot(view_.right, p), dot(view_.up, p), q});
  }

  std::optional<Face> seen(std::size_t n, const WideVector& w, const WideVector& s, Wide k, const Fraction& at) const {
    auto [p, q] = point(n, w, s, k, at);
    if (const Wide divisor = gcd_wide(gcd_wide(p[0], p[1]), gcd_wide(p[2], q)); divisor > 1) {
      for (Wide& component : p) component /= divisor;
      q /= divisor;
    }
    const Wide times = view_.times();
    std::map<Wide, std::size_t> crossings;  // times in 1 / (q times), and the axis of the plane
    for (std::size_t i = 0; i < 3; ++i)
      for (int plane = 0; plane <= n_ && view_.d[i] != 0; ++plane)
        crossings[(plane * q - p[i]) * (times / view_.d[i])] = i;
    for (auto near = crossings.rbegin(); std::next(near) != crossings.rend(); ++near) {
      const Wide middle = near->first + std::next(near)->first;
      std::array<int, 3> voxel{};
      for (std::size_t i = 0; i < 3; ++i)
        voxel[i] = static_cast<int>(floor_div(p[i] * 2 * times + middle * view_.d[i], 2 * times * q));
      for (std::size_t solid = 0; solid < scene_.kept.size(); ++solid)
        if (scene_.kept[solid].at(voxel[0], voxel[1], voxel[2]))
          return Face{solid, near->second, scene_.is_cut(solid, voxel, near->second, view_.d[near->second] > 0)};
    }
    return std::nullopt;
  }

  const DenseCutScene& scene_;
  DenseView view_;
  int n_;
  Layers layers_;
};

}  // namespace blackleaf::reference
