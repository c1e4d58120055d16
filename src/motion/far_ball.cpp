#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>
#include <span>
#include <vector>

#include "grow_kernels.h"
#include "octree/brick.h"

namespace blackleaf::detail {
namespace {

constexpr int kSide = 1 << FarBall::kTileLevel;
constexpr std::size_t kLanes = kSide;

// A brick of the source and its first voxel, from the tile's corner.
struct Brick {
  std::uint64_t in_rows;
  std::array<std::int32_t, 3> at;
};

// One row of source voxels along x, as a tile sees it.
struct Row {
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();
  std::int32_t before = kNone;  // the nearest black voxel at -before, if before the tile
  std::int32_t after = kNone;   // the nearest black voxel at kSide - 1 + after, if after the tile
  std::uint32_t within = 0;     // black voxels 0..15

  bool empty() const { return before == kNone && after == kNone && within == 0; }
  // Four voxels, the first of them at x.
  void add(std::uint32_t voxels, std::int32_t x) {
    if (voxels == 0) return;
    if (x > -4 && x < kSide) {
      const std::uint32_t inside = (0xFu << std::max(0, -x)) & (0xFu >> std::max(0, x - (kSide - 4)));
      within |= (x < 0 ? (voxels & inside) >> -x : (voxels & inside) << x);
      if ((voxels & ~inside) == 0) return;
      voxels &= ~inside;
    }
    if (x < 0)
      before = std::min(before, -(x + static_cast<std::int32_t>(std::bit_width(voxels)) - 1));
    else
      after = std::min(after, x + std::countr_zero(voxels) - (kSide - 1));
  }
};

std::int64_t square(std::int64_t v) { return v * v; }
// The distance of a place from the tile along one axis.
std::int64_t gap(std::int64_t at) { return std::max<std::int64_t>({0, -at, at - (kSide - 1)}); }

// Squared distances up to kFar, beyond which none is told apart; sums of two of them fit in Number.
template <class Number>
class Distances {
 public:
  static constexpr std::int64_t kFar = std::int64_t{1} << (std::numeric_limits<Number>::digits - 1);

  /// Requires: squared < kFar.
  Distances(std::int64_t squared, const Cube& cube)
      : squared_(squared), side_(cube.side()), corner_{cube.x, cube.y, cube.z} {
    assert(squared < kFar);
    for (auto& plane : least_)
      for (auto& row : plane) row.fill(static_cast<Number>(kFar));
  }

  Tile grow(const Sites& sites, const Cube& cube) {
    const VoxelBox box = VoxelBox::of(cube);
    for (const Site& site : sites) add(site.node, site.box, box);
    std::sort(bricks_.begin(), bricks_.end(), [](const Brick& a, const Brick& b) { return a.at[2] < b.at[2]; });
    for (std::size_t first = 0; first < bricks_.size();) {
      std::size_t last = first;
      while (last < bricks_.size() && bricks_[last].at[2] == bricks_[first].at[2]) ++last;
      slab(std::span(bricks_).subspan(first, last - first));
      first = last;
    }
    Tile tile;
    for (std::size_t z = 0; z < kLanes; ++z)
      for (std::size_t y = 0; y < kLanes; ++y)
        for (std::size_t x = 0; x < kLanes; ++x) tile.rows[z][y] |= std::uint32_t{least_[z][y][x] <= squared_} << x;
    return tile;
  }

 private:
  using Lanes = std::array<Number, kLanes>;  // along x
  using Plane = std::array<Lanes, kLanes>;   // by y

  void add(const Node& node, const VoxelBox& at, const VoxelBox& tile) {
    if (least_squared(tile, at) > squared_) return;
    if (node.is_black() && node.level() != 2) {
      add_box(at);
    } else if (node.level() == 2) {
      bricks_.push_back(
          {rows_from_brick(node.brick()), {at.low[0] - corner_[0], at.low[1] - corner_[1], at.low[2] - corner_[2]}});
    } else {
      for (int octant = 0; octant < 8; ++octant) {
        const Node child = node.child(octant);
        if (!child.is_white()) add(child, at.child(octant), tile);
      }
    }
  }

  Number number(std::int64_t squared) const { return static_cast<Number>(std::min(squared, kFar)); }

  // A black box: distances to it are sums of one term an axis.
  void add_box(const VoxelBox& box) {
    std::array<std::array<std::int64_t, kLanes>, 3> terms;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < kLanes; ++k) {
        const std::int64_t at = corner_[i] + static_cast<std::int64_t>(k);
        terms[i][k] = square(std::max<std::int64_t>({0, box.low[i] - at, at - box.high[i]}));
      }
    Lanes along_x;
    for (std::size_t x = 0; x < kLanes; ++x) along_x[x] = number(terms[0][x]);
    for (std::size_t z = 0; z < kLanes; ++z)
      for (std::size_t y = 0; y < kLanes; ++y)
        if (terms[2][z] + terms[1][y] <= squared_) lower(least_[z][y], along_x, terms[2][z] + terms[1][y]);
  }

