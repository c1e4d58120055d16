// Rays through an octree, from leaf to leaf.
//
// Positions are integers in units of 2^-30 voxels, directions integers D of at most 39 bits, times fractions n / d with
// d = |D_i| for some axis: the ray crosses the plane x_i = p when n = +-(p 2^30 - origin_i). |n| < 2^54, so comparing
// two times takes products of 93 bits. What doubles can tell is told by doubles: a quotient is off by less than 2^-51
// of itself.
//
// The walk: the leaf that holds the ray just after a time is known; of its walls the one crossed first gives the next
// time; the next leaf is the one that holds the ray just after that. On an axis with D_i > 0 a point on a lattice plane
// belongs to the voxel above, with D_i < 0 to the one below: where several walls are crossed at one time, at an edge or
// a corner, the walk goes straight on. On an axis with D_i = 0 a point on a lattice plane lies between two voxels, and
// the ray goes along both, or all four; it is in the solid where all are black.
#include "blackleaf/ray.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "blackleaf/error.h"
#include "octree/brick.h"
#include "octree/node_arrays.h"
#include "octree/parallel.h"

namespace blackleaf {
namespace {

__extension__ using Wide = __int128;

constexpr int kBits = 30;           // of fraction in a position
constexpr int kDirectionBits = 39;  // of the largest coordinate of a direction
constexpr double kFarthest = 8388608.0;

/// n / d; d > 0.
struct Time {
  std::int64_t n = 0, d = 1;
  double value = 0;  // off by 2^-51 of itself at most

  friend bool operator==(const Time& a, const Time& b) { return !(a < b) && !(b < a); }
  friend bool operator<(const Time& a, const Time& b) {
    const double difference = b.value - a.value, doubt = 0x1p-49 * (std::abs(a.value) + std::abs(b.value));
    if (difference > doubt) return true;
    if (difference < -doubt) return false;
    return Wide{a.n} * b.d < Wide{b.n} * a.d;
  }
};

class Walk {
 public:
  Walk(const Octree& octree, const Ray& ray) : levels_(detail::level_words(octree)), side_(octree.side()) {
    for (Eigen::Index i = 0; i < 3; ++i)
      if (!(std::abs(ray.origin[i]) <= kFarthest) || !std::isfinite(ray.direction[i]))
        throw Error(ErrorCode::bad_argument, "a ray's origin or direction is not finite, or is beyond 2^23 voxels",
                    "begin the ray nearer to the universe");
    const double longest = ray.direction.cwiseAbs().maxCoeff();
    if (longest == 0) throw Error(ErrorCode::bad_argument, "a ray's direction is (0, 0, 0)", "give it a direction");
    int exponent = 0;
    std::frexp(longest, &exponent);
    scale_ = kDirectionBits - exponent;
    for (std::size_t i = 0; i < 3; ++i) {
      origin_[i] = std::llround(std::ldexp(ray.origin[static_cast<Eigen::Index>(i)], kBits));
      direction_[i] = std::llround(std::ldexp(ray.direction[static_cast<Eigen::Index>(i)], scale_));
      inverse_[i] = 1.0 / static_cast<double>(direction_[i]);
    }
    const Node root = detail::brick_level_root(octree);
    top_ = root.level();
    if (root.is_gray())
      path_[static_cast<std::size_t>(top_)] = root.word();
    else
      uniform_ = root.colour();
    begin();
  }

  /// False when the ray has left the universe, or never meets it.
  bool inside() const { return inside_; }
  /// The colour of the leaf that the ray is in just after now().
  bool black() const { return black_; }
  const Time& now() const { return now_; }

  /// Goes on to the next leaf.
  void next() {
    Time first;
    bool any = false;
    for (std::size_t i = 0; i < 3; ++i) {
      if (direction_[i] == 0) continue;
      const std::int64_t low = voxel_[i] >> level_ << level_;
      const Time at = crossing(i, direction_[i] > 0 ? low + (std::int64_t{1} << level_) : low);
      if (!any || at < first) first = at;
      any = true;
    }
    now_ = first;
    enter();
  }

  /// In units of the user's direction.
  double user_time(const Time& time) const { return std::ldexp(time.value, scale_ - kBits); }

