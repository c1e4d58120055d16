#include "blackleaf/curve.h"

#include <cassert>

namespace blackleaf::curve {
namespace {

using detail::kTwoBits;

// Number and voxel are turned into each other two levels, six bits of the number, at a time. In a cube of 4^3 voxels a
// *place* is x + 4y + 16z. A level chooses among 24 tables; two levels together have 24 * 64 rows, and both directions
// fit the fastest cache (12 and 3 KiB).
//
// Table 2 (1, counted from 0) sends the digit 000 to octant 0 and on to table 1. So an odd order is the next even one
// entered with that table, and no loop has a remainder.
static_assert(kSteps[1][0].octant == 0 && kSteps[1][0].table == 0);

constexpr unsigned first_row(int order) { return static_cast<unsigned>(order & 1) * 64; }
constexpr int pairs_of_levels(int order) { return (order + 1) / 2; }

constexpr unsigned place(unsigned upper_octant, unsigned lower_octant) {
  unsigned result = 0;
  for (unsigned axis = 0; axis < 3; ++axis)
    result |= ((upper_octant >> axis & 1) << 1 | (lower_octant >> axis & 1)) << (2 * axis);
  return result;
}

constexpr std::size_t kRows = std::size_t{24} * 64;

// By [64 * table + six bits of the number]: two bits of each coordinate, packed, and in the highest bits 64 * the table
// of the next two levels.
constexpr int kNextShift = 52;
alignas(64) constexpr std::array<std::uint64_t, kRows> kPlaces = [] {
  std::array<std::uint64_t, kRows> rows{};
  for (std::size_t row = 0; row < kRows; ++row) {
    const Step upper = kSteps[row / 64][row / 8 % 8], lower = kSteps[upper.table][row % 8];
    const unsigned at = place(upper.octant, lower.octant);
    rows[row] = detail::pack(at & 3, at >> 2 & 3, at >> 4) | std::uint64_t{lower.table} << (kNextShift + 6);
  }
  return rows;
}();

// By [64 * table + place]: six bits of the number, and above them the next table.
alignas(64) constexpr std::array<std::uint16_t, kRows> kNumbers = [] {
  std::array<std::uint16_t, kRows> rows{};
  for (unsigned row = 0; row < kRows; ++row) {
    const Step upper = kSteps[row / 64][row / 8 % 8], lower = kSteps[upper.table][row % 8];
    rows[row / 64 * 64 + place(upper.octant, lower.octant)] =
        static_cast<std::uint16_t>(unsigned{lower.table} << 6 | row % 64);
  }
  return rows;
}();

// Two bits of each of three packed coordinates to a place. Multiplying moves z to the six highest bits, y next to it
// and x next to y; the other products fall off the word or lie apart below, so nothing is carried into the six.
constexpr std::uint64_t place_of(std::uint64_t two_bits) {
  constexpr std::uint64_t kGather = std::uint64_t{1} << 58 | std::uint64_t{1} << 40 | std::uint64_t{1} << 22;
  return two_bits * kGather >> 58;
}
static_assert(place_of(detail::pack(3, 0, 0)) == 3 && place_of(detail::pack(0, 3, 0)) == 12 &&
              place_of(detail::pack(0, 0, 3)) == 48 && place_of(kTwoBits) == 63);

// The packed coordinates that the highest `order` digits of a number choose, and the row where the next would begin.
struct Chosen {
  std::uint64_t packed = 0;
  std::uint64_t row = 0;
};
inline Chosen choose(std::uint64_t row, int pairs, std::uint64_t number) {
  std::uint64_t packed = 0;
  for (int shift = 6 * (pairs - 1); shift >= 0; shift -= 6) {
    const std::uint64_t entry = kPlaces[row | (number >> shift & 63)];
    packed = packed << 2 | (entry & kTwoBits);
    row = entry >> kNextShift;
  }
  return {packed, row};
}

inline std::uint64_t number_of(int order, std::int32_t x, std::int32_t y, std::int32_t z) {
  const auto widened = [](std::int32_t coordinate) { return static_cast<std::uint64_t>(coordinate); };
  const std::uint64_t packed = detail::pack(widened(x), widened(y), widened(z));
  std::uint64_t number = 0;
  std::uint64_t row = first_row(order);
  for (int bit = 2 * (pairs_of_levels(order) - 1); bit >= 0; bit -= 2) {
    const std::uint64_t entry = kNumbers[row | place_of(packed >> bit & kTwoBits)];
    number = number << 6 | (entry & 63);
    row = entry & ~std::uint64_t{63};
  }
  return number;
}

}  // namespace

Voxel voxel(int order, std::uint64_t number) {
  assert(order >= 1 && order <= kMaxDepth && number >> (3 * order) == 0);
  return detail::unpack(choose(first_row(order), pairs_of_levels(order), number).packed);
}

Cube cube(int order, std::uint64_t number, int level) {
  assert(order >= 1 && order <= kMaxDepth && level >= 0 && level <= order && number >> (3 * order) == 0);
  // Nodes of a level are themselves on a curve, that of as many levels as are above them.
  const int above = order - level;
  const Voxel at = detail::unpack(choose(first_row(above), pairs_of_levels(above), number >> (3 * level)).packed);
  return {at.x << level, at.y << level, at.z << level, level};
}

std::uint64_t number(int order, Voxel voxel) {
  assert(order >= 1 && order <= kMaxDepth);
  assert(voxel.x >= 0 && voxel.y >= 0 && voxel.z >= 0 && ((voxel.x | voxel.y | voxel.z) >> order) == 0);
  return number_of(order, voxel.x, voxel.y, voxel.z);
}

std::uint64_t first_number(int order, const Cube& cube) {
  assert(order >= 1 && order <= kMaxDepth && cube.level >= 0 && cube.level <= order);
  assert(((cube.x | cube.y | cube.z) & (cube.side() - 1)) == 0);
  assert(cube.x >= 0 && cube.y >= 0 && cube.z >= 0 && ((cube.x | cube.y | cube.z) >> order) == 0);
  return number_of(order - cube.level, cube.x >> cube.level, cube.y >> cube.level, cube.z >> cube.level)
         << (3 * cube.level);
}

namespace detail {

Brick brick(int order, std::uint64_t number) {
  const Chosen chosen = choose(first_row(order), pairs_of_levels(order) - 1, number);
  return {chosen.packed << 2, &kPlaces[chosen.row]};
}

}  // namespace detail

}  // namespace blackleaf::curve
