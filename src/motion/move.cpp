// Arbitrary motion (WA87), from the target's side: a target node's voxel centres, moved back, lie in an upright box of
// the source; where the source is of one colour on that box so is the node, elsewhere the node is split, and in a brick
// each of the 64 centres is looked up. The answer is WA87's, which asks every moved leaf for the voxels it covers; the
// cost is that of the target's surface instead of leaves times depth.
#include <array>

#include "blackleaf/move.h"
#include "extent.h"
#include "octree/brick.h"
#include "window_producer.h"

namespace blackleaf {
namespace {

using detail::CellRange;
using detail::SourceWindow;

// Source coordinates are in units of 2^-39 voxels, twice as fine as the motion's grid, because centres are halves.
constexpr int kBits = FixedMotion::kFractionBits + 1;

class MovedBack {
 public:
  static constexpr int kWidth = 3;

  explicit MovedBack(const FixedMotion& motion) : motion_(motion) {
    for (std::size_t i = 0; i < 3; ++i)
      for (const std::int64_t entry : motion.inverse_rotation[i]) reach_[i] += entry < 0 ? -entry : entry;
  }

  // The cells of the cube's own level whose closed cubes may hold one of its voxel centres, moved back.
  CellRange cells(const Cube& cube) const {
    const auto centre = source_point(2 * std::int64_t{cube.x} + cube.side(), 2 * std::int64_t{cube.y} + cube.side(),
                                     2 * std::int64_t{cube.z} + cube.side());
    CellRange range;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t half = reach_[i] * (cube.side() - 1);
      range.low[i] = (centre[i] - half - 1) >> (kBits + cube.level);  // -1: on a cell's lower face both sides count
      range.high[i] = (centre[i] + half) >> (kBits + cube.level);
    }
    return range;
  }

  std::uint64_t brick(const SourceWindow<kWidth>& window, const Cube& cube) const {
    const auto bricks = window.bricks();
    const auto black = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      const auto u = static_cast<unsigned>(x), v = static_cast<unsigned>(y), w = static_cast<unsigned>(z);
      return (bricks[(u >> 2) + 3 * (v >> 2) + 9 * (w >> 2)] >> detail::brick_bit(u & 3, v & 3, w & 3) & 1) != 0;
    };
    // Of the first voxel's centre, relative to the window's lowest cell; the others follow by adding columns of A.
    auto first = source_point(2 * std::int64_t{cube.x} + 1, 2 * std::int64_t{cube.y} + 1, 2 * std::int64_t{cube.z} + 1);
    for (std::size_t i = 0; i < 3; ++i) first[i] -= window.low()[i] * (std::int64_t{4} << kBits);
    constexpr std::int64_t kFraction = (std::int64_t{1} << kBits) - 1;
    std::uint64_t bits = 0;
    for (unsigned bit = 0; bit < 64; ++bit) {
      const std::array<std::int64_t, 3> at = {2 * detail::brick_x(bit), 2 * detail::brick_y(bit),
                                              2 * detail::brick_z(bit)};
      std::array<std::int64_t, 3> q;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& a = motion_.inverse_rotation[i];
        q[i] = first[i] + a[0] * at[0] + a[1] * at[1] + a[2] * at[2];
      }
      const std::int64_t x = q[0] >> kBits, y = q[1] >> kBits, z = q[2] >> kBits;
      bool inside = black(x, y, z);
      // Exactly on a lattice plane: the closed cubes on both sides hold the point.
      const int on_x = (q[0] & kFraction) == 0, on_y = (q[1] & kFraction) == 0, on_z = (q[2] & kFraction) == 0;
      if (on_x | on_y | on_z)
        for (int i = 0; i <= on_x; ++i)
          for (int j = 0; j <= on_y; ++j)
            for (int k = 0; k <= on_z; ++k) inside = inside || black(x - i, y - j, z - k);
      bits |= std::uint64_t{inside} << bit;
    }
    return bits;
  }

 private:
  // Twice a target point (twice: centres become odd integers), moved back. The bound of motion.h keeps it in 63 bits.
  std::array<std::int64_t, 3> source_point(std::int64_t x2, std::int64_t y2, std::int64_t z2) const {
    std::array<std::int64_t, 3> q;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& a = motion_.inverse_rotation[i];
      q[i] = a[0] * x2 + a[1] * y2 + a[2] * z2 + 2 * motion_.inverse_translation[i];
    }
    return q;
  }

  FixedMotion motion_;
  std::array<std::int64_t, 3> reach_{};  // sum of |A_ij| over j: half the back-moved box per half side
};

}  // namespace

Octree move(const Octree& octree, const Motion& motion, Leaving leaving, const Work& work) {
  if (octree.is_empty()) return octree;
  if (leaving == Leaving::clip && motion.translation().norm() > FixedMotion::kMaxTranslation)
    return Octree(octree.depth(), Colour::white, octree.frame());
  const FixedMotion fixed(motion);
  const auto target = detail::target_universe(octree.depth(), detail::extent_of(octree, fixed), leaving);
  return detail::produce(detail::WindowProducer(MovedBack(fixed.shifted(target.offset)), octree, target.depth),
                         target.depth, detail::grown_frame(octree.frame(), target), work);
}

}  // namespace blackleaf
