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
//   m = |distance of the corners|_1 + 4 (side of a + side of b) >= 8
// and every margin is the result of fewer than 32 roundings of numbers below m (below 222 m for planes, |n|_1 < 222),
// so it is off by less than 2^-19 m (2^-11 m); the edges' not being of length 1, or not at right angles, costs 2^-36 m,
// and the corners' distance 2^-21 < 2^-19 m.
// What is nearer than that stays. Nothing is ever decided to interfere in floating point: a pair of black cubes that
// stays is decided in integers (exact_boxes.h), and so are pairs whose boxes nearly touch.
//
// The voxelised meaning asks whether a voxel centre of a lies in the closed solid of b. That is the same descent with
// a's boxes and planes half a voxel smaller, down to single voxels.
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "blackleaf/contact.h"
#include "contact_node.h"
#include "exact_boxes.h"
#include "octree/parallel.h"
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
        voxelised(meaning == Meaning::voxelised),
        shrunk(voxelised ? 0.5F : 0.0F) {
    const auto& c = placement.turn();
    for (std::size_t octant = 0; octant < 8; ++octant)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i) octants[octant][j] += (octant >> i & 1) != 0 ? c[j][i] : 0;
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i) {
        turn[j][i] = static_cast<float>(c[j][i]);
        reach[j][i] = std::abs(turn[j][i]);
        const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3, i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        const double length = std::sqrt(c[j1][i] * c[j1][i] + c[j2][i] * c[j2][i]);
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

  // True iff two black nodes interfere; voxelised, the first one is a voxel.
  bool hit(const ContactNode& in_a, const ContactNode& in_b) const {
    if (!voxelised) return !apart(in_a, in_b);
    const Placement::Point centre =
        placement.moved({2 * in_a.corner[0] + 1, 2 * in_a.corner[1] + 1, 2 * in_a.corner[2] + 1});
    for (std::size_t i = 0; i < 3; ++i) {
      constexpr int kBits = FixedMotion::kFractionBits + 1;
      if (centre[i] < std::int64_t{in_b.corner[i]} << kBits || centre[i] > std::int64_t{in_b.corner[i] + in_b.side()}
                                                                               << kBits)
        return false;
    }
    return true;
  }

  // True iff the interiors of the boxes of two nodes are disjoint.
  bool apart(const ContactNode& in_a, const ContactNode& in_b) const {
    if (!exact) exact.emplace(placement.motion());
    return exact->apart(in_a.box(), in_b.box());
  }

  const ContactNodes &a, &b;
  Placement placement;
  bool voxelised;
  float shrunk;                                       // what a's boxes lose on every side
  std::array<std::array<float, 3>, 3> turn, reach;    // A / 2^38 and its absolute values, rows
  std::array<std::array<CrossedAxis, 3>, 3> crossed;  // [edge of b][edge of a]
  std::array<std::array<double, 3>, 8> octants{};     // from a node of a to its octants, the child's side being 1
  mutable std::optional<ExactBoxes> exact;            // made when first needed
};

}  // namespace
}  // namespace blackleaf::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace blackleaf::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 8>;
using Vec = hn::Vec<Lanes>;

/// From the corner of b's node to that of a's, in b's frame. Made by less than 64 additions of numbers below 2^25, so
/// off by less than 2^-21 voxels at depth 20.
using Offset = std::array<double, 3>;

struct Row {
  ChildBoxes boxes;
  HWY_ALIGN std::array<float, 8> margin;  // how far apart a child is at least
  float band;                             // how wrong that may be
};

