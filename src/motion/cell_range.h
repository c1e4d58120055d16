// CellRange: a box of nodes of one level.
#pragma once

#include <array>
#include <cstdint>

namespace blackleaf::detail {

/// Cells of one level, [low, high] on every axis, in units of that level's side.
struct CellRange {
  std::array<std::int64_t, 3> low{}, high{};
};

}  // namespace blackleaf::detail
