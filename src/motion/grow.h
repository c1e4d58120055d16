// Growing a solid by a ball: the producer behind offset.h.
#pragma once

#include <array>
#include <cstdint>

#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf::detail {

/// A solid to grow, and where its universe lies in that of the result.
struct Placed {
  Octree octree;
  std::array<std::int64_t, 3> corner{};  // of the solid's universe, in the result's voxels
  bool black_outside = false;            // what lies outside the solid's universe
};

/// Voxels of a universe of `depth` within the squared radius of a black voxel, centre to centre. Requires: 0 <= squared
/// <= 2^44; all corners within 2^22 voxels.
Octree grow(const Placed& solid, std::int64_t squared, int depth, Frame frame, const Work& work);

}  // namespace blackleaf::detail
