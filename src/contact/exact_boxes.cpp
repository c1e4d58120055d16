#include "exact_boxes.h"

#include <algorithm>

namespace blackleaf::detail {
namespace {

__extension__ using Wide = __int128;

struct Interval {
  Wide low, high;
};

// The range of sum_j w_j x_j over a box.
template <class Weights>
Interval range_over(const Weights& w, const IntegerBox& box) {
  Interval sum{0, 0};
  for (std::size_t j = 0; j < 3; ++j) {
    const Wide at_low = Wide{w[j]} * box.low[j], at_high = Wide{w[j]} * box.high[j];
    sum.low += std::min(at_low, at_high);
    sum.high += std::max(at_low, at_high);
  }
  return sum;
}

template <bool kStrictly>
bool disjoint(const Interval& a, const Interval& b) {
  return kStrictly ? a.high < b.low || b.high < a.low : a.high <= b.low || b.high <= a.low;
}

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

}  // namespace

ExactBoxes::ExactBoxes(const FixedMotion& motion) : motion_(motion) {
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

template <bool kStrictly>
bool ExactBoxes::separated(const IntegerBox& upright, const IntegerBox& moved) const {
  const auto& m = motion_.inverse_rotation;
  // The moved box in the coordinates A X: [from, from + length] on every axis.
  std::array<Wide, 3> from{}, length{};
  for (std::size_t j = 0; j < 3; ++j) {
    from[j] = (Wide{moved.low[j]} << FixedMotion::kFractionBits) - motion_.inverse_translation[j];
    length[j] = Wide{moved.high[j] - moved.low[j]} << FixedMotion::kFractionBits;
  }
  for (std::size_t j = 0; j < 3; ++j)
    if (disjoint<kStrictly>(range_over(m[j], upright), {from[j], from[j] + length[j]})) return true;
  for (std::size_t i = 0; i < 3; ++i)
    if (beyond<kStrictly>(i, upright, from, length)) return true;
  for (std::size_t j = 0; j < 3; ++j) {
    const std::size_t k = (j + 1) % 3, l = (j + 2) % 3;
    for (std::size_t i = 0; i < 3; ++i) {
      const Wide u = m[l][i], v = -Wide{m[k][i]};  // the axis is u r_k + v r_l
      Interval tilted{u * from[k] + v * from[l], u * from[k] + v * from[l]};
      (u > 0 ? tilted.high : tilted.low) += u * length[k];
      (v > 0 ? tilted.high : tilted.low) += v * length[l];
      if ((u != 0 || v != 0) && disjoint<kStrictly>(range_over(crossed_[i][j], upright), tilted)) return true;
    }
  }
  return false;
}

// Separation along e_i: det(A) (X_i - P_i) = sum_j adj_ij (A X - A P)_j, and det(A) > 0.
template <bool kStrictly>
bool ExactBoxes::beyond(std::size_t i, const IntegerBox& upright, const std::array<Wide, 3>& from,
                        const std::array<Wide, 3>& length) const {
  for (const bool upper : {false, true}) {
    std::array<std::int32_t, 3> corner = upright.low;
    if (upper) corner[i] = upright.high[i];
    // The moved box's farthest corner: below the lower face for its highest X_i, above the upper one for its lowest.
    std::array<Wide, 3> weights{}, offset{};
    for (std::size_t j = 0; j < 3; ++j) {
      weights[j] = adjoint_[i][j];
      offset[j] = from[j];
      for (std::size_t c = 0; c < 3; ++c) offset[j] -= Wide{motion_.inverse_rotation[j][c]} * corner[c];
      if ((weights[j] > 0) != upper) offset[j] += length[j];
    }
    const int sign = sign_of_product(weights, offset);
    const int outward = upper ? sign : -sign;
    if (kStrictly ? outward > 0 : outward >= 0) return true;
  }
  return false;
}

template bool ExactBoxes::separated<false>(const IntegerBox& upright, const IntegerBox& moved) const;
template bool ExactBoxes::separated<true>(const IntegerBox& upright, const IntegerBox& moved) const;

}  // namespace blackleaf::detail
