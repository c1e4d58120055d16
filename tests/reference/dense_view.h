// What the slow readable twins of drawings share: dense grids seen along a direction, in whole numbers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "blackleaf/drawing.h"
#include "reference/dense_grid.h"

namespace blackleaf::reference {

__extension__ using Wide = __int128;
using WideVector = std::array<Wide, 3>;

inline Wide floor_div(Wide a, Wide b) { return a / b - (a % b != 0 && (a < 0) != (b < 0)); }
inline Wide absolute(Wide a) { return a < 0 ? -a : a; }
inline Wide gcd_wide(Wide a, Wide b) {
  a = absolute(a), b = absolute(b);
  while (b != 0) a = std::exchange(b, a % b);
  return a;
}
inline WideVector cross(const WideVector& p, const WideVector& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
inline Wide dot(const WideVector& p, const WideVector& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

/// Whether the lattice edge along an axis from `at` on is where the boundary is not flat.
inline bool is_feature(const DenseGrid& grid, std::size_t axis, const std::array<int, 3>& at) {
  const auto black = [&](int b, int c) {
    std::array<int, 3> voxel = at;
    voxel[(axis + 1) % 3] -= b;
    voxel[(axis + 2) % 3] -= c;
    return grid.at(voxel[0], voxel[1], voxel[2]);
  };
  const bool flat_across_b = black(0, 0) == black(1, 0) && black(0, 1) == black(1, 1);
  const bool flat_across_c = black(0, 0) == black(0, 1) && black(1, 0) == black(1, 1);
  return !flat_across_b && !flat_across_c;
}

/// Whether p / denominator lies in the interior: every voxel that touches it is black.
inline bool is_interior(const DenseGrid& grid, const WideVector& p, Wide denominator) {
  std::array<int, 3> high{}, low{};
  for (std::size_t i = 0; i < 3; ++i) {
    high[i] = static_cast<int>(floor_div(p[i], denominator));
    low[i] = p[i] % denominator == 0 ? high[i] - 1 : high[i];
  }
  for (int x = low[0]; x <= high[0]; ++x)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int z = low[2]; z <= high[2]; ++z)
        if (!grid.at(x, y, z)) return false;
  return true;
}

/// A direction and its picture.
struct DenseView {
  /// A place of the picture: multiples of the axes, which are not of length one, over a denominator above 0.
  struct Place {
    Wide u, v, denominator;

    /// Of two places on a line: along u, or along v where u is the same for all.
    bool before(const Place& other, bool by_v) const {
      const Wide a = by_v ? v : u, b = by_v ? other.v : other.u;
      // Only views in a coordinate plane, whose denominators are small, put different ones on one line; for equal ones
      // the products could overflow and are not needed.
      return denominator == other.denominator ? a < b : a * other.denominator < b * denominator;
    }
  };
  /// A line of the picture: reduced direction, reduced offset (numerator, denominator).
  struct Line {
    Wide du, dv, offset, denominator;

    bool operator<(const Line& other) const { return tuple() < other.tuple(); }
    bool by_v() const { return du == 0; }

   private:
    std::tuple<Wide, Wide, Wide, Wide> tuple() const { return {du, dv, offset, denominator}; }
  };

  WideVector d, right, up;

  explicit DenseView(const std::array<std::int64_t, 3>& direction) : d{direction[0], direction[1], direction[2]} {
    right = cross(d[0] == 0 && d[1] == 0 ? WideVector{0, 1, 0} : WideVector{0, 0, 1}, d);
    up = cross(d, right);
  }

  /// The line and, in order, the ends of what lies along an axis from from / q to to / q.
  std::pair<Line, std::array<Place, 2>> place(std::size_t axis, const WideVector& from, const WideVector& to,
                                              Wide q) const {
    Wide du = right[axis], dv = up[axis];
    const Wide divisor = gcd_wide(du, dv) * (du < 0 || (du == 0 && dv < 0) ? -1 : 1);
    du /= divisor, dv /= divisor;
    Place low = {dot(right, from), dot(up, from), q}, high = {dot(right, to), dot(up, to), q};
    if (divisor < 0) std::swap(low, high);
    const Wide offset = du * low.v - dv * low.u, common = gcd_wide(offset, q);
    return {{du, dv, offset / common, q / common}, {low, high}};
  }

  /// Places of an edge, in units of 1 / q, between which the answer cannot change: its ends and where rays pass through
  /// lattice lines across it. In any order, some more than once.
  std::vector<Wide> cuts(std::size_t axis, const std::array<int, 3>& at, int side, Wide q) const {
    std::vector<Wide> cuts = {0, q};
    for (const std::size_t other : {(axis + 1) % 3, (axis + 2) % 3})
      for (int plane = 0; plane <= side && d[other] != 0; ++plane) {
        const Wide travelled = (plane - at[other]) * d[axis] * (q / d[other]);
        cuts.push_back(-travelled - floor_div(-travelled, q) * q);
      }
    return cuts;
  }

  /// The product of the components that are not zero, without sign: in units of 1 / (q times it) the times at which a
  /// ray from p / q meets lattice planes are whole.
  Wide times() const {
    Wide product = 1;
    for (const Wide component : d) product *= component == 0 ? 1 : absolute(component);
    return product;
  }

  /// p / q goes the middle of two times along d, in units of 1 / (2 q times()).
  WideVector between(const WideVector& p, Wide first, Wide second) const {
    WideVector middle;
    for (std::size_t i = 0; i < 3; ++i) middle[i] = p[i] * 2 * times() + (first + second) * d[i];
    return middle;
  }

  Eigen::Vector2d on_screen(const Place& p) const {
    const auto scaled = [&](Wide numerator, const WideVector& axis) {
      return static_cast<double>(numerator) / static_cast<double>(p.denominator) /
             std::sqrt(static_cast<double>(dot(axis, axis)));
    };
    return {scaled(p.u, right), scaled(p.v, up)};
  }
};

}  // namespace blackleaf::reference
