// How nodes are searched. A box [A, A + s] x [B, B + s] x [C, C + s] is met by the rays of an edge at the same
// times (tau0, tau1), tau0 = max(0, when they enter the slabs of b and c), tau1 = when they leave the first of them.
// Over that time it covers, along a, what started at the positions A D - tau d_a .. (A + s) D - tau d_a: together the
// open interval (A D - max(tau d_a), (A + s) D - min(tau d_a)). A black box hides it. A gray box can hide nothing else,
// so it is entered only where that interval still shows something. Children are visited in the order in which the rays
// meet them, and the search ends when nothing is left. Whole numbers only; edge_family.h has units and bounds.
#include "visibility.h"

#include "octree/brick.h"

namespace blackleaf::detail {

VisibilityWalk::VisibilityWalk(const Octree& octree, const EdgeFamily& family)
    : family_(family),
      root_(brick_level_root(octree)),
      levels_(level_words(octree)),
      time_b_(std::abs(family.d_c)),
      time_c_(family.mode == EdgeFamily::Mode::general ? std::abs(family.d_b) : 1),
      near_((family.d_b < 0 ? 1u << family.b : 0) | (family.d_c < 0 ? 1u << family.c : 0)) {
  assert(family.mode != EdgeFamily::Mode::end_on);
  for (unsigned i = 0; i < 8; ++i)
    octants_[i] = near_ ^ ((i & 2 ? 1u << family.b : 0) | (i & 4 ? 1u << family.c : 0) | (i & 1 ? 1u << family.a : 0));
  const unsigned a = family.a;
  row_mask_ =
      std::uint64_t{1} | std::uint64_t{1} << (1u << a) | std::uint64_t{1} << (8u << a) | std::uint64_t{1} << (9u << a);
  for (unsigned c = 0; c < 4; ++c)
    for (unsigned b = 0; b < 4; ++b) {
      const unsigned at_b = family.d_b < 0 ? 3 - b : b, at_c = family.d_c < 0 ? 3 - c : c;
      rows_[4 * c + b] = static_cast<std::uint8_t>(kSpread[at_b] << family.b | kSpread[at_c] << family.c);
    }
}

const std::vector<Interval>& VisibilityWalk::visible(const Interval& run, std::int64_t at_b, std::int64_t at_c) {
  const Blocker root{root_, 0, 0, 0};
  begin(run);
  hide(at_b, at_c, {&root, root_.is_white() ? 0u : 1u});
  return left();
}

void VisibilityWalk::hide(std::int64_t at_b, std::int64_t at_c, std::span<const Blocker> nodes) {
  if (family_.mode == EdgeFamily::Mode::in_plane) {
    search_plane(at_b, at_c);
  } else {
    for (const Blocker& blocker : nodes)
      if (search(blocker, at_b, at_c)) break;
  }
}

// Takes out of visible_ what a node hides; true iff nothing is left.
bool VisibilityWalk::search(const Blocker& blocker, std::int64_t at_b, std::int64_t at_c) {
  const EdgeFamily& f = family_;
  const std::array<std::int64_t, 3> corner = {blocker.x, blocker.y, blocker.z};
  const int level = blocker.node.level();
  const std::int64_t side = std::int64_t{1} << level;
  const std::int64_t near_b = (f.d_b > 0 ? corner[f.b] - at_b : at_b - corner[f.b] - side) * time_b_;
  const std::int64_t near_c = (f.d_c > 0 ? corner[f.c] - at_c : at_c - corner[f.c] - side) * time_c_;
  const std::int64_t enter = std::max({std::int64_t{0}, near_b, near_c});
  const std::int64_t leave = std::min({stop_, near_b + side * time_b_, near_c + side * time_c_});
  if (enter >= leave) return false;
  const std::int64_t along = corner[f.a] * f.scale;
  const Interval hides = hidden(along, f.scale << level, enter, leave);
  if (!visible_.meets(hides.low, hides.high)) return false;
  if (blocker.node.is_black()) return visible_.subtract(hides.low, hides.high);
  return search_gray(level, blocker.node.word(), along, near_b, near_c);
}

// The same for the whole tree and rays in the plane x_b = at_b.
void VisibilityWalk::search_plane(std::int64_t at_b, std::int64_t at_c) {
  const EdgeFamily& f = family_;
  const std::int64_t side = std::int64_t{1} << root_.level();
  // Rays on the universe's wall have white on one side: nothing blocks.
  if (root_.is_white() || at_b <= 0 || at_b >= side) return;
  const std::int64_t near_c = (f.d_c > 0 ? -at_c : at_c - side) * time_c_;
  if (root_.is_gray()) {
    descend_in_plane(root_, root_, at_b, 0, near_c);
    return;
  }
  const std::int64_t enter = std::max(std::int64_t{0}, near_c), leave = std::min(stop_, near_c + side * time_c_);
  if (enter >= leave) return;
  const Interval hides = hidden(0, f.scale << root_.level(), enter, leave);
  if (visible_.meets(hides.low, hides.high)) visible_.subtract(hides.low, hides.high);
}

inline Interval VisibilityWalk::hidden(std::int64_t along, std::int64_t length, std::int64_t enter,
                                       std::int64_t leave) const {
  const std::int64_t at_enter = enter * family_.d_a, at_leave = leave * family_.d_a;
  return {along - std::max(at_enter, at_leave), along + length - std::min(at_enter, at_leave)};
}

// The same for a gray node of level 3 or more. `along` is the node's low
// side along a in units of 1/D, near_b and near_c the times at which the rays enter its slabs of b and c.
bool VisibilityWalk::descend(int level, std::uint64_t word, std::int64_t along, std::int64_t near_b,
                             std::int64_t near_c) {
  const int below = level - 1;
  const std::int64_t length = family_.scale << below, time_b = time_b_ << below, time_c = time_c_ << below;
  for (unsigned quadrant = 0; quadrant < 4; ++quadrant) {
    const std::int64_t enter_b = quadrant & 1 ? near_b + time_b : near_b;
    const std::int64_t enter_c = quadrant & 2 ? near_c + time_c : near_c;
    const std::int64_t enter = std::max({std::int64_t{0}, enter_b, enter_c});
    const std::int64_t leave = std::min({enter_b + time_b, enter_c + time_c, stop_});
    if (enter >= leave) continue;
    for (unsigned upper = 0; upper < 2; ++upper) {
      const unsigned octant = octants_[2 * quadrant + upper];
      const bool black = word >> octant & 1;
      if (!black && !(word >> (8 + octant) & 1)) continue;
      const std::int64_t child_along = upper ? along + length : along;
      const Interval hides = hidden(child_along, length, enter, leave);
      if (!visible_.meets(hides.low, hides.high)) continue;
      if (black ? visible_.subtract(hides.low, hides.high)
                : search_gray(below, levels_[static_cast<std::size_t>(below)][gray_child_index(word, octant)],
                              child_along, enter_b, enter_c))
        return true;
    }
  }
  return false;
}

// The same for a brick: its voxels stand in 4 x 4 rows along a, and the rays go from row to row.
bool VisibilityWalk::search_brick(std::uint64_t word, std::int64_t along, std::int64_t near_b, std::int64_t near_c) {
  std::int64_t enter = std::max({std::int64_t{0}, near_b, near_c});
  std::int64_t leave_b = near_b + time_b_, leave_c = near_c + time_c_;
  unsigned b = 0, c = 0;  // the row, counted from the side that rays meet first
  for (; leave_b <= enter; leave_b += time_b_) ++b;
  for (; leave_c <= enter; leave_c += time_c_) ++c;
  while (b < 4 && c < 4 && enter < stop_) {
    const std::int64_t leave = std::min({leave_b, leave_c, stop_});
    const std::uint64_t row = word >> rows_[4 * c + b] & row_mask_;
    if (row != 0) {
      const auto one = 1u << family_.a, two = 8u << family_.a;
      auto voxels = static_cast<unsigned>((row & 1) | (row >> one & 1) << 1 | (row >> two & 1) << 2 |
                                          (row >> (one + two) & 1) << 3);
      while (voxels) {  // those side by side at once
        const auto first = static_cast<unsigned>(std::countr_zero(voxels));
        const auto count = static_cast<unsigned>(std::countr_one(voxels >> first));
        voxels &= ~(((1u << count) - 1) << first);
        const Interval hides = hidden(along + first * family_.scale, count * family_.scale, enter, leave);
        if (visible_.meets(hides.low, hides.high) && visible_.subtract(hides.low, hides.high)) return true;
      }
    }
    enter = leave;
    if (leave_b == leave) ++b, leave_b += time_b_;
    if (leave_c == leave) ++c, leave_c += time_c_;
  }
  return false;
}

// What a gray node of any level hides.
bool VisibilityWalk::search_gray(int level, std::uint64_t word, std::int64_t along, std::int64_t near_b,
                                 std::int64_t near_c) {
  return level == 2 ? search_brick(word, along, near_b, near_c) : descend(level, word, along, near_b, near_c);
}

// The same for rays in the plane x_b = at_b: `below` and `above` are the nodes on its two sides, one and the same as
// long as the plane cuts it. A place blocks iff both sides are black there.
bool VisibilityWalk::descend_in_plane(const Node& below, const Node& above, std::int64_t at_b, std::int64_t along,
                                      std::int64_t near_c) {
  const int level = below.level() - 1;
  const std::int64_t length = family_.scale << level, time_c = time_c_ << level;
  const unsigned bit_a = 1u << family_.a, bit_c = 1u << family_.c;
  const unsigned low_b = static_cast<unsigned>((at_b - 1) >> level & 1) << family_.b;
  const unsigned high_b = static_cast<unsigned>(at_b >> level & 1) << family_.b;
  for (unsigned far = 0; far < 2; ++far) {
    const std::int64_t enter_c = far ? near_c + time_c : near_c, leave = std::min(enter_c + time_c, stop_);
    if (leave <= std::max(std::int64_t{0}, enter_c)) continue;
    const unsigned bits = (near_ & bit_c) ^ (far ? bit_c : 0);
    for (unsigned upper = 0; upper < 2; ++upper) {
      const std::int64_t child_along = upper ? along + length : along;
      const Interval hides = hidden(child_along, length, std::max(std::int64_t{0}, enter_c), leave);
      if (!visible_.meets(hides.low, hides.high)) continue;
      const unsigned octant = bits | (upper ? bit_a : 0);
      const Node low = below.child(static_cast<int>(octant | low_b));
      if (low.is_white()) continue;
      const Node high = above.child(static_cast<int>(octant | high_b));
      if (high.is_white()) continue;
      const bool nothing_left = low.is_black() && high.is_black()
                                    ? visible_.subtract(hides.low, hides.high)
                                    : descend_in_plane(low, high, at_b, child_along, enter_c);
      if (nothing_left) return true;
    }
  }
  return false;
}

}  // namespace blackleaf::detail
