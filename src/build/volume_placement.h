// Where a volume lies in its universe, checked.
#pragma once

#include <array>
#include <cstdint>

#include "blackleaf/voxels.h"

namespace blackleaf::detail {

/// The depth of the universe. Throws Error(bad_input) for a volume without voxels or one that does not fit,
/// Error(bad_argument) for a depth outside 0..20.
int checked_depth(const std::array<std::int64_t, 3>& size, const VolumePlacement& placement);

/// A box of voxels [low, high) in a universe of some depth.
struct PlacedBox {
  int depth = 1;
  std::array<std::int64_t, 3> low{}, high{};
};

/// The box of a volume. Errors as checked_depth.
inline PlacedBox placed_box(const std::array<std::int64_t, 3>& size, const VolumePlacement& placement) {
  PlacedBox box;
  box.depth = checked_depth(size, placement);
  for (std::size_t i = 0; i < 3; ++i) {
    box.low[i] = placement.corner[i];
    box.high[i] = box.low[i] + size[i];
  }
  return box;
}

}  // namespace blackleaf::detail
