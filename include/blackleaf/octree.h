// Octree: an immutable, condensed, solid octree.
//
// Meaning. An octree of depth n (1 <= n <= 20) covers the cube [0, 2^n]^3. Voxel (x,y,z) is the closed unit cube at
// that corner. The root has level n, voxels have level 0, a node of level k covers a cube of side 2^k. Octant label =
// x + 2y + 4z. A node is black (inside the solid), white (outside) or gray (both). Trees are condensed: no gray node
// has eight children of one colour, and storage order is fixed, so equal solids have equal words, bit for bit.
//
// Encoding. Every gray node is one 64-bit word; black and white nodes take no space.
//
//   level >= 3  "node":   bits 0-7 black mask | bits 8-15 gray mask | bits 16-63 index of the first gray child
//                         bit o of a mask speaks of the child with octant label o; the gray children of one node
//                         stand side by side, in order of their labels, among the words of the next lower level.
//   level 2     "brick":  the 4^3 voxels, one bit each, in octant order: bit 8*o1 + o0 is the child o0 of the child o1.
//   level 1     "byte":   eight bits of a brick; it is stored as a word of its own only as the root of a depth-1 tree.
//
// The words of one level are contiguous; groups of siblings follow each other in the order in which the Millar curve
// (curve.h) leaves their parents. The root word stands alone at level n.
//
// Worked example. Depth 3, black voxels exactly [0,4)^3 and (7,7,7): the root word is 0x0000'0000'0000'8001 (octant 0
// black, octant 7 gray, first gray child at index 0 of level 2); level 2 holds one word, the brick
// 0x8000'0000'0000'0000. Two words, 16 bytes.
//
// What follows: a solid with S surface voxels needs O(S) words, about S/8 bytes for smooth surfaces at the bricks and a
// third of that above them; reading a voxel costs at most n - 1 dependent loads; two trees are equal iff their words
// are.
#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "blackleaf/frame.h"

namespace blackleaf {

inline constexpr int kMaxDepth = 20;

enum class Colour : std::uint8_t { white = 0, black = 1, gray = 2 };

/// An upright cube of the octree's tessellation: the voxels [x, x+2^level) x [y, y+2^level) x [z, z+2^level).
struct Cube {
  std::int32_t x = 0, y = 0, z = 0;
  int level = 0;

  std::int32_t side() const { return std::int32_t{1} << level; }
  /// The child with the given octant label (x + 2y + 4z). Requires: level >= 1.
  Cube child(int octant) const {
    const std::int32_t half = std::int32_t{1} << (level - 1);
    return {x + (octant & 1) * half, y + (octant >> 1 & 1) * half, z + (octant >> 2) * half, level - 1};
  }
  friend bool operator==(const Cube&, const Cube&) = default;
};

/// A cursor on one node of an octree, at any level down to single voxels. 24 bytes, cheap to copy; valid as long as the
/// octree (or any copy of it) lives.
class Node {
 public:
  Node() = default;

  int level() const { return level_; }
  Colour colour() const { return colour_; }
  bool is_gray() const { return colour_ == Colour::gray; }
  bool is_black() const { return colour_ == Colour::black; }
  bool is_white() const { return colour_ == Colour::white; }

  /// The child with the given octant label; children of a black or white node have its colour.
  /// Requires: level() >= 1, 0 <= octant < 8. O(1).
  Node child(int octant) const;

  /// The node as a brick of 4^3 voxels, one bit each in octant order. Requires: level() == 2. O(1).
  std::uint64_t brick() const {
    assert(level_ == 2);
    return colour_ == Colour::gray ? word_ : colour_ == Colour::black ? ~std::uint64_t{0} : 0;
  }

  /// The stored word of a gray node (see the head of this file). Requires: is_gray().
  std::uint64_t word() const { return word_; }

