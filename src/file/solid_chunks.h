// The chunks of a solid, one by one: for those who write a part of a file.
#pragma once

#include <vector>

#include "blackleaf/octree.h"
#include "file/file_header.h"

namespace blackleaf::detail {

/// The nodes that chunks hold, in curve order; valid as long as the octree lives.
std::vector<Node> chunk_nodes(const Octree& octree);

/// One of them as it is written. Depends on the subtree alone.
format::Chunk solid_chunk(const Node& node);

}  // namespace blackleaf::detail
