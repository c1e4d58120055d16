// One .octree file written by many ranks (docs/MPI.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "blackleaf/octree.h"
#include "blackleaf/octree_file.h"
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

/// The octree file that the first rank has read, for all: each rank decodes its share of the chunks, and the octrees
/// are put together. A meeting. Throws as from_bytes.
OctreeFile load(Ranks& ranks, std::vector<std::uint8_t>& bytes, const std::string& name);

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

/// Writes the file that write_raw_volume() writes of an octree that every rank has: each rank a share of the slices. A
/// meeting. Throws as write_raw_volume.
void write_raw_volume(Ranks& ranks, const Octree& octree, const std::filesystem::path& path, bool crop);

}  // namespace blackleaf::mpi
