// How the octree is searched. A box [A, A + s] x [B, B + s] x [C, C + s] is met by the rays of an edge at the same
// times (tau0, tau1), tau0 = max(0, when they enter the slabs of b and c), tau1 = when they leave the first of them.
// Over that time it covers, along a, what started at the positions A D - tau d_a .. (A + s) D - tau d_a: together the
// open interval (A D - max(tau d_a), (A + s) D - min(tau d_a)). A black box hides it. A gray box can hide nothing else,
// so it is entered only where that interval still shows something. Children are visited in the order in which the rays
// meet them, and the search ends when nothing is left. Whole numbers only; edge_family.h has units and bounds.
#include "visibility.h"

#include "octree/node_arrays.h"

namespace blackleaf::detail {

VisibilityWalk::VisibilityWalk(const Octree& octree, const EdgeFamily& family)
    : family_(family),
      root_(brick_level_root(octree)),
      time_b_(std::abs(family.d_c)),
      time_c_(family.mode == EdgeFamily::Mode::general ? std::abs(family.d_b) : 1),
      near_((family.d_b < 0 ? 1u << family.b : 0) | (family.d_c < 0 ? 1u << family.c : 0)) {
  assert(family.mode != EdgeFamily::Mode::end_on);
  for (unsigned i = 0; i < 8; ++i)
    octants_[i] = near_ ^ ((i & 2 ? 1u << family.b : 0) | (i & 4 ? 1u << family.c : 0) | (i & 1 ? 1u << family.a : 0));
  for (int level = 0; level <= kMaxDepth; ++level)
    levels_[static_cast<std::size_t>(level)] = octree.words(level).data();
}

const std::vector<Interval>& VisibilityWalk::visible(const Interval& run, std::int64_t at_b, std::int64_t at_c) {
  const EdgeFamily& f = family_;
  visible_.reset(run.low, run.high);
  if (root_.is_white()) return visible_.intervals();
  const std::int64_t side = std::int64_t{1} << root_.level();
  const std::int64_t near_c = (f.d_c > 0 ? -at_c : at_c - side) * time_c_;
  const bool general = f.mode == EdgeFamily::Mode::general;
  const std::int64_t near_b = !general ? near_c : (f.d_b > 0 ? -at_b : at_b - side) * time_b_;
  // Rays on the universe's wall have white on one side: nothing blocks.
  if (!general && (at_b <= 0 || at_b >= side)) return visible_.intervals();
  if (root_.is_black()) {
    const std::int64_t enter = std::max({std::int64_t{0}, near_b, near_c});
    const std::int64_t leave_b = general ? near_b + side * time_b_ : stop_;
    const std::int64_t leave = std::min({stop_, leave_b, near_c + side * time_c_});
    if (enter >= leave) return visible_.intervals();
    const Interval hides = hidden(0, f.scale << root_.level(), enter, leave);
    if (visible_.meets(hides.low, hides.high)) visible_.subtract(hides.low, hides.high);
  } else if (!general) {
    descend_in_plane(root_, root_, at_b, 0, near_c);
  } else if (root_.level() == 2) {
    descend<Kind::brick>(2, root_.word(), 0, near_b, near_c);
  } else {
    descend<Kind::node>(root_.level(), root_.word(), 0, near_b, near_c);
  }
  return visible_.intervals();
}

inline Interval VisibilityWalk::hidden(std::int64_t along, std::int64_t length, std::int64_t enter,
                                       std::int64_t leave) const {
  const std::int64_t at_enter = enter * family_.d_a, at_leave = leave * family_.d_a;
  return {along - std::max(at_enter, at_leave), along + length - std::min(at_enter, at_leave)};
}

// What a gray child hides; the child of a node is a node or a brick, that of a brick a byte.
template <VisibilityWalk::Kind kKind>
bool VisibilityWalk::descend_child(int level, std::uint64_t word, unsigned octant, std::int64_t along,
                                   std::int64_t near_b, std::int64_t near_c) {
  if constexpr (kKind == Kind::brick) {
    return descend<Kind::byte>(level, word >> (8 * octant) & 0xFF, along, near_b, near_c);
  } else {
    const std::uint64_t gray_before = word >> 8 & 0xFF & ((1u << octant) - 1);
    const std::uint64_t index = (word >> 16) + static_cast<unsigned>(std::popcount(gray_before));
    const std::uint64_t child = levels_[static_cast<std::size_t>(level)][index];
    return level == 2 ? descend<Kind::brick>(level, child, along, near_b, near_c)
                      : descend<Kind::node>(level, child, along, near_b, near_c);
  }
}

// Takes out of visible_ what a gray node hides; true iff nothing is left. `along` is the node's low side along a in
// units of 1/D, near_b and near_c the times at which the rays enter its slabs of b and c.
template <VisibilityWalk::Kind kKind>
bool VisibilityWalk::descend(int level, std::uint64_t word, std::int64_t along, std::int64_t near_b,
                             std::int64_t near_c) {
  const int below = level - 1;
  const std::int64_t length = family_.scale << below, time_b = time_b_ << below, time_c = time_c_ << below;
  const auto colour = [&](unsigned octant) {
    if constexpr (kKind == Kind::brick) {
      const std::uint64_t byte = word >> (8 * octant) & 0xFF;
      return byte == 0 ? Colour::white : byte == 0xFF ? Colour::black : Colour::gray;
    } else {
      if (word >> octant & 1) return Colour::black;
      return kKind == Kind::node && (word >> (8 + octant) & 1) ? Colour::gray : Colour::white;
    }
  };
  for (unsigned quadrant = 0; quadrant < 4; ++quadrant) {
    const std::int64_t enter_b = quadrant & 1 ? near_b + time_b : near_b;
    const std::int64_t enter_c = quadrant & 2 ? near_c + time_c : near_c;
    const std::int64_t enter = std::max({std::int64_t{0}, enter_b, enter_c});
    const std::int64_t leave = std::min({enter_b + time_b, enter_c + time_c, stop_});
    if (enter >= leave) continue;
    for (unsigned upper = 0; upper < 2; ++upper) {
      const unsigned octant = octants_[2 * quadrant + upper];
      const Colour child = colour(octant);
      if (child == Colour::white) continue;
      const std::int64_t child_along = upper ? along + length : along;
      const Interval hides = hidden(child_along, length, enter, leave);
      if (!visible_.meets(hides.low, hides.high)) continue;
      bool nothing_left = false;
      if (kKind == Kind::byte || child == Colour::black)
        nothing_left = visible_.subtract(hides.low, hides.high);
      else
        nothing_left = descend_child<kKind>(below, word, octant, child_along, enter_b, enter_c);
      if (nothing_left) return true;
    }
  }
  return false;
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
