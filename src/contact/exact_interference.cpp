// Interference of a solid with a moved one, without voxelising: upright cubes against tilted cubes by separating axes.
//
// The moved solid of b is the set of points X with (A X + b) / 2^38 in b's solid (FixedMotion): its cubes are
// parallelepipeds, upright cubes but for the rounding of the rotation, with face normals r_0, r_1, r_2, the rows of A,
// and edge directions r_k x r_l. Two convex bodies have disjoint interiors iff they are separated along one of
//   3 axes  e_i              the normals of the upright cube,
//   3 axes  r_j              the normals of the tilted cube,
//   9 axes  e_i x (r_k x r_l) = A_li r_k - A_ki r_l   (l, k the two rows other than j).
// In all but the first three the tilted cube's projection follows from its source cube alone. All numbers are integers:
// |A_ij| <= 2^38, cube corners <= 2^20, |b| <= 2^61, so projections on r_j stay below 2^63 and on the crossed axes
// below 2^102; the first three need the adjoint of A and are decided by the sign of a sum of three products of 78 by 63
// bits, taken in two parts.
#include <array>
#include <cstdlib>

#include "blackleaf/contact.h"
#include "octree/same_depth.h"

namespace blackleaf {
namespace {

__extension__ using Wide = __int128;
using Vector = std::array<std::int64_t, 3>;

struct Interval {
  Wide low, high;
};

// The range of sum_j w_j x_j over the cube [p, p + side]^3.
template <class Weights>
Interval range_over(const Weights& w, const Vector& p, std::int64_t side) {
  Interval sum{0, 0};
  for (std::size_t j = 0; j < 3; ++j) {
    const Wide at_low = Wide{w[j]} * p[j], at_high = Wide{w[j]} * (p[j] + side);
    sum.low += std::min(at_low, at_high);
    sum.high += std::max(at_low, at_high);
  }
  return sum;
}

bool apart(const Interval& a, const Interval& b) { return a.high <= b.low || b.high <= a.low; }

// The sign of sum_j a_j w_j for |a_j| < 2^79, |w_j| < 2^63.
int sign_of_product(const std::array<Wide, 3>& a, const std::array<Wide, 3>& w) {
  constexpr int kSplit = 40;
  Wide high = 0, low = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    high += (a[j] >> kSplit) * w[j];
    low += (a[j] & ((Wide{1} << kSplit) - 1)) * w[j];
  }
  high += low >> kSplit;
  low &= (Wide{1} << kSplit) - 1;
  return high > 0 || (high == 0 && low > 0) ? 1 : high < 0 ? -1 : 0;
}

class ExactTest {
 public:
  explicit ExactTest(const Motion& motion) : motion_(motion) {
    const auto& m = motion_.inverse_rotation;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t k = (j + 1) % 3, l = (j + 2) % 3;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t p = (i + 1) % 3, q = (i + 2) % 3;
        adjoint_[i][j] = Wide{m[k][p]} * m[l][q] - Wide{m[k][q]} * m[l][p];  // (r_k x r_l)_i
        for (std::size_t axis = 0; axis < 3; ++axis)
          crossed_[i][j][axis] = Wide{m[l][i]} * m[k][axis] - Wide{m[k][i]} * m[l][axis];
      }
    }
  }

  bool meet(const Node& a, const Cube& in_a, const Node& b, const Cube& in_b) const {
    if (a.is_white() || b.is_white()) return false;
    if (separated(in_a, in_b)) return false;
    if (a.is_black() && b.is_black()) return true;
    if (a.is_gray() && (!b.is_gray() || in_a.level >= in_b.level)) {
      for (int octant = 0; octant < 8; ++octant)
        if (meet(a.child(octant), in_a.child(octant), b, in_b)) return true;
    } else {
      for (int octant = 0; octant < 8; ++octant)
        if (meet(a, in_a, b.child(octant), in_b.child(octant))) return true;
    }
    return false;
  }

 private:
  // True iff the interior of the upright cube and that of the moved cube are disjoint.
  bool separated(const Cube& upright, const Cube& moved) const {
    const auto& m = motion_.inverse_rotation;
    const Vector p = {upright.x, upright.y, upright.z}, q = {moved.x, moved.y, moved.z};
    // The moved cube in the coordinates A X: [from, from + length] on every axis.
    std::array<Wide, 3> from{};
    const Wide length = Wide{moved.side()} << FixedMotion::kFractionBits;
    for (std::size_t j = 0; j < 3; ++j)
      from[j] = (Wide{q[j]} << FixedMotion::kFractionBits) - motion_.inverse_translation[j];
    for (std::size_t j = 0; j < 3; ++j)
      if (apart(range_over(m[j], p, upright.side()), {from[j], from[j] + length})) return true;
    for (std::size_t i = 0; i < 3; ++i)
      if (beyond(i, p, upright.side(), from, length)) return true;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t k = (j + 1) % 3, l = (j + 2) % 3;
      for (std::size_t i = 0; i < 3; ++i) {
        const Wide u = m[l][i], v = -Wide{m[k][i]};  // the axis is u r_k + v r_l
        Interval tilted{u * from[k] + v * from[l], u * from[k] + v * from[l]};
        (u > 0 ? tilted.high : tilted.low) += u * length;
        (v > 0 ? tilted.high : tilted.low) += v * length;
        if ((u != 0 || v != 0) && apart(range_over(crossed_[i][j], p, upright.side()), tilted)) return true;
      }
    }
    return false;
  }

  // Separation along e_i: det(A) (X_i - P_i) = sum_j adj_ij (A X - A P)_j, and det(A) > 0.
  bool beyond(std::size_t i, const Vector& p, std::int64_t side, const std::array<Wide, 3>& from, Wide length) const {
    for (const bool upper : {false, true}) {
      Vector corner = p;
      if (upper) corner[i] += side;
      // The moved cube's farthest corner: below p_i for its highest X_i, above p_i + side for its lowest.
      std::array<Wide, 3> weights{}, offset{};
      for (std::size_t j = 0; j < 3; ++j) {
        weights[j] = adjoint_[i][j];
        offset[j] = from[j];
        for (std::size_t c = 0; c < 3; ++c) offset[j] -= Wide{motion_.inverse_rotation[j][c]} * corner[c];
        if ((weights[j] > 0) != upper) offset[j] += length;
      }
      const int sign = sign_of_product(weights, offset);
      if (upper ? sign >= 0 : sign <= 0) return true;
    }
    return false;
  }

  FixedMotion motion_;
  std::array<std::array<Wide, 3>, 3> adjoint_{};                 // [i][j]: X_i per (A X)_j, times det A
  std::array<std::array<std::array<Wide, 3>, 3>, 3> crossed_{};  // [i][j]: e_i x (r_k x r_l)
};

}  // namespace

bool interferes_exactly(const Octree& a, const Octree& b, const Motion& motion_of_b) {
  detail::require_same_depth(a, b);
  if (a.is_empty() || b.is_empty() || motion_of_b.translation().norm() > FixedMotion::kMaxTranslation) return false;
  return ExactTest(motion_of_b).meet(a.root(), a.universe(), b.root(), b.universe());
}

}  // namespace blackleaf
