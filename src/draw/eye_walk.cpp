// The octree is searched as in visibility.cpp: from the root along the way, nearest children first, into nodes only
// where what they can hide is still visible. The way to the eye has the times k from 1 to infinity, the way away from
// it those from 1 down to 0; what a box hides is the same for both, with k0 and k1 the first and last time between.
// What a box can hide is first computed in doubles, and only where that meets something visible are black boxes taken
// out, in whole numbers (eye_lines.h).
//
// Doubles decide nothing wrongly. Coordinates are whole and below 2^41, so they are exact as doubles. A time b / B is
// rounded once, and rounding keeps order: of two times, the one that is less as a double is less; equal ones are
// compared by products. A bound A k is rounded twice, so it is off by at most a factor 1 +- 2^-52 (1 + 2^-53), and the
// ends of what is visible, Place::rough, by no more. Let R be the greater absolute value of the run's two ends and
// slack = 2^-50 R. Where the true interval (low, high) meets a visible one [l, h], the rough ones meet with slack:
// low < h <= R, and either low < -2 R, and its double is below -R too, or its error and that of h are at most
// 2 R 2^-52 (1 + 2^-53) and R 2^-52 (1 + 2^-53), together less than 2^-50 R; likewise for high and l. So no node is
// passed over that hides something; that some are entered in vain changes nothing.
#include "eye_walk.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "octree/node_arrays.h"

