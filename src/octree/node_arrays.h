// NodeArrays: the one place where octree nodes are made.
//
// A producer hands over the eight children of a node, in whatever way it got them, and receives the node, condensed. A
// node's gray children are stored at that moment, never before, so nothing is stored that is later thrown away. Called
// in post-order along the Millar curve, this yields the canonical storage order of octree.h.
#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <memory>
#include <span>

#include "blackleaf/curve.h"
#include "blackleaf/octree.h"
#include "word_array.h"

namespace blackleaf::detail {

/// A finished node: its colour and, if gray, its word.
struct Subtree {
  std::uint64_t word = 0;
  Colour colour = Colour::white;

  static Subtree uniform(Colour colour) { return {0, colour}; }
  static Subtree brick(std::uint64_t bits) {
    return {bits, bits == 0 ? Colour::white : ~bits == 0 ? Colour::black : Colour::gray};
  }
};

/// A finished node and all below it, in one piece of memory: for those who finish nodes out of order. Sixteen bytes if
/// it has one colour.
class PackedNode {
 public:
  bool is_white() const { return colour_ == Colour::white; }
  /// Nodes stored of a level. Requires: level >= 2.
  std::size_t count(int level) const {
    return words_ && level < level_ ? words_[static_cast<std::size_t>(level - 1)] : 0;
  }

 private:
  friend class NodeArrays;
  // The node's word, the counts of the levels from 2 to the node's, the words of these levels.
  std::unique_ptr<std::uint64_t[]> words_;
  Colour colour_ = Colour::white;
  std::uint8_t level_ = 0;
};

/// The first words of all levels of a tree.
using LevelWords = std::array<const std::uint64_t*, kMaxDepth + 1>;
inline LevelWords level_words(const Octree& octree) {
  LevelWords levels{};
  for (int level = 0; level <= kMaxDepth; ++level) levels[static_cast<std::size_t>(level)] = octree.words(level).data();
  return levels;
}

/// Where among the words of the next lower level a gray child of a node of level 3 or more stands.
/// Requires: the child of that octant is gray.
inline std::uint64_t gray_child_index(std::uint64_t word, unsigned octant) {
  return (word >> 16) + static_cast<unsigned>(std::popcount(word >> 8 & 0xFF & ((1u << octant) - 1)));
}

/// The word of a gray node of level 3 or more with black and white children exchanged.
inline std::uint64_t exchanged(std::uint64_t word) {
  return (word & ~std::uint64_t{0xFF}) | (~(word | word >> 8) & 0xFF);
}

class NodeArrays {
 public:
  /// The node of the given level whose children, by octant, are these. Requires: 3 <= level <= 20.
  Subtree close(int level, const std::array<Subtree, 8>& children) {
    unsigned black = 0, gray = 0;
    for (unsigned octant = 0; octant < 8; ++octant) {
      black |= (children[octant].colour == Colour::black ? 1u : 0u) << octant;
      gray |= (children[octant].colour == Colour::gray ? 1u : 0u) << octant;
    }
    if (gray == 0 && (black == 0 || black == 0xFF)) return Subtree::uniform(black ? Colour::black : Colour::white);
    auto& below = levels_[static_cast<std::size_t>(level - 1)];
    const std::uint64_t first = gray ? below.size() : 0;
    for (unsigned rest = gray; rest; rest &= rest - 1)
      below.push_back(children[static_cast<unsigned>(std::countr_zero(rest))].word);
    return {black | gray << 8 | first << 16, Colour::gray};
  }

  /// The same from the masks of black and gray children and the words of the gray ones, by octant. Requires: no child
  /// is black and gray; a word for each gray one.
  Subtree close(int level, unsigned black, unsigned gray, std::span<const std::uint64_t> words) {
    assert((black & gray) == 0 && words.size() == static_cast<std::size_t>(std::popcount(gray)));
    if (gray == 0 && (black == 0 || black == 0xFF)) return Subtree::uniform(black ? Colour::black : Colour::white);
    auto& below = levels_[static_cast<std::size_t>(level - 1)];
    const std::uint64_t first = gray ? below.size() : 0;
    below.append(words.data(), words.size());
    return {black | gray << 8 | first << 16, Colour::gray};
  }

  /// Appends all that is below a gray node of a finished tree, with black and white exchanged if `exchange`, and
  /// returns the node as one of this object: level by level, because a node's descendants of one level stand together.
  /// Requires: 3 <= level; the tree has the node; it is entered here with the same table as there. O(words copied).
  Subtree copy(const LevelWords& from, std::uint64_t word, int level, bool exchange);

  /// Moves a node of some level that has been closed here and the nodes below it, all there are, out; the room for them
  /// stays. Requires: `top` was made by this object; level >= 3.
  PackedNode pack(const Subtree& top, int level);
  /// Appends the nodes of a later stretch of the curve and returns its top node as a node of this object; its memory is
  /// given back.
  Subtree append(PackedNode node);
  /// The same for nodes that another object has made; `level` is the level of the top node. `stretch` is left empty.
  Subtree append(NodeArrays& stretch, Subtree top, int level);
  /// Makes room for so many more nodes of a level.
  void reserve(int level, std::size_t count);
  /// Nodes stored of a level.
  std::size_t count(int level) const { return levels_[static_cast<std::size_t>(level)].size(); }

  /// The octree with this root. Requires: `root` was made by this object; for depth 1 its word has 8 bits.
  /// Leaves the object empty.
  Octree finish(int depth, Subtree root, Frame frame);

  std::size_t size() const;

 private:
  std::array<WordArray, kMaxDepth + 1> levels_;
};

/// A word of level >= 3 whose children moved up by `offset` places.
inline std::uint64_t shifted(std::uint64_t word, std::uint64_t offset) {
  return (word & 0xFF00) ? word + (offset << 16) : word;
}

/// The root as a node of level 2 at least: a depth-1 tree becomes octant 0 of a brick whose other voxels are white.
inline Node brick_level_root(const Octree& octree) {
  const Node root = octree.root();
  if (octree.depth() > 1) return root;
  return Node::from_brick(root.is_gray() ? root.word() : root.is_black() ? 0xFF : 0);
}

}  // namespace blackleaf::detail
