// Sites: the source nodes that a target node may lie within a radius of.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "blackleaf/octree.h"

namespace blackleaf::detail {

/// A box of voxels, [low, high] on every axis.
struct VoxelBox {
  std::array<std::int32_t, 3> low{}, high{};

  static VoxelBox of(const Cube& cube) {
    const std::int32_t last = cube.side() - 1;
    return {{cube.x, cube.y, cube.z}, {cube.x + last, cube.y + last, cube.z + last}};
  }
  /// The child of a cube's box with the given octant label.
  VoxelBox child(int octant) const {
    VoxelBox box = *this;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t half = (high[i] - low[i] + 1) / 2;
      if (octant >> i & 1)
        box.low[i] += half;
      else
        box.high[i] -= half;
    }
    return box;
  }
};

/// The square of the length of the vector with component(axis), an int32, on each axis: below 2^50 for differences of
/// coordinates below 2^23.
template <class Component>
std::int64_t squared_length(Component component) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t along = component(i);
    sum += along * along;
  }
  return sum;
}

/// Squared distances of voxel centres: the least from a voxel of `a` to one of `b`;
inline std::int64_t least_squared(const VoxelBox& a, const VoxelBox& b) {
  return squared_length([&](std::size_t i) { return std::max({0, b.low[i] - a.high[i], a.low[i] - b.high[i]}); });
}
/// the most from a voxel of `a` to the voxel of `b` that is nearest to it;
inline std::int64_t nearest_squared(const VoxelBox& a, const VoxelBox& b) {
  return squared_length([&](std::size_t i) { return std::max({0, b.low[i] - a.low[i], a.high[i] - b.high[i]}); });
}
/// the most from a voxel of `a` to one of `b`.
inline std::int64_t most_squared(const VoxelBox& a, const VoxelBox& b) {
  return squared_length([&](std::size_t i) { return std::max(a.high[i] - b.low[i], b.high[i] - a.low[i]); });
}

/// A node of the source that is not white, and where it lies in the target's coordinates; or a black box.
struct Site {
  Node node;
  VoxelBox box;
};
using Sites = std::vector<Site>;

/// True iff every voxel of `box` is known to lie within the squared radius of a black voxel of the site: of a black
/// box, or wherever in a small gray node it may be; larger gray ones are looked into.
inline bool covers(const Site& site, const VoxelBox& box, std::int64_t squared) {
  if (nearest_squared(box, site.box) > squared) return false;  // not even if it were black
  if (site.node.is_black() || most_squared(box, site.box) <= squared) return true;
  if (site.node.level() <= 2) return false;
  for (int octant = 0; octant < 8; ++octant) {
    const Node child = site.node.child(octant);
    if (!child.is_white() && covers({child, site.box.child(octant)}, box, squared)) return true;
  }
  return false;
}

/// Adds to `sites` those parts of a site that a voxel of `box` may be within the radius of, gray ones no larger than
/// `level` or bricks.
inline void add_near(Sites& sites, const Site& site, const VoxelBox& box, int level, std::int64_t squared) {
  if (least_squared(box, site.box) > squared) return;
  if (!site.node.is_gray() || site.node.level() <= std::max(level, 2)) {
    sites.push_back(site);
    return;
  }
  for (int octant = 0; octant < 8; ++octant) {
    const Node child = site.node.child(octant);
    if (!child.is_white()) add_near(sites, {child, site.box.child(octant)}, box, level, squared);
  }
}

}  // namespace blackleaf::detail
