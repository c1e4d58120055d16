// The sweep from the target's side: a target node keeps the groups of motions (motion_groups.h) that may bring the
// solid to it. A group is dropped where the box of the node's centres, moved back by all its motions, is white; the
// node is black as soon as the box by one motion is black; a group whose box is large beside the node's is halved. So a
// node looks at the whole path as coarsely as at space.
#include "blackleaf/sweep.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>

#include "blackleaf/measures.h"
#include "extent.h"
#include "motion_groups.h"
#include "neighbourhood.h"
#include "octree/brick.h"
#include "octree/produce.h"
#include "sweep_into.h"
#include "sweep_kernel.h"

namespace blackleaf {
namespace {

using detail::CellRange;
using detail::kSourceBits;
using detail::MotionGroups;
using detail::MovedBackCentres;
using detail::Neighbourhood;
using detail::SourceBox;
using detail::SourcePoint;
using detail::Voxels;

// A group's box beside a node has at most this many cells of the node's own level on an axis. One motion needs 3; with
// 4 a group's motions differ by about the side of the node, and the box meets 3 cells of twice the side at most, a
// Neighbourhood.
constexpr std::int64_t kWidth = 4;

// The voxels of a brick by their coordinate along an axis: kPlanes[axis][c].
constexpr auto kPlanes = [] {
  std::array<std::array<std::uint64_t, 4>, 3> planes{};
  for (unsigned bit = 0; bit < 64; ++bit) {
    planes[0][detail::brick_x(bit)] |= std::uint64_t{1} << bit;
    planes[1][detail::brick_y(bit)] |= std::uint64_t{1} << bit;
    planes[2][detail::brick_z(bit)] |= std::uint64_t{1} << bit;
  }
  return planes;
}();

// The cells of a level whose closed cubes meet a box.
CellRange cells_of(const SourceBox& box, int level) {
  CellRange range;
  for (std::size_t i = 0; i < 3; ++i) {
    range.low[i] = (box.low[i] - 1) >> (kSourceBits + level);  // -1: on a lower face both sides count
    range.high[i] = box.high[i] >> (kSourceBits + level);
  }
  return range;
}

// The voxels of a few bricks, at most kWidth on an axis, with 8 white ones around them on every side.
class SweptVoxels {
 public:
  /// Requires: a neighbourhood of level 3 that covers the bricks.
  SweptVoxels(const Neighbourhood& source, const CellRange& bricks) {
    for (std::size_t i = 0; i < 3; ++i) corner_[i] = 4 * bricks.low[i] - kMargin;
    std::array<std::uint64_t, 8> of_cell;
    for (std::int64_t z = bricks.low[2] >> 1; z <= bricks.high[2] >> 1; ++z)
      for (std::int64_t y = bricks.low[1] >> 1; y <= bricks.high[1] >> 1; ++y)
        for (std::int64_t x = bricks.low[0] >> 1; x <= bricks.high[0] >> 1; ++x) {
          const std::size_t cell = source.index(x, y, z);
          if ((source.black(cell) | source.gray(cell)) == 0) continue;
          source.bricks(cell, of_cell.data());
          for (unsigned octant = 0; octant < 8; ++octant) {
            const std::int64_t u = 2 * x + (octant & 1), v = 2 * y + (octant >> 1 & 1), w = 2 * z + (octant >> 2);
            if (of_cell[octant] == 0 || u < bricks.low[0] || u > bricks.high[0] || v < bricks.low[1] ||
                v > bricks.high[1] || w < bricks.low[2] || w > bricks.high[2])
              continue;
            put(of_cell[octant], static_cast<std::size_t>(4 * u - corner_[0]),
                static_cast<std::size_t>(4 * v - corner_[1]), static_cast<std::size_t>(4 * w - corner_[2]));
          }
        }
  }

  // True unless all voxels whose closed cubes meet the box are white.
  bool any(const SourceBox& box) const {
    const CellRange cells = cells_of(box, 0);
    std::array<std::size_t, 3> low{}, high{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (cells.high[i] < corner_[i] || cells.low[i] >= corner_[i] + kSide) return false;
      low[i] = static_cast<std::size_t>(std::max<std::int64_t>(cells.low[i] - corner_[i], 0));
      high[i] = static_cast<std::size_t>(std::min<std::int64_t>(cells.high[i] - corner_[i], kSide - 1));
    }
    const std::uint32_t wanted = ~std::uint32_t{0} << low[0] & ~std::uint32_t{0} >> (kSide - 1 - high[0]);
    std::uint32_t found = 0;
    for (std::size_t z = low[2]; z <= high[2]; ++z)
      for (std::size_t y = low[1]; y <= high[1]; ++y) found |= rows_[y + 32 * z];
    return (found & wanted) != 0;
  }

