// The one check, and the one message, for operations on octrees of one universe.
#pragma once

#include <string>

#include "blackleaf/error.h"
#include "blackleaf/octree.h"

namespace blackleaf::detail {

inline void require_same_depth(int a, int b) {
  if (a != b)
    throw Error(ErrorCode::bad_argument, "the octrees have depths " + std::to_string(a) + " and " + std::to_string(b),
                "build both with the same depth");
}

inline void require_same_depth(const Octree& a, const Octree& b) { require_same_depth(a.depth(), b.depth()); }

}  // namespace blackleaf::detail
