// BrickShift: bricks of 4^3 voxels read off a lattice of bricks at an offset of some voxels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "octree/brick.h"

namespace blackleaf::detail {

/// The brick that begins 0 to 3 voxels up an axis from one brick and runs into the next one, as four shifts.
class BrickShift {
 public:
  /// Requires: axis < 3, by < 4.
  constexpr BrickShift(unsigned axis, unsigned by) {
    // A plane of voxels across the axis comes from `low` by one of two shifts down or from `high` by one of two up.
    for (unsigned to = 0; to < 4; ++to) {
      const unsigned from = (to + by) % 4;
      const auto at = static_cast<unsigned>(kSpread[from]) << axis, target = static_cast<unsigned>(kSpread[to]) << axis;
      const bool up = to + by >= 4;
      const unsigned distance = up ? target - at : at - target;
      Part& part = parts_[(up ? 2u : 0u) + (distance == 7u << axis ? 1u : 0u)];
      part.shift = distance;
      for (unsigned bit = 0; bit < 64; ++bit)
        if ((axis == 0 ? brick_x(bit) : axis == 1 ? brick_y(bit) : brick_z(bit)) == to)
          part.mask |= std::uint64_t{1} << bit;
    }
  }

  constexpr std::uint64_t operator()(std::uint64_t low, std::uint64_t high) const {
    return (low >> parts_[0].shift & parts_[0].mask) | (low >> parts_[1].shift & parts_[1].mask) |
           (high << parts_[2].shift & parts_[2].mask) | (high << parts_[3].shift & parts_[3].mask);
  }

  struct Part {
    unsigned shift = 0;
    std::uint64_t mask = 0;
  };
  /// Two of the lower brick, shifted down, and two of the upper, shifted up.
  constexpr const std::array<Part, 4>& parts() const { return parts_; }

 private:
  std::array<Part, 4> parts_{};
};

/// The 2^3 bricks that begin at voxel (x, y, z), each 0 to 3, of the first of 3^3 bricks.
class BlockShift {
 public:
  /// Requires: each of `by` < 4.
  constexpr explicit BlockShift(const std::array<unsigned, 3>& by)
      : shifts_{BrickShift(0, by[0]), BrickShift(1, by[1]), BrickShift(2, by[2])} {}

  constexpr const BrickShift& axis(std::size_t i) const { return shifts_[i]; }

  /// `source` has 9 x + 3 y + z, the result 4 x + 2 y + z. One axis after the other, each over neighbours in memory.
  std::array<std::uint64_t, 8> operator()(const std::array<std::uint64_t, 27>& source) const {
    std::array<std::uint64_t, 18> x_done;  // 9 x + 3 y + z, two of x
    std::array<std::uint64_t, 12> y_done;  // 6 x + 3 y + z, two of x and y
    std::array<std::uint64_t, 12> z_done;  // the same, of which z = 2 is not meant
    {
      const BrickShift shift = shifts_[0];
      for (std::size_t i = 0; i < 18; ++i) x_done[i] = shift(source[i], source[i + 9]);
    }
    {
      const BrickShift shift = shifts_[1];
      for (std::size_t i = 0; i < 6; ++i) y_done[i] = shift(x_done[i], x_done[i + 3]);
      for (std::size_t i = 0; i < 6; ++i) y_done[i + 6] = shift(x_done[i + 9], x_done[i + 12]);
    }
    {
      const BrickShift shift = shifts_[2];
      for (std::size_t i = 0; i < 11; ++i) z_done[i] = shift(y_done[i], y_done[i + 1]);
    }
    return {z_done[0], z_done[1], z_done[3], z_done[4], z_done[6], z_done[7], z_done[9], z_done[10]};
  }

 private:
  std::array<BrickShift, 3> shifts_;
};

}  // namespace blackleaf::detail
