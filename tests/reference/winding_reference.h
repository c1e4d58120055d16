// Slow, readable twin of generalised winding numbers: the solid angles of all triangles, one by one.
#pragma once

#include <cmath>
#include <vector>

#include "blackleaf/mesh.h"

namespace blackleaf::reference {

/// The sum of the solid angles of a mesh seen from a point off its surface, over 4 pi.
inline double generalised_winding(const TriangleMesh& mesh, const Eigen::Vector3d& at) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]] - at, b = mesh.vertices[t[1]] - at, c = mesh.vertices[t[2]] - at;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * std::acos(-1.0));
}

}  // namespace blackleaf::reference
