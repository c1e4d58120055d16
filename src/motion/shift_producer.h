// ShiftProducer: a producer (octree/produce.h) for a solid shifted by whole voxels (AN84).
//
// Seen from the target, a node of level k covers at most two source cells of level k on every axis, in the same places
// whichever node it is: `by` alone says how far into the lower cell it begins. So the 2^3 cells' children, 4^3 cells of
// the level below, are two 64-bit masks, black and gray; which of the node's eight children are black, white or neither
// is a dozen operations on them. Where `by` is a multiple of 2^k the node is one source node, and its subtree is copied
// as it is: that is what AN84's lowest set bit H expresses.
#pragma once

#include <array>
#include <cstdint>

#include "brick_shift.h"
#include "neighbourhood.h"
#include "octree/node_arrays.h"

namespace blackleaf::detail {

class ShiftProducer {
 public:
  /// Source words, or what stands for one of one colour (SourceTree), of 2^3 neighbouring cells, x + 2 y + 4 z.
  using Task = std::array<std::uint64_t, 8>;

  /// target = source + by, in a universe of the given depth. Requires: the source outlives the producer, the target's
  /// depth is not below the source's, |by_i| < 2^40.
  ShiftProducer(const std::array<std::int64_t, 3>& by, const Octree& source, int depth);

  Task root() const { return root_; }
  Colour classify(const Task& task, const Cube& cube) const;
  Task child(const Task& task, const Cube& cube, int octant) const;
  /// Universes smaller than 8^3 are octant 0 of one of that size.
  Subtree subtree(const Task& task, const Cube& cube, std::uint8_t table, NodeArrays& arrays) const;
  /// As many nodes as the source has, and a little more.
  void reserve(NodeArrays& arrays) const;

 private:
  // How target nodes of one level lie on source cells.
  struct Level {
    bool one_cell = false;         // each is one cell
    unsigned first = 0;            // for shift_kernel.h
    unsigned places = 0;           // the same as x + 4 y + 16 z
    unsigned x = 0, y = 0, z = 0;  // 1, 4, 16 if the children cover two cells on that axis, else 0
  };
  struct Colours {
    unsigned black = 0, mixed = 0;  // by octant
  };
  // The cells of eight nodes: word 8 i + j is cell i of node j.
  using Cells = std::array<std::uint64_t, 64>;

  static Cells alone(const Task& task);
  Colours children(const std::uint64_t* cells, int level) const;
  Subtree node(const std::uint64_t* cells, int level, std::uint8_t table, NodeArrays& arrays) const;
  Subtree bricks(const std::uint64_t* cells, NodeArrays& arrays) const;

  SourceTree source_;
  std::array<std::size_t, kMaxDepth + 1> counts_{};  // of the source's nodes
  BlockShift block_shift_;
  Task root_{};
  std::array<std::uint64_t, kMaxDepth + 1> above_{};  // one word a level, from the source's root up
  std::array<const std::uint64_t*, kMaxDepth + 1> words_{};
  std::array<Level, kMaxDepth + 1> levels_{};
};

}  // namespace blackleaf::detail