  // The voxels of a level-2 node that one motion makes black.
  std::uint64_t covered(const MovedBackCentres& motion, const Cube& cube) const {
    // The box of a brick's centres is less than 3 sqrt(3) + 1 = 6.2 voxels long: one that meets the window lies within
    // its margins, and another sees white only.
    const SourcePoint first = motion.centre(cube.x, cube.y, cube.z);
    const SourceBox box = motion.brick_box(first);
    for (std::size_t i = 0; i < 3; ++i)
      if (box.high[i] < (corner_[i] + kMargin) << kSourceBits || box.low[i] > (corner_[i] + kSide - kMargin)
                                                                                  << kSourceBits)
        return 0;
    constexpr int kCut = kSourceBits - detail::kSweepFraction;
    detail::CutCentres centres;
    for (std::size_t i = 0; i < 3; ++i)
      centres.first[i] = static_cast<std::uint32_t>((first[i] - (corner_[i] << kSourceBits)) >> kCut);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const SourcePoint step = motion.step(axis);
      for (std::size_t i = 0; i < 3; ++i) centres.step[axis][i] = static_cast<std::uint32_t>(step[i] >> kCut);
    }
    if (const auto bits = detail::covered_voxels(centres, rows_)) return *bits;
    std::uint64_t bits = 0;
    for (unsigned bit = 0; bit < 64; ++bit) {
      const std::int64_t x = detail::brick_x(bit), y = detail::brick_y(bit), z = detail::brick_z(bit);
      bits |= std::uint64_t{in_solid(motion.centre(cube.x + x, cube.y + y, cube.z + z))} << bit;
    }
    return bits;
  }

 private:
  using Four [[gnu::vector_size(16)]] = std::uint32_t;

  static constexpr std::int64_t kMargin = 8, kSide = 32;

  // Sets the voxels of a brick whose first voxel is (x, y, z).
  void put(std::uint64_t brick, std::size_t x, std::size_t y, std::size_t z) {
    const std::uint64_t rows = detail::rows_from_brick(brick);
    for (std::size_t k = 0; k < 4; ++k) {
      // Four rows of four voxels, each brought to the top of 16 bits and from there to its place.
      const auto plane = static_cast<std::uint32_t>(rows >> (16 * k) & 0xFFFF);
      const Four parts =
          ((Four{plane, plane, plane, plane} & Four{0xF, 0xF0, 0xF00, 0xF000}) * Four{0x1000, 0x100, 0x10, 1}) >>
          12 << static_cast<std::uint32_t>(x);
      std::uint32_t* const place = &rows_[y + 32 * (z + k)];
      Four now;
      std::memcpy(&now, place, sizeof now);
      now |= parts;
      std::memcpy(place, &now, sizeof now);
    }
  }

  bool black(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return (rows_[static_cast<std::size_t>(y + 32 * z)] >> x & 1) != 0;
  }

  // The colour of the closed solid at a point.
  bool in_solid(const SourcePoint& q) const {
    constexpr std::int64_t kFraction = (std::int64_t{1} << kSourceBits) - 1;
    std::array<std::int64_t, 3> voxel{}, below{};
    for (std::size_t i = 0; i < 3; ++i) {
      voxel[i] = (q[i] >> kSourceBits) - corner_[i];
      below[i] = (q[i] & kFraction) == 0;  // exactly on a lattice plane: the closed cubes on both sides hold the point
    }
    for (std::int64_t z = voxel[2] - below[2]; z <= voxel[2]; ++z)
      for (std::int64_t y = voxel[1] - below[1]; y <= voxel[1]; ++y)
        for (std::int64_t x = voxel[0] - below[0]; x <= voxel[0]; ++x)
          if (black(x, y, z)) return true;
    return false;
  }

  detail::SweepRows rows_{};
  std::array<std::int64_t, 3> corner_{};
};

class SweepProducer {
 public:
  struct Candidate {
    std::uint32_t group;
    CellRange cells;       // of the source, of the node's level, that the group's motions may bring here
    Neighbourhood source;  // around them, of the next higher level; none for nodes as large as the source or larger
  };
  struct Task {
    bool black = false;
    std::vector<Candidate> candidates;
  };

  SweepProducer(const MotionGroups& groups, const Octree& source, const Box& box, int depth)
      : groups_(groups), source_(source), box_(box), depth_(depth) {}

  Task root() const {
    const Cube cube{0, 0, 0, depth_ < 2 ? 2 : depth_};
    Task task;
    if (!groups_.empty()) enter(task, MotionGroups::kAll, cube, nullptr);
    return task;
  }

  Colour classify(Task& task, const Cube&) const {
    return task.black ? Colour::black : task.candidates.empty() ? Colour::white : Colour::gray;
  }

