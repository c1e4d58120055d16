// DenseGrid: the slow readable twin of Octree: a cube of booleans. No cleverness on purpose.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "blackleaf/implicit.h"
#include "blackleaf/measures.h"
#include "blackleaf/octree.h"

namespace blackleaf::reference {

struct DenseGrid {
  int depth = 1;
  std::vector<std::uint8_t> voxels;  // x fastest

  explicit DenseGrid(int n) : depth(n), voxels(std::size_t{1} << (3 * n), 0) {}

  int side() const { return 1 << depth; }
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(side()) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(side()) +
           static_cast<std::size_t>(x);
  }
  /// Outside the universe everything is white.
  bool at(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const std::int64_t n = side();
    if (x < 0 || y < 0 || z < 0 || x >= n || y >= n || z >= n) return false;
    return voxels[index(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z))] != 0;
  }
  void set(int x, int y, int z, bool black = true) { voxels[index(x, y, z)] = black; }

  template <class Visit>
  void for_each(Visit visit) const {
    for (int z = 0; z < side(); ++z)
      for (int y = 0; y < side(); ++y)
        for (int x = 0; x < side(); ++x) visit(x, y, z, at(x, y, z));
  }
  friend bool operator==(const DenseGrid&, const DenseGrid&) = default;
};

inline DenseGrid dense(const Octree& octree) {
  DenseGrid grid(octree.depth());
  grid.for_each([&](int x, int y, int z, bool) { grid.set(x, y, z, octree.contains(x, y, z)); });
  return grid;
}

/// Through the classifier, one voxel at a time.
inline Octree octree(const DenseGrid& grid) {
  return octree_from_classifier(grid.depth, [&](const Cube& c) {
    if (c.level > 0) return Colour::gray;
    return grid.at(c.x, c.y, c.z) ? Colour::black : Colour::white;
  });
}

/// Random solids made to be nasty: noise at several densities, boxes that touch faces, edges and the universe's walls,
/// balls, single voxels, unions and differences of these, and now and then the empty and the full universe.
inline DenseGrid random_solid(int depth, std::mt19937& random) {
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  DenseGrid grid(depth);
  const int n = grid.side();
  const int kind = pick(0, 19);
  if (kind == 0) return grid;
  if (kind == 1) {
    grid.voxels.assign(grid.voxels.size(), 1);
    return grid;
  }
  if (kind <= 4) {
    const int percent = std::array{3, 50, 97}[static_cast<std::size_t>(kind - 2)];
    for (auto& v : grid.voxels) v = pick(0, 99) < percent;
    return grid;
  }
  if (kind == 5) {
    grid.set(pick(0, 1) * (n - 1), pick(0, 1) * (n - 1), pick(0, 1) * (n - 1));
    return grid;
  }
  for (int part = pick(1, 4); part > 0; --part) {
    const bool black = part % 3 != 0 || pick(0, 1);
    if (pick(0, 2)) {
      std::array<int, 3> low{}, high{};
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = pick(0, n - 1);
        high[i] = pick(low[i] + 1, n);
        if (pick(0, 3) == 0) low[i] = 0;
        if (pick(0, 3) == 0) high[i] = n;
      }
      for (int z = low[2]; z < high[2]; ++z)
        for (int y = low[1]; y < high[1]; ++y)
          for (int x = low[0]; x < high[0]; ++x) grid.set(x, y, z, black);
    } else {
      const int cx = pick(0, 2 * n), cy = pick(0, 2 * n), cz = pick(0, 2 * n), r = pick(1, n);
      grid.for_each([&](int x, int y, int z, bool) {
        const int dx = 2 * x + 1 - cx, dy = 2 * y + 1 - cy, dz = 2 * z + 1 - cz;
        if (dx * dx + dy * dy + dz * dz <= r * r) grid.set(x, y, z, black);
      });
    }
  }
  return grid;
}

/// Fails the current test with the first broken invariant.
inline void expect_valid(const Octree& octree) { EXPECT_EQ(validate(octree), ""); }

}  // namespace blackleaf::reference
