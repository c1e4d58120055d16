// Numbers of twice the precision of double, as sums of two (Dekker 1971, Knuth).
#pragma once

#include <cmath>

#include "grid_mesh.h"

namespace blackleaf::detail {

/// high + low, |low| <= half a unit in the last place of high. Relative errors of the operations are below 2^-100, of a
/// sum of numbers of opposite sign relative to the larger of them.
struct DoubleDouble {
  double high = 0, low = 0;

  static DoubleDouble of(Wide value) {
    const double high = static_cast<double>(value);
    // Beyond 2^127 the rounded part would not fit; integers here stay below 2^126.
    return two_sum(high, static_cast<double>(value - static_cast<Wide>(high)));
  }
  static DoubleDouble two_sum(double a, double b) {
    const double sum = a + b, back = sum - a;
    return {sum, (a - (sum - back)) + (b - back)};
  }
  static DoubleDouble two_product(double a, double b) {
    const double product = a * b;
    return {product, std::fma(a, b, -product)};
  }
  DoubleDouble operator-() const { return {-high, -low}; }
  friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble s = two_sum(a.high, b.high), t = two_sum(a.low, b.low);
    const DoubleDouble u = two_sum(s.high, s.low + t.high);
    return two_sum(u.high, u.low + t.low);
  }
  friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble p = two_product(a.high, b.high);
    return two_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
  }
  DoubleDouble scaled(int exponent) const { return {std::ldexp(high, exponent), std::ldexp(low, exponent)}; }
};

/// Requires: a > 0.
inline DoubleDouble square_root(const DoubleDouble& a) {
  const double root = std::sqrt(a.high);
  const DoubleDouble rest = a - DoubleDouble::two_product(root, root);
  return DoubleDouble::two_sum(root, rest.high / (2 * root));
}

}  // namespace blackleaf::detail
