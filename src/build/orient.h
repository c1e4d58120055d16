// Turning the triangles of a surface so that they agree and face outward.
#pragma once

#include <cstdint>

#include "grid_mesh.h"

namespace blackleaf::detail {

struct Orientation {
  std::uint64_t turned = 0;     // triangles that were turned, but for turning the surface over as a whole
  std::uint64_t one_sided = 0;  // parts that cannot be oriented; left as they were
};

/// Orients the mesh as solid_from_mesh() says. Parts are joined by edges of two triangles, and by edges of more that
/// are passed equally often both ways as given. What is nested is decided in integers. O(triangles log(triangles)) and,
/// for parts whose facing is in doubt, their triangles times those of larger parts that lie at the same y and z.
Orientation orient(GridMesh& mesh);

}  // namespace blackleaf::detail
