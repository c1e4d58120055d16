#include <algorithm>
#include <cassert>
#include <cmath>

#include "grow_kernels.h"
#include "octree/brick.h"

namespace blackleaf::detail {

std::int64_t root_of(std::int64_t square) {
  auto root = static_cast<std::int64_t>(std::sqrt(static_cast<double>(square)));
  while (root * root > square) --root;
  while ((root + 1) * (root + 1) <= square) ++root;
  return root;
}

namespace {

constexpr int kSide = static_cast<int>(Tile::kSide);
constexpr int kMost = SmallBall::kMostReach;
constexpr int kWindow = kSide + 2 * kMost;  // source voxels along an axis that a tile may see: as many as a word's bits
static_assert(kWindow == 64 && SmallBall::kTileLevel == Tile::kLevel);

// The source voxels around a tile. Bit i of rows[z][y] is the voxel (i - kMost, y - first, z - first) from the tile's
// corner, first = reach + kMargin: a brick that begins up to kMargin before the window or ends up to kMargin beyond it
// need not be cut.
class Window {
 public:
  static constexpr int kMargin = 3;

  Window(const Sites& sites, const Cube& tile, int reach) : first_(reach + kMargin), box_(VoxelBox::of(tile)) {
    corner_ = box_.low;
    for (std::size_t i = 0; i < 3; ++i) {
      box_.low[i] -= reach;
      box_.high[i] += reach;
    }
    for (const Site& site : sites) add(site.node, site.box);
  }

  /// The rows with the given z, counted from the tile's corner, the first of them at y = -reach.
  const std::uint64_t* plane(int z) const { return &rows_[index(z)][kMargin]; }

 private:
  std::size_t index(int at) const { return static_cast<std::size_t>(std::int64_t{at} + first_); }

  void add(const Node& node, const VoxelBox& box) {
    for (std::size_t i = 0; i < 3; ++i)
      if (box.high[i] < box_.low[i] || box.low[i] > box_.high[i]) return;
    if (node.is_black()) {
      fill(box);
    } else if (node.level() == 2) {
      put(node.brick(), box.low[0] - corner_[0] + kMost, box.low[1] - corner_[1], box.low[2] - corner_[2]);
    } else {
      for (int octant = 0; octant < 8; ++octant) {
        const Node child = node.child(octant);
        if (!child.is_white()) add(child, box.child(octant));
      }
    }
  }

  void put(std::uint64_t brick, int x, int y, int z) {
    const std::uint64_t in_rows = rows_from_brick(brick);
    for (int row = 0; row < 16; ++row) {
      const std::uint64_t voxels = in_rows >> (4 * row) & 0xF;
      rows_[index(z + row / 4)][index(y + row % 4)] |= x < 0 ? voxels >> -x : voxels << x;
    }
  }

  void fill(const VoxelBox& box) {
    std::array<int, 3> low{}, high{};
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::max(box.low[i], box_.low[i]) - corner_[i];
      high[i] = std::min(box.high[i], box_.high[i]) - corner_[i];
    }
    const std::uint64_t row = ~std::uint64_t{0} >> (63 - (high[0] - low[0])) << (low[0] + kMost);
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y) rows_[index(z)][index(y)] |= row;
  }

  int first_;
  VoxelBox box_;  // of the voxels the tile may see
  std::array<std::int32_t, 3> corner_{};
  std::array<std::array<std::uint64_t, kWindow + 2 * kMargin>, kWindow + 2 * kMargin> rows_{};
};

}  // namespace

SmallBall::SmallBall(std::int64_t squared) : reach_(static_cast<int>(root_of(squared))) {
  assert(squared >= 0 && reach_ <= kMostReach);
  for (int z = 0; z <= kMostReach; ++z)
    for (int w = 0; w <= kMostReach; ++w) {
      const std::int64_t rest = squared - z * z - w * w;
      half_[static_cast<std::size_t>(z)][static_cast<std::size_t>(w)] = rest < 0 ? -1 : static_cast<int>(root_of(rest));
    }
}

Tile SmallBall::grow(const Sites& sites, const Cube& cube) const {
  assert(cube.level <= kTileLevel);
  const Window window(sites, cube, reach_);
  const int side = cube.side(), rows = kSide + 2 * reach_;
  Tile tile;
  // spread[w][y]: the source row at y - reach, each voxel spread w both ways along x; only the tile's 32 places.
  std::array<std::array<std::uint32_t, kWindow>, kMost + 1> spread;
  for (int from = -reach_; from < side + reach_; ++from) {
    const std::uint64_t* const plane = window.plane(from);
    if (std::all_of(plane, plane + rows, [](std::uint64_t row) { return row == 0; })) continue;
    std::array<std::uint64_t, kWindow> now;
    std::copy_n(plane, rows, now.begin());
    for (int w = 0; w <= reach_; ++w) {
      auto& of_width = spread[static_cast<std::size_t>(w)];
      for (std::size_t y = 0; y < static_cast<std::size_t>(rows); ++y) {
        now[y] |= plane[y] << w | plane[y] >> w;
        of_width[y] = static_cast<std::uint32_t>(now[y] >> kMost);
      }
    }
    for (int away = 0; away <= reach_; ++away) {
      const bool before = from - away >= 0 && from - away < side, after = from + away >= 0 && from + away < side;
      if (!before && !after) continue;
      const auto& half = half_[static_cast<std::size_t>(away)];
      std::array<std::uint32_t, Tile::kSide> disc{};
      // Widths fall as |dy| rises: the widest row of the ball's disc at dy is the last w whose half reaches |dy|.
      int w = reach_;
      for (int dy = 0; dy <= half[0]; ++dy) {
        while (half[static_cast<std::size_t>(w)] < dy) --w;
        const std::uint32_t* const up =
            &spread[static_cast<std::size_t>(w)][static_cast<std::size_t>(std::int64_t{reach_} + dy)];
        const std::uint32_t* const down = &spread[static_cast<std::size_t>(w)][static_cast<std::size_t>(reach_ - dy)];
        for (std::size_t y = 0; y < Tile::kSide; ++y) disc[y] |= up[y] | down[y];
      }
      const auto unite = [&](int z) {
        auto& to = tile.rows[static_cast<std::size_t>(z)];
        for (std::size_t y = 0; y < Tile::kSide; ++y) to[y] |= disc[y];
      };
      if (before) unite(from - away);
      if (after && away != 0) unite(from + away);
    }
  }
  return tile;
}

}  // namespace blackleaf::detail
