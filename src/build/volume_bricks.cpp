#include "volume_bricks.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "octree/brick.h"

namespace blackleaf::detail {
namespace {

constexpr std::uint32_t kAllBlack = 0xFFFF;

using Pair [[gnu::vector_size(16)]] = std::uint64_t;

Pair load(const std::uint64_t* words) {
  Pair pair;
  std::memcpy(&pair, words, sizeof pair);
  return pair;
}

// Bits 0, 4, 8, ... of a word as 16 bits.
std::uint32_t every_fourth(std::uint64_t word) {
  word &= 0x1111'1111'1111'1111;
  word = (word | word >> 3) & 0x0303'0303'0303'0303;
  word = (word | word >> 6) & 0x000F'000F'000F'000F;
  word = (word | word >> 12) & 0x0000'00FF'0000'00FF;
  return static_cast<std::uint32_t>((word | word >> 24) & 0xFFFF);
}

// Four voxels along x as bits of a brick.
constexpr auto kFour = [] {
  std::array<std::uint16_t, 16> four{};
  for (unsigned bits = 0; bits < 16; ++bits) four[bits] = static_cast<std::uint16_t>((bits & 3) | (bits & 12) << 6);
  return four;
}();

std::uint64_t gather(const VolumeBricks::Rows& rows, std::size_t group, unsigned shift) {
  std::uint64_t brick = 0;
#pragma GCC unroll 16
  for (unsigned row = 0; row < 16; ++row)
    brick |= std::uint64_t{kFour[rows[row][group] >> shift & 0xF]} << (kSpread[row & 3] << 1 | kSpread[row >> 2] << 2);
  return brick;
}

}  // namespace

VolumeBricks::VolumeBricks(const std::array<std::int64_t, 3>& low, const std::array<std::int64_t, 3>& high) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int bits = axis == 0 ? 6 : 2;
    first_[axis] = low[axis] >> bits;
    count_[axis] = ((high[axis] - 1) >> bits) + 1 - first_[axis];
    if (axis > 0) skew_[axis] = first_[axis] & 15;
  }
  blocks_y_ = (skew_[1] + count_[1] + 15) >> 4;
  const std::int64_t blocks_z = (skew_[2] + count_[2] + 15) >> 4;
  const std::size_t room = static_cast<std::size_t>(count_[0] * blocks_y_ * blocks_z) << 8;
  colours_ = std::make_unique_for_overwrite<std::uint32_t[]>(room);
  first_gray_ = std::make_unique_for_overwrite<std::uint32_t[]>(room);
  gray_.resize(static_cast<std::size_t>(strips()));
}

void VolumeBricks::set(std::int64_t strip, std::int64_t group, std::int64_t count, const Rows& rows,
                       std::vector<std::uint64_t>& gray, std::size_t begin) {
  // OR and AND of the sixteen rows, two groups at a time; an odd last group has a neighbour that is not looked at.
  std::array<std::uint64_t, kMostGroups> any, all;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += 2) {
    Pair any_row = load(&rows[0][i]), all_rows = any_row;
#pragma GCC unroll 16
    for (std::size_t row = 1; row < 16; ++row) {
      const Pair pair = load(&rows[row][i]);
      any_row |= pair;
      all_rows &= pair;
    }
    std::memcpy(&any[i], &any_row, sizeof any_row);
    std::memcpy(&all[i], &all_rows, sizeof all_rows);
  }
  std::size_t at = index(group - first_[0], strip % count_[1], strip / count_[1]);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i, at += kBlockGroups) {
    if (any[i] == 0) {
      colours_[at] = 0;
    } else if (~all[i] == 0) {
      colours_[at] = kAllBlack;
    } else {
      const std::uint64_t any_two = any[i] | any[i] >> 1, all_two = all[i] & all[i] >> 1;
      const std::uint32_t black = every_fourth(all_two & all_two >> 2);
      const std::uint32_t grays = every_fourth(any_two | any_two >> 2) & ~black;
      colours_[at] = black | grays << 16;
      first_gray_[at] = static_cast<std::uint32_t>(gray.size() - begin);
      for (std::uint32_t rest = grays; rest != 0; rest &= rest - 1)
        gray.push_back(gather(rows, i, 4 * static_cast<unsigned>(std::countr_zero(rest))));
    }
  }
}

