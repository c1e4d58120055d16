#include "extent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "blackleaf/error.h"

namespace blackleaf::detail {
namespace {

constexpr int kBits = FixedMotion::kFractionBits;
// A rotation rounded to 2^-38 moves a point of a universe of depth 20 by less than sqrt(3) 2^-39 2^20 < 2^-18 voxels.
// Voxel centres are 1/2 inside the universe, so nothing is lost by forgiving a little more than that.
constexpr std::int64_t kSlack = std::int64_t{1} << (kBits - 16);

using Direction = std::array<std::int64_t, 3>;

// The largest w . X over the corners of a cube: |w . X| < sqrt(3) 2^(38 + 20).
std::int64_t reach(const Direction& w, const Cube& cube) {
  const std::array<std::int64_t, 3> low = {cube.x, cube.y, cube.z};
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += w[i] * (w[i] > 0 ? low[i] + cube.side() : low[i]);
  return sum;
}

void maximise(const Node& node, const Cube& cube, const Direction& w, unsigned nearest_octant, std::int64_t& best) {
  if (node.is_white()) return;
  const std::int64_t bound = reach(w, cube);
  if (bound <= best) return;
  if (node.is_black()) {
    best = bound;
    return;
  }
  for (unsigned i = 0; i < 8; ++i) {
    const int octant = static_cast<int>(i ^ nearest_octant);
    maximise(node.child(octant), cube.child(octant), w, nearest_octant, best);
  }
}

std::int64_t maximum(const Octree& octree, const Direction& w) {
  unsigned nearest = 0;
  for (unsigned i = 0; i < 3; ++i) nearest |= (w[i] > 0 ? 1u : 0u) << i;
  std::int64_t best = std::numeric_limits<std::int64_t>::min();
  maximise(octree.root(), octree.universe(), w, nearest, best);
  return best;
}

std::string voxels(std::int64_t fixed) {
  const double value = std::ldexp(static_cast<double>(fixed), -kBits);
  std::string text = std::to_string(value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  if (text == "0") text = "less than 0.000001";
  return text + (text == "1" ? " voxel" : " voxels");
}

}  // namespace

Extent extent_of(const Octree& octree, const FixedMotion& motion) {
  Extent extent;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& a = motion.inverse_rotation;  // row i of R is column i of R^T
    const Direction w = {a[0][i], a[1][i], a[2][i]};
    extent.max[i] = maximum(octree, w) + motion.forward_translation[i];
    extent.min[i] = -maximum(octree, {-w[0], -w[1], -w[2]}) + motion.forward_translation[i];
  }
  return extent;
}

TargetUniverse target_universe(int depth, const Extent& extent, Leaving leaving, const LeavingWords& words) {
  TargetUniverse target{depth, {}};
  if (leaving == Leaving::clip) return target;
  const auto side = [&] { return std::int64_t{1} << (target.depth + kBits); };
  const auto below = [&](std::size_t i) { return -(extent.min[i] + (target.offset[i] << kBits)); };
  const auto above = [&](std::size_t i) { return extent.max[i] + (target.offset[i] << kBits) - side(); };
  std::string sides;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis(1, static_cast<char>('x' + i));
    const auto tell = [&](std::int64_t by, const std::string& where) {
      if (by > kSlack) sides += (sides.empty() ? "" : ", ") + voxels(by) + " " + where;
    };
    tell(below(i), "below " + axis + " = 0");
    tell(above(i), "beyond " + axis + " = " + std::to_string(std::int64_t{1} << depth));
  }
  if (sides.empty()) return target;
  if (leaving == Leaving::error)
    throw Error(ErrorCode::out_of_universe, words.solid + " leaves the universe: " + sides,
                words.remedy + ", clip it (--clip) or grow the universe (--grow)");
  while (true) {
    bool fits = true;
    std::array<bool, 3> downward{};
    for (std::size_t i = 0; i < 3; ++i) {
      downward[i] = below(i) > kSlack;
      fits = fits && !downward[i] && above(i) <= kSlack;
    }
    if (fits) return target;
    if (target.depth == kMaxDepth)
      throw Error(ErrorCode::out_of_universe,
                  words.solid + " leaves the universe even when it is grown to depth 20: " + sides, words.remedy);
    for (std::size_t i = 0; i < 3; ++i)
      if (downward[i]) target.offset[i] += std::int64_t{1} << target.depth;
    ++target.depth;
  }
}

Frame grown_frame(const Frame& frame, const TargetUniverse& target) {
  return frame.shifted(-Eigen::Vector3d(static_cast<double>(target.offset[0]), static_cast<double>(target.offset[1]),
                                        static_cast<double>(target.offset[2])));
}

}  // namespace blackleaf::detail
