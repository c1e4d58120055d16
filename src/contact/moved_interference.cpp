// Interference of a solid with a moved one, without making the moved octree: both trees are descended together, and
// the eight children of one node are compared with a node of the other at once, by SIMD.
//
// All is done in b's frame (placement.h). What a pair of nodes holds is bounded by two boxes, one upright, one tilted,
// and by two planes (contact_node.h). It is dropped when it is certain to be apart
//   - along one of the 15 axes of two boxes: their own face normals, and the products of their edges; or
//   - by the planes: who is in both solids fulfils n.x <= s and m.x <= t, hence (n + m).x <= s + t, which no point of
//     a child's box may do. Where two smooth surfaces face each other n and m nearly cancel, so the pair is seen to be
//     apart as soon as its size times the angle between them is below the gap.
// This is computed in 32-bit floating point, relative to the pair: all numbers are below
//   m = |distance of the reference points|_1 + 4 (side of a + side of b)
// and every margin is the result of fewer than 32 roundings of numbers below m (below 222 m for planes, |n|_1 < 222),
// so it is off by less than 2^-19 m (2^-11 m); the edges' not being of length 1, or not at right angles, costs 2^-36 m.
// What is nearer than that stays. Nothing is ever decided to interfere in floating point: a pair of black cubes that
// stays is decided in integers (exact_boxes.h), and so are pairs whose boxes nearly touch.
//
// The voxelised meaning asks whether a voxel centre of a lies in the closed solid of b. That is the same descent with
// a's boxes and planes half a voxel smaller, down to single voxels.
#include <algorithm>
#include <bit>
#include <cmath>

#include "blackleaf/contact.h"
#include "contact_node.h"
#include "exact_boxes.h"
#include "octree/same_depth.h"
#include "placement.h"

// Highway compiles what follows once for every instruction set, and chooses when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/moved_interference.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BLACKLEAF_MOVED_INTERFERENCE_QUERY
#define BLACKLEAF_MOVED_INTERFERENCE_QUERY
namespace blackleaf::detail {
namespace {

/// The product of an edge of b and one of a as an axis of length 1, and what the half sides of the boxes reach along
/// it.
struct CrossedAxis {
  std::array<float, 2> axis;        // its other two coordinates than that of b's edge
  std::array<float, 2> of_b, of_a;  // by the two axes of b, of a, that are not the edge's
};

struct Query {
  Query(const ContactNodes& nodes_a, const ContactNodes& nodes_b, const FixedMotion& motion, Meaning meaning)
      : a(nodes_a),
        b(nodes_b),
        placement(motion),
        exact(motion),
        voxelised(meaning == Meaning::voxelised),
        shrunk(voxelised ? 0.5F : 0.0F) {
    const auto& c = placement.turn();
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i) {
        turn[j][i] = static_cast<float>(c[j][i]);
        reach[j][i] = std::abs(turn[j][i]);
        const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3, i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        const double length = std::hypot(c[j1][i], c[j2][i]);
        CrossedAxis& axis = crossed[j][i];
        if (length < 0x1p-10) {  // nearly parallel edges: an axis along which nothing is ever apart
          axis = {{0, 0}, {1, 1}, {1, 1}};
          continue;
        }
        axis.axis = {static_cast<float>(-c[j2][i] / length), static_cast<float>(c[j1][i] / length)};
        axis.of_b = {std::abs(axis.axis[0]), std::abs(axis.axis[1])};
        axis.of_a = {static_cast<float>(std::abs(c[j][i2]) / length), static_cast<float>(std::abs(c[j][i1]) / length)};
      }
  }

  // True iff a pair of a black child of each, or of single voxels, is a hit.
  bool hit(const ContactNode& in_a, const ContactNode& in_b) const {
    if (!voxelised) return !exact.apart({in_a.low, in_a.high}, {in_b.low, in_b.high});
    const Placement::Point centre =
        placement.moved({2 * in_a.corner[0] + 1, 2 * in_a.corner[1] + 1, 2 * in_a.corner[2] + 1});
    for (std::size_t i = 0; i < 3; ++i) {
      constexpr int kBits = FixedMotion::kFractionBits + 1;
      if (centre[i] < std::int64_t{in_b.low[i]} << kBits || centre[i] > std::int64_t{in_b.high[i]} << kBits)
        return false;
    }
    return true;
  }

  const ContactNodes &a, &b;
  Placement placement;
  ExactBoxes exact;
  bool voxelised;
  float shrunk;                                       // what a's boxes lose on every side
  std::array<std::array<float, 3>, 3> turn, reach;    // A / 2^38 and its absolute values, rows
  std::array<std::array<CrossedAxis, 3>, 3> crossed;  // [edge of b][edge of a]
};

}  // namespace
}  // namespace blackleaf::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace blackleaf::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 8>;
using Vec = hn::Vec<Lanes>;

struct Row {
  HWY_ALIGN std::array<float, 8> margin;  // how far apart a child is at least
  float band;                             // how wrong that may be
};

