#include "winding_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace blackleaf::detail {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr std::uint32_t kLeaf = 4;  // triangles of a ball that is not divided

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace

Levels levels_of(const Turns& w, double change) {
  const double error = w.error + change > 0 ? w.error + change + kFieldRounding : 0;
  return {static_cast<int>(std::floor(w.value - error + 0.5)) + 1,
          static_cast<int>(std::floor(w.value + error + 0.5)) + 1};
}

WindingField::WindingField(const GridMesh& mesh, const std::vector<Triangle>& triangles)
    : fraction_bits_(mesh.fraction_bits()), voxel_(std::ldexp(1.0, -mesh.fraction_bits())) {
  std::vector<std::array<double, 3>> centroids;
  for (const Triangle& t : triangles) {
    const GridTriangle triangle{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    bool flat = true;
    for (std::size_t axis = 0; axis < 3; ++axis) flat = flat && normal(triangle.a, triangle.b, triangle.c, axis) == 0;
    if (flat) continue;  // nothing can be seen of it
    triangles_.push_back(triangle);
    centroids.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis)
      centroids.back()[axis] = static_cast<double>(triangle.a[axis]) + static_cast<double>(triangle.b[axis]) +
                               static_cast<double>(triangle.c[axis]);
  }
  if (triangles_.empty()) return;
  std::vector<std::uint32_t> order(triangles_.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  build(0, static_cast<std::uint32_t>(order.size()), order, centroids);
  std::vector<GridTriangle> sorted;
  sorted.reserve(order.size());
  for (const std::uint32_t i : order) sorted.push_back(triangles_[i]);
  triangles_.swap(sorted);
  for (Ball& ball : balls_) {
    const std::uint32_t second = ball.second;
    ball = ball_of(ball.begin, ball.end);
    ball.second = second;
  }
  area_ = balls_.front().area;
  for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
    const Ball ball = ball_of(i, i + 1);
    extents_.push_back({ball.centre, ball.radius, ball.area});
  }
}

std::uint32_t WindingField::build(std::uint32_t begin, std::uint32_t end, std::vector<std::uint32_t>& order,
                                  const std::vector<std::array<double, 3>>& centroids) {
  const auto index = static_cast<std::uint32_t>(balls_.size());
  balls_.emplace_back();
  balls_[index].begin = begin;
  balls_[index].end = end;
  if (end - begin <= kLeaf) return index;
  // Halves along the axis on which the centroids spread most.
  std::array<double, 3> low = centroids[order[begin]], high = low;
  for (std::uint32_t i = begin; i < end; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], centroids[order[i]][axis]);
      high[axis] = std::max(high[axis], centroids[order[i]][axis]);
    }
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double u = centroids[a][longest], v = centroids[b][longest];
                     return u != v ? u < v : a < b;
                   });
  build(begin, middle, order, centroids);
  const std::uint32_t second = build(middle, end, order, centroids);
  balls_[index].second = second;
  return index;
}