// The children of a node that are not certain to be apart from a node of the other tree, as a mask.
template <bool kNodeOfA>
HWY_ATTR unsigned survivors(const Query& query, const ContactNode& node, const ContactNode& other, const Offset& offset,
                            Row& row) {
  const Lanes d;
  const hn::Rebind<std::uint8_t, Lanes> d8;
  const hn::Rebind<std::int8_t, Lanes> signed8;
  const hn::Rebind<std::int16_t, Lanes> d16;
  const hn::Rebind<std::int32_t, Lanes> d32;
  // From the other's place to the node's corner, and the other's plane, n.x <= reach, with x from the node's corner on
  // the node's axes.
  std::array<float, 3> from, start, normal{};
  for (std::size_t i = 0; i < 3; ++i) from[i] = static_cast<float>(offset[i]);
  float reach = other.reach;
  for (std::size_t i = 0; i < 3; ++i) {
    start[i] = from[i];
    if (kNodeOfA) {
      start[i] -= other.place[i];
      for (std::size_t j = 0; j < 3; ++j) normal[i] += query.turn[j][i] * other.normal[j];
      reach -= other.normal[i] * from[i];
    } else {
      for (std::size_t j = 0; j < 3; ++j) start[i] += query.turn[i][j] * other.place[j];
      for (std::size_t j = 0; j < 3; ++j) normal[i] += query.turn[i][j] * other.normal[j];
      reach += normal[i] * from[i] - query.shrunk * std::abs(other.normal[i]);
    }
  }
  const float size =
      std::abs(from[0]) + std::abs(from[1]) + std::abs(from[2]) + 4 * static_cast<float>(node.side() + other.side());
  row.band = size * 0x1p-18F;
  const ChildBounds& bounds = node.child_bounds();
  const auto unit = static_cast<float>(ChildBounds::unit(node.level));
  const unsigned filled = node.filled();
  const auto band = hn::Set(d, row.band), scale = hn::Set(d, 0.5F * unit);
  unsigned stay = 0;
  for (std::size_t lane = 0; lane < 8; lane += hn::Lanes(d)) {
    std::array<Vec, 3> place, own_half;  // of the children, from the node's corner
    for (std::size_t i = 0; i < 3; ++i) {
      const auto low = hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(d8, &bounds.low[i][lane])));
      const auto high = hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(d8, &bounds.high[i][lane])));
      place[i] = hn::Mul(hn::Add(low, high), scale);
      own_half[i] = hn::Mul(hn::Sub(high, low), scale);
      hn::Store(place[i], d, &row.boxes.place[i][lane]);
      hn::Store(own_half[i], d, &row.boxes.half[i][lane]);
      if (kNodeOfA) own_half[i] = hn::Sub(own_half[i], hn::Set(d, query.shrunk));
    }
    // What has no bounds for its children has its own plane for them all.
    auto gap = hn::Set(d, -reach);
    auto own_reach = hn::Set(d, node.reach);
    if (node.bounds != nullptr)
      own_reach = hn::Mul(hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(d16, &bounds.reach[lane]))), hn::Set(d, unit));
    hn::Store(own_reach, d, &row.boxes.reach[lane]);
    for (std::size_t i = 0; i < 3; ++i) {
      auto own = hn::Set(d, node.normal[i]);
      if (node.bounds != nullptr)
        own = hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(signed8, &bounds.normal[i][lane])));
      hn::Store(own, d, &row.boxes.normal[i][lane]);
      const auto sum = hn::Add(own, hn::Set(d, normal[i]));
      gap = hn::MulAdd(sum, place[i], gap);
      gap = hn::NegMulAdd(hn::Abs(sum), own_half[i], gap);
      if (kNodeOfA) gap = hn::MulAdd(hn::Abs(own), hn::Set(d, query.shrunk), gap);
    }
    auto gone = hn::Gt(hn::Sub(gap, own_reach), hn::Mul(band, hn::Set(d, 256.0F)));

    std::array<Vec, 3> apart, half_a, half_b;  // from the centre of b's box to that of a's
    for (std::size_t i = 0; i < 3; ++i) {
      apart[i] = hn::Set(d, start[i]);
      if (kNodeOfA)
        for (std::size_t j = 0; j < 3; ++j) apart[i] = hn::MulAdd(hn::Set(d, query.turn[i][j]), place[j], apart[i]);
      else
        apart[i] = hn::Sub(apart[i], place[i]);
      half_a[i] = kNodeOfA ? own_half[i] : hn::Set(d, other.half[i] - query.shrunk);
      half_b[i] = kNodeOfA ? hn::Set(d, other.half[i]) : own_half[i];
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
    gone = hn::Or(gone, hn::Gt(margin, band));
    const auto left = [&]() HWY_ATTR {
      std::array<std::uint8_t, 8> bits{};
      hn::StoreMaskBits(d, gone, bits.data());
      return filled & ~(static_cast<unsigned>(bits[0]) << lane) & (((1u << hn::Lanes(d)) - 1) << lane);
    };
    unsigned these = left();
    if (these != 0) {
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
      these = left();
    }
    stay |= these;
    hn::Store(margin, d, &row.margin[lane]);
  }
  return stay;
}

HWY_ATTR bool meet(const Query& query, const ContactNode& in_a, const ContactNode& in_b, const Offset& offset) {
  const bool splits_a = in_a.level > 0 && (!in_a.black || query.voxelised), splits_b = !in_b.black;
  const bool of_a = splits_a && (!splits_b || in_a.level >= in_b.level);
  Row row;
  unsigned stay =
      of_a ? survivors<true>(query, in_a, in_b, offset, row) : survivors<false>(query, in_b, in_a, offset, row);
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
    const ContactNode child = (of_a ? query.a : query.b).child(node, row.boxes, next);
    const ContactNode& below_a = of_a ? child : other;
    const ContactNode& below_b = of_a ? other : child;
    if (below_a.black && below_b.black && (!query.voxelised || below_a.level == 0)) {
      if (query.hit(below_a, below_b)) return true;
      continue;
    }
    // Nearly touching: as faces of voxels do, over whole areas.
    if (!query.voxelised && row.margin[next] > -row.band && query.apart(below_a, below_b)) continue;
    Offset below = offset;
    for (std::size_t i = 0; i < 3; ++i)
      below[i] += of_a ? query.octants[next][i] * child.side() : (next >> i & 1) != 0 ? -child.side() : 0;
    if (meet(query, below_a, below_b, below)) return true;
  }
  return false;
}

bool meet_roots(const Query& query) {
  const ContactNode &a = query.a.root(), &b = query.b.root();
  if (a.black && b.black && !query.voxelised) return query.hit(a, b);
  return meet(query, a, b, query.placement.shift());
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

std::vector<bool> interferes(const PreparedSolid& a, const PreparedSolid& b, std::span<const Motion> motions_of_b,
                             Meaning meaning, const Work& work) {
  detail::require_same_depth(a.octree(), b.octree());
  const detail::ContactNodes nodes_a(a), nodes_b(b);
  std::vector<std::uint8_t> answers(motions_of_b.size());
  constexpr std::size_t kAtOnce = 64;  // a hundred microseconds or more
  detail::for_each_index((answers.size() + kAtOnce - 1) / kAtOnce, work, [&](std::size_t part) {
    const std::size_t end = std::min(answers.size(), (part + 1) * kAtOnce);
    for (std::size_t i = part * kAtOnce; i < end; ++i)
      answers[i] = meet(nodes_a, nodes_b, motions_of_b[i], meaning) ? 1 : 0;
  });
  return {answers.begin(), answers.end()};
}

}  // namespace blackleaf
#endif  // HWY_ONCE
