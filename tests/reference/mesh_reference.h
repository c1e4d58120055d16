// Slow, readable twins of building from meshes: every voxel against every triangle, in exact arithmetic.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "blackleaf/mesh.h"
#include "dense_grid.h"

namespace blackleaf::reference {

__extension__ using Big = __int128;
using Integers = std::array<Big, 3>;

inline int sign(Big value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

/// A point in units of 2^(depth-40) voxels, for meshes in universe coordinates.
inline Integers to_integers(const Eigen::Vector3d& p, int depth) {
  Integers result{};
  for (int i = 0; i < 3; ++i) result[static_cast<std::size_t>(i)] = std::llround(std::ldexp(p[i], 40 - depth));
  return result;
}

using IntegerTriangle = std::array<Integers, 3>;

/// The triangles of a mesh in universe coordinates.
inline std::vector<IntegerTriangle> integer_triangles(const TriangleMesh& mesh, int depth) {
  std::vector<IntegerTriangle> result;
  for (const auto& t : mesh.triangles)
    result.push_back({to_integers(mesh.vertices[t[0]], depth), to_integers(mesh.vertices[t[1]], depth),
                      to_integers(mesh.vertices[t[2]], depth)});
  return result;
}

/// Winding number about the centre of a voxel moved by (e, e^2, e^3), from the triangles above it along z.
inline int winding(const std::vector<IntegerTriangle>& triangles, int depth, int x, int y, int z) {
  const auto unit = Big{1} << (39 - depth);
  const Integers p = {(2 * x + 1) * unit, (2 * y + 1) * unit, (2 * z + 1) * unit};
  // The first coefficient that is not zero, of 1, e, e^2 and e^3, gives the sign.
  const auto first = [](std::initializer_list<Big> coefficients) {
    for (const Big c : coefficients)
      if (c != 0) return sign(c);
    return 0;
  };
  int result = 0;
  for (const IntegerTriangle& v : triangles) {
    const auto side = [&](const Integers& a, const Integers& b) {
      const Big dx = b[0] - a[0], dy = b[1] - a[1];
      return first({dx * (p[1] - a[1]) - dy * (p[0] - a[0]), -dy, dx});
    };
    const int s = side(v[0], v[1]);
    if (s == 0 || side(v[1], v[2]) != s || side(v[2], v[0]) != s) continue;
    Integers n{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      n[i] = (v[1][j] - v[0][j]) * (v[2][k] - v[0][k]) - (v[1][k] - v[0][k]) * (v[2][j] - v[0][j]);
    }
    const Big height = n[0] * (p[0] - v[0][0]) + n[1] * (p[1] - v[0][1]) + n[2] * (p[2] - v[0][2]);
    if (first({height, n[0], n[1], n[2]}) != s)
      result += s;  // the normal's z has the sign s: p lies below the triangle
  }
  return result;
}

/// The centre rule, or nothing if the winding numbers are not all 0 and 1 or all 0 and -1.
inline std::optional<DenseGrid> centre_rule(const TriangleMesh& mesh, int depth) {
  const std::vector<IntegerTriangle> triangles = integer_triangles(mesh, depth);
  DenseGrid grid(depth);
  int low = 0, high = 0;
  grid.for_each([&](int x, int y, int z, bool) {
    const int w = winding(triangles, depth, x, y, z);
    low = std::min(low, w);
    high = std::max(high, w);
    grid.set(x, y, z, w != 0);
  });
  if (high - low > 1) return std::nullopt;
  return grid;
}

/// Whether a closed triangle meets the closed unit cube at a voxel, by clipping it with the cube's six sides. Points
/// are homogeneous integers. Exact for coordinates with few digits: here multiples of 1/64 voxel in small universes.
inline bool meets(const std::array<Eigen::Vector3d, 3>& triangle, int x, int y, int z) {
  using Point = std::array<Big, 4>;
  std::vector<Point> polygon;
  for (const Eigen::Vector3d& p : triangle)
    polygon.push_back({std::llround(p.x() * 64), std::llround(p.y() * 64), std::llround(p.z() * 64), 64});
  const std::array<int, 3> corner = {x, y, z};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int upper : {0, 1}) {
      const auto inside = [&](const Point& p) {
        const Big d = p[axis] - p[3] * (corner[axis] + upper);
        return upper ? -d : d;
      };
      std::vector<Point> clipped;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const Big da = inside(a), db = inside(b);
        if (da >= 0) clipped.push_back(a);
        if (sign(da) * sign(db) >= 0) continue;
        Point cut{};
        for (std::size_t k = 0; k < 4; ++k) cut[k] = (b[k] * da - a[k] * db) * (da > 0 ? 1 : -1);
        Big common = 0;
        for (Big k : cut)
          for (k = k < 0 ? -k : k; k != 0; std::swap(common, k)) common %= k;
        for (Big& k : cut) k /= common;
        clipped.push_back(cut);
      }
      polygon = clipped;
    }
  return !polygon.empty();
}

/// The touched rule of a mesh without triangles of no area.
inline DenseGrid touched_rule(const TriangleMesh& mesh, int depth) {
  DenseGrid grid = centre_rule(mesh, depth).value();
  for (const auto& t : mesh.triangles) {
    const std::array<Eigen::Vector3d, 3> p = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    grid.for_each([&](int x, int y, int z, bool black) {
      if (!black && meets(p, x, y, z)) grid.set(x, y, z);
    });
  }
  return grid;
}

}  // namespace blackleaf::reference
