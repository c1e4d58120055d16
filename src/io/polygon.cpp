#include "io/polygon.h"

#include <cmath>
#include <cstddef>

namespace blackleaf::detail {
namespace {

using Point = Eigen::Vector2d;

// Twice the area of the triangle, positive when it turns left.
double turn(const Point& a, const Point& b, const Point& c) {
  const Point ab = b - a, ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

// The polygon seen along the axis its normal is nearest to, turning left; empty when it has no normal.
std::vector<Point> flattened(std::span<const Eigen::Vector3d> vertices, std::span<const std::uint32_t> corners) {
  const Eigen::Vector3d& origin = vertices[corners[0]];
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Eigen::Vector3d a = vertices[corners[i]] - origin, b = vertices[corners[i + 1]] - origin;
    normal +=
        Eigen::Vector3d(a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x());
  }
  int axis = 0;
  if (!(normal.cwiseAbs().maxCoeff(&axis) > 0) || !normal.allFinite()) return {};
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);
  std::vector<Point> points;
  points.reserve(corners.size());
  for (const std::uint32_t corner : corners)
    points.emplace_back(vertices[corner][u] - origin[u], vertices[corner][v] - origin[v]);
  return points;
}

// What is left of a polygon while its ears are cut off: a ring of its corners.
class Ring {
 public:
  explicit Ring(const std::vector<Point>& points) : points_(points), before_(points.size()), after_(points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      after_[i] = (i + 1) % points.size();
      before_[after_[i]] = i;
    }
  }

  std::size_t before(std::size_t i) const { return before_[i]; }
  std::size_t after(std::size_t i) const { return after_[i]; }
  double turn_at(std::size_t i) const { return turn(points_[before_[i]], points_[i], points_[after_[i]]); }
  void cut(std::size_t i) {
    after_[before_[i]] = after_[i];
    before_[after_[i]] = before_[i];
  }
  // Whether the triangle of corner i lies inside and can be cut off: it turns left and no other corner lies in it.
  bool is_ear(std::size_t i) const {
    const Point &a = points_[before_[i]], &b = points_[i], &c = points_[after_[i]];
    if (!(turn(a, b, c) > 0)) return false;
    for (std::size_t j = after_[after_[i]]; j != before_[i]; j = after_[j]) {
      const Point& p = points_[j];
      // If any corner is in the way, one that does not turn left is.
      if (turn(a, b, p) < 0 || turn(b, c, p) < 0 || turn(c, a, p) < 0 || turn_at(j) > 0) continue;
      if (p != a && p != b && p != c) return false;
    }
    return true;
  }

 private:
  const std::vector<Point>& points_;
  std::vector<std::size_t> before_, after_;
};

bool fan_does_it(const std::vector<Point>& points) {
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    if (turn(points[0], points[i], points[i + 1]) < 0) return false;
  return true;
}

}  // namespace

void append_polygon(std::span<const Eigen::Vector3d> vertices, std::span<const std::uint32_t> corners,
                    std::vector<std::array<std::uint32_t, 3>>& triangles) {
  constexpr std::size_t kMostForEars = 4096;
  if (corners.size() < 3) return;
  std::size_t left = corners.size(), at = 0;
  const auto append = [&](std::size_t a, std::size_t b, std::size_t c) {
    triangles.push_back({corners[a], corners[b], corners[c]});
  };
  const std::vector<Point> points =
      left > 3 && left <= kMostForEars ? flattened(vertices, corners) : std::vector<Point>{};
  if (points.empty() || fan_does_it(points)) {
    for (std::size_t i = 1; i + 1 < left; ++i) append(0, i, i + 1);
    return;
  }
  Ring ring(points);
  const auto cut = [&](std::size_t i) {
    append(ring.before(i), i, ring.after(i));
    ring.cut(i);
    --left;
    at = ring.after(i);
  };
  const auto cut_first = [&](const auto& good) {
    for (std::size_t tried = 0; tried < left; ++tried, at = ring.after(at))
      if (good(at)) {
        cut(at);
        return true;
      }
    return false;
  };
  while (left > 3) {
    if (cut_first([&](std::size_t i) { return ring.is_ear(i); })) continue;
    if (!cut_first([&](std::size_t i) { return ring.turn_at(i) == 0; })) break;
  }
  for (std::size_t i = ring.after(at); left > 2; --left, i = ring.after(i)) append(at, i, ring.after(i));
}

}  // namespace blackleaf::detail
