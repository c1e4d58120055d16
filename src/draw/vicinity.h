// Vicinity: a node and the 26 of its level around it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "blackleaf/octree.h"
#include "octree/corner_walk.h"
#include "octree/node_arrays.h"

namespace blackleaf::detail {

class Vicinity {
 public:
  /// About a cube of a universe's level or below, which may lie outside: there all is white. O(depth).
  Vicinity(const Node& root, const Cube& cube) {
    const std::int32_t side = std::int32_t{1} << root.level();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const auto at = [&](std::int32_t low, std::size_t offset) {
        return low + (static_cast<std::int32_t>(offset) - 1) * cube.side();
      };
      const std::int32_t x = at(cube.x, i % 3), y = at(cube.y, i / 3 % 3), z = at(cube.z, i / 9);
      const bool inside = x >= 0 && x < side && y >= 0 && y < side && z >= 0 && z < side;
      Node node = inside ? root : Node::uniform(cube.level, Colour::white);
      while (node.level() > cube.level) {
        const int below = node.level() - 1;
        node = node.child((x >> below & 1) | (y >> below & 1) << 1 | (z >> below & 1) << 2);
      }
      nodes_[i] = node;
    }
  }

  /// The vicinity of a child. Requires: level >= 3.
  Vicinity child(unsigned octant) const {
    Vicinity below;
    std::size_t i = 0;
    for (unsigned z = 0; z < 3; ++z)
      for (unsigned y = 0; y < 3; ++y)
        for (unsigned x = 0; x < 3; ++x)
          below.nodes_[i++] = half(1 + (octant & 1) + x, 1 + (octant >> 1 & 1) + y, 1 + (octant >> 2) + z);
    return below;
  }

  /// The nodes about the cube's corners, as corner_walk has them.
  Around around() const {
    Around around;
    for (unsigned i = 0; i < 8; ++i) around[i] = nodes_[(i & 1) + 3 * (i >> 1 & 1) + 9 * (i >> 2)];
    return around;
  }

  /// Of the 6^3 halves of the nodes that at (x, y, z), each 0 to 5.
  Node half(unsigned x, unsigned y, unsigned z) const {
    const unsigned child = (x & 1) | (y & 1) << 1 | (z & 1) << 2;
    return nodes_[x / 2 + 3 * (y / 2) + 9 * (z / 2)].child(static_cast<int>(child));
  }

  /// x fastest.
  const std::array<Node, 27>& nodes() const { return nodes_; }

 private:
  Vicinity() = default;

  std::array<Node, 27> nodes_;  // x fastest
};

}  // namespace blackleaf::detail
