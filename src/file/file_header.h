// The part that all .octree files share: header, chunk table, and the bytes of a whole file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "blackleaf/frame.h"
#include "blackleaf/octree.h"
#include "blackleaf/work.h"
#include "file/byte_source.h"
#include "file/octree_format.h"

namespace blackleaf::detail::format {

struct Header {
  std::uint32_t version = kVersion;
  Content content = Content::solid;
  int depth = 1;
  std::size_t bytes = 0;  // where the first chunk begins
  Frame frame;
  std::string metadata;
  std::vector<ChunkEntry> chunks;
};

/// Reads the header and checks everything in it, in the order in which a reader comes to rely on it. Chunks' contents
/// lie within the file, one behind the other up to its end. Throws Error(bad_input) that begins with `name`.
Header read_header(const ByteSource& source, std::string_view name);

/// The contents of a chunk, their checksum checked. Throws Damage. May be called from several threads.
std::vector<std::uint8_t> chunk_bytes(const ByteSource& source, const ChunkEntry& entry);

/// Throws Error(bad_argument) for a frame or metadata that no file can keep.
void check_arguments(const Frame& frame, std::string_view metadata);

/// A chunk as it is written.
struct Chunk {
  ChunkKind kind = ChunkKind::uniform;
  std::uint32_t colour = 0;
  std::vector<std::uint8_t> contents;
};

/// The header of a file of the current version; of the chunks' entries kind, colour, stored bytes and checksum are
/// written. Requires: check_arguments() has passed.
std::vector<std::uint8_t> header_bytes(Content content, int depth, const Frame& frame, std::string_view metadata,
                                       const std::vector<ChunkEntry>& chunks);

/// The entry of a chunk that is written.
ChunkEntry entry_of(const Chunk& chunk);

/// A file of the current version. Requires: check_arguments() has passed.
std::vector<std::uint8_t> file_bytes(Content content, int depth, const Frame& frame, std::string_view metadata,
                                     const std::vector<Chunk>& chunks);

/// How chunks are worked on: threads only where there is more than one chunk.
inline Work one_thread_for_one(const Work& work, std::size_t chunks) {
  return chunks > 1 ? work : Work{1, work.progress};
}

}  // namespace blackleaf::detail::format
