// Dense solids enlarged and moved into larger universes.
#pragma once

#include <array>
#include <cstdint>

#include "reference/dense_grid.h"

namespace blackleaf::reference {

/// The same solid, `factor` times as large, moved by `by` in another universe.
inline Octree placed(const DenseGrid& grid, int depth, std::int32_t factor, const std::array<std::int32_t, 3>& by) {
  const std::int32_t side = grid.side() * factor;
  return octree_from_classifier(depth, [&, side](const Cube& cube) {
    const std::array<std::int32_t, 3> low = {cube.x - by[0], cube.y - by[1], cube.z - by[2]};
    std::array<std::int32_t, 3> first{}, last{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (low[i] + cube.side() <= 0 || low[i] >= side) return Colour::white;
      first[i] = (low[i] < 0 ? low[i] - factor + 1 : low[i]) / factor;
      const std::int32_t end = low[i] + cube.side() - 1;
      last[i] = end / factor;
    }
    if (last[0] - first[0] > 1 || last[1] - first[1] > 1 || last[2] - first[2] > 1) return Colour::gray;
    bool some = false, all = true;
    for (int z = first[2]; z <= last[2]; ++z)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int x = first[0]; x <= last[0]; ++x) (grid.at(x, y, z) ? some : all) = grid.at(x, y, z);
    return !some ? Colour::white : all ? Colour::black : Colour::gray;
  });
}

}  // namespace blackleaf::reference
