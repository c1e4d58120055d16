// Feature edges: where the solid's boundary is not flat.
//
// A lattice edge has four voxels around it, A = (b, c), B = (b-1, c), C = (b, c-1), D = (b-1, c-1) in the plane of the
// other two axes. The boundary is flat there, or absent, iff A = B and C = D, or A = C and B = D; every other edge is a
// feature edge. Those that can add nothing to the picture are dropped at once:
//
//   general   the voxel that the rays enter first is black: they are blocked from there on.
//   in_plane  one of the two voxels that the rays run between first is black. If both are, the rays are blocked. If one
//             is, a free ray leaves the last such place, towards two white voxels, through a lattice edge; of the four
//             voxels there just one is black, so it is a feature edge, it is visible, and it has the same picture.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "edge_family.h"
#include "octree/brick.h"
#include "octree/corner_walk.h"

namespace blackleaf::detail {

/// Voxels whose lower, upper coordinate bit along an axis is 0.
struct AxisMasks {
  std::uint64_t even = 0, lower_half = 0;
};
inline constexpr std::array<AxisMasks, 3> kAxisMasks = [] {
  std::array<AxisMasks, 3> masks{};
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned bit = 0; bit < 64; ++bit) {
      masks[axis].even |= std::uint64_t{!(bit >> axis & 1)} << bit;
      masks[axis].lower_half |= std::uint64_t{!(bit >> (axis + 3) & 1)} << bit;
    }
  return masks;
}();

/// The brick moved up by one voxel along an axis: coordinate k gets the bit of k - 1, coordinate 0 that of coordinate 3
/// of the next lower brick. In the index, +1 and +2 along the axis are the distances 2^axis and 8 * 2^axis.
constexpr std::uint64_t moved_up(std::uint64_t brick, std::uint64_t lower, unsigned axis) {
  const AxisMasks& m = kAxisMasks[axis];
  const unsigned one = 1u << axis, two = 8u << axis;
  return (brick & m.even) << one | (brick & ~m.even & m.lower_half) << (two - one) |
         (lower & ~m.even & ~m.lower_half) >> (two + one);
}

/// Bits of the edges that may be visible, from the bits of the voxels around them (64 edges at a time, or more).
/// Requires: the family is not end_on.
template <class Bits>
constexpr Bits candidates(const EdgeFamily& family, Bits A, Bits B, Bits C, Bits D) {
  const Bits feature = ((A ^ B) | (C ^ D)) & ((A ^ C) | (B ^ D));
  if (family.mode == EdgeFamily::Mode::in_plane) return feature & ~(family.d_c > 0 ? A | B : C | D);
  return feature & ~(family.d_b > 0 ? (family.d_c > 0 ? A : C) : (family.d_c > 0 ? B : D));
}

/// Which feature edges are wanted.
enum class EdgeChoice {
  candidates,           // those that can add something to the picture of this solid alone
  not_blocked_at_once,  // those that this solid does not hide from the first step on
  all,
};

/// Bits of the edges of a choice. Beside another solid, whose lines have another pen, an edge along whose rays there is
/// black on one side only is wanted too.
constexpr std::uint64_t chosen(EdgeChoice choice, const EdgeFamily& family, std::uint64_t A, std::uint64_t B,
                               std::uint64_t C, std::uint64_t D) {
  if (choice == EdgeChoice::candidates) return candidates(family, A, B, C, D);
  const std::uint64_t feature = ((A ^ B) | (C ^ D)) & ((A ^ C) | (B ^ D));
  if (choice == EdgeChoice::all) return feature;
  if (family.mode == EdgeFamily::Mode::in_plane) return feature & ~(family.d_c > 0 ? A & B : C & D);
  return candidates(family, A, B, C, D);
}

/// Calls sink(first, end) for the runs of a brick's edges along an axis: from corner `first` to coordinate `end`.
template <class Sink>
void for_each_run(unsigned axis, const Cube& cube, std::uint64_t edges, const Sink& sink) {
  if (edges == 0) return;
  const std::array<std::int32_t, 3> corner = {cube.x, cube.y, cube.z};
  for (std::uint64_t starts = edges & ~moved_up(edges, 0, axis); starts; starts &= starts - 1) {
    const auto bit = static_cast<unsigned>(std::countr_zero(starts));
    const std::array<unsigned, 3> at = {brick_x(bit), brick_y(bit), brick_z(bit)};
    const unsigned line = bit & ~(9u << axis);  // the line's edge with coordinate 0
    unsigned end = at[axis] + 1;
    while (end < 4 && (edges >> (line | unsigned{kSpread[end]} << axis) & 1)) ++end;
    std::array<std::int32_t, 3> first{};
    for (unsigned i = 0; i < 3; ++i) first[i] = corner[i] + static_cast<std::int32_t>(at[i]);
    sink(first, corner[axis] + static_cast<std::int32_t>(end));
  }
}

/// Visitor for corner_walk. Calls sink(family index, a0, a1, b, c) for runs [a0, a1] of the chosen edges, each edge
/// once; not for edges seen end-on. If the sink has enter(cube), it is asked before each cube whether to go in.
template <class Sink>
class FeatureEdges {
 public:
  FeatureEdges(const std::array<EdgeFamily, 3>& families, Sink& sink, EdgeChoice choice = EdgeChoice::candidates)
      : families_(families), sink_(sink), choice_(choice) {}

  bool enter(const Cube& cube) {
    if constexpr (requires { sink_.enter(cube); }) return sink_.enter(cube);
    return true;
  }

  void uniform(const Cube& cube, const Around& around) {
    const std::array<std::int32_t, 3> corner = {cube.x, cube.y, cube.z};
    const auto bits = [&](unsigned i) { return around[i].is_black() ? ~std::uint64_t{0} : 0; };
    for (unsigned axis = 0; axis < 3; ++axis) {
      const EdgeFamily& f = families_[axis];
      if (f.mode == EdgeFamily::Mode::end_on) continue;
      const unsigned b = 1u << f.b, c = 1u << f.c;
      if (chosen(choice_, f, bits(7), bits(7 - b), bits(7 - c), bits(7 - b - c)))
        sink_(axis, corner[f.a], corner[f.a] + cube.side(), corner[f.b], corner[f.c]);
    }
  }

  void bricks(const Cube& cube, const Around& around) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const EdgeFamily& f = families_[axis];
      if (f.mode == EdgeFamily::Mode::end_on) continue;
      const unsigned b = 1u << f.b, c = 1u << f.c;
      const std::uint64_t A = around[7].brick(), low_c = around[7 - c].brick();
      const std::uint64_t B = moved_up(A, around[7 - b].brick(), f.b);
      const std::uint64_t C = moved_up(A, low_c, f.c);
      const std::uint64_t D = moved_up(B, moved_up(low_c, around[7 - b - c].brick(), f.b), f.c);
      const std::uint64_t edges = chosen(choice_, f, A, B, C, D);
      for_each_run(axis, cube, edges, [&](const std::array<std::int32_t, 3>& first, std::int32_t end) {
        sink_(axis, first[f.a], end, first[f.b], first[f.c]);
      });
    }
  }

 private:
  const std::array<EdgeFamily, 3>& families_;
  Sink& sink_;
  EdgeChoice choice_;
};

}  // namespace blackleaf::detail
