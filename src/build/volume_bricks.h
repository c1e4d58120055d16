// VolumeBricks: what is left of a volume once it has been read, the colours of its bricks and the bits of the gray
// ones.
//
// A *strip* is one row of bricks along x: four by four rows of voxels. A *group* is sixteen consecutive bricks of a
// strip, 64 x 4 x 4 voxels, kept in eight bytes: two bits for each brick's colour and where the bits of its gray bricks
// stand among those of the strip. So a volume takes a 128th of its voxels' number in bytes, and eight bytes for each
// brick of two colours, which the octree must store as well.
//
// Groups are aligned to the universe. The sixteen by sixteen groups of a block of 64^3 voxels stand side by side: a
// volume is written strip by strip, as it lies in memory, and looked at block by block, as the octree is built.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "blackleaf/octree.h"
#include "octree/node_arrays.h"

namespace blackleaf::detail {

class VolumeBricks {
 public:
  /// Room for the voxels [low, high) of the universe. Requires: 0 <= low < high <= 2^20 on every axis.
  VolumeBricks(const std::array<std::int64_t, 3>& low, const std::array<std::int64_t, 3>& high);

  /// Strips are numbered along y first. Row r of strip s has y = strip_y(s) + (r & 3), z = strip_z(s) + (r >> 2).
  std::int64_t strips() const { return count_[1] * count_[2]; }
  std::int64_t strip_y(std::int64_t strip) const { return 4 * (first_[1] + strip % count_[1]); }
  std::int64_t strip_z(std::int64_t strip) const { return 4 * (first_[2] + strip / count_[1]); }
  /// A strip has the groups [first_group, first_group + groups) where group g begins at x = 64 g.
  std::int64_t first_group() const { return first_[0]; }
  std::int64_t groups() const { return count_[0]; }

  /// The bits of 16 rows of voxels, row[r][i] those of row r in the i-th of some consecutive groups.
  static constexpr std::int64_t kMostGroups = 32;
  using Rows = std::array<std::array<std::uint64_t, kMostGroups>, 16>;

  /// Sets groups [group, group + count) of a strip; the bits of its gray bricks are added to `gray`, in which those of
  /// the strip begin at index `begin`. Safe for different strips at once. Requires: count <= kMostGroups.
  void set(std::int64_t strip, std::int64_t group, std::int64_t count, const Rows& rows,
           std::vector<std::uint64_t>& gray, std::size_t begin);
  /// Says where the bits of a strip's gray bricks are. They are not copied and must outlive this.
  void set_gray(std::int64_t strip, const std::uint64_t* bits) { gray_[static_cast<std::size_t>(strip)] = bits; }

  /// True iff the cube holds no voxel of the volume's groups. Such a cube is white.
  bool misses(const Cube& cube) const;
  /// The colour of a cube; what lies outside the groups is white. Requires: 2 <= level <= 6.
  Colour colour(const Cube& cube) const;
  /// The bricks of a node of level 3, by octant.
  std::array<Subtree, 8> children(const Cube& cube) const;
  /// The bits of a gray brick. Requires: colour(cube) is gray, level 2.
  std::uint64_t brick(const Cube& cube) const;

 private:
  static constexpr std::size_t kBlockGroups = 256;  // 16 by 16

  // The group of brick row (y, z), counted from first_, at position x from first_.
  std::size_t index(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const std::int64_t by = (y + skew_[1]) >> 4, bz = (z + skew_[2]) >> 4;
    const std::int64_t block = x + count_[0] * (by + blocks_y_ * bz);
    return static_cast<std::size_t>(block << 8 | ((z + skew_[2]) & 15) << 4 | ((y + skew_[1]) & 15));
  }

  // The bits of a gray brick, the i-th of a group of the strip (y, z), counted from first_.
  std::uint64_t gray_bits(std::size_t group, std::int64_t y, std::int64_t z, int i) const {
    const std::uint32_t before = (colours_[group] >> 16) & ((std::uint32_t{1} << i) - 1);
    return gray_[static_cast<std::size_t>(y + count_[1] * z)]
                [first_gray_[group] + static_cast<unsigned>(std::popcount(before))];
  }

  std::array<std::int64_t, 3> first_, count_;  // groups along x, strips along y and z
  std::array<std::int64_t, 3> skew_{};         // strips from the beginning of the first block to first_
  std::int64_t blocks_y_ = 0;
  // Of every group, written before it is read and not cleared before. Most groups have no gray bricks, so most of the
  // memory for first_gray_ is never touched.
  std::unique_ptr<std::uint32_t[]> colours_;     // bit i: brick i is black; bit 16 + i: it is gray
  std::unique_ptr<std::uint32_t[]> first_gray_;  // index of the first gray brick's bits in the strip
  std::vector<const std::uint64_t*> gray_;       // by strip
};

/// Octrees from bricks, as produce.h wants to be told.
class BrickProducer {
 public:
  struct Task {};

  /// `bricks` must outlive this.
  explicit BrickProducer(const VolumeBricks& bricks) : bricks_(bricks) {}

  Task root() const { return {}; }
  Colour classify(Task&, const Cube& cube) const {
    if (cube.level > 6) return bricks_.misses(cube) ? Colour::white : Colour::gray;
    return bricks_.colour(cube);
  }
  Task child(const Task&, const Cube&, int) const { return {}; }
  std::array<Subtree, 8> bricks(const Task&, const Cube& cube) const { return bricks_.children(cube); }
  std::uint64_t brick(const Task&, const Cube& cube) const { return bricks_.brick(cube); }

 private:
  const VolumeBricks& bricks_;
};

}  // namespace blackleaf::detail
