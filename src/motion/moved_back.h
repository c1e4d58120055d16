// MovedBack: where the voxel centres of a target node come from, in integers.
#pragma once

#include <array>
#include <cstdint>

#include "blackleaf/motion.h"
#include "blackleaf/octree.h"
#include "cell_range.h"
#include "octree/brick.h"

namespace blackleaf::detail {

/// Source coordinates are in units of 2^-39 voxels, twice as fine as the motion's grid, because centres are halves. The
/// bound of motion.h keeps them in 63 bits.
class MovedBack {
 public:
  static constexpr int kBits = FixedMotion::kFractionBits + 1;
  using Point = std::array<std::int64_t, 3>;

  /// A closed box of the source around the centres of a target node; open at its lower side by one unit, because a
  /// centre on a voxel's lower face also touches the voxel before.
  struct Box {
    Point low{}, high{};

    /// The cells of a level whose closed cubes the centres may touch.
    CellRange cells(int level) const {
      CellRange range;
      for (std::size_t i = 0; i < 3; ++i) {
        range.low[i] = low[i] >> (kBits + level);
        range.high[i] = high[i] >> (kBits + level);
      }
      return range;
    }
  };

  explicit MovedBack(const FixedMotion& motion) : motion_(motion) {
    for (std::size_t i = 0; i < 3; ++i)
      for (const std::int64_t entry : motion.inverse_rotation[i]) {
        reach_[i] += entry < 0 ? -entry : entry;
        brick_reach_.low[i] += entry < 0 ? 6 * entry : 0;
        brick_reach_.high[i] += entry > 0 ? 6 * entry : 0;
      }
    for (auto& low : brick_reach_.low) low -= 1;
    for (unsigned bit = 0; bit < 64; ++bit)
      steps_[bit] = step(detail::brick_x(bit), detail::brick_y(bit), detail::brick_z(bit));
  }

  /// The box of a node's centres.
  Box box(const Cube& cube) const {
    const Point centre = moved(2 * std::int64_t{cube.x} + cube.side(), 2 * std::int64_t{cube.y} + cube.side(),
                               2 * std::int64_t{cube.z} + cube.side());
    Box box;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t half = reach_[i] * (cube.side() - 1);
      box.low[i] = centre[i] - half - 1;
      box.high[i] = centre[i] + half;
    }
    return box;
  }

  /// The centre of the voxel (x, y, z).
  Point centre(std::int64_t x, std::int64_t y, std::int64_t z) const { return moved(2 * x + 1, 2 * y + 1, 2 * z + 1); }
  /// The same box for a brick, from its first centre.
  Box brick_box(const Point& first) const { return {sum(first, brick_reach_.low), sum(first, brick_reach_.high)}; }
  /// From a voxel's centre to that of the voxel (x, y, z) farther on.
  Point step(std::int64_t x, std::int64_t y, std::int64_t z) const {
    Point q;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& a = motion_.inverse_rotation[i];
      q[i] = 2 * (a[0] * x + a[1] * y + a[2] * z);
    }
    return q;
  }
  /// From a brick's first centre to each of its 64, by bit.
  const std::array<Point, 64>& steps() const { return steps_; }

  static Point sum(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

  /// True iff every voxel centre comes from a lattice plane across this axis: no rounding, the axis only changes
  /// places.
  bool always_on_planes(std::size_t axis) const {
    constexpr std::int64_t kVoxel = std::int64_t{1} << kBits;
    int others = 0;
    for (const std::int64_t entry : motion_.inverse_rotation[axis]) others += 2 * entry % kVoxel != 0 ? 1 : 0;
    return others == 0 && moved(1, 1, 1)[axis] % kVoxel == 0;
  }

 private:
  // Twice a target point (twice: centres become odd integers), moved back.
  Point moved(std::int64_t x2, std::int64_t y2, std::int64_t z2) const {
    Point q;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& a = motion_.inverse_rotation[i];
      q[i] = a[0] * x2 + a[1] * y2 + a[2] * z2 + 2 * motion_.inverse_translation[i];
    }
    return q;
  }

  FixedMotion motion_;
  Point reach_{};  // sum of |A_ij| over j: half the box per half side
  Box brick_reach_;
  std::array<Point, 64> steps_{};
};

}  // namespace blackleaf::detail
