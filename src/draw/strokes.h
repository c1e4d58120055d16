// Strokes: pieces of picture lines united exactly and turned into points of the picture.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "blackleaf/drawing.h"
#include "edge_family.h"
#include "found_pieces.h"
#include "octree/team.h"
#include "screen.h"
#include "wide.h"

namespace blackleaf::detail {

/// Positions of one line class as points of the picture. The point of space that stands for (key, position) has
/// coordinate 0 along one axis and, over the common denominator `denominator`, whole coordinates along the others:
///   general:  a: position, b: key |d_b| sgn(d_c), over D = |d_b d_c|                      (below 2^61)
///   in_plane: i: position sgn(d_j), b: key |d_j|, over |d_j|, with position = x_i d_j - x_j d_i  (below 2^42)
/// Times U and V (screen.h, below 2^42) and summed, 128 bits hold them exactly; one rounding each makes them doubles.
class PictureLines {
 public:
  PictureLines(const EdgeFamily& family, const View& view) : screen_(view.direction()) {
    const Direction& d = view.direction();
    key_axis_ = family.b;
    position_axis_ = family.line_class;
    std::int64_t denominator = family.scale;
    if (family.mode == EdgeFamily::Mode::general) {
      key_factor_ = std::abs(family.d_b) * EdgeFamily::sign(family.d_c);
    } else {
      const std::int64_t d_j = d[family.line_class == family.a ? family.c : family.a];
      denominator = key_factor_ = std::abs(d_j);
      position_factor_ = EdgeFamily::sign(d_j);
    }
    units_ = static_cast<double>(denominator) * Eigen::Vector2d(screen_.u_norm, screen_.v_norm);
  }

  Eigen::Vector2d point(std::int64_t key, std::int64_t position) const {
    const Eigen::Vector2d numerators(whole(key, position, screen_.u), whole(key, position, screen_.v));
    return numerators.cwiseQuotient(units_);
  }

 private:
  // The numerator along an axis of the picture, rounded once.
  double whole(std::int64_t key, std::int64_t position, const std::array<std::int64_t, 3>& axis) const {
    std::int64_t along, across, sum;  // mostly 64 bits are enough
    if (!__builtin_mul_overflow(position * position_factor_, axis[position_axis_], &along) &&
        !__builtin_mul_overflow(key, key_factor_ * axis[key_axis_], &across) &&
        !__builtin_add_overflow(along, across, &sum))
      return static_cast<double>(sum);
    return static_cast<double>(Wide{position * position_factor_} * axis[position_axis_] +
                               Wide{key} * key_factor_ * axis[key_axis_]);
  }

  Screen screen_;
  unsigned key_axis_, position_axis_;
  std::int64_t key_factor_, position_factor_ = 1;
  Eigen::Vector2d units_;  // the denominator times the axes' lengths
};

struct ClassLines {
  unsigned line_class;
  PictureLines picture;
};

/// The strokes of what all parts have found, pieces that overlap or touch united: one class after the other, each in
/// order of (key, low). The parts' pieces are lost. Requires: all parts have the same buckets. O(n) for n pieces that
/// are spread evenly over the picture, O(n log n) in any case.
std::vector<Stroke> strokes_of(std::span<FoundPieces* const> parts, const ClassBuckets& buckets,
                               std::span<const ClassLines> classes, Team& team);

}  // namespace blackleaf::detail
