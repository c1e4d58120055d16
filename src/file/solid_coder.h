// The contents of version 2, solids: one chunk's subtree, node by node, in the context of its neighbours.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "blackleaf/work.h"
#include "octree/node_arrays.h"

namespace blackleaf::detail {

/// The bytes of a gray node of level >= 2. Depend on the subtree alone.
std::vector<std::uint8_t> encode_solid(const Node& node);

/// A chunk that is read, and what comes of it.
struct SolidPart {
  bool coded = false;     // whether it has contents
  std::size_t bytes = 0;  // of these
  unsigned table = 0;     // with which the curve enters it
  Subtree top;            // its node
  NodeArrays arrays;      // and the nodes below it
  std::string damage;     // what is wrong with it, if anything
};

/// The contents of parts[i]. Called from several threads; may throw Damage.
using ChunkContents = std::function<std::vector<std::uint8_t>(std::size_t i)>;

/// Reads the chunks of the given level that have contents, on all threads and two at a time on each: fills `top` and
/// `arrays`, or `damage` if encode_solid cannot have made the contents. An octree takes at most some 1600 times its
/// bytes, and reading it a few times that. Throws Error(cancelled).
void decode_solids(std::span<SolidPart> parts, int level, const Work& work, const ChunkContents& contents);

}  // namespace blackleaf::detail
