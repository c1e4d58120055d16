// .octree files: docs/FILE_FORMAT.md draws them byte by byte.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blackleaf/label_map.h"
#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// Writes an octree with its frame and metadata (a JSON object as text, e.g. where the object comes from; "{}" if there
/// is nothing to say). The same octree, frame and metadata give the same bytes, on any number of threads. Written to a
/// temporary name beside `path`, flushed to disk and renamed: a crash leaves the old file or the new one; a symbolic
/// link is followed. Throws Error(io), and Error(bad_argument) for metadata that are not a JSON object or longer than
/// 16 MiB, for a frame with numbers that are not finite, and for a unit that is not UTF-8 of at most 255 bytes without
/// control characters.
void save(const Octree& octree, const std::filesystem::path& path, const std::string& metadata = "{}",
          const Work& work = {});
/// The same bytes in memory.
std::vector<std::uint8_t> to_bytes(const Octree& octree, const std::string& metadata = "{}", const Work& work = {});

/// The same for a label map: the file keeps every voxel's label.
void save(const LabelMap& labels, const std::filesystem::path& path, const std::string& metadata = "{}",
          const Work& work = {});
std::vector<std::uint8_t> to_bytes(const LabelMap& labels, const std::string& metadata = "{}", const Work& work = {});

struct OctreeFile {
  Octree octree;         // with labels: the solid of all labels but 0
  std::string metadata;  // JSON object
  std::uint64_t file_bytes = 0;
  std::optional<LabelMap> labels;  // if the file was saved from a label map
};
/// Reads and checks everything: magic, version, checksums, counts; trusts no length. Throws Error(io) when the file
/// cannot be read, Error(bad_input) that names the first thing wrong.
OctreeFile load(const std::filesystem::path& path, const Work& work = {});
/// The same from memory; `name` stands for the file in messages.
OctreeFile from_bytes(const std::vector<std::uint8_t>& bytes, const std::string& name = "octree data",
                      const Work& work = {});

}  // namespace blackleaf
