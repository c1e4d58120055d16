// Where a volume lies in its universe, checked.
#pragma once

#include <array>
#include <cstdint>

#include "blackleaf/voxels.h"

namespace blackleaf::detail {

/// The depth of the universe. Throws Error(bad_input) for a volume without voxels or one that does not fit,
/// Error(bad_argument) for a depth outside 0..20.
int checked_depth(const std::array<std::int64_t, 3>& size, const VolumePlacement& placement);

}  // namespace blackleaf::detail
