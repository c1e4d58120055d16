// SourceWindow: the few nodes of a source tree that a target node may see.
//
// A target node of level k, moved back into the source, lies in a box that meets at most three cells of level k on
// every axis: the box is less than sqrt(3) 2^k long, so with both ends closed it meets floor(sqrt(3)) + 2 = 3. The
// window holds the source's nodes of level k for these cells; the window of a child is read off its parent's in at most
// kWidth^3 steps, without a search from the root. An integer translation needs two cells an axis.
#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <cstdint>

#include "octree/node_arrays.h"

namespace blackleaf::detail {

/// Cells of one level, [low, high] on every axis, in units of that level's side.
struct CellRange {
  std::array<std::int64_t, 3> low{}, high{};
};

/// kWidth: the most cells on an axis, at most 3.
template <int kWidth>
class SourceWindow {
  static constexpr std::size_t kCells = kWidth * kWidth * kWidth;
  static_assert(kCells <= 32);

 public:
  /// The window on a whole source: its root and white cells around it.
  static SourceWindow of_root(const Node& root, const CellRange& cells) {
    SourceWindow window;
    window.tree_ = root;
    window.reset(cells, root.level());
    window.fill([&](std::int64_t x, std::int64_t y, std::int64_t z) {
      return (x | y | z) == 0 ? root : Node::uniform(root.level(), Colour::white);
    });
    return window;
  }

  /// The window on `cells` of the next lower level. Requires: every cell lies in a cell of this window.
  SourceWindow narrowed(const CellRange& cells) const {
    SourceWindow window;
    window.tree_ = tree_;
    window.reset(cells, level_ - 1);
    window.fill([&](std::int64_t x, std::int64_t y, std::int64_t z) {
      return node(x >> 1, y >> 1, z >> 1).child(static_cast<int>((x & 1) | (y & 1) << 1 | (z & 1) << 2));
    });
    return window;
  }

  /// Black or white if all nodes of the window are, else gray.
  Colour colour() const {
    return (black_ | gray_) == 0 ? Colour::white : black_ == all_ ? Colour::black : Colour::gray;
  }

  /// The node of a cell. Requires: the cell is in the window.
  Node node(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return at(static_cast<std::size_t>((x - low_[0]) + kWidth * ((y - low_[1]) + kWidth * (z - low_[2]))));
  }

  const std::array<std::int64_t, 3>& low() const { return low_; }

  /// The voxels of the window as bricks, indexed x + kWidth (y + kWidth z) from its lowest cell. Requires: a window of
  /// level 2.
  std::array<std::uint64_t, kCells> bricks() const {
    std::array<std::uint64_t, kCells> result{};
    for (std::uint32_t rest = black_ | gray_; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      result[i] = at(i).brick();
    }
    return result;
  }

 private:
  void reset(const CellRange& cells, int level) {
    level_ = level;
    low_ = cells.low;
    for (std::size_t i = 0; i < 3; ++i) {
      size_[i] = cells.high[i] - cells.low[i] + 1;
      assert(size_[i] >= 1 && size_[i] <= kWidth);
    }
  }

  Node at(std::size_t cell) const {
    if (gray_ >> cell & 1) return tree_.relative(level_, words_[cell]);
    return Node::uniform(level_, black_ >> cell & 1 ? Colour::black : Colour::white);
  }

  template <class NodeOf>
  void fill(NodeOf node_of) {
    for (std::int64_t z = 0; z < size_[2]; ++z)
      for (std::int64_t y = 0; y < size_[1]; ++y)
        for (std::int64_t x = 0; x < size_[0]; ++x) {
          const Node node = node_of(low_[0] + x, low_[1] + y, low_[2] + z);
          const auto i = static_cast<std::size_t>(x + kWidth * (y + kWidth * z));
          all_ |= std::uint32_t{1} << i;
          black_ |= std::uint32_t{node.is_black()} << i;
          gray_ |= std::uint32_t{node.is_gray()} << i;
          if (node.is_gray()) words_[i] = node.word();
        }
  }

  Node tree_;                                     // any node of the source
  std::uint32_t all_ = 0, black_ = 0, gray_ = 0;  // cells of the window, one bit each
  int level_ = 0;
  std::array<std::int64_t, 3> low_{}, size_{};
  std::array<std::uint64_t, kCells> words_;  // of the gray ones
};

}  // namespace blackleaf::detail