  /// The point at a time; `entering` says which side of it is black.
  RayPoint point(const Time& time, bool entering, bool at_origin = false) const {
    RayPoint result;
    result.time = user_time(time);
    for (std::size_t i = 0; i < 3; ++i)
      result.point[static_cast<Eigen::Index>(i)] =
          std::ldexp(static_cast<double>(origin_[i]) + static_cast<double>(direction_[i]) * time.value, -kBits);
    if (at_origin) return result;
    // The first axis on which it crosses a lattice plane just then.
    for (std::size_t i = 0; i < 3; ++i) {
      if (direction_[i] == 0) continue;
      const Eigen::Index axis = static_cast<Eigen::Index>(i);
      const auto plane = static_cast<std::int64_t>(std::llround(result.point[axis]));
      if (!(crossing(i, plane) == time)) continue;
      result.point[axis] = static_cast<double>(plane);
      if (result.normal == Eigen::Vector3i::Zero()) result.normal[axis] = (direction_[i] > 0) == entering ? -1 : 1;
    }
    return result;
  }

 private:
  Time crossing(std::size_t axis, std::int64_t plane) const {
    const std::int64_t way = (plane << kBits) - origin_[axis];
    const bool forward = direction_[axis] > 0;
    return {forward ? way : -way, forward ? direction_[axis] : -direction_[axis],
            static_cast<double>(way) * inverse_[axis]};
  }

  // The voxel's coordinate just after a time.
  std::int64_t after(std::size_t axis, const Time& time) const {
    const double at =
        (static_cast<double>(origin_[axis]) + static_cast<double>(direction_[axis]) * time.value) * 0x1p-30;
    const double below = std::floor(at);
    // Positions within the universe are below 2^21 voxels, sums before them below 2^25: this is off by 2^-24 at most.
    if (at - below > 0x1p-20 && at - below < 1 - 0x1p-20) return static_cast<std::int64_t>(below);
    const auto plane = static_cast<std::int64_t>(std::llround(at));
    if (direction_[axis] == 0) return origin_[axis] >> kBits;
    const Time crossed = crossing(axis, plane);
    const bool passed = !(time < crossed);  // it is on the far side of the plane just after
    return (direction_[axis] > 0) == passed ? plane : plane - 1;
  }

  void begin() {
    Time first, last;
    bool bounded = false;
    for (std::size_t i = 0; i < 3; ++i) {
      if (direction_[i] == 0) {
        // In a lattice plane: along the voxels on both sides; those outside the universe are white.
        sides_[i] = (origin_[i] & ((std::int64_t{1} << kBits) - 1)) == 0;
        if (origin_[i] < (sides_[i] ? 1 : 0) || origin_[i] >> kBits >= side_) return;
        continue;
      }
      const Time low = crossing(i, direction_[i] > 0 ? 0 : side_), high = crossing(i, direction_[i] > 0 ? side_ : 0);
      if (first < low) first = low;
      if (!bounded || high < last) last = high;
      bounded = true;
    }
    if (!(first < last)) return;
    now_ = first;
    enter();
  }

  // Finds the leaf that holds the ray just after now_.
  void enter() {
    std::array<std::int64_t, 3> voxel;
    for (std::size_t i = 0; i < 3; ++i) voxel[i] = after(i, now_);
    const auto all = static_cast<std::uint64_t>(voxel[0]) | static_cast<std::uint64_t>(voxel[1]) |
                     static_cast<std::uint64_t>(voxel[2]);
    inside_ = all < static_cast<std::uint64_t>(side_);
    if (!inside_) return;
    const auto changed =
        static_cast<std::uint64_t>((voxel[0] ^ voxel_[0]) | (voxel[1] ^ voxel_[1]) | (voxel[2] ^ voxel_[2]));
    voxel_ = voxel;
    known_ = std::max(known_, static_cast<int>(std::bit_width(changed)));
    descend(voxel);
    if (!(sides_[0] || sides_[1] || sides_[2])) return;
    bool black = black_;
    int level = level_;
    for (unsigned side = 1; side < 8; ++side) {
      std::array<std::int64_t, 3> other = voxel;
      bool wanted = true;
      for (std::size_t i = 0; i < 3; ++i) {
        if ((side >> i & 1) == 0) continue;
        wanted = wanted && sides_[i];
        --other[i];
      }
      if (!wanted) continue;
      known_ = top_;
      descend(other);
      black = black && black_;
      level = std::min(level, level_);
    }
    known_ = top_;
    black_ = black;
    level_ = level;
  }

