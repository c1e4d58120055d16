// SourceWindow: the few nodes of a source tree that a target node may see.
//
// A target node of level k, moved back into the source, lies in a box that meets at most three cells of level k on
// every axis: the box is less than sqrt(3) 2^k long, so with both ends closed it meets floor(sqrt(3)) + 2 = 3. The
// window holds the source's nodes of level k for these cells; the window of a child is read off its parent's in at most
// kWidth^3 steps, without a search from the root. An integer translation needs two cells an axis.
#pragma once

#include <array>
#include <cstdint>

#include "octree/node_arrays.h"

namespace blackleaf::detail {

/// Cells of one level, [low, high] on every axis, in units of that level's side.
struct CellRange {
  std::array<std::int64_t, 3> low{}, high{};
};

/// kWidth: the most cells on an axis.
template <int kWidth>
class SourceWindow {
  static constexpr std::size_t kCells = kWidth * kWidth * kWidth;

 public:
  /// The window on a whole source: its root and white cells around it.
  static SourceWindow of_root(const Node& root, const CellRange& cells) {
    SourceWindow window;
    window.reset(cells, root.level());
    window.fill([&](std::int64_t x, std::int64_t y, std::int64_t z) {
      return (x | y | z) == 0 ? root : Node::uniform(root.level(), Colour::white);
    });
    return window;
  }

  /// The window on `cells` of the next lower level. Requires: every cell lies in a cell of this window.
  SourceWindow narrowed(const CellRange& cells) const {
    SourceWindow window;
    window.reset(cells, level_ - 1);
    window.fill([&](std::int64_t x, std::int64_t y, std::int64_t z) {
      return node(x >> 1, y >> 1, z >> 1).child(static_cast<int>((x & 1) | (y & 1) << 1 | (z & 1) << 2));
    });
    return window;
  }

  /// Black or white if all nodes of the window are, else gray.
  Colour colour() const { return colour_; }

  /// The node of a cell. Requires: the cell is in the window.
  const Node& node(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return nodes_[static_cast<std::size_t>((x - low_[0]) + kWidth * ((y - low_[1]) + kWidth * (z - low_[2])))];
  }

  const std::array<std::int64_t, 3>& low() const { return low_; }

  /// The voxels of the window as bricks, indexed x + kWidth (y + kWidth z) from its lowest cell. Requires: a window of
  /// level 2.
  std::array<std::uint64_t, kCells> bricks() const {
    std::array<std::uint64_t, kCells> result{};
    for (std::int64_t z = 0; z < size_[2]; ++z)
      for (std::int64_t y = 0; y < size_[1]; ++y)
        for (std::int64_t x = 0; x < size_[0]; ++x) {
          const auto i = static_cast<std::size_t>(x + kWidth * (y + kWidth * z));
          result[i] = nodes_[i].brick();
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

  template <class NodeOf>
  void fill(NodeOf node_of) {
    bool black = false, white = false, gray = false;
    for (std::int64_t z = 0; z < size_[2]; ++z)
      for (std::int64_t y = 0; y < size_[1]; ++y)
        for (std::int64_t x = 0; x < size_[0]; ++x) {
          const Node node = node_of(low_[0] + x, low_[1] + y, low_[2] + z);
          black |= node.is_black();
          white |= node.is_white();
          gray |= node.is_gray();
          nodes_[static_cast<std::size_t>(x + kWidth * (y + kWidth * z))] = node;
        }
    colour_ = gray || (black && white) ? Colour::gray : black ? Colour::black : Colour::white;
  }

  std::array<Node, kCells> nodes_;
  std::array<std::int64_t, 3> low_{}, size_{};
  int level_ = 0;
  Colour colour_ = Colour::white;
};

}  // namespace blackleaf::detail
