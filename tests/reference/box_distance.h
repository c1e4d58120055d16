// The slow readable twin of distances between an upright solid and a moved one: all pairs of leaves, all pairs of their
// features, in long double.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <vector>

#include "blackleaf/leaves.h"
#include "blackleaf/motion.h"

namespace blackleaf::reference {

using WideReal = long double;
using WideVector = Eigen::Matrix<WideReal, 3, 1>;
using WideMatrix = Eigen::Matrix<WideReal, 3, 3>;

/// X = rotation y + shift.
struct WideMap {
  WideMatrix rotation = WideMatrix::Identity();
  WideVector shift = WideVector::Zero();
};

/// The exact solid's map: the inverse of (A X + b) / 2^38.
inline WideMap exact_map(const Motion& motion) {
  const FixedMotion fixed(motion);
  WideMatrix a;
  WideVector b;
  for (int i = 0; i < 3; ++i) {
    b[i] = static_cast<WideReal>(fixed.inverse_translation[static_cast<std::size_t>(i)]) * 0x1p-38L;
    for (int j = 0; j < 3; ++j)
      a(i, j) =
          static_cast<WideReal>(fixed.inverse_rotation[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]) *
          0x1p-38L;
  }
  const WideMatrix inverse = a.inverse();
  return {inverse, -(inverse * b)};
}

/// A box with edges along the columns, centre +- columns.
struct TiltedBox {
  WideVector centre;
  WideMatrix columns;

  WideVector corner(unsigned which) const {
    WideVector p = centre;
    for (unsigned i = 0; i < 3; ++i) p += ((which >> i & 1) != 0 ? 1 : -1) * columns.col(i);
    return p;
  }
  WideReal radius() const {
    return (columns.col(0).cwiseAbs() + columns.col(1).cwiseAbs() + columns.col(2).cwiseAbs()).norm();
  }
};

inline TiltedBox tilted(const Cube& cube, const WideMap& map) {
  const WideReal half = cube.side() / WideReal{2};
  const WideVector centre = WideVector(cube.x, cube.y, cube.z) + WideVector::Constant(half);
  return {map.rotation * centre + map.shift, map.rotation * half};
}

/// Largest gap over the 15 separating axes, each of length 1: minus the depth when they overlap.
inline WideReal separation(const TiltedBox& a, const TiltedBox& b) {
  std::vector<WideVector> axes;
  for (int i = 0; i < 3; ++i)
    for (const TiltedBox* box : {&a, &b})
      axes.push_back(box->columns.col((i + 1) % 3).cross(box->columns.col((i + 2) % 3)));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) axes.push_back(a.columns.col(i).normalized().cross(b.columns.col(j).normalized()));
  WideReal largest = -std::numeric_limits<WideReal>::infinity();
  for (const WideVector& axis : axes) {
    if (axis.norm() < 1e-9L) continue;
    const WideVector n = axis.normalized();
    WideReal gap = std::abs(n.dot(b.centre - a.centre));
    for (int i = 0; i < 3; ++i) gap -= std::abs(n.dot(a.columns.col(i))) + std::abs(n.dot(b.columns.col(i)));
    largest = std::max(largest, gap);
  }
  return largest;
}

/// The point of the box nearest to p.
inline WideVector nearest_in(const TiltedBox& box, const WideVector& p) {
  const WideVector inside = (box.columns.inverse() * (p - box.centre)).cwiseMax(-1).cwiseMin(1);
  return box.centre + box.columns * inside;
}

inline WideReal segment_distance(const WideVector& p, const WideVector& u, const WideVector& q, const WideVector& v) {
  // The least of: both ends of each against the other, and both insides if the nearest points of the lines are there.
  WideReal least = std::numeric_limits<WideReal>::infinity();
  const auto end = [&](const WideVector& point, const WideVector& from, const WideVector& along) {
    const WideReal t = std::clamp<WideReal>((point - from).dot(along) / along.squaredNorm(), 0, 1);
    least = std::min(least, (from + t * along - point).norm());
  };
  end(p, q, v);
  end(p + u, q, v);
  end(q, p, u);
  end(q + v, p, u);
  const WideVector n = u.cross(v);
  if (n.norm() > 1e-9L * u.norm() * v.norm()) {
    WideMatrix m;
    m << u, -v, n;
    const WideVector at = m.inverse() * (q - p);
    if (at[0] >= 0 && at[0] <= 1 && at[1] >= 0 && at[1] <= 1) least = std::min(least, std::abs(at[2]) * n.norm());
  }
  return least;
}

/// 0 when they overlap; else the least over corners against boxes and edges against edges.
inline WideReal distance(const TiltedBox& a, const TiltedBox& b) {
  if (separation(a, b) <= 0) return 0;
  WideReal least = std::numeric_limits<WideReal>::infinity();
  for (unsigned which = 0; which < 8; ++which) {
    least = std::min(least, (nearest_in(a, b.corner(which)) - b.corner(which)).norm());
    least = std::min(least, (nearest_in(b, a.corner(which)) - a.corner(which)).norm());
  }
  const auto for_each_edge = [](const TiltedBox& box, const auto& visit) {
    for (unsigned axis = 0; axis < 3; ++axis)
      for (unsigned which = 0; which < 8; ++which)
        if ((which >> axis & 1) == 0) visit(box.corner(which), WideVector(2 * box.columns.col(axis)));
  };
  for_each_edge(a, [&](const WideVector& p, const WideVector& u) {
    for_each_edge(
        b, [&](const WideVector& q, const WideVector& v) { least = std::min(least, segment_distance(p, u, q, v)); });
  });
  return least;
}

/// A solid as its black leaves.
inline std::vector<Cube> cubes(const Octree& octree) {
  std::vector<Cube> result;
  for_each_black_leaf(octree, [&](const Leaf& leaf) { result.push_back(leaf.cube); });
  return result;
}

/// The least over all pairs of leaves; `signed_` tells the depth of the deepest pair, as a negative number, when some
/// overlap. Pairs whose balls are farther apart than what is known are skipped. Infinite if one solid is empty.
inline WideReal distance(const std::vector<Cube>& a, const WideMap& map_of_a, const std::vector<Cube>& b,
                         const WideMap& map_of_b, bool signed_ = false) {
  std::vector<TiltedBox> boxes_a, boxes_b;
  for (const Cube& cube : a) boxes_a.push_back(tilted(cube, map_of_a));
  for (const Cube& cube : b) boxes_b.push_back(tilted(cube, map_of_b));
  WideReal least = std::numeric_limits<WideReal>::infinity();
  for (const TiltedBox& p : boxes_a)
    for (const TiltedBox& q : boxes_b) {
      const WideReal apart = (p.centre - q.centre).norm() - p.radius() - q.radius();
      if (apart > std::max<WideReal>(least, 0) || (least <= 0 && !signed_)) continue;
      const WideReal separated = separation(p, q);
      if (separated > std::max<WideReal>(least, 0)) continue;
      least = std::min(least, signed_ && separated < 0 ? separated : distance(p, q));
    }
  return least;
}

}  // namespace blackleaf::reference
