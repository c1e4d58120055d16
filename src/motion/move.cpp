// Arbitrary motion (WA87), from the target's side: a target node's voxel centres, moved back, lie in an upright box of
// the source; where the source is of one colour on that box so is the node, elsewhere the node is split, and in a node
// of level 3 each of the 512 centres is looked up. The answer is WA87's, which asks every moved leaf for the voxels it
// covers; the cost is that of the target's surface instead of leaves times depth.
#include <array>
#include <bit>

#include "blackleaf/move.h"
#include "centre_kernel.h"
#include "extent.h"
#include "octree/brick.h"
#include "voxel_rows.h"
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
    for (unsigned bit = 0; bit < 64; ++bit)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& a = motion.inverse_rotation[i];
        steps_[bit][i] = 2 * (a[0] * detail::brick_x(bit) + a[1] * detail::brick_y(bit) + a[2] * detail::brick_z(bit));
        cut_steps_[i][bit] = static_cast<std::uint32_t>(steps_[bit][i] >> kCut);
      }
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

  // The 4^3 voxels of a target too small for nodes of level 3: the readable twin of bricks().
  std::uint64_t brick(const SourceWindow<kWidth>& window, const Cube& cube) const {
    const auto bricks = window.bricks();
    const auto black = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      const auto u = static_cast<unsigned>(x), v = static_cast<unsigned>(y), w = static_cast<unsigned>(z);
      return (bricks[(u >> 2) + 3 * (v >> 2) + 9 * (w >> 2)] >> detail::brick_bit(u & 3, v & 3, w & 3) & 1) != 0;
    };
    const auto& low = window.low();
    const auto first = first_centre(cube, {4 * low[0], 4 * low[1], 4 * low[2]});
    std::uint64_t bits = 0;
    for (unsigned bit = 0; bit < 64; ++bit) bits |= std::uint64_t{in_solid(sum(first, steps_[bit]), black)} << bit;
    return bits;
  }

  // The eight bricks of a target node of level 3.
  std::array<detail::Subtree, 8> bricks(const SourceWindow<kWidth>& window, const Cube& cube) const {
    const detail::VoxelRows rows(window, voxels(cube));
    std::array<Point, 8> firsts;
    detail::FirstCentres cut;
    for (std::size_t octant = 0; octant < 8; ++octant) {
      firsts[octant] = first_centre(cube.child(static_cast<int>(octant)), rows.origin());
      for (std::size_t i = 0; i < 3; ++i) cut[octant][i] = static_cast<std::uint32_t>(firsts[octant][i] >> kCut);
    }
    std::array<std::uint64_t, 8> bits;
    unsigned unclear = detail::look_up(cut, cut_steps_, rows, bits);
    for (; unclear != 0; unclear &= unclear - 1) {
      const auto octant = static_cast<std::size_t>(std::countr_zero(unclear));
      const auto black = [&](std::int64_t x, std::int64_t y, std::int64_t z) { return rows.black(x, y, z); };
      bits[octant] = 0;
      for (unsigned bit = 0; bit < 64; ++bit)
        bits[octant] |= std::uint64_t{in_solid(sum(firsts[octant], steps_[bit]), black)} << bit;
    }
    std::array<detail::Subtree, 8> children;
    for (std::size_t octant = 0; octant < 8; ++octant) children[octant] = detail::Subtree::brick(bits[octant]);
    return children;
  }

 private:
  using Point = std::array<std::int64_t, 3>;  // of the source, in units of 2^-39 voxels

  static Point sum(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

  // The colour of the closed solid at a point. black(x, y, z) is that of a voxel.
  template <class Black>
  static bool in_solid(const Point& q, const Black& black) {
    const std::int64_t x = q[0] >> kBits, y = q[1] >> kBits, z = q[2] >> kBits;
    if (black(x, y, z)) return true;
    // Exactly on a lattice plane: the closed cubes on both sides hold the point.
    constexpr std::int64_t kFraction = (std::int64_t{1} << kBits) - 1;
    const int on_x = (q[0] & kFraction) == 0, on_y = (q[1] & kFraction) == 0, on_z = (q[2] & kFraction) == 0;
    for (int i = 0; i <= on_x; ++i)
      for (int j = 0; j <= on_y; ++j)
        for (int k = 0; k <= on_z; ++k)
          if (black(x - i, y - j, z - k)) return true;
    return false;
  }

  // The voxels that the closed solid around the centres of a node of level 3, moved back, may depend on.
  detail::VoxelRange voxels(const Cube& cube) const {
    const auto centre = source_point(2 * std::int64_t{cube.x} + cube.side(), 2 * std::int64_t{cube.y} + cube.side(),
                                     2 * std::int64_t{cube.z} + cube.side());
    detail::VoxelRange range;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t half = reach_[i] * (cube.side() - 1);
      range.low[i] = (centre[i] - half - 1) >> kBits;
      range.high[i] = (centre[i] + half) >> kBits;
    }
    return range;
  }

  // The centre of a node's first voxel, moved back, relative to a corner of source voxels.
  Point first_centre(const Cube& cube, const Point& corner) const {
    Point first =
        source_point(2 * std::int64_t{cube.x} + 1, 2 * std::int64_t{cube.y} + 1, 2 * std::int64_t{cube.z} + 1);
    for (std::size_t i = 0; i < 3; ++i) first[i] -= corner[i] * (std::int64_t{1} << kBits);
    return first;
  }

  // Twice a target point (twice: centres become odd integers), moved back. The bound of motion.h keeps it in 63 bits.
  Point source_point(std::int64_t x2, std::int64_t y2, std::int64_t z2) const {
    Point q;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& a = motion_.inverse_rotation[i];
      q[i] = a[0] * x2 + a[1] * y2 + a[2] * z2 + 2 * motion_.inverse_translation[i];
    }
    return q;
  }

  FixedMotion motion_;
  static constexpr int kCut = kBits - detail::kCentreBits;
  std::array<Point, 64> steps_{};        // from a brick's first centre to each of its centres
  detail::CentreSteps cut_steps_{};      // the same, cut
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