namespace blackleaf::detail {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

// A time num / den; never if den = 0.
struct EyeWalk::Time {
  std::int64_t num, den;
  friend bool operator<(const Time& s, const Time& t) { return Wide{s.num} * t.den < Wide{t.num} * s.den; }
};

EyeWalk::EyeWalk(const Octree& octree, const std::array<std::int64_t, 3>& eye, Way way)
    : eye_(eye),
      way_(way),
      begin_(way == Way::to_eye ? 1 : 0),
      end_(way == Way::to_eye ? kNever : 1),
      root_(brick_level_root(octree)) {
  for (int level = 0; level <= kMaxDepth; ++level)
    levels_[static_cast<std::size_t>(level)] = octree.words(level).data();
}

// The universe's slab along an axis, for an edge at X = `at`.
EyeWalk::Slab EyeWalk::whole(std::int64_t at, unsigned axis) const {
  const std::int64_t low = -eye_[axis], high = (kUnit << root_.level()) - eye_[axis];
  Slab slab = at < 0 ? Slab{-high, -low, kNever, 0} : Slab{low, high, kNever, 0};
  const auto distance = static_cast<double>(std::abs(at));
  slab.first = distance / static_cast<double>(slab.high);
  if (slab.low > 0) slab.last = distance / static_cast<double>(slab.low);
  return slab;
}

// The half farther from the eye and the nearer one.
inline std::array<EyeWalk::Slab, 2> EyeWalk::halves(const Slab& slab, std::int64_t half, double at) {
  const std::int64_t middle = slab.low + half;
  const double passed = middle > 0 ? at / static_cast<double>(middle) : kNever;
  return {Slab{middle, slab.high, passed, slab.first}, Slab{slab.low, middle, slab.last, passed}};
}

// Whether the ways through both slabs miss their common inside. `first`, `last`: the greatest of first times and the
// least of last ones, with begin_ and end_.
inline bool EyeWalk::nothing_met(const Slab& b, const Slab& c, double first, double last) const {
  if (first != last || first == 1 || first == kNever) return first >= last;  // nothing but 1 is rounded to 1
  // One slab is entered about when the other is left.
  return b.first == first ? !(Time{at_b_, b.high} < Time{at_c_, c.low}) : !(Time{at_c_, c.high} < Time{at_b_, b.low});
}

inline bool EyeWalk::may_hide(std::int64_t along, std::int64_t length, double first, double last) const {
  const auto bottom = static_cast<double>(along), top = static_cast<double>(along + length);
  const double low = bottom * (along >= 0 ? first : last) - slack_, high = top * (top > 0 ? last : first) + slack_;
  const std::vector<Interval>& intervals = visible_.intervals();
  if (low >= intervals.back().high.rough || high <= intervals.front().low.rough) return false;
  return intervals.size() == 1 || std::any_of(intervals.begin(), intervals.end(), [&](const Interval& i) {
           return low < i.high.rough && high > i.low.rough;
         });
}

// Exact times over |X_b| or |X_c|, 1 and 0 too, so that all numerators are multiples of what divides both: see
// EyeEdge::piece.
inline EyeWalk::Time EyeWalk::first_of(std::int64_t at, const Slab& slab) const {
  return {at, way_ == Way::to_eye ? std::min(slab.high, at) : slab.high};
}
inline EyeWalk::Time EyeWalk::last_of(std::int64_t at, const Slab& slab) const {
  return {at, std::max(slab.low, way_ == Way::to_eye ? 0 : at)};
}

// Takes out what a black box hides; true iff nothing is left. Without b, the ways run in its plane. Requires: the slabs
// reach beyond the eye toward the edge.
bool EyeWalk::subtract(std::int64_t along, std::int64_t length, const Slab* b, const Slab& c) {
  Time first = first_of(at_c_, c), last = last_of(at_c_, c);
  if (b) {
    const Time first_b = first_of(at_b_, *b), last_b = last_of(at_b_, *b);
    if (first < first_b) first = first_b;
    if (last_b < last) last = last_b;
  }
  if (!(first < last)) return false;
  const auto place = [&](std::int64_t side, const Time& time, bool upper) {
    if (time.den > 0) return Place::of(side, time.num, time.den);
    return upper ? visible_.intervals().back().high : visible_.intervals().front().low;  // all the way out
  };
  const std::int64_t top = along + length;
  const Place low = place(along, along >= 0 ? first : last, false), high = place(top, top > 0 ? last : first, true);
  return visible_.meets(low, high) && visible_.subtract(low, high);
}

const std::vector<EyeWalk::Interval>& EyeWalk::visible(const EyeEdge& edge, const Interval& run) {
  assert(!edge.end_on() && run.low < run.high);
  visible_.reset(run.low, run.high);
  if (root_.is_white()) return visible_.intervals();
  slack_ = std::max(std::abs(run.low.rough), std::abs(run.high.rough)) * 0x1p-50;
  a_ = edge.a, b_ = edge.b, c_ = edge.c;
  at_b_ = std::abs(edge.at_b), at_c_ = std::abs(edge.at_c);
  rough_b_ = static_cast<double>(at_b_), rough_c_ = static_cast<double>(at_c_);
  const unsigned farther = (edge.at_b > 0 ? 1u << b_ : 0) | (edge.at_c > 0 ? 1u << c_ : 0);
  for (unsigned i = 0; i < 8; ++i)
    octants_[i] = farther ^ ((i & 2 ? 1u << b_ : 0) | (i & 4 ? 1u << c_ : 0) | (i & 1 ? 1u << a_ : 0));
  const std::int64_t along = -eye_[a_], length = kUnit << root_.level();
  const Slab slab_c = whole(edge.at_c, c_);
  if (edge.in_plane()) {
    const std::int64_t plane = eye_[b_] / kUnit, side = std::int64_t{1} << root_.level();
    // On the universe's wall one side is white: nothing blocks.
    if (plane <= 0 || plane >= side) return visible_.intervals();
    if (root_.is_black())
      subtract(along, length, nullptr, slab_c);
    else
      descend_in_plane(root_, root_, plane, along, slab_c);
    return visible_.intervals();
  }
  const Slab slab_b = whole(edge.at_b, b_);
  if (root_.is_black())
    subtract(along, length, &slab_b, slab_c);
  else if (root_.level() == 2)
    descend<Kind::brick>(2, root_.word(), along, slab_b, slab_c);
  else
    descend<Kind::node>(root_.level(), root_.word(), along, slab_b, slab_c);
  return visible_.intervals();
}

// What a gray child hides; the child of a node is a node or a brick, that of a brick a byte.
template <EyeWalk::Kind kKind>
bool EyeWalk::descend_child(int level, std::uint64_t word, unsigned octant, std::int64_t along, const Slab& slab_b,
                            const Slab& slab_c) {
  if constexpr (kKind == Kind::brick) {
    return descend<Kind::byte>(level, word >> (8 * octant) & 0xFF, along, slab_b, slab_c);
  } else {
    const std::uint64_t child = levels_[static_cast<std::size_t>(level)][gray_child_index(word, octant)];
    return level == 2 ? descend<Kind::brick>(level, child, along, slab_b, slab_c)
                      : descend<Kind::node>(level, child, along, slab_b, slab_c);
  }
}

// Takes out of visible_ what a gray node hides; true iff nothing is left. `along` is the node's low side along a.
template <EyeWalk::Kind kKind>
bool EyeWalk::descend(int level, std::uint64_t word, std::int64_t along, const Slab& slab_b, const Slab& slab_c) {
  const int below = level - 1;
  const std::int64_t length = kUnit << below;
  const std::array<Slab, 2> b = halves(slab_b, length, rough_b_), c = halves(slab_c, length, rough_c_);
  const auto colour = [&](unsigned octant) {
    if constexpr (kKind == Kind::brick) {
      const std::uint64_t byte = word >> (8 * octant) & 0xFF;
      return byte == 0 ? Colour::white : byte == 0xFF ? Colour::black : Colour::gray;
    } else {
      if (word >> octant & 1) return Colour::black;
      return kKind == Kind::node && (word >> (8 + octant) & 1) ? Colour::gray : Colour::white;
    }
  };
  for (unsigned i = 0; i < 4; ++i) {
    const unsigned quadrant = way_ == Way::to_eye ? i : 3 - i;
    const Slab &in_b = b[quadrant & 1], &in_c = c[quadrant >> 1];
    const double first = std::max({begin_, in_b.first, in_c.first}), last = std::min({end_, in_b.last, in_c.last});
    if (nothing_met(in_b, in_c, first, last)) continue;
    for (unsigned upper = 0; upper < 2; ++upper) {
      const unsigned octant = octants_[2 * quadrant + upper];
      const Colour child = colour(octant);
      if (child == Colour::white) continue;
      const std::int64_t child_along = upper ? along + length : along;
      if (!may_hide(child_along, length, first, last)) continue;
      bool nothing_left = false;
      if (kKind == Kind::byte || child == Colour::black)
        nothing_left = subtract(child_along, length, &in_b, in_c);
      else
        nothing_left = descend_child<kKind>(below, word, octant, child_along, in_b, in_c);
      if (nothing_left) return true;
    }
  }
  return false;
}

// The same for ways in the plane x_b = plane: `below` and `above` are the nodes on its two sides, one and the same as
// long as the plane cuts it. A place blocks iff both sides are black there.
bool EyeWalk::descend_in_plane(const Node& below, const Node& above, std::int64_t plane, std::int64_t along,
                               const Slab& slab_c) {
  assert(below.level() >= 1);
  const int level = below.level() - 1;
  const std::int64_t length = kUnit << level;
  const std::array<Slab, 2> c = halves(slab_c, length, rough_c_);
  const unsigned low_b = static_cast<unsigned>((plane - 1) >> level & 1) << b_;
  const unsigned high_b = static_cast<unsigned>(plane >> level & 1) << b_;
  for (unsigned i = 0; i < 2; ++i) {
    const unsigned half = way_ == Way::to_eye ? i : 1 - i;
    const double first = std::max(begin_, c[half].first), last = std::min(end_, c[half].last);
    if (first >= last) continue;
    for (unsigned upper = 0; upper < 2; ++upper) {
      const std::int64_t child_along = upper ? along + length : along;
      if (!may_hide(child_along, length, first, last)) continue;
      const unsigned octant = octants_[4 * half + upper] & ~(1u << b_);
      const Node low = below.child(static_cast<int>(octant | low_b));
      if (low.is_white()) continue;
      const Node high = above.child(static_cast<int>(octant | high_b));
      if (high.is_white()) continue;
      const bool nothing_left = low.is_black() && high.is_black()
                                    ? subtract(child_along, length, nullptr, c[half])
                                    : descend_in_plane(low, high, plane, child_along, c[half]);
      if (nothing_left) return true;
    }
  }
  return false;
}

}  // namespace blackleaf::detail
