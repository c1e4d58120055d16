// The contents of version 2, solids: one chunk's subtree, node by node, in the context of its neighbours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "octree/node_arrays.h"

namespace blackleaf::detail {

/// The bytes of a gray node of level >= 2. Depend on the subtree alone.
std::vector<std::uint8_t> encode_solid(const Node& node);

/// The node of the given level that the bytes stand for, its words appended to `arrays` in the order of the curve that
/// enters it with `table`. Throws Damage for bytes that encode_solid cannot have made. The octree takes at most some
/// 1600 times bytes.size(), and reading it a few times that.
Subtree decode_solid(std::span<const std::uint8_t> bytes, int level, unsigned table, NodeArrays& arrays);

}  // namespace blackleaf::detail