  static void lower(Lanes& to, const Lanes& from, std::int64_t by) {
    const auto add = static_cast<Number>(by);
    for (std::size_t x = 0; x < kLanes; ++x) to[x] = std::min(to[x], static_cast<Number>(from[x] + add));
  }

  // Four planes of source voxels, whose bricks all begin at the same z.
  void slab(std::span<const Brick> bricks) {
    std::int32_t first = bricks.front().at[1], last = first;
    for (const Brick& brick : bricks) {
      first = std::min(first, brick.at[1]);
      last = std::max(last, brick.at[1] + 3);
    }
    const auto count = static_cast<std::size_t>(std::int64_t{last} - first + 1);
    rows_.assign(4 * count, {});
    for (const Brick& brick : bricks)
      for (std::size_t k = 0; k < 16; ++k)
        rows_[k / 4 * count + static_cast<std::size_t>(brick.at[1] - first) + k % 4].add(
            static_cast<std::uint32_t>(brick.in_rows >> (4 * k) & 0xF), brick.at[0]);
    for (std::size_t k = 0; k < 4; ++k)
      plane(std::span(rows_).subspan(k * count, count), first, bricks.front().at[2] + static_cast<std::int32_t>(k));
  }

  // The source rows of one z, the first of them at y = first.
  void plane(std::span<const Row> rows, std::int32_t first, std::int32_t z) {
    const std::int64_t left = squared_ - square(gap(z));  // for x and y
    if (left < 0) return;
    Plane least;
    for (Lanes& row : least) row.fill(static_cast<Number>(kFar));
    bool any = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].empty()) continue;
      const std::int64_t y_of_row = first + static_cast<std::int64_t>(i);
      const Row& row = rows[i];
      const std::int64_t along_x = row.within != 0 ? 0 : square(std::min(row.before, row.after));
      if (along_x + square(gap(y_of_row)) > left) continue;
      const Lanes distances = along(row);
      // From the target row nearest to it outward, as far as it can reach.
      const auto at = [&](std::int64_t y) {
        if (square(y - y_of_row) > left - along_x) return false;
        lower(least[static_cast<std::size_t>(y)], distances, square(y - y_of_row));
        return true;
      };
      const std::int64_t nearest = std::clamp<std::int64_t>(y_of_row, 0, side_ - 1);
      for (std::int64_t y = nearest; y < side_ && at(y); ++y) continue;
      for (std::int64_t y = nearest - 1; y >= 0 && at(y); --y) continue;
      any = true;
    }
    if (!any) return;
    const std::int64_t reach = root_of(squared_);
    const std::int64_t low = std::max<std::int64_t>(0, z - reach), high = std::min<std::int64_t>(side_ - 1, z + reach);
    for (std::int64_t to = low; to <= high; ++to)
      for (std::size_t y = 0; y < static_cast<std::size_t>(side_); ++y)
        lower(least_[static_cast<std::size_t>(to)][y], least[y], square(to - z));
  }

  // Squared distances along x to the nearest black voxel of a row.
  Lanes along(const Row& row) const {
    Lanes result;
    for (std::size_t x = 0; x < kLanes; ++x) {
      const auto at = static_cast<std::int64_t>(x);
      result[x] = number(std::min(square(at + row.before), square(kSide - 1 - at + row.after)));
    }
    for (std::uint32_t rest = row.within; rest != 0; rest &= rest - 1) {
      const std::int64_t black = std::countr_zero(rest);
      for (std::size_t x = 0; x < kLanes; ++x)
        result[x] = std::min(result[x], static_cast<Number>(square(static_cast<std::int64_t>(x) - black)));
    }
    return result;
  }

  std::int64_t squared_;
  std::int32_t side_;
  std::array<std::int32_t, 3> corner_;
  std::vector<Brick> bricks_;
  std::vector<Row> rows_;
  std::array<Plane, kLanes> least_;  // of every voxel of the tile, by z
};

template <class Number>
Tile grow(std::int64_t squared, const Sites& sites, const Cube& cube) {
  return Distances<Number>(squared, cube).grow(sites, cube);
}

}  // namespace

Tile FarBall::grow(const Sites& sites, const Cube& cube) const {
  assert(cube.level <= kTileLevel);
  if (squared_ < Distances<std::int16_t>::kFar) return detail::grow<std::int16_t>(squared_, sites, cube);
  if (squared_ < Distances<std::int32_t>::kFar) return detail::grow<std::int32_t>(squared_, sites, cube);
  return detail::grow<std::int64_t>(squared_, sites, cube);
}

}  // namespace blackleaf::detail
