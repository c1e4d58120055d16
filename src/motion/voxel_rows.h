// VoxelRows: 16^3 voxels of a source as rows along x, so that a voxel is one load and one shift away.
//
// The 8^3 centres of a target node of level 3, moved back, lie in a box less than 8 sqrt(3) = 13.9 voxels long, so with
// the closed cubes on both sides they touch at most 15 voxels on an axis: the rows hold all that such a node may see.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "octree/brick.h"
#include "source_window.h"

namespace blackleaf::detail {

/// A box of voxels, [low, high] on every axis.
struct VoxelRange {
  std::array<std::int64_t, 3> low{}, high{};
};

class VoxelRows {
 public:
  /// Rows of one z stand this far apart; voxel (x, y, z), relative to the origin, is bit x + kMargin of row
  /// (y + kMargin) + kRows (z + kMargin). Bricks at the range's lower end begin up to kMargin voxels before it.
  static constexpr std::uint32_t kMargin = 3, kRows = 20;
  static constexpr std::int64_t kMaxLength = 16;

  /// The voxels of `range` out of a window of level 3; others are unspecified. Requires: the range is at most
  /// kMaxLength voxels long; every cell it meets is in the window.
  template <int kWidth>
  VoxelRows(const SourceWindow<kWidth>& window, const VoxelRange& range) : origin_(range.low) {
    assert(range.high[0] - range.low[0] < kMaxLength && range.high[1] - range.low[1] < kMaxLength &&
           range.high[2] - range.low[2] < kMaxLength);
    for (std::int64_t z = range.low[2] >> 3; z <= range.high[2] >> 3; ++z)
      for (std::int64_t y = range.low[1] >> 3; y <= range.high[1] >> 3; ++y)
        for (std::int64_t x = range.low[0] >> 3; x <= range.high[0] >> 3; ++x) {
          const Node cell = window.node(x, y, z);
          if (cell.is_white()) continue;
          for (int octant = 0; octant < 8; ++octant) {
            const std::int64_t bx = 2 * x + (octant & 1), by = 2 * y + (octant >> 1 & 1), bz = 2 * z + (octant >> 2);
            if (bx < range.low[0] >> 2 || bx > range.high[0] >> 2 || by < range.low[1] >> 2 ||
                by > range.high[1] >> 2 || bz < range.low[2] >> 2 || bz > range.high[2] >> 2)
              continue;
            const Node node = cell.child(octant);
            if (!node.is_white()) put(node.brick(), 4 * bx - origin_[0], 4 * by - origin_[1], 4 * bz - origin_[2]);
          }
        }
  }

  /// The first voxel of the range.
  const std::array<std::int64_t, 3>& origin() const { return origin_; }

  /// The colour of a voxel, relative to the origin. Requires: it lies in the range.
  bool black(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return (rows_[row(y, z)] >> (x + kMargin) & 1) != 0;
  }
  /// All rows.
  const std::uint32_t* data() const { return rows_.data(); }

 private:
  using Four [[gnu::vector_size(16)]] = std::uint32_t;

  static std::size_t row(std::int64_t y, std::int64_t z) {
    return static_cast<std::size_t>((y + kMargin) + kRows * (z + kMargin));
  }

  // Sets the voxels of a brick whose first voxel is at (x, y, z), each -3 or more.
  void put(std::uint64_t brick, std::int64_t x, std::int64_t y, std::int64_t z) {
    const std::uint64_t ordered = in_rows(brick);
    const auto shift = static_cast<std::uint32_t>(x + kMargin);
    for (unsigned k = 0; k < 4; ++k) {
      // Four rows of four voxels, each brought to the top of 16 bits and from there to its place.
      const auto plane = static_cast<std::uint32_t>(ordered >> (16 * k) & 0xFFFF);
      const Four parts =
          ((Four{plane, plane, plane, plane} & Four{0xF, 0xF0, 0xF00, 0xF000}) * Four{0x1000, 0x100, 0x10, 1}) >>
          12 << shift;
      std::uint32_t* const rows = &rows_[row(y, z + k)];
      Four now;
      std::memcpy(&now, rows, sizeof now);
      now |= parts;
      std::memcpy(rows, &now, sizeof now);
    }
  }

  // The bits of a brick with x fastest, then y, then z: three exchanges of two bits of the index.
  static constexpr std::uint64_t in_rows(std::uint64_t brick) {
    const auto exchange = [&](unsigned shift, std::uint64_t mask) {
      const std::uint64_t t = (brick ^ brick >> shift) & mask;
      brick ^= t ^ t << shift;
    };
    exchange(6, 0x00CC'00CC'00CC'00CC);  // x0 y0 z0 x1 y1 z1 -> x0 x1 z0 y0 y1 z1
    exchange(4, 0x00F0'00F0'00F0'00F0);  // -> x0 x1 y0 z0 y1 z1
    exchange(8, 0x0000'FF00'0000'FF00);  // -> x0 x1 y0 y1 z0 z1
    return brick;
  }

  std::array<std::uint32_t, kRows * kRows> rows_{};
  std::array<std::int64_t, 3> origin_{};
};

}  // namespace blackleaf::detail
