// NearField: what the nearest voxels hide of the edges of 16^3 corners, many at a time.
//
// Of the voxels about the cube 32^3, more of them on the side that rays go to, are laid out in rows of 32 bits. The
// voxels that a look (near_looks.h) asks of all edges of a family are then a step away, the same for all: along y and z
// of the address, along x of the bits.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>

#include "near_blocks.h"
#include "near_kernel.h"
#include "near_looks.h"
#include "vicinity.h"

namespace blackleaf::detail {

/// Corners of a near field: an aligned cube, of side 4 at least.
struct CornerCube {
  unsigned x, y, z, side;

  /// A bit for each of its bricks: of 4^3, x fastest.
  std::uint64_t bricks() const {
    const std::uint64_t row = side == 16 ? 0xF : side == 8 ? 0x3 : 0x1;
    const std::uint64_t layer = side == 16 ? row * 0x1111 : side == 8 ? row * 0x11 : row;
    const std::uint64_t all = side == 16 ? layer * 0x0001'0001'0001'0001 : side == 8 ? layer * 0x0001'0001 : layer;
    return all << (x / 4 + y + 4 * z);
  }

  CornerCube child(unsigned octant) const {
    const unsigned half = side / 2;
    return {x + (octant & 1) * half, y + (octant >> 1 & 1) * half, z + (octant >> 2) * half, half};
  }
};

/// Edges of one family that begin at the corners of a near field.
class NearEdges {
 public:
  static constexpr unsigned kSide = 16;
  using Corner = std::array<unsigned, 3>;

  void clear() {
    if (bricks_ == 0) return;
    rows_ = {};
    bricks_ = 0;
  }
  /// Sixteen layers along z of 16 rows of 32 bits along y; whoever has written to them calls written().
  std::uint32_t* rows() { return rows_[0].data(); }
  void written() {
    bricks_ = 0;
    for (unsigned layer = 0; layer < 4; ++layer)
      for (unsigned quad = 0; quad < 4; ++quad) {
        std::uint64_t rows = 0;
        for (unsigned z = 4 * layer; z < 4 * layer + 4; ++z) rows |= two_rows(z, 2 * quad) | two_rows(z, 2 * quad + 1);
        if (rows == 0) continue;
        rows |= rows >> 32;
        rows |= rows >> 1;
        rows |= rows >> 2;
        const std::uint64_t bricks = (rows & 1) | (rows >> 3 & 2) | (rows >> 6 & 4) | (rows >> 9 & 8);
        bricks_ |= bricks << (4 * quad + 16 * layer);
      }
  }
  /// Takes over those of a cube.
  void add(const NearEdges& edges, const CornerCube& cube) {
    bricks_ |= edges.bricks_ & cube.bricks();
    edges.for_each_pair(cube, [&](unsigned z, unsigned pair, std::uint64_t mask) {
      const std::uint64_t both = two_rows(z, pair) | (edges.two_rows(z, pair) & mask);
      std::memcpy(&rows_[z][2 * pair], &both, sizeof(both));
    });
  }
  bool any() const { return bricks_ != 0; }
  /// Whether a cube has any.
  bool any(const CornerCube& cube) const { return (bricks_ & cube.bricks()) != 0; }
  /// Calls sink(corner) for every edge of a cube.
  template <class Sink>
  void for_each(const CornerCube& cube, const Sink& sink) const {
    for_each_pair(cube, [&](unsigned z, unsigned pair, std::uint64_t mask) {
      for (std::uint64_t left = two_rows(z, pair) & mask; left; left &= left - 1) sink(corner(z, pair, left));
    });
  }

  /// Calls sink(corner, count) for the runs of a cube's edges along an axis: from that corner on, `count` edges.
  template <class Sink>
  void for_each_run(unsigned axis, const CornerCube& cube, const Sink& sink) const {
    axis == 0 ? runs<0>(cube, sink) : axis == 1 ? runs<1>(cube, sink) : runs<2>(cube, sink);
  }

 private:
  std::uint64_t two_rows(unsigned z, unsigned pair) const {
    static_assert(std::endian::native == std::endian::little);
    std::uint64_t both;
    std::memcpy(&both, &rows_[z][2 * pair], sizeof(both));
    return both;
  }

