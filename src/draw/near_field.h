// NearField: what the nearest voxels hide of the edges of 16^3 corners, 64 edges at a time.
//
// Of the voxels about the cube 32^3, more of them on the side that rays go to, are rows of 32 bits along x. The voxels
// that a look (near_looks.h) asks of all edges of a family are then a step away, the same for all: along y and z of the
// address, along x of the bits.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>

#include "feature_edges.h"
#include "near_looks.h"
#include "octree/brick.h"
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
  /// Bit x of lane y.
  using Lanes = std::uint32_t __attribute__((vector_size(16)));

  static bool any(const Lanes& lanes) {
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(lanes);
    return (halves[0] | halves[1]) != 0;
  }

  /// Requires: nothing has been there.
  void set(unsigned z, unsigned quad, const Lanes& lanes) {
    if (!any(lanes)) return;
    std::memcpy(&words_[z][2 * quad], &lanes, sizeof(lanes));
    std::uint32_t rows = lanes[0] | lanes[1] | lanes[2] | lanes[3];
    rows |= rows >> 1;
    rows |= rows >> 2;
    const std::uint64_t bricks = (rows & 1) | (rows >> 3 & 2) | (rows >> 6 & 4) | (rows >> 9 & 8);
    bricks_ |= bricks << (4 * quad + 16 * (z / 4));
  }
  void clear() {
    if (bricks_ == 0) return;
    words_ = {};
    bricks_ = 0;
  }
  /// Takes over those of a cube.
  void add(const NearEdges& edges, const CornerCube& cube) {
    if (!edges.any(cube)) return;
    bricks_ |= edges.bricks_ & cube.bricks();
    for_each_word(
        cube, [&](unsigned z, unsigned pair, std::uint64_t mask) { words_[z][pair] |= edges.words_[z][pair] & mask; });
  }
  bool any(const CornerCube& cube) const { return (bricks_ & cube.bricks()) != 0; }
  bool has(const Corner& at) const { return words_[at[2]][at[1] >> 1] >> (32 * (at[1] & 1) + at[0]) & 1; }

  /// Calls sink(corner) for every edge of a cube.
  template <class Sink>
  void for_each(const CornerCube& cube, const Sink& sink) const {
    if (!any(cube)) return;
    for_each_word(cube, [&](unsigned z, unsigned pair, std::uint64_t mask) {
      for (std::uint64_t left = words_[z][pair] & mask; left; left &= left - 1) sink(corner(z, pair, left));
    });
  }

  /// Calls sink(corner, count) for the runs of a cube's edges along an axis: from that corner on, `count` edges.
  template <class Sink>
  void for_each_run(unsigned axis, const CornerCube& cube, const Sink& sink) const {
    if (!any(cube)) return;
    const unsigned end = std::array{cube.x, cube.y, cube.z}[axis] + cube.side;
    for_each_word(cube, [&](unsigned z, unsigned pair, std::uint64_t mask) {
      // The edges that follow on others.
      std::uint64_t below;
      if (axis == 0)
        below = (words_[z][pair] & mask) << 1;
      else if (axis == 1)
        below = words_[z][pair] << 32 | (2 * pair > cube.y ? words_[z][pair - 1] >> 32 : 0);
      else
        below = z > cube.z ? words_[z - 1][pair] : 0;
      for (std::uint64_t starts = words_[z][pair] & mask & ~below; starts; starts &= starts - 1) {
        const Corner first = corner(z, pair, starts);
        Corner at = first;
        do {
          ++at[axis];
        } while (at[axis] < end && has(at));
        sink(first, at[axis] - first[axis]);
      }
    });
  }

 private:
  // Calls visit(z, pair, mask) for the words of a cube.
  template <class Visit>
  static void for_each_word(const CornerCube& cube, const Visit& visit) {
    const std::uint64_t row = ((std::uint64_t{1} << cube.side) - 1) << cube.x, mask = row | row << 32;
    for (unsigned z = cube.z; z < cube.z + cube.side; ++z)
      for (unsigned pair = cube.y / 2; pair < (cube.y + cube.side) / 2; ++pair) visit(z, pair, mask);
  }
  static Corner corner(unsigned z, unsigned pair, std::uint64_t bits) {
    const auto bit = static_cast<unsigned>(std::countr_zero(bits));
    return {bit & 31, 2 * pair + (bit >> 5), z};
  }

  std::array<std::array<std::uint64_t, kSide / 2>, kSide> words_{};  // two rows a word
  std::uint64_t bricks_ = 0;                                         // of corners, those with edges
};

