#include "triangle_boxes.h"

#include <algorithm>
#include <cmath>

namespace blackleaf::detail {

TriangleBoxes::TriangleBoxes(const GridMesh& mesh, const std::vector<Triangle>& triangles) {
  triangles_.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    Corners corners{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < 3; ++i)
        corners.p[i][axis] = std::ldexp(static_cast<double>(mesh.vertices[t[i]][axis]), -mesh.fraction_bits());
      const Wide n = normal(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], axis);
      corners.normal[axis] = std::ldexp(static_cast<double>(n), -2 * mesh.fraction_bits());
    }
    triangles_.push_back(corners);
  }
}

bool TriangleBoxes::near(std::uint32_t i, const std::array<double, 3>& centre, double half) const {
  // Coordinates are at most 2^20 and rounded by 2^-33 at most; the slack is far more than that makes of a product.
  constexpr double kSlack = 0x1p-10;
  const double reach = half + kSlack;
  const Corners& t = triangles_[i];
  std::array<std::array<double, 3>, 3> p;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < 3; ++k) p[k][axis] = t.p[k][axis] - centre[axis];
    if (std::min({p[0][axis], p[1][axis], p[2][axis]}) > reach) return false;
    if (std::max({p[0][axis], p[1][axis], p[2][axis]}) < -reach) return false;
  }
  const std::array<double, 3>& n = t.normal;
  const double height = n[0] * p[0][0] + n[1] * p[0][1] + n[2] * p[0][2];
  if (std::abs(height) > reach * (std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]))) return false;
  // The edges turned by a right angle in each of the coordinate planes.
  for (std::size_t edge = 0; edge < 3; ++edge) {
    const std::array<double, 3>&from = p[edge], &to = p[(edge + 1) % 3], &opposite = p[(edge + 2) % 3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
      const double nj = to[k] - from[k], nk = from[j] - to[j];
      const double one = nj * from[j] + nk * from[k], other = nj * opposite[j] + nk * opposite[k];
      const double width = reach * (std::abs(nj) + std::abs(nk));
      if (std::min(one, other) > width || std::max(one, other) < -width) return false;
    }
  }
  return true;
}

}  // namespace blackleaf::detail
