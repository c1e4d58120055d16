#include "blackleaf/measures.h"

#include <algorithm>
#include <bit>

#include "blackleaf/runs.h"
#include "brick.h"
#include "corner_walk.h"

namespace blackleaf {
namespace {

__extension__ using Wide = unsigned __int128;  // sums of 2^60 voxels times coordinates of 21 bits

constexpr std::uint64_t voxels_of(int level) { return std::uint64_t{1} << (3 * level); }

struct Counts {
  std::array<std::uint64_t, kMaxDepth + 1> black{}, white{}, gray{};

  void add(const Node& node) {
    const auto level = static_cast<std::size_t>(node.level());
    if (node.is_black()) {
      ++black[level];
    } else if (node.is_white()) {
      ++white[level];
    } else {
      ++gray[level];
      if (level == 1) {
        const auto ones = static_cast<unsigned>(std::popcount(node.word()));
        black[0] += ones;
        white[0] += 8 - ones;
      } else {
        for (int octant = 0; octant < 8; ++octant) add(node.child(octant));
      }
    }
  }
};

std::uint64_t volume_of(const Node& node) {
  if (!node.is_gray()) return node.is_black() ? voxels_of(node.level()) : 0;
  if (node.level() <= 2) return static_cast<unsigned>(std::popcount(node.word()));
  std::uint64_t sum = 0;
  for (int octant = 0; octant < 8; ++octant) sum += volume_of(node.child(octant));
  return sum;
}

// How far the black voxels of a node reach along an axis, up or down, if that is farther than `farthest`: branch and
// bound, the nearer half of a node first. `sign` is 1 for up and -1 for down; what is compared is sign * coordinate.
void reach(const Node& node, const Cube& cube, unsigned axis, std::int32_t sign, std::int32_t& farthest) {
  const std::int32_t low = axis == 0 ? cube.x : axis == 1 ? cube.y : cube.z;
  const std::int32_t end = sign > 0 ? low + cube.side() : -low;
  if (node.is_white() || end <= farthest) return;
  if (node.is_black()) {
    farthest = end;
    return;
  }
  const int nearer = sign > 0 ? 1 << axis : 0;
  for (const int half : {nearer, nearer ^ 1 << axis})
    for (int octant = 0; octant < 8; ++octant)
      if ((octant & 1 << axis) == half) reach(node.child(octant), cube.child(octant), axis, sign, farthest);
}

// Twice the sum of the black voxels' centres.
void add_moments(const Node& node, const Cube& cube, std::array<Wide, 3>& twice) {
  if (node.is_white()) return;
  if (node.is_black()) {
    const Wide voxels = voxels_of(cube.level);
    twice[0] += voxels * static_cast<Wide>(2 * static_cast<std::int64_t>(cube.x) + cube.side());
    twice[1] += voxels * static_cast<Wide>(2 * static_cast<std::int64_t>(cube.y) + cube.side());
    twice[2] += voxels * static_cast<Wide>(2 * static_cast<std::int64_t>(cube.z) + cube.side());
    return;
  }
  for (int octant = 0; octant < 8; ++octant) add_moments(node.child(octant), cube.child(octant), twice);
}

// Counts boundary faces: at each corner, the three faces that begin there toward +y+z, +z+x and +x+y, which lie between
// the main voxel and its lower neighbour along x, y and z.
struct FaceCounter {
  std::uint64_t faces = 0;

  void uniform(const Cube& cube, const detail::Around& around) {
    for (unsigned axis = 1; axis <= 4; axis *= 2)
      if (around[7].colour() != around[7 - axis].colour()) faces += std::uint64_t{1} << (2 * cube.level);
  }
  void bricks(const Cube&, const detail::Around& around) {
    const std::uint64_t main = around[7].brick();
    // Lower neighbours along x: voxels with x > 0 have theirs in the brick itself, those with x = 0 in the lower brick.
    faces += count(main, around[6].brick(), kUpper[0], 0);
    faces += count(main, around[5].brick(), kUpper[1], 1);
    faces += count(main, around[3].brick(), kUpper[2], 2);
  }

 private:
  // Voxels whose coordinate along an axis is 0, 1, 2: the masks for moving bits up by one along it.
  static constexpr std::array<std::uint64_t, 3> kUpper = [] {
    std::array<std::uint64_t, 3> even{};  // bits whose lowest coordinate bit along the axis is 0
    for (unsigned bit = 0; bit < 64; ++bit)
      for (unsigned axis = 0; axis < 3; ++axis) even[axis] |= std::uint64_t{!(bit >> axis & 1)} << bit;
    return even;
  }();

  static std::uint64_t count(std::uint64_t main, std::uint64_t lower, std::uint64_t even, unsigned axis) {
    const unsigned near = 1u << axis, far = 8u << axis;  // index distances of coordinates +1 and +2
    std::uint64_t half = 0;                              // bits whose second coordinate bit along the axis is 0
    for (unsigned bit = 0; bit < 64; ++bit) half |= std::uint64_t{!(bit >> (axis + 3) & 1)} << bit;
    // Coordinate c gets the bit of c - 1: 1 <- 0 and 3 <- 2 by near; 2 <- 1 by far - near; 0 <- 3 of the lower brick.
    const std::uint64_t shifted =
        (main & even) << near | (main & ~even & half) << (far - near) | (lower & ~even & ~half) >> (far + near);
    return static_cast<unsigned>(std::popcount(main ^ shifted));
  }
};

}  // namespace

std::uint64_t volume(const Octree& octree) { return volume_of(octree.root()); }

std::optional<Box> bounding_box(const Octree& octree) {
  if (octree.is_empty()) return std::nullopt;
  Box box;
  for (unsigned axis = 0; axis < 3; ++axis) {
    std::int32_t up = 0, down = -octree.side();
    reach(octree.root(), octree.universe(), axis, 1, up);
    reach(octree.root(), octree.universe(), axis, -1, down);
    box.max[axis] = up;
    box.min[axis] = -down;
  }
  return box;
}

std::optional<Eigen::Vector3d> centroid(const Octree& octree) {
  const std::uint64_t voxels = volume(octree);
  if (voxels == 0) return std::nullopt;
  std::array<Wide, 3> twice{};
  add_moments(octree.root(), octree.universe(), twice);
  Eigen::Vector3d result;
  for (int i = 0; i < 3; ++i) {
    const Wide sum = twice[static_cast<std::size_t>(i)], whole = sum / voxels;
    result[i] = (static_cast<double>(whole) + static_cast<double>(sum % voxels) / static_cast<double>(voxels)) / 2;
  }
  return result;
}

Measures measure(const Octree& octree) {
  Counts counts;
  counts.add(octree.root());
  Measures m;
  const auto levels = static_cast<std::size_t>(octree.depth()) + 1;
  m.black_leaves_by_level.assign(counts.black.begin(), counts.black.begin() + static_cast<std::ptrdiff_t>(levels));
  for (std::size_t level = 0; level < levels; ++level) {
    m.black_leaves += counts.black[level];
    m.white_leaves += counts.white[level];
    m.internal_nodes += counts.gray[level];
    m.volume += counts.black[level] << (3 * level);
  }
  FaceCounter faces;
  detail::corner_walk(octree, faces);
  m.surface_area = faces.faces;
  m.bounding_box = bounding_box(octree);
  m.centroid = centroid(octree);
  for_each_run(octree, [&](std::uint64_t, bool) { ++m.runs; });
  return m;
}

}  // namespace blackleaf