WindingField::Ball WindingField::ball_of(std::uint32_t begin, std::uint32_t end) const {
  Ball ball;
  ball.begin = begin;
  ball.end = end;
  std::array<double, 3> plain{};
  for (std::uint32_t i = begin; i < end; ++i) {
    const GridTriangle& t = triangles_[i];
    const std::array<double, 3> a = voxels(t.a), b = voxels(t.b), c = voxels(t.c);
    std::array<double, 3> n{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      n[axis] = std::ldexp(static_cast<double>(normal(t.a, t.b, t.c, axis)), -2 * fraction_bits_ - 1);
    const double area = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    ball.area += area;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double third = (a[axis] + b[axis] + c[axis]) / 3;
      ball.vector[axis] += n[axis];
      ball.centre[axis] += area * third;
      plain[axis] += third;
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    ball.centre[axis] = ball.area > 0 ? ball.centre[axis] / ball.area : plain[axis] / (end - begin);
  for (std::uint32_t i = begin; i < end; ++i)
    for (const GridPoint* corner : {&triangles_[i].a, &triangles_[i].b, &triangles_[i].c})
      ball.radius = std::max(ball.radius, distance(voxels(*corner), ball.centre));
  ball.radius *= 1 + 0x1p-40;
  for (std::uint32_t i = begin; i < end; ++i) {
    const GridTriangle& t = triangles_[i];
    const std::array<double, 3> a = voxels(t.a), b = voxels(t.b), c = voxels(t.c);
    for (std::size_t row = 0; row < 3; ++row) {
      const double n = std::ldexp(static_cast<double>(normal(t.a, t.b, t.c, row)), -2 * fraction_bits_ - 1);
      for (std::size_t column = 0; column < 3; ++column)
        ball.moment[row][column] += n * ((a[column] + b[column] + c[column]) / 3 - ball.centre[column]);
    }
  }
  return ball;
}

std::array<double, 3> WindingField::voxels(const GridPoint& p) const {
  std::array<double, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis) result[axis] = static_cast<double>(p[axis]) * voxel_;
  return result;
}

Turns WindingField::far(const Ball& ball, const std::array<double, 3>& p, double h) {
  const std::array<double, 3> d = {ball.centre[0] - p[0], ball.centre[1] - p[1], ball.centre[2] - p[2]};
  const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], r = std::sqrt(square);
  const double gap = r - ball.radius - h - 0x1p-20;
  if (gap <= 0) return {0, std::numeric_limits<double>::infinity()};
  double along = 0;  // d.M d
  for (std::size_t i = 0; i < 3; ++i)
    along += d[i] * (ball.moment[i][0] * d[0] + ball.moment[i][1] * d[1] + ball.moment[i][2] * d[2]);
  const double trace = ball.moment[0][0] + ball.moment[1][1] + ball.moment[2][2];
  const double value =
      ball.vector[0] * d[0] + ball.vector[1] * d[1] + ball.vector[2] * d[2] + trace - 3 * along / square;
  const double reach = ball.radius + h, near = gap * gap;
  return {value / (4 * kPi * square * r), 3 * ball.area * reach * reach / (4 * kPi * near * near)};
}

std::array<double, 3> WindingField::gradient(const Ball& ball, const std::array<double, 3>& p) {
  const std::array<double, 3> d = {ball.centre[0] - p[0], ball.centre[1] - p[1], ball.centre[2] - p[2]};
  const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  const double along = ball.vector[0] * d[0] + ball.vector[1] * d[1] + ball.vector[2] * d[2];
  const double scale = 1 / (4 * kPi * square * std::sqrt(square));
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = scale * (3 * along * d[i] / square - ball.vector[i]);
  return result;
}

WindingField::Slope WindingField::slope(const GridTriangle& t, const std::array<double, 3>& p) const {
  const std::array<std::array<double, 3>, 3> corners = {voxels(t.a), voxels(t.b), voxels(t.c)};
  std::array<std::array<double, 3>, 3> to{};
  std::array<double, 3> length{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) to[i][axis] = corners[i][axis] - p[axis];
    length[i] = std::sqrt(to[i][0] * to[i][0] + to[i][1] * to[i][1] + to[i][2] * to[i][2]);
  }
  // The law of Biot and Savart for each edge from a to b: a x b (|a| + |b|) / (|a| |b| (|a| |b| + a.b)).
  Slope result{{}, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::array<double, 3>&a = to[i], &b = to[(i + 1) % 3];
    const double sizes = length[i] * length[(i + 1) % 3];
    const double opening = sizes + a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const double scale = (length[i] + length[(i + 1) % 3]) / (4 * kPi * sizes * opening);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
      result.gradient[axis] += scale * (a[j] * b[k] - a[k] * b[j]);
    }
    // a x b and a.b are off by a few roundings of |a| |b|; |a x b|^2 <= 2 |a| |b| (|a| |b| + a.b).
    result.error += 0x1p-48 * scale * sizes * (1 + std::sqrt(2 * sizes / opening));
  }
  return result;
}