// The children of a node that are not certain to be apart from a node of the other tree, as a mask.
template <bool kNodeOfA>
HWY_ATTR unsigned survivors(const Query& query, const ContactNode& node, const ContactNode& other, Row& row) {
  const Lanes d;
  const hn::Rebind<std::uint8_t, Lanes> d8;
  const hn::Rebind<std::int8_t, Lanes> signed8;
  const hn::Rebind<std::int16_t, Lanes> d16;
  const hn::Rebind<std::int32_t, Lanes> d32;
  std::array<std::int32_t, 3> corner, centre;  // doubled
  std::array<float, 3> other_half;
  std::int32_t longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    corner[i] = 2 * node.corner[i];
    centre[i] = other.low[i] + other.high[i];
    const std::int32_t side = other.high[i] - other.low[i];
    longest = std::max(longest, side);
    other_half[i] = 0.5F * static_cast<float>(side) - (kNodeOfA ? 0 : query.shrunk);
  }
  const std::array<double, 3> from =
      kNodeOfA ? query.placement.from(corner, centre) : query.placement.from(centre, corner);
  std::array<float, 3> start;
  for (std::size_t i = 0; i < 3; ++i) start[i] = static_cast<float>(from[i]);
  const float size =
      std::abs(start[0]) + std::abs(start[1]) + std::abs(start[2]) + 4 * static_cast<float>(node.side() + longest);
  row.band = size * 0x1p-19F;
  const ChildBounds& bounds = node.child_bounds();
  const auto unit = static_cast<float>(ChildBounds::unit(node.level));

  // The other's plane, on the node's axes and from the node's corner.
  const bool planes = node.bounds != nullptr || node.reach != 0 || other.reach != 0;
  std::array<float, 3> other_normal{};
  float other_reach = other.reach;
  if (planes) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto to_centre = 0.5F * static_cast<float>(centre[i] - 2 * other.corner[i]);
      if (kNodeOfA) {
        for (std::size_t j = 0; j < 3; ++j) other_normal[i] += query.turn[j][i] * other.normal[j];
        other_reach -= other.normal[i] * (start[i] + to_centre);
      } else {
        for (std::size_t j = 0; j < 3; ++j) other_normal[i] += query.turn[i][j] * other.normal[j];
        other_reach += other_normal[i] * start[i] - other.normal[i] * to_centre;
        other_reach -= query.shrunk * std::abs(other.normal[i]);
      }
    }
  }

  const auto band = hn::Set(d, row.band), half = hn::Set(d, 0.5F * unit);
  unsigned stay = 0;
  for (std::size_t lane = 0; lane < 8; lane += hn::Lanes(d)) {
    std::array<Vec, 3> place, own_half;  // of the children, from the node's corner
    for (std::size_t i = 0; i < 3; ++i) {
      const auto low = hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(d8, &bounds.low[i][lane])));
      const auto high = hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(d8, &bounds.high[i][lane])));
      place[i] = hn::Mul(hn::Add(low, high), half);
      own_half[i] = hn::Mul(hn::Sub(high, low), half);
      if (kNodeOfA) own_half[i] = hn::Sub(own_half[i], hn::Set(d, query.shrunk));
    }
    std::array<Vec, 3> apart, half_a, half_b;  // from the centre of b's box to that of a's
    for (std::size_t i = 0; i < 3; ++i) {
      apart[i] = hn::Set(d, start[i]);
      if (kNodeOfA)
        for (std::size_t j = 0; j < 3; ++j) apart[i] = hn::MulAdd(hn::Set(d, query.turn[i][j]), place[j], apart[i]);
      else
        apart[i] = hn::Sub(apart[i], place[i]);
      half_a[i] = kNodeOfA ? own_half[i] : hn::Set(d, other_half[i]);
      half_b[i] = kNodeOfA ? hn::Set(d, other_half[i]) : own_half[i];
    }
    auto margin = hn::Set(d, -1e30F);
    for (std::size_t j = 0; j < 3; ++j) {
      auto m = hn::Sub(hn::Abs(apart[j]), half_b[j]);
      for (std::size_t i = 0; i < 3; ++i) m = hn::NegMulAdd(hn::Set(d, query.reach[j][i]), half_a[i], m);
      margin = hn::Max(margin, m);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      auto along = hn::Mul(hn::Set(d, query.turn[0][i]), apart[0]);
      along = hn::MulAdd(hn::Set(d, query.turn[1][i]), apart[1], along);
      along = hn::MulAdd(hn::Set(d, query.turn[2][i]), apart[2], along);
      auto m = hn::Sub(hn::Abs(along), half_a[i]);
      for (std::size_t j = 0; j < 3; ++j) m = hn::NegMulAdd(hn::Set(d, query.reach[j][i]), half_b[j], m);
      margin = hn::Max(margin, m);
    }
    auto gone = hn::Gt(margin, band);
    if (planes) {
      auto gap = hn::Set(d, -other_reach);
      // What has no bounds for its children has its own plane for them all.
      const bool each = node.bounds != nullptr;
      auto bound =
          each ? hn::Mul(hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(d16, &bounds.reach[lane]))), hn::Set(d, unit))
               : hn::Set(d, node.reach);
      for (std::size_t i = 0; i < 3; ++i) {
        const auto own = each ? hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(signed8, &bounds.normal[i][lane])))
                              : hn::Set(d, node.normal[i]);
        const auto sum = hn::Add(own, hn::Set(d, other_normal[i]));
        gap = hn::MulAdd(sum, place[i], gap);
        gap = hn::NegMulAdd(hn::Abs(sum), own_half[i], gap);
        if (kNodeOfA) bound = hn::NegMulAdd(hn::Abs(own), hn::Set(d, query.shrunk), bound);
      }
      gone = hn::Or(gone, hn::Gt(hn::Sub(gap, bound), hn::Mul(band, hn::Set(d, 256.0F))));
    }
    if (!hn::AllTrue(d, gone)) {
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i) {
          const CrossedAxis& axis = query.crossed[j][i];
          const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3, i1 = (i + 1) % 3, i2 = (i + 2) % 3;
          const auto along =
              hn::MulAdd(hn::Set(d, axis.axis[0]), apart[j1], hn::Mul(hn::Set(d, axis.axis[1]), apart[j2]));
          auto m = hn::NegMulAdd(hn::Set(d, axis.of_b[0]), half_b[j1], hn::Abs(along));
          m = hn::NegMulAdd(hn::Set(d, axis.of_b[1]), half_b[j2], m);
          m = hn::NegMulAdd(hn::Set(d, axis.of_a[0]), half_a[i1], m);
          m = hn::NegMulAdd(hn::Set(d, axis.of_a[1]), half_a[i2], m);
          margin = hn::Max(margin, m);
        }
      gone = hn::Or(gone, hn::Gt(margin, band));
    }
    std::array<std::uint8_t, 8> bits{};
    hn::StoreMaskBits(d, hn::Not(gone), bits.data());
    stay |= static_cast<unsigned>(bits[0]) << lane;
    hn::StoreU(margin, d, &row.margin[lane]);
  }
  return stay & node.filled();
}

