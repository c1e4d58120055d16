#include "nearest_pair.h"

#include <algorithm>

namespace blackleaf::detail {

NearestPair::NearestPair(const BoxTree& a, const BoxTree& b, const RigidMap& map_of_b) : a_(a), b_(b), map_(map_of_b) {
  for (std::size_t i = 0; i < 3; ++i) {
    g_[i] = map_.shift[static_cast<Eigen::Index>(i)];
    for (std::size_t j = 0; j < 3; ++j) {
      f_[i][j] = map_.rotation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      size_[i][j] = std::abs(f_[i][j]);
    }
  }
  const double size = map_.shift.cwiseAbs().sum() + 8 * std::ldexp(1.0, std::max(a.depth, b.depth));
  slop_ = rounding_slop(size);
  // In b's frame lengths are those of a's up to 2^-37 of themselves (FixedMotion), and angles likewise.
  loss_ = slop_ + 0x1p-35 * size;
}

void NearestPair::bounds_of_a(const BoxNode* first, std::size_t count, const BoxNode& b, Bounds& bounds) const {
  std::array<double, 3> centre = g_, half{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      centre[i] += f_[i][j] * double{b.centre[j]};
      half[i] += size_[i][j] * double{b.half[j]};
    }
  for (std::size_t k = 0; k < count; ++k) {
    const BoxNode& a = first[k];
    std::array<double, 3> d;
    double in_a = 0, in_b = 0, squared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      d[i] = centre[i] - double{a.centre[i]};
      const double gap = std::max(0.0, std::abs(d[i]) - double{a.half[i]} - half[i]);
      in_a += gap * gap;
      squared += d[i] * d[i];
    }
    for (std::size_t j = 0; j < 3; ++j) {
      const double across = f_[0][j] * d[0] + f_[1][j] * d[1] + f_[2][j] * d[2];
      const double reach =
          size_[0][j] * double{a.half[0]} + size_[1][j] * double{a.half[1]} + size_[2][j] * double{a.half[2]};
      const double gap = std::max(0.0, std::abs(across) - double{b.half[j]} - reach);
      in_b += gap * gap;
    }
    bounds[k] = {std::max(in_a, in_b), squared};
  }
}

void NearestPair::bounds_of_b(const BoxNode& a, const BoxNode* first, std::size_t count, Bounds& bounds) const {
  std::array<double, 3> from, half{};
  for (std::size_t j = 0; j < 3; ++j) {
    from[j] = g_[j] - double{a.centre[j]};
    for (std::size_t i = 0; i < 3; ++i) half[j] += size_[i][j] * double{a.half[i]};
  }
  for (std::size_t k = 0; k < count; ++k) {
    const BoxNode& b = first[k];
    std::array<double, 3> d;
    double in_a = 0, in_b = 0, squared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      d[i] = f_[i][0] * double{b.centre[0]} + f_[i][1] * double{b.centre[1]} + f_[i][2] * double{b.centre[2]} + from[i];
      const double reach =
          size_[i][0] * double{b.half[0]} + size_[i][1] * double{b.half[1]} + size_[i][2] * double{b.half[2]};
      const double gap = std::max(0.0, std::abs(d[i]) - double{a.half[i]} - reach);
      in_a += gap * gap;
      squared += d[i] * d[i];
    }
    for (std::size_t j = 0; j < 3; ++j) {
      const double across = f_[0][j] * d[0] + f_[1][j] * d[1] + f_[2][j] * d[2];
      const double gap = std::max(0.0, std::abs(across) - double{b.half[j]} - half[j]);
      in_b += gap * gap;
    }
    bounds[k] = {std::max(in_a, in_b), squared};
  }
}

// A's points x and B's points y, from their centres xi and eta, fulfil m.xi <= r and w.eta <= t, w the normal of B as
// it is placed. So m.(y - x) >= m.d - r - (largest -m.eta), and -m.eta = w.eta - (m + w).eta <= t + (largest -(m +
// w).eta) over the box; likewise for -w. Where two surfaces face each other m + w is small.
double NearestPair::plane_gap(const BoxNode& a, const BoxNode& b) const {
  std::array<double, 3> d, m, w, in_b, sum;
  const auto dot = [](const auto& p, const auto& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; };
  const auto reach = [](const std::array<float, 3>& half, const std::array<double, 3>& n) {
    return double{half[0]} * std::abs(n[0]) + double{half[1]} * std::abs(n[1]) + double{half[2]} * std::abs(n[2]);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    d[i] = f_[i][0] * double{b.centre[0]} + f_[i][1] * double{b.centre[1]} + f_[i][2] * double{b.centre[2]} + g_[i] -
           double{a.centre[i]};
    m[i] = double{a.normal[i]};
    w[i] = f_[i][0] * double{b.normal[0]} + f_[i][1] * double{b.normal[1]} + f_[i][2] * double{b.normal[2]};
    sum[i] = m[i] + w[i];
  }
  const auto back = [&](const std::array<double, 3>& v) {
    for (std::size_t j = 0; j < 3; ++j) in_b[j] = f_[0][j] * v[0] + f_[1][j] * v[1] + f_[2][j] * v[2];
    return in_b;
  };
  double gap = 0;
  const bool facing = a.has_plane() && b.has_plane();
  if (a.has_plane()) {
    double of_b = reach(b.half, back(m));
    if (facing) of_b = std::min(of_b, double{b.reach} + reach(b.half, back(sum)));
    gap = dot(m, d) - double{a.reach} - of_b;
  }
  if (b.has_plane()) {
    double of_a = reach(a.half, w);
    if (facing) of_a = std::min(of_a, double{a.reach} + reach(a.half, sum));
    gap = std::max(gap, -dot(w, d) - double{b.reach} - of_a);
  }
  // Normals are of length 1 up to 2^-22.
  return gap * (1 - 0x1p-21);
}

}  // namespace blackleaf::detail
