// Polygons into triangles: nothing lost, nothing twice.
#include "io/polygon.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

namespace blackleaf {
namespace {

using Vertices = std::vector<Eigen::Vector3d>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Triangles cut(const Vertices& vertices) {
  std::vector<std::uint32_t> corners(vertices.size());
  std::iota(corners.begin(), corners.end(), 0u);
  Triangles triangles;
  detail::append_polygon(vertices, corners, triangles);
  return triangles;
}

// The law that holds for any polygon: n - 2 triangles, whose edges add up to those of the polygon.
void expect_same_boundary(const Triangles& triangles, std::uint32_t corners) {
  EXPECT_EQ(triangles.size() + 2, corners);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    ASSERT_LT(a, corners);
    a < b ? ++edges[{a, b}] : --edges[{b, a}];
  };
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) add(t[k], t[(k + 1) % 3]);
  for (std::uint32_t i = 0; i < corners; ++i) add((i + 1) % corners, i);
  for (const auto& [edge, times] : edges) EXPECT_EQ(times, 0) << edge.first << " " << edge.second;
}

double area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return (b - a).cross(c - a).norm() / 2;
}

// Of a simple plane polygon, besides: areas that add up to its own, so the triangles do not overlap.
void expect_no_overlap(const Vertices& vertices, const Triangles& triangles) {
  Eigen::Vector3d twice = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < vertices.size(); ++i) twice += vertices[i].cross(vertices[(i + 1) % vertices.size()]);
  double sum = 0;
  for (const auto& t : triangles) sum += area(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
  EXPECT_NEAR(sum, twice.norm() / 2, 1e-9 * sum);
}

Eigen::Matrix3d random_turn(std::mt19937& random) {
  const auto number = [&] { return static_cast<double>(random() % 2001) - 1000.5; };
  return Eigen::Quaterniond(number(), number(), number(), number()).normalized().toRotationMatrix();
}

TEST(Polygon, SimpleOnesInAnyPlane) {
  std::mt19937 random(51);
  for (unsigned i = 0; i < 2000; ++i) {
    SCOPED_TRACE(i);
    // A star shape about the origin, or a comb, which no fan covers; either way round.
    Vertices vertices;
    const auto n = static_cast<unsigned>(3 + random() % 40);
    if (i % 2 == 0) {
      for (unsigned k = 0; k < n; ++k) {
        const double angle = 2 * std::numbers::pi * k / n, radius = 1 + static_cast<double>(random() % 1000) / 100;
        vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
      }
    } else {
      for (unsigned k = 0; k < n; ++k)
        vertices.emplace_back(k, k % 2 == 0 ? 0.5 : static_cast<double>(5 + random() % 9), 0);
      vertices.emplace_back(n, -1, 0);
      for (unsigned k = n; k-- > 0;) vertices.emplace_back(k, k % 2 == 0 ? -1 : -3, 0);
    }
    if (random() % 2 == 0) std::reverse(vertices.begin(), vertices.end());
    std::rotate(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(random() % vertices.size()),
                vertices.end());
    if (i % 4 > 1) {
      const Eigen::Matrix3d turn = random_turn(random);
      for (auto& v : vertices) v = turn * v;
    }
    const Triangles triangles = cut(vertices);
    expect_same_boundary(triangles, static_cast<std::uint32_t>(vertices.size()));
    expect_no_overlap(vertices, triangles);
  }
}

// Small integer coordinates: repeated corners, corners on edges, edges back and forth, crossings, no area at all.
TEST(Polygon, AnyAtAll) {
  std::mt19937 random(52);
  for (unsigned i = 0; i < 5000; ++i) {
    SCOPED_TRACE(i);
    Vertices vertices;
    for (std::size_t k = 0, n = 3 + random() % 12; k < n; ++k)
      vertices.emplace_back(random() % 4, random() % 4, i % 3 == 0 ? random() % 3 : 0);
    expect_same_boundary(cut(vertices), static_cast<std::uint32_t>(vertices.size()));
  }
}

TEST(Polygon, CornersOnEdges) {
  // A plus sign whose edges have a corner in the middle.
  Vertices vertices;
  const std::vector<std::pair<double, double>> plus = {{1, -3}, {1, -1}, {3, -1}, {3, 1},   {1, 1},   {1, 3},
                                                       {-1, 3}, {-1, 1}, {-3, 1}, {-3, -1}, {-1, -1}, {-1, -3}};
  for (std::size_t i = 0; i < plus.size(); ++i) {
    const auto& [x, y] = plus[i];
    const auto& [u, v] = plus[(i + 1) % plus.size()];
    vertices.emplace_back(7, x, y);
    vertices.emplace_back(7, (x + u) / 2, (y + v) / 2);
  }
  const Triangles triangles = cut(vertices);
  expect_same_boundary(triangles, 24);
  expect_no_overlap(vertices, triangles);
}

TEST(Polygon, LargeOnesAndNumbersWithoutMeaning) {
  Vertices circle, zigzag;
  for (unsigned k = 0; k < 100'000; ++k) {
    circle.emplace_back(std::cos(2 * std::numbers::pi * k / 100'000), std::sin(2 * std::numbers::pi * k / 100'000), 1);
    zigzag.emplace_back(k, k % 2, 0);
  }
  EXPECT_EQ(cut(circle).size(), circle.size() - 2);
  EXPECT_EQ(cut(zigzag).size(), zigzag.size() - 2);
  for (const double value : {std::nan(""), HUGE_VAL, 1e300, 1e-310}) {
    Vertices vertices = {{0, 0, 0}, {1, 0, 0}, {0.1, 0.1, value}, {value, 1, 0}, {value, value, 0}};
    expect_same_boundary(cut(vertices), 5);
  }
  EXPECT_TRUE(cut({}).empty());
  EXPECT_TRUE(cut({{0, 0, 0}, {1, 0, 0}}).empty());
}

}  // namespace
}  // namespace blackleaf