template <class TakeFar, class TakeNear>
void WindingField::visit(const std::array<double, 3>& p, double h, double tolerance, const TakeFar& take_far,
                         const TakeNear& take_near) const {
  if (triangles_.empty()) return;
  // If the error of each ball is at most its share of the tolerance, by area, all make no more than that; a small one
  // may be larger, as few balls come near the limit. What counts is their sum.
  const double share = tolerance / area_;
  std::array<std::uint32_t, 64> stack;  // halving 2^32 triangles makes at most 32 levels, of which each leaves one here
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const Ball& ball = balls_[index];
    if (tolerance > 0) {
      const Turns turns = far(ball, p, h);
      if (turns.error <= std::max(share * ball.area, tolerance / 64)) {
        take_far(ball, turns);
        continue;
      }
    }
    if (ball.second != 0) {
      stack[size++] = ball.second;
      stack[size++] = index + 1;
    } else {
      for (std::uint32_t i = ball.begin; i < ball.end; ++i) take_near(i);
    }
  }
}

Turns WindingField::sum(const GridPoint& p, double tolerance) const {
  QuickSum sum;
  visit(
      voxels(p), 0, tolerance, [&](const Ball&, const Turns& turns) { sum.add(turns); },
      [&](std::uint32_t i) { sum.add(p, triangles_[i]); });
  return sum.turns();
}

WindingField::Around WindingField::around(const GridPoint& p, double h, double tolerance) const {
  Around result;
  result.centre = voxels(p);
  QuickSum middle;  // of the triangles that are taken as linear one by one
  visit(
      result.centre, h, tolerance,
      [&](const Ball& ball, const Turns& turns) {
        result.at_centre.value += turns.value;
        result.at_centre.error += turns.error + kFieldRounding * std::abs(turns.value);
        const std::array<double, 3> slope = gradient(ball, result.centre);
        for (std::size_t i = 0; i < 3; ++i) result.gradient[i] += slope[i];
      },
      [&](std::uint32_t i) {
        // A triangle's own linear function leaves out half the second derivative of n.K over its area.
        const GridTriangle& t = triangles_[i];
        const Extent& extent = extents_[i];
        const double gap = distance(extent.centre, result.centre) - extent.radius - h - 0x1p-20;
        const double bend = 3 * extent.area * h * h / (4 * kPi * gap * gap * gap * gap);
        const double allowed = std::max(tolerance * extent.area / area_, tolerance / 256);
        if (!(gap > 0 && bend < allowed)) return result.near.push_back(t);
        const Slope slope = this->slope(t, result.centre);
        if (!(h * slope.error < 0x1p-30)) return result.near.push_back(t);
        middle.add(p, t);
        middle.add({0, bend + h * slope.error});
        for (std::size_t axis = 0; axis < 3; ++axis) result.gradient[axis] += slope.gradient[axis];
      });
  const Turns turns = middle.turns();
  result.at_centre.value += turns.value;
  result.at_centre.error += turns.error + kFieldRounding;
  return result;
}

Turns WindingField::sum(const Around& around, const GridPoint& p) const {
  const std::array<double, 3> at = voxels(p);
  double far = around.at_centre.value;
  for (std::size_t i = 0; i < 3; ++i) far += around.gradient[i] * (at[i] - around.centre[i]);
  QuickSum sum;
  sum.add({far, around.at_centre.error});
  for (const GridTriangle& t : around.near) sum.add(p, t);
  return sum.turns();
}

int WindingField::level(const GridPoint& p) const {
  for (const double tolerance : {0x1p-5, 0x1p-9, 0x1p-14, 0.0}) {
    const Levels levels = levels_of(sum(p, tolerance), 0);
    if (levels.low == levels.high) return levels.low;
  }
  AngleSum exact;
  for (const GridTriangle& t : triangles_) exact.add(p, t);
  return exact.above_half();
}

}  // namespace blackleaf::detail
