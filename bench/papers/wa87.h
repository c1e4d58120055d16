// WA87: J. Weng and N. Ahuja, "Octrees of objects in arbitrary motion: representation and efficiency", 1987, as
// printed, its slips mended (section 4: a voxel whose centre a moved cube misses is left alone, not coloured white;
// condense follows after all eight children).
//
// Every black leaf of the source tree is moved and added to the target tree: from the root down, target nodes are
// tested against the moved cube by spheres and upright cubes (relation B). Only internal nodes are stored; children's
// colours are bits of the parent (lemma: I = (T - 1) / 8).
//
// This is the paper's own algorithm, kept as a second witness and as a baseline. The libraries do not use it. Which
// voxel centres belong to a moved cube is decided with FixedMotion's integers, so its answer must equal the product's
// bit for bit.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "blackleaf/motion.h"
#include "blackleaf/octree.h"
#include "papers/node_pool.h"

namespace blackleaf::papers::wa87 {

/// An octree whose leaves live in their parents' bits.
class Tree {
 public:
  /// The white universe.
  explicit Tree(int depth) : depth_(depth) {}
  explicit Tree(const Octree& octree);
  Octree octree() const;

  int depth() const { return depth_; }
  /// I: internal nodes. M: the most internal nodes alive at once while the tree was built. B: black leaves.
  std::size_t internal_nodes() const { return pool_->alive(); }
  std::size_t peak_internal_nodes() const { return pool_->peak(); }
  std::size_t black_leaves() const;
  /// V: black voxels.
  std::uint64_t volume() const;

  /// The source moved by X' = RX + T. Throws Error(out_of_universe) when a corner of a moved black leaf lies outside by
  /// more than 2^-16 voxels. O(Kn) on the average for K nodes in a universe of depth n (Theorem 3).
  friend Tree move(const Tree& source, const FixedMotion& motion);

 private:
  struct Node {
    std::array<Node*, 8> child{};  // of the gray children
    std::uint8_t black = 0, gray = 0;
  };
  struct Link {
    Colour colour;
    const Node* node;
  };
  class Mover;

  static Link link(const Node& parent, std::size_t octant);
  template <class Visit>
  void for_each_black_leaf(const Visit& visit) const;
  void condense(Node& parent, std::size_t octant);

  int depth_;
  std::unique_ptr<NodePool<Node>> pool_ = std::make_unique<NodePool<Node>>();
  Node holder_;  // its octant 0 is the root; not itself a node of the tree
};

Tree move(const Tree& source, const FixedMotion& motion);

/// Theorem 1: no more black leaves represent an m-cube in any orientation and position. Requires: m >= 0.
double black_leaf_bound(int m);
/// Theorem 2: the same for internal nodes, in a universe of depth n.
double internal_node_bound(int m, int n);
/// Corollary: the same for all nodes; for m < 3 it follows from Theorem 2 by the lemma.
double node_bound(int m, int n);

}  // namespace blackleaf::papers::wa87
