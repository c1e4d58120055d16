// NearBlocks: nodes of level 4 as 16^3 voxels in rows; the last ones are kept, for near fields overlap.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "octree/brick.h"
#include "octree/node_arrays.h"

namespace blackleaf::detail {

/// The lower and the upper half along x, each of 16 layers along z of 16 rows along y of eight voxels.
using NearBlock = std::array<std::array<std::array<std::uint8_t, 16>, 16>, 2>;

class NearBlocks {
 public:
  /// `words` are those of the tree.
  explicit NearBlocks(const LevelWords& words) : words_(words) {}

  /// Makes room for the blocks of a vicinity; what block() returned is lost if there was too little.
  void make_room() {
    if (count_ + 27 <= blocks_.size()) return;
    count_ = 0;
    places_.fill({});
  }

  /// The voxels of a node of level 4; until make_room(). Requires: at most 27 calls after that.
  const NearBlock& block(const Node& node) {
    static constexpr NearBlock kWhite{}, kBlack = [] {
      NearBlock black{};
      for (auto& half : black)
        for (auto& layer : half) layer.fill(0xFF);
      return black;
    }();
    if (!node.is_gray()) return node.is_black() ? kBlack : kWhite;
    const std::uint64_t word = node.word();  // never 0: there would be nothing in it
    std::size_t i = word * 0x9E3779B97F4A7C15 >> (64 - kBits);
    while (places_[i].word != word) {
      if (places_[i].word == 0) {
        places_[i] = {word, count_++};
        fill(word, blocks_[places_[i].block]);
        break;
      }
      i = (i + 1) % places_.size();
    }
    return blocks_[places_[i].block];
  }

 private:
  static constexpr int kBits = 8;

  void fill(std::uint64_t word, NearBlock& block) const {
    std::size_t gray = word >> 16;
    for (unsigned octant = 0; octant < 8; ++octant) {
      std::uint8_t* const rows = &block[octant & 1][8 * (octant >> 2)][8 * (octant >> 1 & 1)];
      if (word >> (8 + octant) & 1)
        fill_octant(words_[3][gray++], rows);
      else
        for (unsigned layer = 0; layer < 8; ++layer) std::memset(rows + 16 * layer, word >> octant & 1 ? 0xFF : 0, 8);
    }
  }

  // A gray node of level 3; layers are 16 bytes from each other.
  void fill_octant(std::uint64_t word, std::uint8_t* block) const {
    const std::uint64_t* gray = words_[2] + (word >> 16);
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
        std::memcpy(block + 16 * (4 * (i >> 2) + layer) + 4 * (i >> 1 & 1), &rows, sizeof(rows));
      }
    }
  }

  struct Place {
    std::uint64_t word = 0;
    std::size_t block = 0;
  };

  const LevelWords words_;
  std::array<Place, 1 << kBits> places_{};  // by the words' hashes
  std::array<NearBlock, 1 << (kBits - 1)> blocks_;
  std::size_t count_ = 0;
};

}  // namespace blackleaf::detail