  Task child(const Task& task, const Cube& cube, int) const {
    Task below;
    below.candidates.reserve(task.candidates.size());
    for (const Candidate& candidate : task.candidates) {
      enter(below, candidate.group, cube, cube.level + 1 < source_.level() ? &candidate : nullptr);
      if (below.black) break;
    }
    return below;
  }

  // The 64 voxels of a node, motion by motion until all are black. Groups that see much black come first, and of each
  // the motion in its middle: inside the swept space one motion is then mostly enough.
  std::uint64_t brick(Task& task, const Cube& cube) const {
    std::ranges::sort(task.candidates, std::ranges::greater(),
                      [](const Candidate& candidate) { return candidate.source.black_children(); });
    std::uint64_t bits = 0;
    for (const Candidate& candidate : task.candidates) {
      const MotionGroups::Group& group = groups_[candidate.group];
      const SweptVoxels voxels(candidate.source, candidate.cells);
      if (!group.single()) bits |= voxels.covered(groups_.motion(groups_[candidate.group + 1].last), cube);
      if (~bits != 0) add(bits, candidate.group, cube, voxels);
      if (~bits == 0) break;
    }
    return bits;
  }

 private:
  // The box of the brick's voxels that are still white.
  static Voxels white_box(std::uint64_t bits, const Cube& cube) {
    Voxels box{{cube.x, cube.y, cube.z}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      std::size_t low = 0, high = 3;
      while (low < 3 && (~bits & kPlanes[i][low]) == 0) ++low;
      while (high > low && (~bits & kPlanes[i][high]) == 0) --high;
      box.high[i] = box.low[i] + static_cast<std::int32_t>(high);
      box.low[i] += static_cast<std::int32_t>(low);
    }
    return box;
  }

  // Adds to a brick what the motions of a group make black; halves of the group that see no black voxel are passed
  // over.
  void add(std::uint64_t& bits, std::uint32_t index, const Cube& cube, const SweptVoxels& voxels) const {
    const MotionGroups::Group& group = groups_[index];
    if (!voxels.any(groups_.box(group, white_box(bits, cube)))) return;
    constexpr std::uint32_t kFew = 3;  // not worth a look at the halves
    if (group.last - group.first >= kFew) {
      add(bits, index + 1, cube, voxels);
      if (~bits != 0) add(bits, group.second_half, cube, voxels);
      return;
    }
    for (std::uint32_t motion = group.first; motion <= group.last && ~bits != 0; ++motion)
      bits |= voxels.covered(groups_.motion(motion), cube);
  }

  // Adds what is left of a group beside a node. `above` is the candidate of the node's parent for the same group or one
  // that it is a half of; null if the parent is as large as the source or larger.
  void enter(Task& task, std::uint32_t index, const Cube& cube, const Candidate* above) const {
    const MotionGroups::Group& group = groups_[index];
    if (!groups_.reaches(group, cube)) return;
    if (cube.level >= source_.level()) {
      task.candidates.emplace_back().group = index;
      return;
    }
    // Cells without any of the source are white by all motions. The parent's candidate, cut likewise, has the rest:
    // what a half's box has beyond the whole's is out of the solid's reach.
    const MotionGroups::Ends ends = groups_.ends(group, cube);
    CellRange cells = cells_of(MotionGroups::hull(group, ends), cube.level), around;
    bool wide = false;
    for (std::size_t i = 0; i < 3; ++i) {
      cells.low[i] = std::max<std::int64_t>(cells.low[i], box_.min[i] >> cube.level);
      cells.high[i] = std::min<std::int64_t>(cells.high[i], (box_.max[i] - 1) >> cube.level);
      if (above) {
        cells.low[i] = std::max(cells.low[i], 2 * above->cells.low[i]);
        cells.high[i] = std::min(cells.high[i], 2 * above->cells.high[i] + 1);
      }
      if (cells.low[i] > cells.high[i]) return;
      wide = wide || cells.high[i] - cells.low[i] >= kWidth;
      around.low[i] = cells.low[i] >> 1;
      around.high[i] = cells.high[i] >> 1;
    }
    if (wide) {
      enter(task, index + 1, cube, above);
      if (!task.black) enter(task, group.second_half, cube, above);
      return;
    }
    if (above && above->source.colour(around) == Colour::white) return;
    Candidate& candidate = task.candidates.emplace_back();
    candidate.group = index;
    candidate.cells = cells;
    if (above)
      candidate.source.narrow(source_, above->source, around);
    else
      candidate.source.enter(source_, around);
    if (candidate.source.colour(cells) == Colour::white)
      task.candidates.pop_back();
    else
      task.black = blackens(ends.first, cube, candidate) || (!group.single() && blackens(ends.last, cube, candidate));
  }

