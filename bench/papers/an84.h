// AN84: N. Ahuja and C. Nash, "Octree representations of moving objects", 1984, as printed.
//
// Only black leaves are kept: a pointer tree whose missing children are white. An object is translated along x, then y,
// then z. For a displacement whose lowest set bit is H, black leaves above level H are split down to it; every node of
// level H is then thrown to the place that its label path plus the displacement names, and the tree is compacted at
// the end (sections 3.1 and 3.2). Levels are counted here from the voxels (0) up, as everywhere in this project.
//
// This is the paper's own algorithm, kept as a second witness and as a baseline. The libraries do not use it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "blackleaf/octree.h"
#include "papers/node_pool.h"

namespace blackleaf::papers::an84 {

enum class Axis : std::uint8_t { x = 0, y = 1, z = 2 };

/// Table 1: what a unit displacement adds to a label, modulo 8, by [initial label][axis].
inline constexpr std::array<std::array<std::uint8_t, 3>, 8> kIncrements = {
    {{1, 2, 4}, {7, 2, 4}, {1, 6, 4}, {7, 6, 4}, {1, 2, 4}, {7, 2, 4}, {1, 6, 4}, {7, 6, 4}}};

struct Transition {
  std::uint8_t label;
  bool carry;
  friend bool operator==(const Transition&, const Transition&) = default;
};

/// Table 2: the label after a unit displacement, by [initial label][axis]. There is a carry when the label lies in the
/// half that the displacement leaves. Derived from Table 1.
inline constexpr std::array<std::array<Transition, 3>, 8> kTransitions = [] {
  std::array<std::array<Transition, 3>, 8> table{};
  for (unsigned label = 0; label < 8; ++label)
    for (unsigned axis = 0; axis < 3; ++axis)
      table[label][axis] = {static_cast<std::uint8_t>((label + kIncrements[label][axis]) % 8),
                            (label >> axis & 1) != 0};
  return table;
}();

/// The labels met on the way from the root to a node; r057 is {0, 5, 7}.
struct Path {
  std::array<std::uint8_t, kMaxDepth> labels{};
  int length = 0;

  void push(int label) { labels[static_cast<std::size_t>(length++)] = static_cast<std::uint8_t>(label); }
  void pop() { labels[static_cast<std::size_t>(--length)] = 0; }
  friend bool operator==(const Path&, const Path&) = default;
};

struct Sum {
  Path path;
  bool carry_lost = false;  // a carry left the most significant position and was dropped
};

/// The path of the node reached from `path` by a displacement in units of the node's own side. A negative displacement
/// is added as its two's complement of path.length bits, and the carry that leaves the root is dropped; then the sum is
/// meaningful only if a carry was in fact lost, while for positive displacements it is only if none was: otherwise the
/// node has left the universe and the path wraps around. O(length) look-ups in Table 2 (section 3.1).
Sum add(const Path& path, std::int64_t displacement, Axis axis);

/// An object as a tree of black leaves.
class Tree {
 public:
  explicit Tree(const Octree& octree);
  Octree octree() const;

  int depth() const { return depth_; }
  /// Nodes alive, gray and black, the root included; and the most there ever were.
  std::size_t nodes() const { return pool_->alive(); }
  std::size_t peak_nodes() const { return pool_->peak(); }

  /// Shifts the object by whole voxels (section 3.2). Throws Error(out_of_universe), before anything is changed, when a
  /// black leaf would leave the universe. O(N H + N') with N nodes at levels H and above after splitting, N' nodes
  /// before compaction (section 3.3); an odd displacement splits the object to voxels.
  void translate(const std::array<std::int64_t, 3>& by);

  /// True iff some voxel is black in both, by one parallel traversal of the two trees (section 5).
  /// Requires: equal depths.
  friend bool interferes(const Tree& a, const Tree& b);

 private:
  struct Node {
    std::array<Node*, 8> child{};  // null: white
    bool black = false;            // a black leaf; otherwise gray
    bool is_empty() const { return !black && child == std::array<Node*, 8>{}; }
  };
  struct Link {
    Colour colour;
    const Node* node;
  };
  class Shift;

  static Link link(const Node* node);
  static bool meet(const Node* a, const Node* b);
  Node* access(const Path& path);
  void split(Node* node, int level, int height);
  bool compact(Node* node);

  int depth_;
  std::unique_ptr<NodePool<Node>> pool_ = std::make_unique<NodePool<Node>>();
  Node* root_;
};

}  // namespace blackleaf::papers::an84
