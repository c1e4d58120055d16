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
#include <cstdlib>
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

/// One motion, seen from the target. All of it is asked for millions of times.
class MovedBackCentres {
 public:
  explicit MovedBackCentres(const FixedMotion& motion);

  const FixedMotion& motion() const { return motion_; }
  /// The centre of a voxel, moved back.
  SourcePoint centre(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return at(2 * x + 1, 2 * y + 1, 2 * z + 1);
  }
  /// The box around the centres of these voxels, moved back.
  SourceBox box(const Voxels& voxels) const {
    const auto &low = voxels.low, &high = voxels.high;
    const SourcePoint middle =
        at(std::int64_t{low[0]} + high[0] + 1, std::int64_t{low[1]} + high[1] + 1, std::int64_t{low[2]} + high[2] + 1);
    SourceBox box;
    for (std::size_t i = 0; i < 3; ++i) {
      std::int64_t half = 0;
      for (std::size_t j = 0; j < 3; ++j) half += std::abs(motion_.inverse_rotation[i][j]) * (high[j] - low[j]);
      box.low[i] = middle[i] - half;
      box.high[i] = middle[i] + half;
    }
    return box;
  }
  /// The same for all voxels of a cube.
  SourceBox box(const Cube& cube) const {
    const SourcePoint middle = at(2 * std::int64_t{cube.x} + cube.side(), 2 * std::int64_t{cube.y} + cube.side(),
                                  2 * std::int64_t{cube.z} + cube.side());
    SourceBox box;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t half = reach_[i] * (cube.side() - 1);
      box.low[i] = middle[i] - half;
      box.high[i] = middle[i] + half;
    }
    return box;
  }
  /// The same for the brick whose first voxel's centre, moved back, is this. Its middle is 3/2 voxels on on every axis.
  SourceBox brick_box(const SourcePoint& first) const {
    SourceBox box;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& a = motion_.inverse_rotation[i];
      const std::int64_t middle = first[i] + 3 * (a[0] + a[1] + a[2]);
      box.low[i] = middle - 3 * reach_[i];
      box.high[i] = middle + 3 * reach_[i];
    }
    return box;
  }
  /// From a voxel's centre to that of the next along an axis of the target.
  SourcePoint step(std::size_t axis) const {
    return {2 * motion_.inverse_rotation[0][axis], 2 * motion_.inverse_rotation[1][axis],
            2 * motion_.inverse_rotation[2][axis]};
  }

 private:
  // Twice a point of the target, moved back. Below 2^63 by the bound of motion.h.
  SourcePoint at(std::int64_t x2, std::int64_t y2, std::int64_t z2) const {
    SourcePoint q;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& a = motion_.inverse_rotation[i];
      q[i] = a[0] * x2 + a[1] * y2 + a[2] * z2 + 2 * motion_.inverse_translation[i];
    }
    return q;
  }

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
  /// The box of a region's centres, moved back by one motion of the group: the first, and the last.
  struct Ends {
    SourceBox first, last;
  };
  /// Region: Voxels or Cube.
  template <class Region>
  Ends ends(const Group& group, const Region& region) const {
    const SourceBox first = motions_[group.first].box(region);
    return {first, group.single() ? first : motions_[group.last].box(region)};
  }
  /// A box that holds, by every motion of the group, the region's centres, moved back, that fall into the source's box.
  static SourceBox hull(const Group& group, const Ends& ends) {
    SourceBox box;
    for (std::size_t i = 0; i < 3; ++i) {  // the slack of a single motion is 0
      box.low[i] = std::min(ends.first.low[i], ends.last.low[i]) - group.slack[i];
      box.high[i] = std::max(ends.first.high[i], ends.last.high[i]) + group.slack[i];
    }
    return box;
  }
  template <class Region>
  SourceBox box(const Group& group, const Region& region) const {
    return hull(group, ends(group, region));
  }

 private:
  std::uint32_t build(std::uint32_t first, std::uint32_t last);
  SourcePoint deviation(std::uint32_t motion, const Group& group) const;

  std::vector<MovedBackCentres> motions_;
  std::vector<std::array<std::array<double, 3>, 2>> regions_;  // of the motions: low and high
  std::vector<Group> groups_;
};

}  // namespace blackleaf::detail
