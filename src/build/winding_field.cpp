#include "winding_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace blackleaf::detail {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr std::uint32_t kLeaf = 4;  // triangles of a ball that is not divided
// Added to errors, for the roundings of positions, radii and dipoles and of the arcus tangent, whichever library
// computes it: their true size is below 2^-40.
constexpr double kRounding = 0x1p-30;

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace

WindingField::WindingField(const GridMesh& mesh, const std::vector<Triangle>& triangles)
    : depth_(mesh.depth), fraction_bits_(mesh.fraction_bits()) {
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
  const auto voxels = [&](const GridPoint& p) {
    std::array<double, 3> result{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      result[axis] = std::ldexp(static_cast<double>(p[axis]), -fraction_bits_);
    return result;
  };
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
  ball.length =
      std::sqrt(ball.vector[0] * ball.vector[0] + ball.vector[1] * ball.vector[1] + ball.vector[2] * ball.vector[2]);
  return ball;
}

Turns WindingField::far(const Ball& ball, const std::array<double, 3>& p, double h) const {
  const std::array<double, 3> d = {ball.centre[0] - p[0], ball.centre[1] - p[1], ball.centre[2] - p[2]};
  const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], r = std::sqrt(square);
  const double gap = r - ball.radius - h - 0x1p-20;
  if (gap <= 0) return {0, std::numeric_limits<double>::infinity()};
  const double cube = square * r;
  double along = 0;  // d.M d
  for (std::size_t i = 0; i < 3; ++i)
    along += d[i] * (ball.moment[i][0] * d[0] + ball.moment[i][1] * d[1] + ball.moment[i][2] * d[2]);
  const double trace = ball.moment[0][0] + ball.moment[1][1] + ball.moment[2][2];
  const double value =
      ball.vector[0] * d[0] + ball.vector[1] * d[1] + ball.vector[2] * d[2] + trace - 3 * along / square;
  const double reach = (ball.radius + h) / gap;
  // The slope of M's part is a term of second order, as is the change of V's part's slope: both are in the first sum.
  const double error = 3 * ball.area * reach * reach / (gap * gap) + 2 * ball.length * h / cube;
  return {value / (4 * kPi * cube), error / (4 * kPi)};
}

Turns WindingField::sum(const GridPoint& p, double tolerance) const {
  std::array<double, 3> at{};
  for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = std::ldexp(static_cast<double>(p[axis]), -fraction_bits_);
  // If the error of each ball is at most its share of the tolerance, by area, all make no more than that; a small one
  // may be larger, as few balls come near the limit. What counts is their sum.
  const double share = tolerance / area_;
  Turns sum;
  std::array<std::uint32_t, 64> stack;  // halving 2^32 triangles makes at most 32 levels, of which each leaves one here
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const Ball& ball = balls_[index];
    const Turns turns = far(ball, at, 0);
    if (turns.error <= std::max(share * ball.area, tolerance / 64)) {
      sum.value += turns.value;
      sum.error += turns.error + 0x1p-40 * std::abs(turns.value);
    } else if (ball.second != 0) {
      stack[size++] = ball.second;
      stack[size++] = index + 1;
    } else {
      for (std::uint32_t i = ball.begin; i < ball.end; ++i) {
        const Turns one = solid_angle(p, triangles_[i]);
        sum.value += one.value;
        sum.error += one.error + 0x1p-48 * std::abs(one.value);
      }
    }
  }
  return sum;
}

int WindingField::level(std::int32_t x, std::int32_t y, std::int32_t z) const {
  if (triangles_.empty()) return 1;
  const int half = fraction_bits_ - 1;
  const GridPoint p = {(2 * std::int64_t{x} + 1) << half, (2 * std::int64_t{y} + 1) << half,
                       (2 * std::int64_t{z} + 1) << half};
  for (const double tolerance : {0x1p-2, 0x1p-5, 0x1p-9, 0x1p-14, 0.0}) {
    const Turns w = sum(p, tolerance);
    const double error = w.error + kRounding;
    const double low = std::floor(w.value - error + 0.5), high = std::floor(w.value + error + 0.5);
    if (low == high) return static_cast<int>(low) + 1;
  }
  AngleSum exact;
  for (const GridTriangle& t : triangles_) exact.add(p, t);
  return exact.above_half();
}

Levels WindingField::levels(const Cube& cube, const Levels& all) const {
  if (triangles_.empty()) return {1, 1};
  // The centres lie in the cube less half a voxel on each side.
  const double half = 0.5 * cube.side();
  const std::array<double, 3> at = {cube.x + half, cube.y + half, cube.z + half};
  const double h = (half - 0.5) * 1.7320508075688774;  // the next double above the root of 3
  constexpr double kTolerance = 0.25;
  const double share = kTolerance / area_;
  Turns sum;
  std::array<std::uint32_t, 64> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const Ball& ball = balls_[index];
    const Turns turns = far(ball, at, h);
    if (turns.error <= std::max(share * ball.area, kTolerance / 64) ||
        (ball.second == 0 && turns.error <= 0.5 * (ball.end - ball.begin))) {
      sum.value += turns.value;
      sum.error += turns.error + 0x1p-40 * std::abs(turns.value);
    } else if (ball.second != 0) {
      stack[size++] = ball.second;
      stack[size++] = index + 1;
    } else {
      sum.error += 0.5 * (ball.end - ball.begin);
    }
    if (2 * sum.error > all.high - all.low) return all;  // wider than all that is asked for
  }
  const double error = sum.error + kRounding;
  const double low = std::floor(sum.value - error + 0.5) + 1, high = std::floor(sum.value + error + 0.5) + 1;
  return {static_cast<int>(std::clamp<double>(low, all.low, all.high)),
          static_cast<int>(std::clamp<double>(high, all.low, all.high))};
}

}  // namespace blackleaf::detail