  // True if a motion by which the node's centres come from a box makes the whole node black by itself.
  static bool blackens(const SourceBox& box, const Cube& cube, const Candidate& candidate) {
    const CellRange cells = cells_of(box, cube.level);
    for (std::size_t i = 0; i < 3; ++i)
      if (cells.low[i] < candidate.cells.low[i] || cells.high[i] > candidate.cells.high[i]) return false;
    return candidate.source.colour(cells) == Colour::black;
  }

  const MotionGroups& groups_;
  detail::SourceTree source_;
  Box box_;    // of the source
  int depth_;  // of the target
};

constexpr double kNear = 1e-3;  // voxels: far beyond the rounding of a box found with real numbers

bool surely_inside(const Motion& motion, const Box& box, double side) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    double low = motion.translation()[i], high = low;
    for (Eigen::Index j = 0; j < 3; ++j) {
      const double r = motion.rotation()(i, j);
      const auto [min, max] = std::pair(box.min[static_cast<std::size_t>(j)], box.max[static_cast<std::size_t>(j)]);
      low += r * (r > 0 ? min : max);
      high += r * (r > 0 ? max : min);
    }
    if (!(low > kNear && high < side - kNear)) return false;
  }
  return true;
}

// How far the solid reaches by those of the motions that may take it out of its universe; none if none can.
std::optional<detail::Extent> farthest(const Octree& octree, const Box& box, std::span<const Motion> motions) {
  std::optional<detail::Extent> all;
  for (const Motion& motion : motions) {
    if (surely_inside(motion, box, octree.side())) continue;
    const detail::Extent extent = detail::extent_of(octree, FixedMotion(motion));
    if (!all) all = extent;
    for (std::size_t i = 0; i < 3; ++i) {
      all->min[i] = std::min(all->min[i], extent.min[i]);
      all->max[i] = std::max(all->max[i], extent.max[i]);
    }
  }
  return all;
}

}  // namespace

detail::TargetUniverse detail::universe_for(const Octree& octree, const Box& box, std::span<const Motion> motions,
                                            Leaving leaving) {
  if (leaving != Leaving::clip)
    if (const auto extent = farthest(octree, box, motions))
      return detail::target_universe(octree.depth(), *extent, leaving, {"the solid on its way", "change the path"});
  return {octree.depth(), {}};
}

Octree detail::sweep_into(const TargetUniverse& target, const Octree& octree, const Box& box,
                          std::span<const Motion> motions, const Work& work) {
  std::vector<FixedMotion> fixed;
  fixed.reserve(motions.size());
  for (const Motion& motion : motions)
    if (motion.translation().norm() <= FixedMotion::kMaxTranslation)  // else clipped away
      fixed.push_back(FixedMotion(motion).shifted(target.offset));
  const MotionGroups groups(fixed, box, target.depth);
  return produce(SweepProducer(groups, octree, box, target.depth), target.depth, grown_frame(octree.frame(), target),
                 work);
}

void detail::move_with(const TargetUniverse& target, std::vector<Motion>& motions) {
  const Eigen::Vector3d offset(static_cast<double>(target.offset[0]), static_cast<double>(target.offset[1]),
                               static_cast<double>(target.offset[2]));
  for (Motion& motion : motions) motion = motion.about(offset);
}

Octree sweep(const Octree& octree, std::span<const Motion> motions, Leaving leaving, const Work& work) {
  const std::optional<Box> box = bounding_box(octree);
  if (!box) return octree;
  return detail::sweep_into(detail::universe_for(octree, *box, motions, leaving), octree, *box, motions, work);
}

Octree sweep(const Octree& octree, const Path& path, double step, Leaving leaving, const Work& work) {
  return sweep(octree, motions_along(octree, path, step), leaving, work);
}

std::vector<Motion> motions_along(const Octree& octree, const Path& path, double step) {
  const std::optional<Box> box = bounding_box(octree);
  std::vector<Motion> motions;
  for (const double time : box ? path.times(*box, step) : std::vector<double>{path.begin()})
    motions.push_back(path.motion_at(time));
  return motions;
}

RoomForMotions room_for(const Octree& octree, std::span<const Motion> motions, Leaving leaving, const Work& work) {
  RoomForMotions room{octree, {motions.begin(), motions.end()}};
  const std::optional<Box> box = bounding_box(octree);
  if (!box) return room;
  const detail::TargetUniverse target = detail::universe_for(octree, *box, motions, leaving);
  if (target.depth == octree.depth()) return room;
  const std::array<Motion, 1> rest;
  room.octree = detail::sweep_into(target, octree, *box, rest, work);
  detail::move_with(target, room.motions);
  return room;
}

}  // namespace blackleaf
