// corner_walk: visits every place where black and white meet, in time proportional to the tree.
//
// Lattice corner (x,y,z), 0 <= x,y,z <= 2^n, has eight voxels around it. The walk covers all corners by aligned cubes
// of corners [c, c + 2^k)^3; around such a cube stand eight nodes of level k: m[0..7], m[7] being the node of those
// voxels itself and bit i of the index saying whether the node is the main one (1) or the next lower one (0) along axis
// i. Outside the universe everything is white. Where all eight are of one colour there is nothing to see; where each is
// of one colour but not the same, boundary runs only along the planes x = c.x, y = c.y, z = c.z of the cube.
#pragma once

#include <array>
#include <cstdint>

#include "blackleaf/octree.h"
#include "node_arrays.h"

namespace blackleaf::detail {

using Around = std::array<Node, 8>;

/// Calls visitor.uniform(cube, around) where all eight nodes are black or white but not all alike, and
/// visitor.bricks(cube, around) at level 2 where some are gray (gray nodes of depth-1 trees come as bricks). A visitor
/// may have enter(cube), called on the way down for each cube that is not passed over; where it says false, nothing
/// below is visited.
template <class Visitor>
void corner_walk(const Around& around, const Cube& cube, Visitor& visitor) {
  unsigned black = 0, gray = 0;
  for (unsigned i = 0; i < 8; ++i) {
    black += around[i].is_black();
    gray += around[i].is_gray();
  }
  if (gray == 0 && (black == 0 || black == 8)) return;
  if constexpr (requires { visitor.enter(cube); })
    if (!visitor.enter(cube)) return;
  if (gray == 0) {
    visitor.uniform(cube, around);
    return;
  }
  if (cube.level == 2) {
    visitor.bricks(cube, around);
    return;
  }
  for (unsigned octant = 0; octant < 8; ++octant) {
    Around below;
    for (unsigned i = 0; i < 8; ++i) {
      // Axis by axis: child index of the main cube (0 or 1) minus one for the lower side; -1 is the upper half of the
      // lower node.
      const unsigned node = octant | i, child = ~(octant ^ i) & 7;
      below[i] = around[node].child(static_cast<int>(child));
    }
    corner_walk(below, cube.child(static_cast<int>(octant)), visitor);
  }
}

/// The walk over all corners of a universe, those on its upper faces included.
template <class Visitor>
void corner_walk(const Octree& octree, Visitor& visitor) {
  const Node root = brick_level_root(octree);
  const Node white = Node::uniform(root.level(), Colour::white);
  const std::int32_t side = std::int32_t{1} << root.level();
  for (unsigned octant = 0; octant < 8; ++octant) {
    Around around;
    around.fill(white);
    around[~octant & 7] = root;
    const Cube cube{octant & 1 ? side : 0, octant & 2 ? side : 0, octant & 4 ? side : 0, root.level()};
    corner_walk(around, cube, visitor);
  }
}

}  // namespace blackleaf::detail
