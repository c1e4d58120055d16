// DoubleDouble: a number as the unevaluated sum of two doubles, about 106 bits (T. J. Dekker, Numer. Math. 18, 1971).
//
// Motions are composed in it, so that what thousands of compositions lose stays far below the grid of 2^-38 to which a
// motion is rounded in the end; so are solid angles where double cannot decide. Relative error of a sum of like signs,
// a product or a quotient: below 2^-102, of a sum of numbers of opposite sign relative to the larger of them; needs
// round-to-nearest and no contraction.
#pragma once

#include <cmath>

namespace blackleaf::detail {

struct DoubleDouble {
  double high = 0, low = 0;  // |low| <= half an ulp of high

  DoubleDouble() = default;
  DoubleDouble(double value) : high(value) {}  // NOLINT(google-explicit-constructor): no information is lost
  DoubleDouble(double first, double second) : high(first), low(second) {}

  explicit operator double() const { return high; }

  /// A whole number below 2^126 in size.
  template <class Whole>
  static DoubleDouble of(Whole value) {
    const auto high = static_cast<double>(value);
    return sum(high, static_cast<double>(value - static_cast<Whole>(high)));
  }
  /// a + b without error. Requires: |a| >= |b|, or a is 0.
  static DoubleDouble quick_sum(double a, double b) {
    const double sum = a + b;
    return {sum, b - (sum - a)};
  }
  /// a + b without error.
  static DoubleDouble sum(double a, double b) {
    const double total = a + b, part = total - a;
    return {total, (a - (total - part)) + (b - part)};
  }
  /// a * b without error, unless the low part underflows.
  static DoubleDouble product(double a, double b) {
    const double result = a * b;
    return {result, std::fma(a, b, -result)};
  }
  /// 2^exponent times this, without error.
  DoubleDouble scaled(int exponent) const { return {std::ldexp(high, exponent), std::ldexp(low, exponent)}; }
};

inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = DoubleDouble::sum(a.high, b.high), low = DoubleDouble::sum(a.low, b.low);
  const DoubleDouble part = DoubleDouble::sum(high.high, high.low + low.high);
  return DoubleDouble::sum(part.high, part.low + low.low);
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = DoubleDouble::product(a.high, b.high);
  return DoubleDouble::quick_sum(high.high, high.low + (a.high * b.low + a.low * b.high));
}

inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double first = a.high / b.high;
  const DoubleDouble rest = a - b * first;
  const double second = rest.high / b.high;
  const double third = (rest - b * second).high / b.high;
  return DoubleDouble::quick_sum(first, second) + third;
}

/// Requires: a > 0.
inline DoubleDouble square_root(const DoubleDouble& a) {
  const double root = std::sqrt(a.high);
  const DoubleDouble rest = a - DoubleDouble::product(root, root);
  return DoubleDouble::sum(root, rest.high / (2 * root));
}

/// 1 / sqrt(a): one Newton step from double precision. Requires: a is positive and finite.
inline DoubleDouble inverse_square_root(const DoubleDouble& a) {
  const DoubleDouble start = 1 / std::sqrt(a.high);
  return start + start * (DoubleDouble(1) - a * start * start) * 0.5;
}

}  // namespace blackleaf::detail
