// Leaves: visiting the leaves of an octree in Millar order.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "blackleaf/octree.h"

namespace blackleaf {

/// A leaf and the first of the 8^level numbers of its voxels on the Millar curve.
struct Leaf {
  Cube cube;
  std::uint64_t first = 0;
};

/// Calls visit for every black leaf in curve order. O(words).
void for_each_black_leaf(const Octree& octree, const std::function<void(const Leaf&)>& visit);
/// Calls visit(leaf, black) for every leaf, black and white, in curve order. O(words).
void for_each_leaf(const Octree& octree, const std::function<void(const Leaf&, bool black)>& visit);
/// The black leaves in curve order.
std::vector<Leaf> black_leaves(const Octree& octree);

}  // namespace blackleaf
