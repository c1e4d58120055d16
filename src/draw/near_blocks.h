// NearBlocks: nodes of level 3 as 8^3 voxels in rows; the last ones are kept, for near fields overlap.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "octree/brick.h"

namespace blackleaf::detail {

/// Layers along z of rows along y of eight voxels along x.
using NearBlock = std::array<std::array<std::uint8_t, 8>, 8>;

class NearBlocks {
 public:
  /// `bricks` are the tree's words of level 2.
  explicit NearBlocks(const std::uint64_t* bricks) : bricks_(bricks) {}

  /// The voxels of a gray node of level 3, by its word; until the next call.
  const NearBlock& block(std::uint64_t word) {
    Entry& entry = entries_[word * 0x9E3779B97F4A7C15 >> 56];
    if (entry.word != word) {
      entry.word = word;  // never 0: there would be nothing in it
      fill(word, entry.block);
    }
    return entry.block;
  }

 private:
  struct Entry {
    std::uint64_t word = 0;
    NearBlock block;
  };

  void fill(std::uint64_t word, NearBlock& block) const {
    const std::uint64_t* gray = bricks_ + (word >> 16);
    std::array<std::uint64_t, 8> children{};
    for (std::uint64_t left = word >> 8 & 0xFF; left; left &= left - 1)
      children[static_cast<unsigned>(std::countr_zero(left))] = rows_from_brick(*gray++);
    for (std::uint64_t left = word & 0xFF; left; left &= left - 1)
      children[static_cast<unsigned>(std::countr_zero(left))] = ~std::uint64_t{0};
    for (unsigned i = 0; i < 8; i += 2) {
      constexpr std::uint64_t kEven = 0x0F0F'0F0F'0F0F'0F0F, kLow = 0x00FF'00FF'00FF'00FF;
      const std::uint64_t first = children[i], second = children[i + 1];  // side by side along x
      // Every second row of both, a byte each; then the lower and the upper two of each layer.
      const std::uint64_t even = (first & kEven) | (second & kEven) << 4;
      const std::uint64_t odd = (first >> 4 & kEven) | (second & ~kEven);
      const std::uint64_t lower = (even & kLow) | (odd & kLow) << 8, upper = (even >> 8 & kLow) | (odd & ~kLow);
      for (unsigned layer = 0; layer < 4; ++layer) {
        const auto rows =
            static_cast<std::uint32_t>((lower >> (16 * layer) & 0xFFFF) | (upper >> (16 * layer) & 0xFFFF) << 16);
        std::memcpy(&block[4 * (i >> 2) + layer][4 * (i >> 1 & 1)], &rows, sizeof(rows));
      }
    }
  }

  const std::uint64_t* bricks_;
  std::array<Entry, 256> entries_;
};

}  // namespace blackleaf::detail
