// The Millar polyhedron: a cubic space-filling curve that visits voxels in depth-first octree order (MHF92, section 2).
//
// The curve of order n numbers the 8^n voxels of a universe of depth n. Three bits of the number choose, from the root
// down, which octant of the current node is visited when; in which order a node's octants are visited is one of 24
// orders ("tables"). Table 1 is the order of M_1; the others are its images under the 24 symmetries of a tetrahedron
// (permutations of the axes combined with an even number of reversals), numbered in order of first use.
//
// Worked example (MHF92): order 2, number 30 = 011 110. Table 1 sends 011 to octant (0,0,1) and on to table 4, which
// sends 110 to (0,1,1): x = 00, y = 01, z = 11 in binary, so voxel (0,1,3).
//
// What follows: consecutive voxels share a face; the numbers of a node of level k are one interval [first, first +
// 8^k).
#pragma once

#include <array>
#include <cassert>
#include <cstdint>

#include "blackleaf/octree.h"

namespace blackleaf::curve {

/// One row of a table: where the digit triple leads.
struct Step {
  std::uint8_t octant;  // x + 2y + 4z
  std::uint8_t table;   // the table for the next three bits, 0-based (the paper's number minus one)
};

/// Rows by [table][digit triple]; tables are 0-based, so the paper's table (1) is kSteps[0].
using Tables = std::array<std::array<Step, 8>, 24>;

namespace detail {

// A symmetry of the unit cube: axis i of the image is axis `from[i]` of the argument, reversed where `flip[i]`.
struct Symmetry {
  std::array<std::uint8_t, 3> from{};
  std::array<bool, 3> flip{};

