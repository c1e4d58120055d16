// Growing and shrinking of dense grids: by distances along one axis after the other.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "reference/dense_grid.h"

namespace blackleaf::reference {

/// The grid in a universe of another depth, its corner at `corner`; white around it.
inline DenseGrid placed(const DenseGrid& grid, int depth, const std::array<int, 3>& corner) {
  DenseGrid result(depth);
  result.for_each(
      [&](int x, int y, int z, bool) { result.set(x, y, z, grid.at(x - corner[0], y - corner[1], z - corner[2])); });
  return result;
}

/// Voxels within the radius of a voxel of the given colour, centre to centre, those outside the universe included:
/// least squared distances axis after axis, each by looking at every place. One layer of outside is enough: it is
/// nearer than the next.
inline DenseGrid near(const DenseGrid& grid, double radius, bool black) {
  const int n = grid.side() + 2;  // with the layer
  const auto count = static_cast<std::size_t>(n);
  constexpr int kFar = 1 << 28;
  std::vector<int> squared(count * count * count);
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        squared[static_cast<std::size_t>((z * n + y) * n + x)] = grid.at(x - 1, y - 1, z - 1) == black ? 0 : kFar;
  for (const std::size_t step : {std::size_t{1}, count, count * count}) {
    const std::vector<int> before = squared;
    for (std::size_t i = 0; i < squared.size(); ++i) {
      const std::size_t at = i / step % count;
      for (std::size_t to = 0; to < count; ++to) {
        const int away = static_cast<int>(at) - static_cast<int>(to);
        squared[i] = std::min(squared[i], before[i - at * step + to * step] + away * away);
      }
    }
  }
  DenseGrid result(grid.depth);
  result.for_each([&](int x, int y, int z, bool) {
    const double distance2 = squared[static_cast<std::size_t>(((z + 1) * n + y + 1) * n + x + 1)];
    // Rounded only once, at the end, so its sign is exact.
    result.set(x, y, z, std::fma(radius, radius, -distance2) >= 0 && distance2 < kFar);
  });
  return result;
}

inline DenseGrid grow(const DenseGrid& grid, double radius) { return near(grid, radius, true); }

inline DenseGrid shrink(const DenseGrid& grid, double radius) {
  DenseGrid result = near(grid, radius, false);
  for (auto& voxel : result.voxels) voxel = !voxel;
  return result;
}

/// In a universe with room for the grown solid on all sides.
inline DenseGrid closing(const DenseGrid& grid, double radius) {
  int depth = grid.depth;
  const double reach = std::floor(radius);
  while ((1 << depth) < grid.side() + 2 * reach) ++depth;
  const int corner = ((1 << depth) - grid.side()) / 2;
  const DenseGrid closed = shrink(grow(placed(grid, depth, {corner, corner, corner}), radius), radius);
  return placed(closed, grid.depth, {-corner, -corner, -corner});
}

}  // namespace blackleaf::reference
