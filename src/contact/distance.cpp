// Distance of two solids: best-first branch and bound over pairs of nodes. The first pair of black nodes to come out of
// the queue is nearest, because the gap between two cubes bounds that between anything inside them from below.
#include <algorithm>
#include <cmath>
#include <queue>
#include <vector>

#include "blackleaf/contact.h"
#include "octree/same_depth.h"

namespace blackleaf {
namespace {

struct Pair {
  Node a, b;
  Cube in_a, in_b;
  std::int64_t squared;  // of the gap between the two cubes
};

struct Farther {
  bool operator()(const Pair& p, const Pair& q) const {
    if (p.squared != q.squared) return p.squared > q.squared;
    // Among equals finish what is nearly done: smaller nodes first, then a fixed order.
    const auto key = [](const Pair& r) {
      return std::array{r.in_a.level + r.in_b.level, r.in_a.x, r.in_a.y, r.in_a.z, r.in_b.x, r.in_b.y, r.in_b.z};
    };
    return key(p) > key(q);
  }
};

std::int64_t gap(std::int64_t low_a, std::int64_t side_a, std::int64_t low_b, std::int64_t side_b) {
  return std::max({std::int64_t{0}, low_b - (low_a + side_a), low_a - (low_b + side_b)});
}

std::int64_t squared_gap(const Cube& a, const Cube& b) {
  const std::int64_t x = gap(a.x, a.side(), b.x, b.side()), y = gap(a.y, a.side(), b.y, b.side()),
                     z = gap(a.z, a.side(), b.z, b.side());
  return x * x + y * y + z * z;
}

// Nearest points of two intervals.
std::pair<std::int32_t, std::int32_t> nearest(std::int32_t low_a, std::int32_t side_a, std::int32_t low_b,
                                              std::int32_t side_b) {
  if (low_a + side_a <= low_b) return {low_a + side_a, low_b};
  if (low_b + side_b <= low_a) return {low_a, low_b + side_b};
  const std::int32_t common = std::max(low_a, low_b);
  return {common, common};
}

}  // namespace

std::optional<Distance> distance(const Octree& a, const Octree& b) {
  detail::require_same_depth(a, b);
  if (a.is_empty() || b.is_empty()) return std::nullopt;
  std::priority_queue<Pair, std::vector<Pair>, Farther> queue;
  queue.push({a.root(), b.root(), a.universe(), b.universe(), 0});
  while (true) {
    const Pair pair = queue.top();
    queue.pop();
    if (pair.a.is_black() && pair.b.is_black()) {
      Distance result;
      result.squared = pair.squared;
      result.voxels = std::sqrt(static_cast<double>(pair.squared));
      const std::int32_t s = pair.in_a.side(), t = pair.in_b.side();
      std::tie(result.on_a[0], result.on_b[0]) = nearest(pair.in_a.x, s, pair.in_b.x, t);
      std::tie(result.on_a[1], result.on_b[1]) = nearest(pair.in_a.y, s, pair.in_b.y, t);
      std::tie(result.on_a[2], result.on_b[2]) = nearest(pair.in_a.z, s, pair.in_b.z, t);
      return result;
    }
    const bool split_a = pair.a.is_gray() && (!pair.b.is_gray() || pair.in_a.level >= pair.in_b.level);
    for (int octant = 0; octant < 8; ++octant) {
      Pair below = pair;
      if (split_a) {
        below.a = pair.a.child(octant);
        below.in_a = pair.in_a.child(octant);
      } else {
        below.b = pair.b.child(octant);
        below.in_b = pair.in_b.child(octant);
      }
      if ((split_a ? below.a : below.b).is_white()) continue;
      below.squared = squared_gap(below.in_a, below.in_b);
      queue.push(below);
    }
  }
}

}  // namespace blackleaf
