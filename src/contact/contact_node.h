// ContactNode: a node of an octree with a tight box of its black voxels and a plane that they do not cross.
//
// ChildBounds holds these for the eight children of one gray node of level 3 or more, side by side for SIMD, in 88
// bytes; the bounds of a level stand as its words do (octree.h), so a word's index is that of its children's bounds.
// Lengths are in units of max(1, 2^(level - 7)) voxels, so that a node's side is at most 128 units; boxes and planes
// are rounded outward to them.
//
// The plane of a child is the average direction in which its surface faces, outward: by Gauss the sum of all normals of
// the faces between its black and white voxels is, on each axis, how many black voxels touch its lower wall less how
// many touch its upper wall. It is stored as three whole numbers, the vector n of about 127 units length, with the
// largest n.x of its black points. Where a smooth surface passes through a node, plane and points are close together
// by the square of the node's side; boxes only by the side itself.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "blackleaf/octree.h"
#include "blackleaf/prepared_solid.h"
#include "box_tree.h"
#include "exact_boxes.h"

namespace blackleaf::detail {

struct ChildBounds {
  std::array<std::array<std::uint8_t, 8>, 3> low, high;  // [axis][octant]: units from the parent's corner
  std::array<std::array<std::int8_t, 8>, 3> normal;      // [axis][octant]; 0 where there is no plane
  std::array<std::int16_t, 8> reach;                     // n.x <= reach, x in units from the parent's corner

  /// Units of the bounds of the children of a node.
  static std::int32_t unit(int level) {
    return std::int32_t{1} << (static_cast<unsigned>(std::max(level - 7, 0)) & 31U);
  }
  /// The octants themselves, without planes.
  static const ChildBounds& plain(int level);
};

/// A node that is not white, of a tree prepared or not. Floats are exact.
struct ContactNode {
  std::uint64_t word = 0;                // of a gray node; the byte of one of level 1
  const ChildBounds* bounds = nullptr;   // of its children; null where it has none
  std::array<std::int32_t, 3> corner{};  // of its cube
  int level = 0;
  bool black = false;
  std::array<float, 3> place{}, half{};  // box of its black voxels: its centre from the corner, its half sides; voxels
  std::array<float, 3> normal{};         // n.(X - corner) <= reach for its black points X; 0 without a plane
  float reach = 0;

  std::int32_t side() const { return std::int32_t{1} << level; }
  /// The box, in voxels of the universe.
  IntegerBox box() const {
    IntegerBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = corner[axis] + static_cast<std::int32_t>(place[axis] - half[axis]);
      box.high[axis] = corner[axis] + static_cast<std::int32_t>(place[axis] + half[axis]);
    }
    return box;
  }
  /// Children that are not white. Requires: level >= 1.
  unsigned filled() const {
    if (black) return 0xFF;
    if (level >= 3) return static_cast<unsigned>((word | word >> 8) & 0xFF);
    if (level == 1) return static_cast<unsigned>(word);
    std::uint64_t bytes = word;  // of each byte the lowest bit: is any set?
    bytes |= bytes >> 4;
    bytes |= bytes >> 2;
    bytes |= bytes >> 1;
    return static_cast<unsigned>((bytes & 0x0101'0101'0101'0101) * 0x0102'0408'1020'4080 >> 56);
  }
  /// The bounds of all children, at worst the octants. Requires: level >= 1.
  const ChildBounds& child_bounds() const { return bounds != nullptr ? *bounds : ChildBounds::plain(level); }
};

/// The bounds of the eight children of a node as floats: ContactNode's, but all from the parent's corner.
struct ChildBoxes {
  alignas(32) std::array<std::array<float, 8>, 3> place, half, normal;  // [axis][octant]
  alignas(32) std::array<float, 8> reach;
};

}  // namespace blackleaf::detail

namespace blackleaf {

struct PreparedSolid::Storage {
  Octree octree;
  std::array<std::vector<detail::ChildBounds>, kMaxDepth + 1> bounds;  // by level, as the words
  detail::ContactNode root;                                            // unless the octree is empty
  // For questions of distance; made when the first is asked (box_tree.h).
  mutable std::once_flag boxes_made;
  mutable std::unique_ptr<const detail::BoxTree> boxes;

  explicit Storage(Octree solid) : octree(std::move(solid)) {}
};

}  // namespace blackleaf

namespace blackleaf::detail {

/// The box of the black voxels of a byte: its centre from the byte's corner and its half sides.
struct ByteBox {
  std::array<float, 3> place, half;
};
inline constexpr auto kByteBoxes = [] {
  std::array<ByteBox, 256> boxes{};
  for (unsigned byte = 1; byte < 256; ++byte)
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned upper = axis == 0 ? 0xAA : axis == 1 ? 0xCC : 0xF0;
      const float low = (byte & ~upper) != 0 ? 0 : 1, high = (byte & upper) != 0 ? 2 : 1;
      boxes[byte].place[axis] = 0.5F * (low + high);
      boxes[byte].half[axis] = 0.5F * (high - low);
    }
  return boxes;
}();

/// The nodes of one tree, prepared or not. Valid as long as what it was made from.
class ContactNodes {
 public:
  explicit ContactNodes(const Octree& octree);
  explicit ContactNodes(const PreparedSolid& solid);

  bool is_empty() const { return empty_; }
  /// Requires: not empty.
  const ContactNode& root() const { return root_; }
  /// A child of a node with these boxes. Requires: parent.level >= 1; the child is not white.
  ContactNode child(const ContactNode& parent, const ChildBoxes& boxes, std::size_t octant) const;
  /// The same boxes, without SIMD.
  static ChildBoxes boxes(const ContactNode& node);

 private:
  std::array<const std::uint64_t*, kMaxDepth + 1> words_{};
  std::array<const ChildBounds*, kMaxDepth + 1> bounds_{};  // null if not prepared
  ContactNode root_;
  bool empty_ = true;
};

inline ContactNode ContactNodes::child(const ContactNode& parent, const ChildBoxes& boxes, std::size_t octant) const {
  assert(parent.level >= 1 && (parent.filled() >> octant & 1) != 0);
  ContactNode child;
  child.level = parent.level - 1;
  const std::int32_t half = child.side();
  child.reach = boxes.reach[octant];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int32_t shift = (octant >> axis & 1) != 0 ? half : 0;
    const auto by = static_cast<float>(shift);
    child.corner[axis] = parent.corner[axis] + shift;
    child.place[axis] = boxes.place[axis][octant] - by;
    child.half[axis] = boxes.half[axis][octant];
    child.normal[axis] = boxes.normal[axis][octant];
    child.reach -= child.normal[axis] * by;  // whole numbers below 2^16 times a power of two
  }
  child.black = parent.black || parent.level == 1;
  if (child.black) return child;
  const auto bit = std::uint64_t{1} << octant;
  if (parent.level >= 3) {
    child.black = (parent.word & bit) != 0;
    if (child.black) return child;
    const auto below = static_cast<std::size_t>(child.level);
    const std::uint64_t index =
        (parent.word >> 16) + static_cast<unsigned>(std::popcount(parent.word >> 8 & (bit - 1) & 0xFF));
    child.word = words_[below][index];
    if (bounds_[below] != nullptr) child.bounds = &bounds_[below][index];
  } else {
    child.word = parent.word >> (8 * octant) & 0xFF;
    child.black = child.word == 0xFF;
    child.place = kByteBoxes[child.word].place;
    child.half = kByteBoxes[child.word].half;
  }
  return child;
}

}  // namespace blackleaf::detail
