// LabelTree: a label map as a tree, for those who ask for nodes in an order that is not its curve's.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blackleaf/label_map.h"

namespace blackleaf::detail {

class LabelTree {
 public:
  /// A node: its label if it has one, else where its children stand.
  class Node {
   public:
    static constexpr Node of_label(std::uint32_t label) { return Node(label); }
    constexpr bool has_one_label() const { return value_ >> 32 == 0; }
    /// Requires: has_one_label().
    constexpr std::uint32_t label() const { return static_cast<std::uint32_t>(value_); }
    friend constexpr bool operator==(const Node&, const Node&) = default;
    Node() = default;

   private:
    friend class LabelTree;
    constexpr explicit Node(std::uint64_t value) : value_(value) {}
    std::uint64_t value_ = 0;  // the label, or 2^32 + the index of its children
  };

  /// The tree of a map, as octant 0 of octant 0 and so on of a universe of the given depth, whose rest has label 0.
  /// Requires: depth >= map.depth(). O(runs * depth); about as many bytes as the map has.
  LabelTree(const LabelMap& map, int depth);

  Node root() const { return root_; }
  /// Children of a node of one label have it too.
  Node child(Node node, unsigned octant) const {
    if (node.has_one_label()) return node;
    const Children& children = children_[node.label()];
    const std::uint64_t inner = children.inner >> octant & 1;
    return Node(inner << 32 | children.values[octant]);
  }

 private:
  struct Children {
    std::array<std::uint32_t, 8> values{};  // by octant: the label, or the index of the children
    std::uint32_t inner = 0;                // by octant: whether it has children
  };
  class Builder;

  Node add(const std::array<Node, 8>& children);

  std::vector<Children> children_;
  Node root_;
};

}  // namespace blackleaf::detail
