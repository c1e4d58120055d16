#include "solid_angle.h"

#include <algorithm>
#include <cmath>

namespace blackleaf::detail {
namespace {

constexpr double kPi = 3.141592653589793;

int sign(Wide value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

// a - p: below 2^40 + 1 in size, so exact as doubles, and dot products below 2^83.
GridPoint minus(const GridPoint& a, const GridPoint& p) { return {a[0] - p[0], a[1] - p[1], a[2] - p[2]}; }
Wide dot(const GridPoint& a, const GridPoint& b) { return Wide{a[0]} * b[0] + Wide{a[1]} * b[1] + Wide{a[2]} * b[2]; }

std::array<Wide, 3> normal_of(const GridTriangle& t) {
  return {normal(t.a, t.b, t.c, 0), normal(t.a, t.b, t.c, 1), normal(t.a, t.b, t.c, 2)};
}

// a . (b x c) for vectors a, b, c from a point to the corners: the normal times a. Below 2^124.
Wide determinant(const std::array<Wide, 3>& n, const GridPoint& a) { return n[0] * a[0] + n[1] * a[1] + n[2] * a[2]; }

// On which side of the plane through it (e, e^2, e^3) leads, 1 behind.
int side_moved_to(const std::array<Wide, 3>& n) {
  for (const Wide component : n)
    if (component != 0) return -sign(component);
  return 0;
}

}  // namespace

void QuickSum::add(const GridPoint& p, const GridTriangle& t) {
  const GridPoint a = minus(t.a, p), b = minus(t.b, p), c = minus(t.c, p);
  const double ax = static_cast<double>(a[0]), ay = static_cast<double>(a[1]), az = static_cast<double>(a[2]);
  const double bx = static_cast<double>(b[0]), by = static_cast<double>(b[1]), bz = static_cast<double>(b[2]);
  const double cx = static_cast<double>(c[0]), cy = static_cast<double>(c[1]), cz = static_cast<double>(c[2]);
  const double la = std::sqrt(ax * ax + ay * ay + az * az), lb = std::sqrt(bx * bx + by * by + bz * bz),
               lc = std::sqrt(cx * cx + cy * cy + cz * cz);
  const double size = la * lb * lc;
  double im = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
  const double re = size + (ax * bx + ay * by + az * bz) * lc + (bx * cx + by * cy + bz * cz) * la +
                    (cx * ax + cy * ay + cz * az) * lb;
  // Neither sum has terms of more than 6 `size` in all, each with fewer than ten roundings of 2^-53.
  const double rounding = 0x1p-47 * size;
  if (std::abs(im) <= rounding) {
    const std::array<Wide, 3> n = normal_of(t);
    const Wide exact = determinant(n, a);
    if (exact == 0) {
      if (re > rounding) return;
      if (re < -rounding)
        value_ += 0.5 * side_moved_to(n);
      else
        error_ += 0.5;
      return;
    }
    im = static_cast<double>(exact);
  }
  // The sign of im is right now, so the argument is on the right side of the cut along the negative numbers.
  const double length = std::abs(re) + std::abs(im);  // at most twice too long, so an eighth stands for a quarter
  if (length <= 16 * rounding) {
    error_ += 0.5;
    return;
  }
  error_ += rounding / length + 0x1p-50;
  const bool was_upper = im_ > 0 || (im_ == 0 && re_ < 0);
  const double scale = 1 / length, factor_re = re * scale, factor_im = im * scale;
  const double product_re = re_ * factor_re - im_ * factor_im;
  im_ = re_ * factor_im + im_ * factor_re;
  re_ = product_re;
  // The argument moved by less than pi, up if im > 0. Where it is near 0 or pi on both sides of the product, the two
  // terms of its imaginary part have one sign, so rounding never carries it to the other end of its range.
  const bool is_upper = im_ > 0 || (im_ == 0 && re_ < 0);
  if (im > 0 && was_upper && !is_upper) ++rounds_;
  if (im < 0 && !was_upper && is_upper) --rounds_;
  const double size_now = std::max(std::abs(re_), std::abs(im_));
  if (size_now < 0x1p-300) {  // no factor is longer than 1
    const int exponent = -std::ilogb(size_now);
    re_ = std::ldexp(re_, exponent);
    im_ = std::ldexp(im_, exponent);
  }
}

Turns QuickSum::turns() const {
  if (im_ == 0 && re_ > 0) return {value_ + rounds_, error_};
  return {value_ + rounds_ + std::atan2(im_, re_) / (2 * kPi), error_ + 0x1p-48 * std::abs(value_) + 0x1p-50};
}

void AngleSum::add(const GridPoint& p, const GridTriangle& t) {
  const std::array<Wide, 3> n = normal_of(t);
  const std::array<GridPoint, 3> corner = {minus(t.a, p), minus(t.b, p), minus(t.c, p)};
  const Wide im = determinant(n, corner[0]);
  if (im != 0) {
    const DoubleDouble la = square_root(DoubleDouble::of(dot(corner[0], corner[0]))),
                       lb = square_root(DoubleDouble::of(dot(corner[1], corner[1]))),
                       lc = square_root(DoubleDouble::of(dot(corner[2], corner[2])));
    const DoubleDouble size = la * lb * lc;
    const DoubleDouble re = size + DoubleDouble::of(dot(corner[0], corner[1])) * lc +
                            DoubleDouble::of(dot(corner[1], corner[2])) * la +
                            DoubleDouble::of(dot(corner[2], corner[0])) * lb;
    multiply(re, DoubleDouble::of(im), 0x1p-94 * size.high);
    return;
  }

  // In the plane. The turns about p in the plane's two coordinates in which it is widest say where; `turning` is their
  // sign where p sees the triangle from inside.
  const std::size_t flat = static_cast<std::size_t>(
      std::max_element(n.begin(), n.end(), [](Wide u, Wide v) { return (u < 0 ? -u : u) < (v < 0 ? -v : v); }) -
      n.begin());
  const std::size_t j = (flat + 1) % 3, k = (flat + 2) % 3;
  const int turning = sign(n[flat]);
  std::array<int, 3> turn{};  // of the edge from corner i to the next: 1 inside, 0 on its line
  for (std::size_t i = 0; i < 3; ++i) {
    const GridPoint &u = corner[i], &v = corner[(i + 1) % 3];
    turn[i] = turning * sign(Wide{u[j]} * v[k] - Wide{u[k]} * v[j]);
  }
  if (turn[0] < 0 || turn[1] < 0 || turn[2] < 0) return;  // beside it
  const auto edge = [&](std::size_t i, std::size_t first_axis) {
    // A half plane seen from its rim, moved by d: an angle about the rim. With u along the rim and m = n x u inward,
    // its sine is to its cosine as -d.n |u| is to -d.m.
    const GridPoint &from = corner[i], &to = corner[(i + 1) % 3];
    const GridPoint u = minus(to, from);
    std::size_t d = first_axis;
    while (u[(d + 1) % 3] == 0 && u[(d + 2) % 3] == 0) ++d;  // moving along the rim changes nothing
    const Wide sine = -n[d];
    const Wide cosine = n[(d + 2) % 3] * u[(d + 1) % 3] - n[(d + 1) % 3] * u[(d + 2) % 3];
    if (sine == 0) {
      if (cosine < 0) add_half_turn(side_moved_to(n));
      return;
    }
    multiply(DoubleDouble::of(cosine), DoubleDouble::of(sine) * square_root(DoubleDouble::of(dot(u, u))), 0);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    if (turn[i] != 0) continue;
    const std::size_t next = (i + 1) % 3;
    if (turn[next] != 0 && turn[(i + 2) % 3] != 0) return edge(i, 0);
    // At a corner: two of the edges pass through it.
    const std::size_t at = corner[i] == GridPoint{} ? i : next;
    const GridPoint &b = corner[(at + 1) % 3], &c = corner[(at + 2) % 3];
    // Moved by d along x, p sees the sector between b and c from its tip: a spherical triangle of -d, b and c.
    if (n[0] != 0) {
      const DoubleDouble lb = square_root(DoubleDouble::of(dot(b, b))), lc = square_root(DoubleDouble::of(dot(c, c)));
      const DoubleDouble size = lb * lc;
      const DoubleDouble re =
          size - DoubleDouble::of(b[0]) * lc - DoubleDouble::of(c[0]) * lb + DoubleDouble::of(dot(b, c));
      return multiply(re, DoubleDouble::of(-n[0]), 0x1p-94 * size.high);
    }
    // Within the plane: along an edge, into the triangle, or out of it.
    if (b[1] == 0 && b[2] == 0) return b[0] > 0 ? edge(at, 1) : void();
    if (c[1] == 0 && c[2] == 0) return c[0] > 0 ? edge((at + 2) % 3, 1) : void();
    const Wide from_b = n[1] * b[2] - n[2] * b[1], to_c = n[2] * c[1] - n[1] * c[2];  // n.(b x d), n.(d x c)
    if (from_b > 0 && to_c > 0) add_half_turn(side_moved_to(n));
    return;
  }
  if (turn[0] > 0 && turn[1] > 0 && turn[2] > 0) add_half_turn(side_moved_to(n));
}

bool AngleSum::upper() const { return im_.high > 0 || (im_.high == 0 && re_.high < 0); }

void AngleSum::multiply(DoubleDouble re, DoubleDouble im, double error) {
  const double length = std::max(std::abs(re.high), std::abs(im.high));
  error_ += error / length + 0x1p-94;
  const int exponent = -std::ilogb(length);
  re = re.scaled(exponent);
  im = im.scaled(exponent);
  const bool was_upper = upper();
  const DoubleDouble product = re_ * re - im_ * im;
  im_ = re_ * im + im_ * re;
  re_ = product;
  // The argument moved by less than pi, up if im > 0.
  if (im.high > 0 && was_upper && !upper()) ++revolutions_;
  if (im.high < 0 && !was_upper && upper()) --revolutions_;
  const int back = -std::ilogb(std::max(std::abs(re_.high), std::abs(im_.high)));
  re_ = re_.scaled(back);
  im_ = im_.scaled(back);
}

void AngleSum::add_half_turn(int sign) {
  const bool was_upper = upper();
  re_ = -re_;
  im_ = -im_;
  if (sign > 0 && was_upper) ++revolutions_;
  if (sign < 0 && !was_upper) --revolutions_;
}

int AngleSum::above_half() const {
  // revolutions + argument / 2 pi is the sum; only an argument of about pi is near an integer and a half.
  const bool half = re_.high < 0 && std::abs(im_.high) <= error_ * std::abs(re_.high);
  return revolutions_ + (half && im_.high >= 0 ? 2 : 1);
}

}  // namespace blackleaf::detail