class NearField {
 public:
  static constexpr int kLevel = 4;  // of the cube
  using Lanes = NearEdges::Lanes;

  struct Found {
    NearEdges clear;   // none of the looks meets a black voxel
    NearEdges partly;  // some do, but none, and no two, hide all of the edge
  };

  /// Takes the voxels about a cube. Requires: level 4; the direction is that of the families; `bricks` are the tree's
  /// words of level 2.
  NearField(const Vicinity& vicinity, const Direction& d, const std::uint64_t* bricks) {
    static_assert(kNearReach == 12);
    std::array<unsigned, 3> first{};  // brick, counted from 16 voxels below the cube
    for (std::size_t i = 0; i < 3; ++i) {
      below_[i] = voxels_below(d[i]);
      first[i] = 4 - static_cast<unsigned>(below_[i]) / 4;
    }
    for (unsigned z = first[2] / 2; 2 * z < first[2] + 8; ++z)
      for (unsigned y = first[1] / 2; 2 * y < first[1] + 8; ++y)
        for (unsigned x = first[0] / 2; 2 * x < first[0] + 8; ++x)
          place(vicinity.half(x, y, z), {2 * x - first[0], 2 * y - first[1], 2 * z - first[2]}, bricks);
  }

  /// The edges of a family that may be visible (feature_edges.h), sorted out.
  void find(const EdgeFamily& family, const NearLooks& looks, Found& found) const {
    family.mode == EdgeFamily::Mode::in_plane ? find<true>(family, looks, found) : find<false>(family, looks, found);
  }

  /// Whether what a look asks for is black for the edge that begins at one of the cube's corners.
  bool meets(const EdgeFamily& family, const NearLook& look, const NearEdges::Corner& corner) const {
    const char* const from =
        bytes() + VoxelStep::to({0, static_cast<int>(corner[1]), static_cast<int>(corner[2])}).bytes;
    const auto there = [&](const VoxelStep& step) {
      std::uint32_t row;
      std::memcpy(&row, from + step.bytes, sizeof(row));
      return row >> (static_cast<unsigned>(step.bits) + corner[0]) & 1;
    };
    return there(look.step) && (family.mode != EdgeFamily::Mode::in_plane || there(look.step + beside(family.b)));
  }

 private:
  using Place = std::array<unsigned, 3>;  // of a brick; wraps about below 0

