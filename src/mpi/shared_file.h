// One .octree file written by many ranks (docs/MPI.md).
#pragma once

#include <filesystem>
#include <string>

#include "blackleaf/octree.h"
#include "blackleaf/work.h"
#include "ranks.h"
#include "stretch.h"

namespace blackleaf::mpi {

/// An octree that the ranks have together: every rank holds the chunks (docs/FILE_FORMAT.md) that begin in its stretch,
/// whole. `own` is white elsewhere.
struct SharedOctree {
  Octree own;
  Stretch chunks;  // of the chunks held; ends at chunk borders
};

/// From parts to chunks: a rank whose stretch begins within a chunk sends what it has of that chunk to the rank in
/// whose stretch the chunk begins, its left neighbour unless stretches are smaller than chunks. A meeting.
SharedOctree by_chunks(Ranks& ranks, const Octree& part, const Cuts& cuts);

/// What is told of an octree when it has been made.
struct Told {
  std::uint64_t volume = 0, black_leaves = 0, internal_nodes = 0, memory_bytes = 0;
};
/// Of the whole octree, for all ranks. A meeting. O(words of this rank's chunks).
Told tell_of(Ranks& ranks, const SharedOctree& octree);
/// Whether the whole octree is white, for all ranks. A meeting.
bool is_empty(Ranks& ranks, const SharedOctree& octree);

/// Writes the file that save() would write of the whole octree. Chunks are coded by the ranks that hold them; their
/// sizes and checksums are gathered, and every rank writes its own at their place, the first the header. The file is
/// written under a temporary name, which the first rank changes when all is on disk. A meeting. Throws Error(io).
void save(Ranks& ranks, const SharedOctree& octree, const std::filesystem::path& path, const std::string& metadata,
          const Work& work);

}  // namespace blackleaf::mpi
