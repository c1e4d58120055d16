// EdgeFamily: what all lattice edges along one axis have in common under one view direction, in integers.
//
// The points of an edge along axis a differ only in a, so in the plane of the other two axes (b, c) they all follow the
// same 2-D ray. With d the view direction, D the family's `scale` and d_i its components:
//
//   general  d_b and d_c are not zero. D = |d_b d_c|. A box blocks a ray iff the ray meets its inside.
//   in_plane d_b = 0, d_c is not. D = |d_c|. The ray stays in the lattice plane of its edge's coordinate b and only
//            touches faces there; it is blocked only where the cubes on both sides of the plane are black.
//   end_on   d_b = d_c = 0. The edge is a point of the picture and is not drawn.
//
// Positions S along an edge are in units of 1/D voxel, times tau along a ray in units of 1/D of d; the numbers below
// are then whole: tau of the plane x_b = B is (B - b) |d_c| sgn(d_b), and a ray that starts at S has at time tau the
// coordinate (S + tau d_a) / D along a.
//
// Bounds. |d_i| <= 2^20 and coordinates lie in [0, 2^20], so |S| <= 2^60, |tau| <= 2^40, |tau d_a| <= 2^60 and sums of
// an S and a tau d_a stay below 2^62: 64 bits are enough.
//
// Picture lines. A point lands where all points p + t d land, so a point of the picture is named by the one of them
// with coordinate c = 0. An edge lies on the picture line `key`, at `position`:
//
//   general   key = b d_c - c d_b, position = S - c d_a |d_b| sgn(d_c). |key| <= 2^41, |position| <= 2^61.
//   in_plane  key = b, position = +-(S sgn(d_c) - c d_a). When d_a is not zero the edges along a and along c of one
//             plane b share its picture line; the sign makes both count position as x_i d_j - x_j d_i with i < j.
//
// Lines of different `line_class` are never on one line of the picture: the images of two axes are parallel only if d
// lies in their plane, and then they are of one class.
#pragma once

#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>

namespace blackleaf::detail {

using Direction = std::array<std::int64_t, 3>;

/// A visible piece of an edge on its picture line: [low, high], low < high.
struct Piece {
  std::int64_t key, low, high;

  /// Not set to anything, so that room for many costs nothing.
  Piece() {}
  Piece(std::int64_t on_line, std::int64_t from, std::int64_t to) : key(on_line), low(from), high(to) {}
  /// Of pieces that begin at one place any may come first.
  friend bool operator<(const Piece& p, const Piece& q) { return p.key != q.key ? p.key < q.key : p.low < q.low; }
};

/// Positions [low, high] in the units of a family.
struct Interval {
  std::int64_t low, high;
};

struct EdgeFamily {
  enum class Mode { general, in_plane, end_on };

  Mode mode;
  unsigned a, b, c;            // axes: the edges', and the other two (in_plane: the ray moves along c, not along b)
  std::int64_t d_a, d_b, d_c;  // the view direction along them
  std::int64_t scale;          // D
  unsigned line_class;         // 0..2, index of a LineClass
  std::int64_t position_sign;  // the sign of S in `position`
  std::int64_t shift;          // what each c takes from it

  static constexpr std::int64_t sign(std::int64_t value) { return value < 0 ? -1 : 1; }

  EdgeFamily(unsigned axis, const Direction& d) : a(axis), b((axis + 1) % 3), c((axis + 2) % 3) {
    if (d[b] != 0 && d[c] == 0) std::swap(b, c);
    d_a = d[a], d_b = d[b], d_c = d[c];
    mode = d_c == 0 ? Mode::end_on : d_b == 0 ? Mode::in_plane : Mode::general;
    scale = mode == Mode::general ? std::abs(d_b * d_c) : std::abs(d_c);
    line_class = a;
    position_sign = 1;
    if (mode == Mode::in_plane) {
      const bool first = d_a == 0 || a < c;
      line_class = first ? a : c;
      position_sign = first ? sign(d_c) : -sign(d_c);
    }
    // In a plane, position_sign carries the sign of d_c; without it, +1 or -1 is left.
    shift = mode == Mode::general ? d_a * std::abs(d_b) * sign(d_c) : position_sign * sign(d_c) * d_a;
  }

  /// The time tau at which rays have gone `times` d, rounded up; the largest there is for anything beyond 2^61.
  /// Requires: times >= 0.
  std::int64_t time_of(double times) const {
    const double tau = times * static_cast<double>(scale);
    return tau < 2305843009213693952.0 ? static_cast<std::int64_t>(std::ceil(tau))
                                       : std::numeric_limits<std::int64_t>::max();
  }

  /// The picture line of the edge at (b, c) = (at_b, at_c).
  std::int64_t key(std::int64_t at_b, std::int64_t at_c) const {
    return mode == Mode::general ? at_b * d_c - at_c * d_b : at_b;
  }

  /// The picture's name of the positions `visible` of the edge at (b, c) = (at_b, at_c). Requires: mode is not end_on.
  Piece piece(const Interval& visible, std::int64_t at_b, std::int64_t at_c) const {
    assert(mode != Mode::end_on);
    const std::int64_t away = at_c * shift;
    if (mode == Mode::general) return {key(at_b, at_c), visible.low - away, visible.high - away};
    const std::int64_t one = position_sign * visible.low - away, other = position_sign * visible.high - away;
    return {at_b, position_sign > 0 ? one : other, position_sign > 0 ? other : one};
  }
};

}  // namespace blackleaf::detail