  template <unsigned kAxis, class Sink>
  void runs(const CornerCube& cube, const Sink& sink) const {
    for_each_pair(cube, [&](unsigned z, unsigned pair, std::uint64_t mask) {
      const std::uint64_t word = two_rows(z, pair);
      std::uint64_t before;  // those that follow on others
      if constexpr (kAxis == 0)
        before = (word & mask) << 1;
      else if constexpr (kAxis == 1)
        before = word << 32 | (2 * pair > cube.y ? two_rows(z, pair - 1) >> 32 : 0);
      else
        before = z > cube.z ? two_rows(z - 1, pair) : 0;
      for (std::uint64_t starts = word & mask & ~before; starts; starts &= starts - 1) {
        const Corner first = corner(z, pair, starts);
        const auto has = [&](unsigned at_y, unsigned at_z) { return rows_[at_z][at_y] >> first[0] & 1; };
        unsigned count = 1;
        if constexpr (kAxis == 0)
          count = static_cast<unsigned>(std::countr_one((word & mask) >> std::countr_zero(starts)));
        else if constexpr (kAxis == 1)
          while (first[1] + count < cube.y + cube.side && has(first[1] + count, z)) ++count;
        else
          while (z + count < cube.z + cube.side && has(first[1], z + count)) ++count;
        sink(first, count);
      }
    });
  }
  // Calls visit(z, pair of rows, mask) for a cube's bricks that have edges.
  template <class Visit>
  void for_each_pair(const CornerCube& cube, const Visit& visit) const {
    const std::uint64_t row = ((std::uint64_t{1} << cube.side) - 1) << cube.x, mask = row | row << 32;
    for (std::uint64_t left = bricks_ & cube.bricks(); left;) {
      const auto first = static_cast<unsigned>(std::countr_zero(left)) & ~3u;  // of up to four along x
      left &= ~(std::uint64_t{0xF} << first);
      for (unsigned z = first / 16 * 4; z < first / 16 * 4 + 4; ++z)
        for (unsigned pair = first / 4 % 4 * 2; pair < first / 4 % 4 * 2 + 2; ++pair) visit(z, pair, mask);
    }
  }
  static Corner corner(unsigned z, unsigned pair, std::uint64_t bits) {
    const auto bit = static_cast<unsigned>(std::countr_zero(bits));
    return {bit & 31, 2 * pair + (bit >> 5), z};
  }

  std::array<std::array<std::uint32_t, kSide>, kSide> rows_{};
  std::uint64_t bricks_ = 0;  // of corners, those with edges
};

class NearField {
 public:
  static constexpr int kLevel = 4;  // of the cube

  struct Found {
    NearEdges clear;   // none of the looks meets a black voxel
    NearEdges partly;  // some do, but none, and no two, hide all of the edge
    NearMet met;       // what meets black for some of the latter
  };

  /// The voxels about a cube, until the blocks make room. Requires: level 4; the direction is that of the families;
  /// blocks of the same tree.
  NearField(const Vicinity& vicinity, const Direction& d, NearBlocks& blocks) {
    static_assert(kNearReach == 12);
    static_assert(kSpareRows == 4 && kRows == 32 + 2 * kSpareRows);
    blocks.make_room();
    for (std::size_t i = 0; i < blocks_.size(); ++i) blocks_[i] = &blocks.block(vicinity.nodes()[i]);
    for (std::size_t i = 0; i < blocks_.size(); i += 3)
      if (const auto& nodes = vicinity.nodes();
          nodes[i].is_white() && nodes[i + 1].is_white() && nodes[i + 2].is_white())
        white_ |= 1u << i;
    for (std::size_t i = 0; i < 3; ++i) below_[i] = voxels_below(d[i]);
  }

  /// Finds the edges that may be visible (feature_edges.h), by family; whether there are any. All are `partly` clear.
  bool begin(const std::array<EdgeFamily, 3>& families, std::array<Found, 3>& found) {
    lay_out_part(true);
    std::array<EdgeRows, 3> edges{};
    for (unsigned axis = 0; axis < 3; ++axis) {
      found[axis].clear.clear();
      found[axis].partly.clear();
      edges[axis] = found[axis].partly.rows();
    }
    there_ = candidates(families, bytes(), VoxelStep::to(below_), edges);
    return there_ != 0;
  }

