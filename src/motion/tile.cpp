#include "tile.h"

#include <algorithm>
#include <span>

#include "octree/brick.h"

namespace blackleaf::detail {
namespace {

using Bricks = std::array<std::uint64_t, 512>;  // of a tile, in octant order

// Contribution of a brick's coordinate 0..7 to its place in octant order.
constexpr std::array<std::uint16_t, 8> kPlace = {0, 1, 8, 9, 64, 65, 72, 73};

// Nibbles 0..3 of the argument at bits 0, 16, 32, 48.
constexpr std::uint64_t spread_nibbles(std::uint64_t sixteen) {
  std::uint64_t x = (sixteen | sixteen << 24) & 0x0000'00FF'0000'00FF;
  x = (x | x << 12) & 0x000F'000F'000F'000F;
  return x;
}

// Four bricks that stand side by side along x: those with the voxels 16 half .. 16 half + 15 of 4 x 4 rows.
void four_bricks(const Tile& tile, std::size_t half, std::size_t y, std::size_t z, Bricks& bricks) {
  std::array<std::uint64_t, 4> in_rows{};
  for (std::size_t k = 0; k < 4; ++k) {
    std::uint64_t plane = 0;  // 16 bits a brick
    for (std::size_t j = 0; j < 4; ++j)
      plane |= spread_nibbles(tile.rows[4 * z + k][4 * y + j] >> (16 * half) & 0xFFFF) << (4 * j);
    for (std::size_t i = 0; i < 4; ++i) in_rows[i] |= (plane >> (16 * i) & 0xFFFF) << (16 * k);
  }
  for (std::size_t i = 0; i < 4; ++i)
    bricks[kPlace[4 * half + i] + 2u * kPlace[y] + 4u * kPlace[z]] = brick_from_rows(in_rows[i]);
}

// The eight bricks of one y and z.
void bricks_along_x(const Tile& tile, std::size_t y, std::size_t z, Bricks& bricks) {
  std::uint32_t any = 0, every = ~std::uint32_t{0};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j) {
      any |= tile.rows[4 * z + k][4 * y + j];
      every &= tile.rows[4 * z + k][4 * y + j];
    }
  for (std::size_t half = 0; half < 2; ++half) {
    const std::uint32_t mask = std::uint32_t{0xFFFF} << (16 * half);
    if ((any & mask) != 0 && (every & mask) != mask) {
      four_bricks(tile, half, y, z, bricks);
    } else {
      for (std::size_t i = 0; i < 4; ++i)
        bricks[kPlace[4 * half + i] + 2u * kPlace[y] + 4u * kPlace[z]] = (any & mask) != 0 ? ~std::uint64_t{0} : 0;
    }
  }
}

// A node of level 3 or more from its bricks.
Subtree node(std::span<const std::uint64_t> bricks, int level, std::uint8_t table, NodeArrays& arrays) {
  if (level == 3) {
    unsigned black = 0, gray = 0;
    std::array<std::uint64_t, 8> words;
    std::size_t count = 0;
    for (unsigned octant = 0; octant < 8; ++octant) {
      const std::uint64_t brick = bricks[octant];
      if (~brick == 0) {
        black |= 1u << octant;
      } else if (brick != 0) {
        gray |= 1u << octant;
        words[count++] = brick;
      }
    }
    return arrays.close(3, black, gray, {words.data(), count});
  }
  std::array<Subtree, 8> children;
  const std::size_t part = bricks.size() / 8;
  for (const curve::Step step : curve::kSteps[table])
    children[step.octant] = node(bricks.subspan(step.octant * part, part), level - 1, step.table, arrays);
  return arrays.close(level, children);
}

}  // namespace

Subtree Tile::subtree(int level, std::uint8_t table, NodeArrays& arrays) const {
  const std::size_t bricks_a_side = std::size_t{1} << (level - 2);
  Bricks bricks;
  for (std::size_t z = 0; z < bricks_a_side; ++z)
    for (std::size_t y = 0; y < bricks_a_side; ++y) bricks_along_x(*this, y, z, bricks);
  if (level == 2) return Subtree::brick(bricks[0]);
  return node(std::span(bricks).first(std::size_t{1} << (3 * (level - 2))), level, table, arrays);
}

}  // namespace blackleaf::detail
