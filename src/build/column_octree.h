// From columns to octrees.
#pragma once

#include "blackleaf/octree.h"
#include "columns.h"

namespace blackleaf::detail {

/// The octree of the bricks in the slabs, or of all the others. O(bricks on the boundary log(their number)).
Octree octree_of_columns(const Slabs& slabs, int depth, const Frame& frame, bool complement, const Work& work);

}  // namespace blackleaf::detail