  // From the lowest node of the path that holds the voxel, of level known_ or more, down to its leaf.
  void descend(const std::array<std::int64_t, 3>& voxel) {
    if (uniform_ != Colour::gray) {
      black_ = uniform_ == Colour::black;
      level_ = top_;
      return;
    }
    int level = std::min(known_, top_);
    std::uint64_t word = path_[static_cast<std::size_t>(level)];
    for (; level > 2; --level) {
      const auto below = static_cast<std::size_t>(level - 1);
      const auto octant =
          static_cast<unsigned>((voxel[0] >> below & 1) | (voxel[1] >> below & 1) << 1 | (voxel[2] >> below & 1) << 2);
      if ((word >> (8 + octant) & 1) == 0) {
        black_ = (word >> octant & 1) != 0;
        level_ = level - 1;
        known_ = level;
        return;
      }
      word = levels_[below][detail::gray_child_index(word, octant)];
      path_[below] = word;
    }
    const auto low = [](std::int64_t coordinate) { return static_cast<unsigned>(coordinate & 3); };
    const unsigned bit = detail::brick_bit(low(voxel[0]), low(voxel[1]), low(voxel[2]));
    const std::uint64_t byte = word >> (bit & ~7U) & 0xFF;
    black_ = (byte >> (bit & 7U) & 1) != 0;
    level_ = byte == 0 || byte == 0xFF ? 1 : 0;
    known_ = 2;
  }

  detail::LevelWords levels_;
  std::int64_t side_;
  std::array<std::int64_t, 3> origin_{}, direction_{};  // units of 2^-30 voxels; of 2^-scale_ of the user's direction
  std::array<double, 3> inverse_{};                     // of the direction
  int scale_ = 0;
  std::array<bool, 3> sides_{};                      // axes on which the ray goes between voxels
  std::array<std::uint64_t, kMaxDepth + 1> path_{};  // words of the gray nodes above the leaf
  int known_ = kMaxDepth;                            // the path holds for the voxel from this level on
  Colour uniform_ = Colour::gray;                    // of a tree without gray nodes
  int top_ = 0;

  bool inside_ = false, black_ = false;
  int level_ = 0;
  std::array<std::int64_t, 3> voxel_{};
  Time now_;
};

// Passes what has one colour and returns when it ends, or the universe does.
Time pass(Walk& walk) {
  const bool black = walk.black();
  do {
    walk.next();
  } while (walk.inside() && walk.black() == black);
  return walk.now();
}

}  // namespace

std::optional<RayPoint> first_hit(const Octree& octree, const Ray& ray, double up_to) {
  Walk walk(octree, ray);
  if (octree.is_empty() || !walk.inside()) return std::nullopt;
  const bool at_origin = walk.now().n == 0;
  if (walk.black()) {
    if (!(walk.user_time(walk.now()) <= up_to)) return std::nullopt;
    return walk.point(walk.now(), true, at_origin);
  }
  do {
    walk.next();
    if (!walk.inside() || walk.user_time(walk.now()) > up_to) return std::nullopt;
  } while (!walk.black());
  return walk.point(walk.now(), true);
}

std::vector<std::optional<RayPoint>> first_hits(const Octree& octree, std::span<const Ray> rays, const Work& work) {
  std::vector<std::optional<RayPoint>> hits(rays.size());
  constexpr std::size_t kAtOnce = 256;  // a hundred microseconds or more
  detail::for_each_index((rays.size() + kAtOnce - 1) / kAtOnce, work, [&](std::size_t part) {
    const std::size_t end = std::min(rays.size(), (part + 1) * kAtOnce);
    for (std::size_t i = part * kAtOnce; i < end; ++i) hits[i] = first_hit(octree, rays[i]);
  });
  return hits;
}

std::vector<RayStretch> crossings(const Octree& octree, const Ray& ray) {
  Walk walk(octree, ray);
  std::vector<RayStretch> stretches;
  bool at_origin = walk.now().n == 0;
  while (walk.inside()) {
    if (!walk.black()) {
      pass(walk);
      at_origin = false;
      continue;
    }
    RayStretch stretch;
    stretch.enter = walk.point(walk.now(), true, at_origin);
    at_origin = false;
    stretch.leave = walk.point(pass(walk), false);
    stretches.push_back(stretch);
  }
  return stretches;
}

}  // namespace blackleaf