  /// The gray node of another level with this word, of the tree that this node belongs to. Requires: the tree has it.
  Node relative(int level, std::uint64_t word) const { return Node(levels_, word, level, Colour::gray); }

  /// A node of one colour that belongs to no tree, e.g. the space outside a universe.
  static Node uniform(int level, Colour colour) { return Node(nullptr, 0, level, colour); }
  /// A node of level 2 that belongs to no tree, from its 64 voxels.
  static Node from_brick(std::uint64_t bits) {
    return Node(nullptr, bits, 2, bits == 0 ? Colour::white : ~bits == 0 ? Colour::black : Colour::gray);
  }

 private:
  friend class Octree;
  Node(const std::uint64_t* const* levels, std::uint64_t word, int level, Colour colour)
      : levels_(levels), word_(word), level_(static_cast<std::uint8_t>(level)), colour_(colour) {}

  const std::uint64_t* const* levels_ = nullptr;  // levels_[k]: first word of level k
  std::uint64_t word_ = 0;
  std::uint8_t level_ = 0;
  Colour colour_ = Colour::white;
};

/// An immutable solid octree with its world frame. Copies share their storage and may be used from many threads.
class Octree {
 public:
  /// The empty universe (every voxel white) or the full one. Requires: 1 <= depth <= 20; colour is not gray.
  explicit Octree(int depth = 1, Colour colour = Colour::white, Frame frame = {});

  int depth() const;
  /// Side of the universe in voxels, 2^depth.
  std::int32_t side() const { return std::int32_t{1} << depth(); }
  Cube universe() const { return {0, 0, 0, depth()}; }
  const Frame& frame() const;
  /// The same solid with another frame. O(1).
  Octree with_frame(Frame frame) const;

  Node root() const;
  bool is_empty() const { return root().is_white(); }

  /// True iff voxel (x,y,z) is black; voxels outside the universe are white. O(depth). The first call for a tree of
  /// depth 6 or more makes a directory of 32 kB (some ten microseconds), shared by all copies of the octree.
  bool contains(std::int64_t x, std::int64_t y, std::int64_t z) const;

  /// The words of one level in storage order; empty above the root and for levels without gray nodes.
  /// Requires: 0 <= level <= 20.
  std::span<const std::uint64_t> words(int level) const;
  /// Bytes held by the tree: its words and the fixed part; without the directory that contains() makes.
  std::size_t memory_bytes() const;

  /// Equality of solids: same depth and same words. Frames are not compared. O(words).
  friend bool operator==(const Octree& a, const Octree& b);

  struct Storage;  // src/octree/storage.h
  explicit Octree(std::shared_ptr<const Storage> storage);

 private:
  std::shared_ptr<const Storage> storage_;
};

inline Node Node::child(int octant) const {
  assert(level_ >= 1 && octant >= 0 && octant < 8);
  const int below = level_ - 1;
  if (colour_ != Colour::gray) return Node(nullptr, 0, below, colour_);
  if (level_ >= 3) {
    const std::uint64_t bit = std::uint64_t{1} << octant;
    if (word_ & bit) return Node(nullptr, 0, below, Colour::black);
    const std::uint64_t gray = word_ >> 8 & 0xFF;
    if (!(gray & bit)) return Node(nullptr, 0, below, Colour::white);
    const std::uint64_t index = (word_ >> 16) + static_cast<unsigned>(std::popcount(gray & (bit - 1)));
    return Node(levels_, levels_[below][index], below, Colour::gray);
  }
  if (level_ == 2) {
    const std::uint64_t byte = word_ >> (8 * octant) & 0xFF;
    if (byte == 0) return Node(nullptr, 0, 1, Colour::white);
    if (byte == 0xFF) return Node(nullptr, 0, 1, Colour::black);
    return Node(nullptr, byte, 1, Colour::gray);
  }
  return Node(nullptr, 0, 0, (word_ >> octant & 1) ? Colour::black : Colour::white);
}

}  // namespace blackleaf
