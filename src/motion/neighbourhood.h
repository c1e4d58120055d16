// Neighbourhood: the few nodes of a source tree that a target node may see after an arbitrary motion.
//
// A target node of level k, moved back into the source, lies in a box that meets at most three cells of level k on
// every axis: the box is less than sqrt(3) 2^k long, so with both ends closed it meets floor(sqrt(3)) + 2 = 3. The
// neighbourhood holds these at most 27 cells as the colours of their children: a byte of black and a byte of gray ones
// each, as in a node's word. Whether any box of cells of the level below has one colour is then a few operations on 32
// bytes at once, and the neighbourhood of a target's child is read off its parent's without a search from the root.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <cstring>

#include "blackleaf/octree.h"
#include "cell_range.h"

namespace blackleaf::detail {

/// The words of a source tree as nodes of level 3 at least. A universe of depth 1 or 2 is octant 0 of one of level 3
/// whose other voxels are white.
class SourceTree {
 public:
  explicit SourceTree(const Octree& octree) : level_(octree.depth() < 3 ? 3 : octree.depth()) {
    static constexpr std::uint64_t kFullByte = 0xFF;
    for (int k = 2; k <= kMaxDepth; ++k) {
      const auto words = octree.words(k);
      levels_[static_cast<std::size_t>(k)] = words.empty() ? &kFullByte : words.data();
      counts_[static_cast<std::size_t>(k)] = words.size();
    }
    const Node root = octree.root();
    if (octree.depth() >= 3) {
      root_ = root.is_gray() ? root.word() : root.is_black() ? kBlack : kWhite;
    } else if (root.is_gray()) {
      levels_[2] = octree.words(octree.depth()).data();
      root_ = 0x0100;
    } else if (root.is_black()) {
      levels_[2] = &kFullByte;  // of depth 1; of depth 2 the octant is black
      root_ = octree.depth() == 1 ? 0x0100 : 0x0001;
    }
  }

  int level() const { return level_; }
  /// A gray node's word, or as if it were one: no child gray, and all black or all white.
  std::uint64_t root() const { return root_; }
  /// The first word of a level, or of something that may be read.
  const std::uint64_t* words(int level) const { return levels_[static_cast<std::size_t>(level)]; }

  /// Words of a level.
  std::size_t count(int level) const { return counts_[static_cast<std::size_t>(level)]; }

  static constexpr std::uint64_t kWhite = 0, kBlack = 0xFF;

 private:
  int level_;
  std::array<std::size_t, kMaxDepth + 1> counts_{};
  std::uint64_t root_ = kWhite;
  std::array<const std::uint64_t*, kMaxDepth + 1> levels_{};
};

class Neighbourhood {
 public:
  static constexpr std::size_t kWidth = 3, kCells = kWidth * kWidth * kWidth;

  /// Uninitialised.
  Neighbourhood() {}  // NOLINT(modernize-use-equals-default): = default would clear what is made anew anyway

  /// The cells of the root's level. Requires: at most three on an axis.
  void enter(const SourceTree& tree, const CellRange& cells) {
    begin(tree.level(), cells);
    for (std::int64_t z = cells.low[2]; z <= cells.high[2]; ++z)
      for (std::int64_t y = cells.low[1]; y <= cells.high[1]; ++y)
        for (std::int64_t x = cells.low[0]; x <= cells.high[0]; ++x)
          set(index(x, y, z), (x | y | z) == 0 ? tree.root() : SourceTree::kWhite, tree.words(level_ - 1));
  }

  /// The cells of the level below another neighbourhood. Requires: it covers them; at most three on an axis; the level
  /// is 3 at least.
  void narrow(const SourceTree& tree, const Neighbourhood& from, const CellRange& cells) {
    begin(from.level_ - 1, cells);
    // What a place on an axis adds to the index of the parent's cell and to the octant there. A third cell of a row is
    // always done, as white where it is not asked for: how many there are is as good as random, and a wrong guess costs
    // more.
    std::array<std::array<std::uint8_t, kWidth>, 3> cell, octant;
    for (std::size_t axis = 0, width = 1; axis < 3; ++axis, width *= kWidth)
      for (std::size_t i = 0; i < kWidth; ++i) {
        const std::int64_t place = std::min(cells.low[axis] + static_cast<std::int64_t>(i), cells.high[axis]);
        cell[axis][i] = static_cast<std::uint8_t>(((place >> 1) - from.low_[axis]) * static_cast<std::int64_t>(width));
        octant[axis][i] = static_cast<std::uint8_t>((place & 1) << axis);
      }
    const std::array<std::uint64_t, kWidth> asked = {~std::uint64_t{0}, size_[0] > 1 ? ~std::uint64_t{0} : 0,
                                                     size_[0] > 2 ? ~std::uint64_t{0} : 0};
    const std::uint64_t* below = tree.words(level_ - 1);
    for_each_row([&](std::size_t y, std::size_t z) {
      const unsigned row_cell = cell[1][y] + cell[2][z], row_octant = octant[1][y] + octant[2][z];
      for (std::size_t x = 0; x < kWidth; ++x)
        set(x + 3 * y + 9 * z, from.child(row_cell + cell[0][x], row_octant + octant[0][x]) & asked[x], below);
    });
  }

