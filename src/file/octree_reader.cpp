#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/octree_file.h"
#include "file/byte_source.h"
#include "file/file_header.h"
#include "file/label_chunks.h"
#include "file/old_runs.h"

namespace blackleaf {
namespace {

using namespace detail::format;
using Bytes = std::vector<std::uint8_t>;

LabelMap read_labels(const detail::ByteSource& source, std::string_view name, const Header& header) {
  LabelMapBuilder builder(header.depth);
  for (std::size_t i = 0; i < header.chunks.size(); ++i) {
    const ChunkEntry& entry = header.chunks[i];
    if (entry.kind == ChunkKind::uniform) {
      builder.add(chunk_voxels(header.depth), entry.colour);
      continue;
    }
    try {
      detail::decode_labels(chunk_bytes(source, name, header, i), chunk_voxels(header.depth),
                            [&](std::uint64_t count, std::uint32_t label) { builder.add(count, label); });
    } catch (const std::string& problem) {
      throw Error(ErrorCode::bad_input, fmt::format("{}: chunk {}: {}", name, i, problem), std::string(kDamaged));
    }
  }
  return builder.finish(header.frame);
}

OctreeFile read(const detail::ByteSource& source, std::string_view name) {
  Header header = read_header(source, name);
  if (header.content == Content::labels) {
    LabelMap labels = read_labels(source, name, header);
    Octree octree = octree_from_labels(labels);
    return {std::move(octree), std::move(header.metadata), source.size(), std::move(labels)};
  }
  return {read_old_runs(source, name, header), std::move(header.metadata), source.size(), std::nullopt};
}

}  // namespace

OctreeFile load(const std::filesystem::path& path) {
  detail::InputFile file(path);
  if (file.is_regular()) return read(detail::FileBytes(file), path.string());
  // A pipe: take what it gives; the checks are the same.
  Bytes bytes;
  std::array<std::uint8_t, 1 << 16> buffer;
  while (const std::size_t got = file.read_some(buffer))
    bytes.insert(bytes.end(), buffer.begin(), buffer.begin() + got);
  return from_bytes(bytes, path.string());
}

OctreeFile from_bytes(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  return read(detail::MemoryBytes(bytes), name);
}

}  // namespace blackleaf
