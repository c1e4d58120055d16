// BoxTree: a solid as a tree of boxes, for questions of distance.
//
// Every node is the smallest box around its black voxels, single children are skipped, and whatever fills its box is
// one leaf, cube or not. So a plate one voxel thick is one box, and a question neither looks at empty corners of nodes
// nor at voxels that a box can stand for. The solid is the same: the union of the leaves is the union of the black
// voxels.
//
// Nodes that are no leaves also have a plane that their black voxels do not cross, if PreparedSolid has one: where a
// smooth surface passes, it is much closer than the box.
//
// Nodes stand in one array; the children of a node are neighbours in it, at most 8. 48 bytes a node:
//   centre, half   floats, exact: multiples of 1/2 of at most 2^20
//   radius         of the ball around the box, rounded up
//   normal, reach  normal.(x - centre) <= reach for black points x; length 1 up to 2^-22, or 0 without a plane
//   children       index of the first child << 4 | number of children; no children: a leaf, wholly black
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blackleaf/prepared_solid.h"

namespace blackleaf::detail {

struct BoxNode {
  std::array<float, 3> centre{}, half{}, normal{};
  float reach = 0, radius = 0;
  std::uint32_t children = 0;

  bool has_plane() const { return normal[0] != 0 || normal[1] != 0 || normal[2] != 0; }
  bool is_leaf() const { return (children & 15) == 0; }
  std::uint32_t first() const { return children >> 4; }
  std::uint32_t count() const { return children & 15; }
};
static_assert(sizeof(BoxNode) == 48);

struct BoxTree {
  int depth = 1;
  std::vector<BoxNode> nodes;  // the root is the last one; empty for the empty solid

  explicit BoxTree(const PreparedSolid& solid);
  bool is_empty() const { return nodes.empty(); }
  std::uint32_t root() const { return static_cast<std::uint32_t>(nodes.size() - 1); }
};

/// The boxes of a solid, made when they are first asked for, by whichever thread. O(words) then.
const BoxTree& boxes(const PreparedSolid& solid);

}  // namespace blackleaf::detail
