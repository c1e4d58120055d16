// MotionGroups: a list of motions as a binary tree of groups of neighbours, and where a target node's voxel centres lie
// in the source by all motions of a group at once.
//
// By one motion, moved back, a point x of the target lies at q(x) = A x + b. By the motions of a group it lies near the
// straight line between its places by the first and the last: A and b are in between, but for a part that is quadratic
// in the turn of the group. So the box of a node's centres by all motions of a group is the hull of two boxes, widened
// by a slack that is computed once for each group. The slack holds only for points that the moved solid can reach by
// the motion; any other is white by it, wherever it lies.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blackleaf/measures.h"
#include "blackleaf/motion.h"
#include "blackleaf/octree.h"

namespace blackleaf::detail {

/// Source coordinates are in units of 2^-39 voxels, twice as fine as the motion's grid, because centres are halves.
inline constexpr int kSourceBits = FixedMotion::kFractionBits + 1;

/// A point of the source.
using SourcePoint = std::array<std::int64_t, 3>;

/// A closed box of the source.
struct SourceBox {
  SourcePoint low{}, high{};
};

/// Voxels of the target, [low, high] on every axis.
struct Voxels {
  std::array<std::int32_t, 3> low{}, high{};
};

/// One motion, seen from the target.
class MovedBackCentres {
 public:
  explicit MovedBackCentres(const FixedMotion& motion);

  const FixedMotion& motion() const { return motion_; }
  /// The centre of a voxel, moved back.
  SourcePoint centre(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return at(2 * x + 1, 2 * y + 1, 2 * z + 1);
  }
  /// The box around the centres of these voxels, moved back.
  SourceBox box(const Voxels& voxels) const;
  /// The same for all voxels of a cube.
  SourceBox box(const Cube& cube) const;
  /// From a voxel's centre to that of the next along an axis of the target.
  SourcePoint step(std::size_t axis) const;

 private:
  // Twice a point of the target, moved back. Below 2^63 by the bound of motion.h.
  SourcePoint at(std::int64_t x2, std::int64_t y2, std::int64_t z2) const;

  FixedMotion motion_;
  SourcePoint reach_{};  // sum of |A_ij| over j: half a cube's box per half side
};

class MotionGroups {
 public:
  struct Group {
    std::uint32_t first = 0, last = 0;  // of the motions, inclusive
    std::uint32_t second_half = 0;      // a group; the first half is the next group. 0 for a single motion
    SourcePoint slack{};
    std::array<double, 3> low{},
        high{};  // voxels of the target: the moved solid lies in here by all motions of the group
    bool single() const { return first == last; }
  };
  /// The group of all motions.
  static constexpr std::uint32_t kAll = 0;

  /// `box` holds the source; motions that bring it nowhere near the target's universe are left out.
  MotionGroups(const std::vector<FixedMotion>& motions, const Box& box, int target_depth);

  /// No motion is left.
  bool empty() const { return motions_.empty(); }
  const Group& operator[](std::uint32_t group) const { return groups_[group]; }
  const MovedBackCentres& motion(std::uint32_t index) const { return motions_[index]; }

  /// False only if no motion of the group brings the solid to the cube.
  bool reaches(const Group& group, const Cube& cube) const;
  /// A box that holds, by every motion of the group, the centres of these voxels, moved back, that fall into the
  /// source's box. Region: Voxels or Cube.
  template <class Region>
  SourceBox box(const Group& group, const Region& region) const {
    SourceBox box = motions_[group.first].box(region);
    if (group.single()) return box;
    const SourceBox other = motions_[group.last].box(region);
    for (std::size_t i = 0; i < 3; ++i) {
      box.low[i] = std::min(box.low[i], other.low[i]) - group.slack[i];
      box.high[i] = std::max(box.high[i], other.high[i]) + group.slack[i];
    }
    return box;
  }

 private:
  std::uint32_t build(std::uint32_t first, std::uint32_t last);
  SourcePoint deviation(std::uint32_t motion, const Group& group) const;

  std::vector<MovedBackCentres> motions_;
  std::vector<std::array<std::array<double, 3>, 2>> regions_;  // of the motions: low and high
  std::vector<Group> groups_;
};

}  // namespace blackleaf::detail