  /// Sorts them out; whether any are left. Requires: begin(), which has found some; looks of all families that are not
  /// seen end-on.
  bool find(const std::array<EdgeFamily, 3>& families, const std::array<std::optional<NearLooks>, 3>& looks,
            std::array<Found, 3>& found) {
    lay_out_part(false);
    bool any = false;
    for (const EdgeFamily& family : families) {
      if (!(there_ >> family.a & 1)) continue;
      Found& of = found[family.a];
      const NearLooks& sight = *looks[family.a];
      look({family, bytes(), VoxelStep::below(family.b), sight.first(), sight.others()}, of.partly.rows(),
           of.clear.rows(), of.met);
      of.clear.written();
      of.partly.written();
      any |= of.clear.any() || of.partly.any();
    }
    return any;
  }

  /// Calls hide(look) for what meets black of a partly clear edge, in the order of the looks, until that returns true;
  /// true iff it did.
  template <class Hide>
  bool any_of(const EdgeFamily& family, const NearLooks& looks, const Found& found, const NearEdges::Corner& corner,
              const Hide& hide) const {
    const char* const from =
        bytes() + VoxelStep::to({0, static_cast<int>(corner[1]), static_cast<int>(corner[2])}).bytes;
    const VoxelStep b = VoxelStep::below(family.b);
    const auto is_black = [&](const VoxelStep& step) {
      std::uint32_t row;
      std::memcpy(&row, from + step.bytes, sizeof(row));
      return row >> (static_cast<unsigned>(step.bits) + corner[0]) & 1;
    };
    for (std::size_t k = 0; k < found.met[0].size(); ++k)
      for (std::uint64_t left = found.met[corner[2]][k]; left; left &= left - 1) {
        const NearLook& look = looks.looks()[64 * k + static_cast<unsigned>(std::countr_zero(left))];
        if (is_black(look.step) && (family.mode != EdgeFamily::Mode::in_plane || is_black(look.step + b)) && hide(look))
          return true;
      }
    return false;
  }

 private:
  // The first row that is not spare.
  const char* bytes() const { return reinterpret_cast<const char*>(&rows_[kSpareRows][kSpareRows]); }
  // Lays out, of the halves of the vicinity's nodes, the middle 3^3 along y and z or the others.
  void lay_out_part(bool middle) {
    const unsigned first_y = first(1), first_z = first(2);
    for (unsigned z = 0; z < 5; ++z)
      for (unsigned y = 0; y < 5; ++y) {
        const unsigned half_y = first_y + y, half_z = first_z + z;
        if ((half_y - 1 < 3 && half_z - 1 < 3) == middle) lay_out_row(half_y, half_z, &rows_[8 * z][8 * y]);
      }
  }
  void lay_out_row(unsigned half_y, unsigned half_z, std::uint32_t* rows) const {
    const std::size_t row = 3 * (half_y / 2) + 9 * (half_z / 2);
    if (white_ >> row & 1) {
      for (unsigned layer = 0; layer < 8; ++layer) std::memset(rows + kRows * layer, 0, 8 * sizeof(*rows));
      return;
    }
    const std::size_t within = 128 * (half_z & 1) + 8 * (half_y & 1);
    SideBySide pieces;
    for (unsigned x = 0; x < 5; ++x) {
      const unsigned half_x = first(0) + x;
      pieces[x] = (*blocks_[row + half_x / 2])[half_x & 1][0].data() + within;
    }
    lay_out(pieces, reinterpret_cast<char*>(rows));
  }
  // Of the halves of the vicinity's nodes; one begins four voxels early.
  unsigned first(std::size_t axis) const { return below_[axis] == kNearReach ? 0 : 1; }

  std::array<const NearBlock*, 27> blocks_;  // of the vicinity
  std::uint32_t white_ = 0;                  // a bit for each three of them, side by side along x, that are white
  std::array<int, 3> below_{};               // voxels below the cube
  unsigned there_ = 0;                       // a bit for each family that has edges
  std::array<std::array<std::uint32_t, kRows>, kRows> rows_;
};

}  // namespace blackleaf::detail
