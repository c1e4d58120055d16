// EyeEdges: feature edges that an eye may see. FeatureEdges for perspective.
//
// Which voxel the ways to the eye enter first differs from edge to edge: they go up along axis b from edges below the
// eye and down from those above. With U_b, D_b the edges with b <= e_b, b >= e_b, and A, B, C, D the voxels around an
// edge as in feature_edges.h, what enters a black voxel first, or may be left out because it runs along one, is
//
//   U_b U_c A | D_b U_c B | U_b D_c C | D_b D_c D.
//
// For edges level with the eye (in both U_b and D_b) these are both voxels that the ways run between; and edges in one
// line with it always go. That edges along which a way runs with a black voxel at one side may be left out needs, as in
// parallel projection, that the way leaves the last such place toward white; so the eye must not be on the solid.
#pragma once

#include <array>
#include <cstdint>

#include "eye_lines.h"
#include "feature_edges.h"
#include "octree/brick.h"
#include "octree/corner_walk.h"

namespace blackleaf::detail {

/// Visitor for corner_walk. Calls sink(axis, a0, a1, b, c) for runs [a0, a1] of the chosen edges along `axis`, at
/// coordinates b and c along the axes axis + 1 and axis + 2 modulo 3, each edge once; for edges in one line with the
/// eye too, unless candidates are chosen. Requires: the eye, in units of 2^-16 voxel, is not in the closed solid.
template <class Sink>
class EyeEdges {
 public:
  EyeEdges(const std::array<std::int64_t, 3>& eye, Sink& sink, EdgeChoice choice = EdgeChoice::candidates)
      : sink_(sink), choice_(choice) {
    for (std::size_t i = 0; i < 3; ++i) {
      floor_[i] = eye[i] >> Perspective::kGridBits;
      ceiling_[i] = -(-eye[i] >> Perspective::kGridBits);
    }
  }

  void uniform(const Cube& cube, const Around& around) {
    const std::array<std::int32_t, 3> corner = {cube.x, cube.y, cube.z};
    const auto all_or_none = [](bool bit) { return bit ? ~std::uint64_t{0} : 0; };
    const auto bits = [&](unsigned i) { return all_or_none(around[i].is_black()); };
    const auto ways = [&](unsigned axis) {
      return Ways{all_or_none(corner[axis] <= floor_[axis]), all_or_none(corner[axis] >= ceiling_[axis])};
    };
    for (unsigned a = 0; a < 3; ++a) {
      const unsigned b = (a + 1) % 3, c = (a + 2) % 3, bit_b = 1u << b, bit_c = 1u << c;
      if (chosen(ways(b), ways(c), bits(7), bits(7 - bit_b), bits(7 - bit_c), bits(7 - bit_b - bit_c)))
        sink_(a, corner[a], corner[a] + cube.side(), corner[b], corner[c]);
    }
  }

  void bricks(const Cube& cube, const Around& around) {
    const std::array<std::int32_t, 3> corner = {cube.x, cube.y, cube.z};
    std::array<Ways, 3> ways{};
    for (unsigned axis = 0; axis < 3; ++axis)
      ways[axis] = {below(axis, floor_[axis] + 1 - corner[axis]), ~below(axis, ceiling_[axis] - corner[axis])};
    for (unsigned a = 0; a < 3; ++a) {
      const unsigned b = (a + 1) % 3, c = (a + 2) % 3, bit_b = 1u << b, bit_c = 1u << c;
      const std::uint64_t A = around[7].brick(), low_c = around[7 - bit_c].brick();
      const std::uint64_t B = moved_up(A, around[7 - bit_b].brick(), b);
      const std::uint64_t C = moved_up(A, low_c, c);
      const std::uint64_t D = moved_up(B, moved_up(low_c, around[7 - bit_b - bit_c].brick(), b), c);
      for_each_run(a, cube, chosen(ways[b], ways[c], A, B, C, D),
                   [&](const std::array<std::int32_t, 3>& first, std::int32_t end) {
                     sink_(a, first[a], end, first[b], first[c]);
                   });
    }
  }

 private:
  // Edges from which the way to the eye does not go down, does not go up along an axis.
  struct Ways {
    std::uint64_t up, down;
  };

  std::uint64_t chosen(const Ways& b, const Ways& c, std::uint64_t A, std::uint64_t B, std::uint64_t C,
                       std::uint64_t D) const {
    const std::uint64_t feature = ((A ^ B) | (C ^ D)) & ((A ^ C) | (B ^ D));
    if (choice_ == EdgeChoice::all) return feature;
    const std::uint64_t at_a_black = (c.up & ((b.up & A) | (b.down & B))) | (c.down & ((b.up & C) | (b.down & D)));
    if (choice_ == EdgeChoice::candidates) return feature & ~at_a_black;
    // Level with the eye it takes two of them to block.
    const std::uint64_t level_b = b.up & b.down, level_c = c.up & c.down;
    const std::uint64_t between =
        (level_b & ((c.up & A & B) | (c.down & C & D))) | (level_c & ((b.up & A & C) | (b.down & B & D)));
    return feature & ~(level_b | level_c ? (at_a_black & ~(level_b | level_c)) | between : at_a_black);
  }

  // Bits of a brick with a coordinate below `count` along an axis.
  static std::uint64_t below(unsigned axis, std::int64_t count) {
    if (count <= 0) return 0;
    if (count >= 4) return ~std::uint64_t{0};
    const AxisMasks& m = kAxisMasks[axis];
    return count == 1 ? m.even & m.lower_half : count == 2 ? m.lower_half : m.lower_half | m.even;
  }

  std::array<std::int64_t, 3> floor_{}, ceiling_{};  // the eye in voxels
  Sink& sink_;
  EdgeChoice choice_;
};

}  // namespace blackleaf::detail