  // A node of level 3, as far as it is within.
  void place(const Node& node, const Place& at, const std::uint64_t* bricks) {
    if (node.is_white()) return;
    if (node.is_black()) {
      place_black(at);
      return;
    }
    const std::uint64_t word = node.word();
    const std::uint64_t* gray = bricks + (word >> 16);
    std::array<std::uint64_t, 8> children{};
    for (std::uint64_t left = word >> 8 & 0xFF; left; left &= left - 1)
      children[static_cast<unsigned>(std::countr_zero(left))] = rows_from_brick(*gray++);
    for (std::uint64_t left = word & 0xFF; left; left &= left - 1)
      children[static_cast<unsigned>(std::countr_zero(left))] = ~std::uint64_t{0};
    for (unsigned octant = 0; octant < 8; octant += 2) {
      const unsigned y = at[1] + (octant >> 1 & 1), z = at[2] + (octant >> 2);
      if (y < 8 && z < 8) place_pair(children[octant], children[octant + 1], at[0], y, z);
    }
  }
  // Two bricks side by side along x, each in rows.
  void place_pair(std::uint64_t first, std::uint64_t second, unsigned x, unsigned y, unsigned z) {
    constexpr std::uint64_t kEven = 0x0F0F'0F0F'0F0F'0F0F, kLow = 0x00FF'00FF'00FF'00FF;
    // Every second row of both, a byte each; the lower and the upper two of a layer.
    const std::uint64_t even = (first & kEven) | (second & kEven) << 4, odd = (first >> 4 & kEven) | (second & ~kEven);
    if ((even | odd) == 0) return;
    const std::uint64_t lower = (even & kLow) | (odd & kLow) << 8, upper = (even >> 8 & kLow) | (odd & ~kLow);
    using Bytes = std::uint8_t __attribute__((vector_size(16)));
    const auto bytes = std::bit_cast<Bytes>(std::array{lower, upper});
    const auto put = [&](unsigned layer, const Bytes& rows) {
      const auto lanes = std::bit_cast<Lanes>(rows);
      auto* const at = &rows_[4 * z + layer][2 * y];
      Lanes there;
      std::memcpy(&there, at, sizeof(there));
      there |= x < 8 ? lanes << (4 * x) : lanes >> 4;  // beyond 7 only the second is within
      std::memcpy(at, &there, sizeof(there));
    };
    constexpr Bytes kNone{};
    put(0, __builtin_shufflevector(bytes, kNone, 0, 16, 16, 16, 1, 16, 16, 16, 8, 16, 16, 16, 9, 16, 16, 16));
    put(1, __builtin_shufflevector(bytes, kNone, 2, 16, 16, 16, 3, 16, 16, 16, 10, 16, 16, 16, 11, 16, 16, 16));
    put(2, __builtin_shufflevector(bytes, kNone, 4, 16, 16, 16, 5, 16, 16, 16, 12, 16, 16, 16, 13, 16, 16, 16));
    put(3, __builtin_shufflevector(bytes, kNone, 6, 16, 16, 16, 7, 16, 16, 16, 14, 16, 16, 16, 15, 16, 16, 16));
  }
  // A black node of level 3.
  void place_black(const Place& at) {
    const auto begin = [&](unsigned axis) { return at[axis] < 8 ? at[axis] : 0; };
    const auto end = [&](unsigned axis) { return std::min(at[axis] + 2, 8u); };
    const std::uint64_t row = (std::uint64_t{1} << 4 * end(0)) - (std::uint64_t{1} << 4 * begin(0));
    for (unsigned z = 4 * begin(2); z < 4 * end(2); ++z)
      for (unsigned pair = 2 * begin(1); pair < 2 * end(1); ++pair) rows_[z][pair] |= row | row << 32;
  }

  const char* bytes() const { return reinterpret_cast<const char*>(rows_.data()); }
  // To the voxel on the other side of the lattice plane across an axis.
  static VoxelStep beside(unsigned axis) {
    std::array<int, 3> at{};
    at[axis] = -1;
    return VoxelStep::to(at);
  }
  // Sixteen voxels of each of four rows.
  static Lanes voxels(const char* from, const VoxelStep& step) {
    Lanes lanes;
    std::memcpy(&lanes, from + step.bytes, sizeof(lanes));
    return lanes >> step.bits;
  }

  template <bool kInPlane>
  void find(const EdgeFamily& f, const NearLooks& looks, Found& found) const {
    found.clear.clear();
    found.partly.clear();
    const VoxelStep a = VoxelStep::to(below_), b = beside(f.b), c = beside(f.c);
    for (unsigned z = 0; z < NearEdges::kSide; ++z)
      for (unsigned quad = 0; quad < NearEdges::kSide / 4; ++quad) {
        const char* const from = bytes() + VoxelStep::to({0, 4 * static_cast<int>(quad), static_cast<int>(z)}).bytes;
        const Lanes A = voxels(from, a), B = voxels(from, a + b), C = voxels(from, a + c), D = voxels(from, a + b + c);
        Lanes edges = candidates(f, A, B, C, D) & 0xFFFF;
        if (!NearEdges::any(edges)) continue;
        const auto look_at = [&](const NearLook& look) {
          Lanes black = voxels(from, look.step);
          if constexpr (kInPlane) black &= voxels(from, look.step + b);
          return black;
        };
        Lanes touched{}, hidden{}, last{};
        for (const NearLook& look : looks.first()) {
          const Lanes black = look_at(look);
          touched |= black;
          if (look.alone) hidden |= black;
          if (look.with_last) hidden |= black & last;
          last = black;
        }
        edges &= ~hidden;
        if (!NearEdges::any(edges)) continue;
        for (const NearLook& look : looks.others()) touched |= look_at(look);
        found.clear.set(z, quad, edges & ~touched);
        found.partly.set(z, quad, edges & touched);
      }
  }

  std::array<int, 3> below_{};  // voxels below the cube
  // 32 layers along z of 32 rows along y, two a word, of 32 voxels along x.
  std::array<std::array<std::uint64_t, 16>, 32> rows_{};
};

}  // namespace blackleaf::detail
