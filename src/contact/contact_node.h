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

#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blackleaf/octree.h"
#include "blackleaf/prepared_solid.h"

namespace blackleaf::detail {

struct ChildBounds {
  std::array<std::array<std::uint8_t, 8>, 3> low, high;  // [axis][octant]: units from the parent's corner
  std::array<std::array<std::int8_t, 8>, 3> normal;      // [axis][octant]; 0 where there is no plane
  std::array<std::int16_t, 8> reach;                     // n.x <= reach, x in units from the parent's corner

  /// Units of the bounds of the children of a node.
  static std::int32_t unit(int level) { return level <= 7 ? 1 : std::int32_t{1} << (level - 7); }
  /// The octants themselves, without planes.
  static const ChildBounds& plain(int level);
};

/// A node that is not white, of a tree prepared or not.
struct ContactNode {
  std::uint64_t word = 0;                     // of a gray node; the byte of one of level 1
  const ChildBounds* bounds = nullptr;        // of its children; null where it has none
  std::array<std::int32_t, 3> corner{};       // of its cube
  std::array<std::int32_t, 3> low{}, high{};  // box of its black voxels, in voxels
  std::array<float, 3> normal{};              // n.(X - corner) <= reach for its black points X; 0 without a plane
  float reach = 0;
  int level = 0;
  bool black = false;

  std::int32_t side() const { return std::int32_t{1} << level; }
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
  /// Children that are black. Requires: level >= 1.
  unsigned black_children() const {
    if (black) return 0xFF;
    if (level != 2) return static_cast<unsigned>(word & 0xFF);
    std::uint64_t bytes = word;  // are all set?
    bytes &= bytes >> 4;
    bytes &= bytes >> 2;
    bytes &= bytes >> 1;
    return static_cast<unsigned>((bytes & 0x0101'0101'0101'0101) * 0x0102'0408'1020'4080 >> 56);
  }
  /// The bounds of all children, at worst the octants. Requires: level >= 1.
  const ChildBounds& child_bounds() const { return bounds != nullptr ? *bounds : ChildBounds::plain(level); }
};

}  // namespace blackleaf::detail

namespace blackleaf {

struct PreparedSolid::Storage {
  Octree octree;
  std::array<std::vector<detail::ChildBounds>, kMaxDepth + 1> bounds;  // by level, as the words
  detail::ContactNode root;                                            // unless the octree is empty
};

}  // namespace blackleaf

namespace blackleaf::detail {

/// The nodes of one tree, prepared or not. Valid as long as what it was made from.
class ContactNodes {
 public:
  explicit ContactNodes(const Octree& octree);
  explicit ContactNodes(const PreparedSolid& tree);

  bool is_empty() const { return empty_; }
  /// Requires: not empty.
  const ContactNode& root() const { return root_; }
  /// Requires: parent.level >= 1; the child is not white.
  ContactNode child(const ContactNode& parent, int octant) const;

 private:
  std::array<const std::uint64_t*, kMaxDepth + 1> words_{};
  std::array<const ChildBounds*, kMaxDepth + 1> bounds_{};  // null if not prepared
  ContactNode root_;
  bool empty_ = true;
};

/// The box of the black voxels of a byte, from its corner: the lower end on each axis 0 or 1, the upper 1 or 2.
struct ByteBox {
  std::array<std::uint8_t, 3> low, high;
};
inline constexpr auto kByteBoxes = [] {
  std::array<ByteBox, 256> boxes{};
  for (unsigned byte = 1; byte < 256; ++byte)
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned upper = axis == 0 ? 0xAA : axis == 1 ? 0xCC : 0xF0;
      boxes[byte].low[axis] = (byte & ~upper) != 0 ? 0 : 1;
      boxes[byte].high[axis] = (byte & upper) != 0 ? 2 : 1;
    }
  return boxes;
}();

inline ContactNode ContactNodes::child(const ContactNode& parent, int octant) const {
  assert(parent.level >= 1 && (parent.filled() >> octant & 1) != 0);
  ContactNode child;
  child.level = parent.level - 1;
  const std::int32_t half = child.side();
  for (std::size_t axis = 0; axis < 3; ++axis)
    child.corner[axis] = parent.corner[axis] + ((octant >> axis & 1) != 0 ? half : 0);
  child.low = child.corner;
  for (std::size_t axis = 0; axis < 3; ++axis) child.high[axis] = child.corner[axis] + half;
  const auto bit = std::uint64_t{1} << octant;
  if (parent.black) {
    child.black = true;
    return child;
  }
  if (parent.level >= 3) {
    child.black = (parent.word & bit) != 0;
    if (child.black) return child;
    const auto below = static_cast<std::size_t>(child.level);
    const std::uint64_t index =
        (parent.word >> 16) + static_cast<unsigned>(std::popcount(parent.word >> 8 & (bit - 1) & 0xFF));
    child.word = words_[below][index];
    if (bounds_[below] != nullptr) child.bounds = &bounds_[below][index];
    if (parent.bounds == nullptr) return child;
    const ChildBounds& bounds = *parent.bounds;
    const std::int32_t unit = ChildBounds::unit(parent.level);
    const auto at = static_cast<std::size_t>(octant);
    float shift = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      child.low[axis] = parent.corner[axis] + bounds.low[axis][at] * unit;
      child.high[axis] = parent.corner[axis] + bounds.high[axis][at] * unit;
      child.normal[axis] = bounds.normal[axis][at];
      if ((octant >> axis & 1) != 0) shift += child.normal[axis];
    }
    // Whole numbers below 2^16 times a power of two: exact.
    child.reach = static_cast<float>(bounds.reach[at]) * static_cast<float>(unit) - shift * static_cast<float>(half);
    return child;
  }
  // Without bounds of its own the parent's plane is as good as any.
  child.normal = parent.normal;
  child.reach = parent.reach;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if ((octant >> axis & 1) != 0) child.reach -= child.normal[axis] * static_cast<float>(half);
  if (parent.level == 2) {
    child.word = parent.word >> (8 * octant) & 0xFF;
    child.black = child.word == 0xFF;
    const ByteBox& box = kByteBoxes[child.word];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      child.high[axis] = child.corner[axis] + box.high[axis];
      child.low[axis] = child.corner[axis] + box.low[axis];
    }
  } else {
    child.black = true;
  }
  return child;
}

}  // namespace blackleaf::detail