HWY_ATTR bool meet(const Query& query, const ContactNode& in_a, const ContactNode& in_b) {
  const bool splits_a = in_a.level > 0 && (!in_a.black || query.voxelised), splits_b = !in_b.black;
  const bool of_a = splits_a && (!splits_b || in_a.level >= in_b.level);
  Row row;
  unsigned stay = of_a ? survivors<true>(query, in_a, in_b, row) : survivors<false>(query, in_b, in_a, row);
  const ContactNode& node = of_a ? in_a : in_b;
  const ContactNode& other = of_a ? in_b : in_a;
  while (stay != 0) {
    // The deepest one first.
    auto next = static_cast<std::size_t>(std::countr_zero(stay));
    for (unsigned rest = stay & (stay - 1); rest != 0; rest &= rest - 1) {
      const auto octant = static_cast<std::size_t>(std::countr_zero(rest));
      if (row.margin[octant] < row.margin[next]) next = octant;
    }
    stay &= ~(1u << next);
    const ContactNode child = (of_a ? query.a : query.b).child(node, static_cast<int>(next));
    const ContactNode& below_a = of_a ? child : other;
    const ContactNode& below_b = of_a ? other : child;
    if (below_a.black && below_b.black && (!query.voxelised || below_a.level == 0)) {
      if (query.hit(below_a, below_b)) return true;
      continue;
    }
    // Nearly touching: as faces of voxels do, over whole areas.
    if (!query.voxelised && row.margin[next] > -row.band &&
        query.exact.apart({below_a.low, below_a.high}, {below_b.low, below_b.high}))
      continue;
    if (meet(query, below_a, below_b)) return true;
  }
  return false;
}

bool meet_roots(const Query& query) {
  const ContactNode &a = query.a.root(), &b = query.b.root();
  if (a.black && b.black && !query.voxelised) return query.hit(a, b);
  return meet(query, a, b);
}

}  // namespace blackleaf::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blackleaf {
namespace detail {
namespace {

HWY_EXPORT(meet_roots);

}  // namespace
}  // namespace detail

namespace {

bool meet(const detail::ContactNodes& a, const detail::ContactNodes& b, const Motion& motion_of_b, Meaning meaning) {
  if (a.is_empty() || b.is_empty() || motion_of_b.translation().norm() > FixedMotion::kMaxTranslation) return false;
  return HWY_DYNAMIC_DISPATCH(detail::meet_roots)(detail::Query(a, b, FixedMotion(motion_of_b), meaning));
}

}  // namespace

bool interferes(const Octree& a, const Octree& b, const Motion& motion_of_b, Meaning meaning) {
  detail::require_same_depth(a, b);
  return meet(detail::ContactNodes(a), detail::ContactNodes(b), motion_of_b, meaning);
}

bool interferes(const PreparedSolid& a, const PreparedSolid& b, const Motion& motion_of_b, Meaning meaning) {
  detail::require_same_depth(a.octree(), b.octree());
  return meet(detail::ContactNodes(a), detail::ContactNodes(b), motion_of_b, meaning);
}

}  // namespace blackleaf
#endif  // HWY_ONCE
