// Bricks: the bottom two levels of an octree as 64 bits.
//
// Bit 8*o1 + o0 is the voxel with x = (o0 & 1) + 2 (o1 & 1), and so on: x takes bits 0 and 3 of the index, y bits 1 and
// 4, z bits 2 and 5.
#pragma once

#include <array>
#include <cstdint>

#include "blackleaf/curve.h"

namespace blackleaf::detail {

/// Contribution of a coordinate 0..3 to a voxel's bit index in a brick: kSpread[x] + 2 kSpread[y] + 4 kSpread[z].
inline constexpr std::array<std::uint8_t, 4> kSpread = {0, 1, 8, 9};

constexpr unsigned brick_bit(unsigned x, unsigned y, unsigned z) {
  return static_cast<unsigned>(kSpread[x] | kSpread[y] << 1 | kSpread[z] << 2);
}

/// Coordinates 0..3 of a voxel from its bit index.
constexpr unsigned brick_x(unsigned bit) { return (bit & 1) | (bit >> 2 & 2); }
constexpr unsigned brick_y(unsigned bit) { return (bit >> 1 & 1) | (bit >> 3 & 2); }
constexpr unsigned brick_z(unsigned bit) { return (bit >> 2 & 1) | (bit >> 4 & 2); }

/// kBrickOrder[table][i]: the bit index of the i-th voxel that the Millar curve visits in a brick entered with `table`.
inline constexpr auto kBrickOrder = [] {
  std::array<std::array<std::uint8_t, 64>, 24> order{};
  for (unsigned table = 0; table < 24; ++table)
    for (unsigned i = 0; i < 64; ++i) {
      const curve::Step upper = curve::kSteps[table][i >> 3];
      order[table][i] = static_cast<std::uint8_t>(8 * upper.octant + curve::kSteps[upper.table][i & 7].octant);
    }
  return order;
}();

/// The same bits in curve order: bit i of the result is the i-th voxel visited.
constexpr std::uint64_t to_curve_order(std::uint64_t brick, unsigned table) {
  std::uint64_t bits = 0;
  for (unsigned i = 0; i < 64; ++i) bits |= (brick >> kBrickOrder[table][i] & 1) << i;
  return bits;
}
constexpr std::uint64_t from_curve_order(std::uint64_t bits, unsigned table) {
  std::uint64_t brick = 0;
  for (unsigned i = 0; i < 64; ++i) brick |= (bits >> i & 1) << kBrickOrder[table][i];
  return brick;
}

// Exchanges pairs of bits of the index: bits under `mask` change places with those `shift` higher.
constexpr std::uint64_t exchange_bits(std::uint64_t bits, unsigned shift, std::uint64_t mask) {
  const std::uint64_t t = (bits ^ bits >> shift) & mask;
  return bits ^ t ^ t << shift;
}
// Bits of the index, lowest first: x0 y0 z0 x1 y1 z1 <-> x0 x1 z0 y0 y1 z1 <-> x0 x1 y0 z0 y1 z1 <-> x0 x1 y0 y1 z0 z1.
/// The bits of a brick as rows: x fastest, then y, then z; and back.
constexpr std::uint64_t rows_from_brick(std::uint64_t bits) {
  bits = exchange_bits(bits, 6, 0x00CC'00CC'00CC'00CC);
  bits = exchange_bits(bits, 4, 0x00F0'00F0'00F0'00F0);
  return exchange_bits(bits, 8, 0x0000'FF00'0000'FF00);
}
constexpr std::uint64_t brick_from_rows(std::uint64_t bits) {
  bits = exchange_bits(bits, 8, 0x0000'FF00'0000'FF00);
  bits = exchange_bits(bits, 4, 0x00F0'00F0'00F0'00F0);
  return exchange_bits(bits, 6, 0x00CC'00CC'00CC'00CC);
}

}  // namespace blackleaf::detail
