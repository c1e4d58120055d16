// Paths checked the slow way: at many times, by the exact tilted cubes of contact.h.
#pragma once

#include <algorithm>

#include "blackleaf/contact.h"
#include "blackleaf/measures.h"
#include "blackleaf/motion.h"
#include "blackleaf/octree.h"
#include "blackleaf/path.h"

namespace blackleaf::reference {

/// Whether the solid interferes with the environment at one of many times of its path, so close together that no point
/// of it travels `step` voxels in between.
inline bool hits(const Octree& environment, const Octree& object, const Path& path, double step) {
  const std::vector<double> times = path.times(*bounding_box(object), step);
  const PreparedSolid a(environment), b(object);
  return std::any_of(times.begin(), times.end(),
                     [&](double t) { return interferes(a, b, path.motion_at(t), Meaning::exact); });
}

/// The same of two solids that both move, at `count` times from the first of either path to the last of either.
inline bool meet(const Octree& a, const Path& path_of_a, const Octree& b, const Path& path_of_b, int count) {
  const double begin = std::min(path_of_a.begin(), path_of_b.begin());
  const double end = std::max(path_of_a.end(), path_of_b.end());
  const PreparedSolid p(a), q(b);
  for (int i = 0; i <= count; ++i) {
    const double t = begin + (end - begin) * i / count;
    if (interferes(p, q, path_of_a.motion_at(t).inverse() * path_of_b.motion_at(t), Meaning::exact)) return true;
  }
  return false;
}

/// Whether a corner of the solid's bounding box leaves the universe at one of these times.
inline bool leaves(const Octree& object, const Path& path, double step) {
  const Box box = *bounding_box(object);
  for (const double t : path.times(box, step))
    for (unsigned corner = 0; corner < 8; ++corner) {
      Eigen::Vector3d x;
      for (unsigned i = 0; i < 3; ++i) x[i] = (corner >> i & 1 ? box.max : box.min)[i];
      const Eigen::Vector3d y = path.motion_at(t)(x);
      if (y.minCoeff() < 0 || y.maxCoeff() > object.side()) return true;
    }
  return false;
}

}  // namespace blackleaf::reference
