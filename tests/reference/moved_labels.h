// Dense label maps in motion, by the definition.
#pragma once

#include <algorithm>

#include "reference/dense_labels.h"
#include "reference/dense_motion.h"

namespace blackleaf::reference {

/// Every voxel takes the largest label of the closed voxels that hold its centre, moved back.
inline DenseLabels move(const DenseLabels& grid, const FixedMotion& motion) {
  DenseLabels result(grid.depth);
  const int side = grid.side();
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        for_each_touched(motion, {x, y, z}, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
          if (std::min({i, j, k}) < 0 || std::max({i, j, k}) >= side) return;
          auto& label = result.at(x, y, z);
          label = std::max(label, grid.at(static_cast<int>(i), static_cast<int>(j), static_cast<int>(k)));
        });
  return result;
}

}  // namespace blackleaf::reference
