// ExactBoxes: whether an upright box of one octree and a moved one of another interfere, in integers.
//
// The moved solid of b is the set of points X with (A X + b) / 2^38 in b's solid (FixedMotion): its boxes are
// parallelepipeds, upright boxes but for the rounding of the rotation, with face normals r_0, r_1, r_2, the rows of A,
// and edge directions r_k x r_l. Two convex bodies have disjoint interiors iff they are separated along one of
//   3 axes  e_i              the normals of the upright box,
//   3 axes  r_j              the normals of the tilted box,
//   9 axes  e_i x (r_k x r_l) = A_li r_k - A_ki r_l   (l, k the two rows other than j).
// In all but the first three the tilted box's projection follows from its source box alone. All numbers are integers:
// |A_ij| <= 2^38, box corners <= 2^20, |b| <= 2^61, so projections on r_j stay below 2^63 and on the crossed axes
// below 2^102; the first three need the adjoint of A and are decided by the sign of a sum of three products of 78 by 63
// bits, taken in two parts.
#pragma once

#include <array>
#include <cstdint>

#include "blackleaf/motion.h"

namespace blackleaf::detail {

/// Voxels [low, high] on every axis.
struct IntegerBox {
  std::array<std::int32_t, 3> low{}, high{};
};

class ExactBoxes {
 public:
  explicit ExactBoxes(const FixedMotion& motion);

  /// True iff the interior of the upright box of a and that of the moved box of b are disjoint. Requires: neither box
  /// is flat; coordinates from 0 to 2^20.
  bool apart(const IntegerBox& upright, const IntegerBox& moved) const { return separated<false>(upright, moved); }
  /// True iff the closed boxes share a point: they touch or interfere. Requires: the same.
  bool touch(const IntegerBox& upright, const IntegerBox& moved) const { return !separated<true>(upright, moved); }

 private:
  __extension__ using Wide = __int128;

  template <bool kStrictly>
  bool separated(const IntegerBox& upright, const IntegerBox& moved) const;
  template <bool kStrictly>
  bool beyond(std::size_t i, const IntegerBox& upright, const std::array<Wide, 3>& from,
              const std::array<Wide, 3>& length) const;

  FixedMotion motion_;
  std::array<std::array<Wide, 3>, 3> adjoint_{};                 // [i][j]: X_i per (A X)_j, times det A
  std::array<std::array<std::array<Wide, 3>, 3>, 3> crossed_{};  // [i][j]: e_i x (r_k x r_l)
};

}  // namespace blackleaf::detail