bool VolumeBricks::misses(const Cube& cube) const {
  const std::int64_t side = cube.side();
  const auto apart = [&](std::int64_t begin, std::size_t axis, int bits) {
    return begin + side <= first_[axis] << bits || begin >= (first_[axis] + count_[axis]) << bits;
  };
  return apart(cube.x, 0, 6) || apart(cube.y, 1, 2) || apart(cube.z, 2, 2);
}

Colour VolumeBricks::colour(const Cube& cube) const {
  if (misses(cube)) return Colour::white;
  const std::int64_t bricks = std::int64_t{1} << (cube.level - 2);
  const auto begin = [&](std::int64_t first, std::size_t axis) {
    return std::max<std::int64_t>(first - first_[axis], 0);
  };
  const auto end = [&](std::int64_t first, std::size_t axis) {
    return std::min(first + bricks - first_[axis], count_[axis]);
  };
  const std::int64_t y0 = begin(cube.y >> 2, 1), y1 = end(cube.y >> 2, 1);
  const std::int64_t z0 = begin(cube.z >> 2, 2), z1 = end(cube.z >> 2, 2);
  const std::uint32_t mask = (kAllBlack >> (16 - bricks)) << (cube.x >> 2 & 15);
  // What lies outside counts as white. The groups of one z stand side by side.
  std::uint32_t any = 0, all = y1 - y0 == bricks && z1 - z0 == bricks ? mask : 0;
  const std::uint32_t black_or_gray = mask | mask << 16;
  for (std::int64_t z = z0; z < z1; ++z) {
    const std::uint32_t* const colours = &colours_[index((cube.x >> 6) - first_[0], y0, z)];
    for (std::int64_t i = 0; i < y1 - y0; ++i) {
      any |= colours[i];
      all &= colours[i];
    }
    if ((any & black_or_gray) != 0 && all != mask) return Colour::gray;
  }
  return all == mask ? Colour::black : (any & black_or_gray) == 0 ? Colour::white : Colour::gray;
}

std::array<Subtree, 8> VolumeBricks::children(const Cube& cube) const {
  std::array<Subtree, 8> children{};
  const std::int64_t x = (cube.x >> 6) - first_[0];
  if (x < 0 || x >= count_[0]) return children;
  const int brick = cube.x >> 2 & 15;
  for (std::size_t row = 0; row < 4; ++row) {
    const std::int64_t y = (cube.y >> 2) - first_[1] + static_cast<std::int64_t>(row & 1);
    const std::int64_t z = (cube.z >> 2) - first_[2] + static_cast<std::int64_t>(row >> 1);
    if (y < 0 || y >= count_[1] || z < 0 || z >= count_[2]) continue;
    const std::size_t group = index(x, y, z);
    const std::uint32_t colours = colours_[group] >> brick;
    for (const int i : {0, 1}) {
      Subtree& child = children[2 * row + static_cast<std::size_t>(i)];
      if ((colours >> i & 1) != 0)
        child = Subtree::uniform(Colour::black);
      else if ((colours >> (16 + i) & 1) != 0)
        child = {gray_bits(group, y, z, brick + i), Colour::gray};
    }
  }
  return children;
}

std::uint64_t VolumeBricks::brick(const Cube& cube) const {
  const std::int64_t y = (cube.y >> 2) - first_[1], z = (cube.z >> 2) - first_[2];
  return gray_bits(index((cube.x >> 6) - first_[0], y, z), y, z, cube.x >> 2 & 15);
}

}  // namespace blackleaf::detail
