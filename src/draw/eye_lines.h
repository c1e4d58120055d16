// Lines and planes through the eye: the integers of perspective drawings.
//
// Everything is seen from the eye, in units of 2^-16 voxel: a lattice plane x_i = k is at X_i = 2^16 k - e_i. Lattice
// coordinates lie in [0, 2^20] and |e_i| <= 2^40, so |X_i| <= 2^40 + 2^36 < 2^41.
//
// An edge along axis a stands at (X_b, X_c) = (b, c). The way from its point s to the eye is (s, b, c) / k for k from 1
// to infinity; in the plane of the axes b and c all points of an edge go the same way at the same "time" k. The plane
// X_b = B is passed at k = b / B if B has the sign of b and is nearer to 0. A box [A, A'] x [B, B'] x [C, C'] is met
// for k in an open interval (k0, k1) and hides there the points s with A < s / k < A', together the open interval
//
//   (A k0 or A k1, whichever is less;  A' k0 or A' k1, whichever is greater).
//
// So every end of a visible piece is s = A b / B or A c / C: a `Place`, a fraction with a numerator below 2^82 and a
// denominator of at most 2^41. Two of them are compared by products below 2^123.
//
// Picture lines. An edge is seen on the plane through it and the eye. If b and c are not zero, only edges along a with
// the same direction (b, c) / g, g = gcd(|b|, |c|), lie there, and s / g is a position that they share. If b is zero,
// the plane is the lattice plane X_b = 0, and edges along a and along c lie in it, on all sides of the eye; a position
// is then the direction (X_i, X_j), i < j, in that plane, and one precedes another if it lies clockwise of it. All that
// is seen lies inside the field of view, which is less than a half plane there, so that this is an order. In both cases
// a position is a pair (along, across), along = s / g and across = 1 in the first one, and (x, y) precedes (x', y') iff
// x y' < x' y.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "blackleaf/perspective.h"
#include "wide.h"

namespace blackleaf::detail {

inline constexpr std::int64_t kUnit = std::int64_t{1} << Perspective::kGridBits;

/// A position along an edge, num / den from the eye in units of 2^-16 voxel.
struct Place {
  Wide num;
  std::int64_t den;  // > 0
  double rough;      // num / den within a factor 1 +- 2^-52

  static Place of(std::int64_t along, std::int64_t factor, std::int64_t den) { return of(Wide{along} * factor, den); }
  static Place of(Wide num, std::int64_t den) {
    return {num, den, static_cast<double>(num) / static_cast<double>(den)};
  }

  friend bool operator<(const Place& p, const Place& q) { return p.num * q.den < q.num * p.den; }
  friend bool operator>(const Place& p, const Place& q) { return q < p; }
  friend bool operator<=(const Place& p, const Place& q) { return !(q < p); }
  friend bool operator>=(const Place& p, const Place& q) { return !(p < q); }
};

/// The name of a picture line within its line class.
using EyeKey = std::pair<std::int64_t, std::int64_t>;

/// A place on a picture line: a point that is seen at the coordinates (along, across key.first, across key.second)
/// times a positive number from the eye, along the axes (a, b, c) of the line class. |along| < 2^82, |across| <= 2^41.
struct EyePosition {
  Wide along;
  std::int64_t across;

  friend std::weak_ordering operator<=>(const EyePosition& p, const EyePosition& q) {
    const Wide left = p.along * q.across, right = q.along * p.across;
    return left < right   ? std::weak_ordering::less
           : right < left ? std::weak_ordering::greater
                          : std::weak_ordering::equivalent;
  }
  friend bool operator==(const EyePosition& p, const EyePosition& q) { return !(p < q) && !(q < p); }
};

/// A piece of an edge on its picture line.
struct EyePiece {
  EyeKey key;
  EyePosition low, high;
};

/// Line classes: a for edges along axis a; 3 + b for the lattice plane X_b = 0 through the eye.
inline constexpr unsigned kEyeLineClasses = 6;

/// The axes (a, b, c) of a line class.
constexpr std::array<unsigned, 3> axes_of(unsigned line_class) {
  if (line_class < 3) return {line_class, (line_class + 1) % 3, (line_class + 2) % 3};
  const unsigned b = line_class - 3;
  return {b == 0 ? 1u : 0u, b, b == 2 ? 1u : 2u};
}

/// Where an edge stands, seen from the eye.
struct EyeEdge {
  unsigned a, b, c;         // axes: the edge's, and the other two; b is the one in which the eye is level with it
  std::int64_t at_b, at_c;  // X_b and X_c
  bool in_plane() const { return at_b == 0; }
  bool end_on() const { return at_b == 0 && at_c == 0; }

  /// Requires: `at_b`, `at_c` are those of axes axis + 1, axis + 2 modulo 3.
  EyeEdge(unsigned axis, std::int64_t at_first, std::int64_t at_second)
      : a(axis), b((axis + 1) % 3), c((axis + 2) % 3), at_b(at_first), at_c(at_second) {
    if (at_c == 0) {
      std::swap(b, c);
      std::swap(at_b, at_c);
    }
  }

  unsigned line_class() const { return in_plane() ? 3 + b : a; }

  /// [low, high] on the picture line. Requires: not end_on(); low < high; the numerators are multiples of at_b, of at_c
  /// or of what divides both, as all those are that the head of this file speaks of.
  EyePiece piece(const Place& low, const Place& high) const {
    if (!in_plane()) {
      const std::int64_t g = std::gcd(at_b, at_c);
      return {{at_b / g, at_c / g}, {low.num / g, low.den}, {high.num / g, high.den}};
    }
    // (s, at_c) is (num / |at_c|, den sgn(at_c)) times a positive number; all these are at most 2^41 in size.
    const auto position = [&](const Place& place) {
      const auto s = static_cast<std::int64_t>(place.num / std::abs(at_c));
      const std::int64_t across = at_c < 0 ? -place.den : place.den;
      return a < c ? EyePosition{s, across} : EyePosition{across, s};
    };
    const EyePosition one = position(low), other = position(high);
    return one < other ? EyePiece{{0, 1}, one, other} : EyePiece{{0, 1}, other, one};
  }
};

}  // namespace blackleaf::detail