  constexpr unsigned operator()(unsigned octant) const {
    unsigned image = 0;
    for (unsigned i = 0; i < 3; ++i) image |= ((octant >> from[i] & 1u) ^ (flip[i] ? 1u : 0u)) << i;
    return image;
  }
  // (a * b)(o) = a(b(o))
  friend constexpr Symmetry operator*(const Symmetry& a, const Symmetry& b) {
    Symmetry product;
    for (unsigned i = 0; i < 3; ++i) {
      product.from[i] = b.from[a.from[i]];
      product.flip[i] = a.flip[i] != b.flip[a.from[i]];
    }
    return product;
  }
  friend constexpr bool operator==(const Symmetry&, const Symmetry&) = default;
};

// M_1 as octant labels (MHF92, Figure 3), and the transformation that each of its eight copies of M_{i-1} undergoes
// (Figure 2): the five of tables (2) to (6).
inline constexpr std::array<std::uint8_t, 8> kFirstOrder = {0, 1, 5, 4, 6, 7, 3, 2};
inline constexpr Symmetry kSwapXY{{1, 0, 2}, {false, false, false}};
inline constexpr Symmetry kSwapYZ{{0, 2, 1}, {false, false, false}};
inline constexpr Symmetry kTurnY{{0, 1, 2}, {true, false, true}};
inline constexpr Symmetry kSwapYZReversed{{0, 2, 1}, {false, true, true}};
inline constexpr Symmetry kSwapXYReversed{{1, 0, 2}, {true, true, false}};
inline constexpr std::array<Symmetry, 8> kCopies = {kSwapXY, kSwapYZ,         kSwapYZ,         kTurnY,
                                                    kTurnY,  kSwapYZReversed, kSwapYZReversed, kSwapXYReversed};

// Closes {identity} under the copies' transformations, breadth first; the order of discovery is the paper's numbering.
constexpr Tables derive_tables() {
  Tables tables{};
  std::array<Symmetry, 24> found{};
  found[0] = Symmetry{{0, 1, 2}, {false, false, false}};
  std::uint8_t count = 1;
  for (std::uint8_t t = 0; t < count; ++t) {
    for (unsigned digit = 0; digit < 8; ++digit) {
      const Symmetry next = found[t] * kCopies[digit];
      std::uint8_t number = 0;
      while (number < count && !(found[number] == next)) ++number;
      if (number == count) found[count++] = next;
      tables[t][digit] = {static_cast<std::uint8_t>(found[t](kFirstOrder[digit])), number};
    }
  }
  return tables;
}

// The converse tables (MHF92, section 2.3): [table][octant] gives the digit triple in place of the octant.
constexpr Tables invert(const Tables& tables) {
  Tables inverse{};
  for (unsigned t = 0; t < 24; ++t)
    for (unsigned digit = 0; digit < 8; ++digit)
      inverse[t][tables[t][digit].octant] = {static_cast<std::uint8_t>(digit), tables[t][digit].table};
  return inverse;
}

}  // namespace detail

inline constexpr Tables kSteps = detail::derive_tables();
/// kDigits[table][octant].octant is the digit triple; .table as in kSteps.
inline constexpr Tables kDigits = detail::invert(kSteps);

struct Voxel {
  std::int32_t x = 0, y = 0, z = 0;
  friend bool operator==(const Voxel&, const Voxel&) = default;
};

/// The voxel with the given number on the curve of order `order`. Requires: 1 <= order <= 20, number < 8^order.
/// One table look-up for every two levels (MHF92, section 2.2, has one for every level).
Voxel voxel(int order, std::uint64_t number);

/// The number of a voxel on the curve of order `order`, in [0, 8^order). Requires: coordinates in [0, 2^order).
/// One table look-up for every two levels (MHF92, section 2.3, has one for every level).
std::uint64_t number(int order, Voxel voxel);

/// The first number of a node: its voxels have the numbers [first, first + 8^level). Requires: the cube lies in the
/// universe of depth `order` and is aligned to its side. O(order).
std::uint64_t first_number(int order, const Cube& cube);

/// The node of the given level whose interval holds `number`.
Cube cube(int order, std::uint64_t number, int level);

/// Calls visit(voxel) for the voxels with the numbers [first, last), in curve order: MHF92's walkround without a
/// descent from the root for every voxel: bricks of 64 voxels come from a table. Requires: 1 <= order <= 20, first <=
/// last <= 8^order. O(last - first + order).
template <class Visit>
void walk(int order, std::uint64_t first, std::uint64_t last, Visit&& visit);

namespace detail {

// Three coordinates of up to 20 bits side by side in one word.
constexpr std::uint64_t pack(std::uint64_t x, std::uint64_t y, std::uint64_t z) { return x | y << 20 | z << 40; }
constexpr Voxel unpack(std::uint64_t packed) {
  constexpr std::uint64_t kCoordinate = (1u << 20) - 1;
  return {static_cast<std::int32_t>(packed & kCoordinate), static_cast<std::int32_t>(packed >> 20 & kCoordinate),
          static_cast<std::int32_t>(packed >> 40)};
}
inline constexpr std::uint64_t kTwoBits = pack(3, 3, 3);

// 4^3 voxels that follow each other on the curve: their corner, packed, and 64 rows, one a voxel in order, of which the
// bits kTwoBits are its place from the corner.
struct Brick {
  std::uint64_t corner;
  const std::uint64_t* rows;
};
// The voxels with the numbers [64 * number, 64 * number + 64); for order 1 only the first eight are meant.
Brick brick(int order, std::uint64_t number);

}  // namespace detail

template <class Visit>
void walk(int order, std::uint64_t first, std::uint64_t last, Visit&& visit) {
  assert(order >= 1 && order <= kMaxDepth && first <= last && last <= std::uint64_t{1} << (3 * order));
  for (std::uint64_t at = first; at < last;) {
    const detail::Brick brick = detail::brick(order, at / 64);
    const std::uint64_t end = last - at < 64 - at % 64 ? last % 64 : 64;
    for (std::uint64_t i = at % 64; i < end; ++i)
      visit(detail::unpack(brick.corner | (brick.rows[i] & detail::kTwoBits)));
    at += end - at % 64;
  }
}

}  // namespace blackleaf::curve
