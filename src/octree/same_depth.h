// The one check, and the one message, for operations on octrees of one universe.
#pragma once

#include <string>

#include "blackleaf/error.h"
#include "blackleaf/octree.h"

namespace blackleaf::detail {

inline void require_same_depth(const Octree& a, const Octree& b) {
  if (a.depth() != b.depth())
    throw Error(ErrorCode::bad_argument,
                "the octrees have depths " + std::to_string(a.depth()) + " and " + std::to_string(b.depth()),
                "build both with the same depth");
}

}  // namespace blackleaf::detail
