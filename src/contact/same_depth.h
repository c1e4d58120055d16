// The check that two prepared solids are of one universe.
#pragma once

#include "blackleaf/prepared_solid.h"
#include "octree/same_depth.h"

namespace blackleaf::detail {

inline void require_same_depth(const PreparedSolid& a, const PreparedSolid& b) {
  require_same_depth(a.depth(), b.depth());
}

}  // namespace blackleaf::detail