  /// Black or white if all those cells of the level below are, else gray. Requires: the neighbourhood covers them.
  Colour colour(const CellRange& below) const {
    const auto mask = [&](std::size_t axis) -> const Bytes& {
      const auto low = static_cast<std::size_t>(below.low[axis] - 2 * low_[axis]);
      const auto high = static_cast<std::size_t>(below.high[axis] - 2 * low_[axis]);
      assert(low <= high && high < 2 * kWidth);
      return kBetween[axis][low][high];
    };
    const Bytes &x = mask(0), &y = mask(1), &z = mask(2);
    std::uint64_t some = 0, hole = 0;
    for (std::size_t i = 0; i < sizeof(Bytes); i += sizeof(std::uint64_t)) {
      const std::uint64_t among = eight(x, i) & eight(y, i) & eight(z, i), black = eight(black_, i);
      some |= (black | eight(gray_, i)) & among;
      hole |= ~black & among;
    }
    return some == 0 ? Colour::white : hole == 0 ? Colour::black : Colour::gray;
  }

  /// How many of the cells of the level below are black.
  int black_children() const {
    int count = 0;
    for (std::size_t i = 0; i < sizeof(Bytes); i += sizeof(std::uint64_t)) count += std::popcount(eight(black_, i));
    return count;
  }

  /// A cell's number, x + 3 (y + 3 z) from the lowest.
  std::size_t index(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return static_cast<std::size_t>((x - low_[0]) + 3 * (y - low_[1]) + 9 * (z - low_[2]));
  }
  /// Calls visit(y, z) for the rows of three cells; those that are not in the neighbourhood are white.
  template <class Visit>
  void for_each_row(Visit visit) const {
    for (std::size_t z = 0; z < size_[2]; ++z)
      for (std::size_t y = 0; y < size_[1]; ++y) visit(y, z);
  }
  /// The children of a cell that are black, the gray ones, and the words of these.
  std::uint8_t black(std::size_t cell) const { return black_[cell]; }
  std::uint8_t gray(std::size_t cell) const { return gray_[cell]; }
  const std::uint64_t* words(std::size_t cell) const { return words_[cell]; }
  /// The eight bricks of a cell in octant order. Requires: a neighbourhood of level 3.
  void bricks(std::size_t cell, std::uint64_t* result) const {
    assert(level_ == 3);
    const std::uint64_t* gray = words_[cell];
    for (unsigned octant = 0; octant < 8; ++octant) {
      const unsigned bit = 1u << octant;
      if ((gray_[cell] & bit) != 0)
        result[octant] = *gray++;
      else
        result[octant] = (black_[cell] & bit) != 0 ? ~std::uint64_t{0} : 0;
    }
  }

 private:
  using Bytes = std::array<std::uint8_t, 32>;  // by cell, x + 3 (y + 3 z) from the lowest

  // [axis][low][high]: the octants of each cell whose place on the axis is between, counted from the lowest cell's
  // lower half.
  static constexpr auto kBetween = [] {
    std::array<std::array<std::array<Bytes, 2 * kWidth>, 2 * kWidth>, 3> masks{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t low = 0; low < 2 * kWidth; ++low)
        for (std::size_t high = low; high < 2 * kWidth; ++high)
          for (std::size_t cell = 0; cell < kCells; ++cell)
            for (std::size_t octant = 0; octant < 8; ++octant) {
              const std::size_t along = axis == 0 ? cell % 3 : axis == 1 ? cell / 3 % 3 : cell / 9;
              const std::size_t place = 2 * along + (octant >> axis & 1);
              if (place >= low && place <= high)
                masks[axis][low][high][cell] = static_cast<std::uint8_t>(masks[axis][low][high][cell] | 1u << octant);
            }
    return masks;
  }();

  static std::uint64_t eight(const Bytes& bytes, std::size_t at) {
    std::uint64_t word;
    std::memcpy(&word, &bytes[at], sizeof word);
    return word;
  }

  void begin(int level, const CellRange& cells) {
    assert(level >= 3);
    level_ = level;
    low_ = cells.low;
    black_ = gray_ = {};
    for (std::size_t i = 0; i < 3; ++i) {
      assert(cells.low[i] <= cells.high[i] && cells.high[i] < cells.low[i] + 3);
      size_[i] = static_cast<std::size_t>(cells.high[i] - cells.low[i] + 1);
    }
  }

  void set(std::size_t cell, std::uint64_t word, const std::uint64_t* below) {
    black_[cell] = static_cast<std::uint8_t>(word);
    gray_[cell] = static_cast<std::uint8_t>(word >> 8);
    words_[cell] = below + (word >> 16);
  }

  // The word of a child, or what stands for one. Without a branch, because what is met is as good as random.
  std::uint64_t child(std::size_t cell, unsigned octant) const {
    const std::uint64_t gray = gray_[cell], black = black_[cell];
    const std::uint64_t is_gray = -(gray >> octant & 1), is_black = -(black >> octant & 1);
    const auto before = static_cast<std::uint64_t>(std::popcount(gray & ((std::uint64_t{1} << octant) - 1)));
    return (words_[cell][before & is_gray] & is_gray) | (SourceTree::kBlack & is_black);
  }

  Bytes black_, gray_;                              // children of each cell
  std::array<const std::uint64_t*, kCells> words_;  // of each cell's gray children; some word if there are none
  std::array<std::int64_t, 3> low_;
  std::array<std::size_t, 3> size_;  // cells on each axis
  int level_;
};

}  // namespace blackleaf::detail
