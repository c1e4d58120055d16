#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/octree_file.h"
#include "file/byte_source.h"
#include "file/damage.h"
#include "file/file_header.h"
#include "file/label_chunks.h"
#include "file/octree_share.h"
#include "file/old_runs.h"
#include "file/solid_coder.h"
#include "octree/parallel.h"

namespace blackleaf {
namespace {

using namespace detail::format;
using detail::NodeArrays;
using detail::Subtree;
using Bytes = std::vector<std::uint8_t>;

void check(std::string_view name, std::size_t chunk, const std::string& problem) {
  if (!problem.empty())
    throw Error(ErrorCode::bad_input, fmt::format("{}: chunk {}: {}", name, chunk, problem), std::string(kDamaged));
}

// Calls read(i) for every chunk that has contents, on all threads; of several damaged chunks the first is told of.
template <class Read>
void read_chunks(const Header& header, std::string_view name, const Work& work, const Read& read) {
  std::vector<std::string> problems(header.chunks.size());
  detail::for_each_index(problems.size(), one_thread_for_one(work, problems.size()), [&](std::size_t i) {
    try {
      if (header.chunks[i].kind != ChunkKind::uniform) read(i);
    } catch (const detail::Damage& damage) {
      problems[i] = damage.what;
    }
  });
  for (std::size_t i = 0; i < problems.size(); ++i) check(name, i, problems[i]);
}

class SolidReader {
 public:
  /// Reads the chunks [first, last); the others are taken for white.
  SolidReader(const detail::ByteSource& source, const Header& header, std::size_t first, std::size_t last)
      : source_(source), header_(header), first_(first), last_(last) {}

  Octree read(std::string_view name, const Work& work) {
    collect(header_.depth, 0);
    detail::decode_solids(parts_, std::max(2, level_), work,
                          [&](std::size_t i) { return chunk_bytes(source_, header_.chunks[i]); });
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (header_.depth == 1 && parts_[i].damage.empty() &&
          (parts_[i].top.word >> 8 != 0 || parts_[i].top.word == 0xFF))
        parts_[i].damage = "has voxels that are not its universe's";
      check(name, i, parts_[i].damage);
    }
    NodeArrays arrays;
    for (int level = 2; level < level_; ++level) {
      std::size_t count = 0;
      for (const detail::SolidPart& part : parts_) count += part.arrays.count(level);
      arrays.reserve(level, count);
    }
    std::size_t part = 0;
    const Subtree root = join(header_.depth, 0, part, arrays);
    return arrays.finish(header_.depth, root, header_.frame);
  }

 private:
  // The tables with which the curve enters the chunks.
  void collect(int level, unsigned table) {
    if (level == level_) {
      const std::size_t i = parts_.size();
      detail::SolidPart& part = parts_.emplace_back();
      if (i < first_ || i >= last_) return;
      part.coded = header_.chunks[i].kind != ChunkKind::uniform;
      part.bytes = header_.chunks[i].stored_bytes;
      part.table = table;
      part.top = Subtree::uniform(header_.chunks[i].colour ? Colour::black : Colour::white);
      return;
    }
    for (const curve::Step step : curve::kSteps[table]) collect(level - 1, step.table);
  }

  Subtree join(int level, unsigned table, std::size_t& part, NodeArrays& arrays) {
    if (level == level_) {
      detail::SolidPart& here = parts_[part++];
      return arrays.append(here.arrays, here.top, level);
    }
    std::array<Subtree, 8> children;
    for (const curve::Step step : curve::kSteps[table])
      children[step.octant] = join(level - 1, step.table, part, arrays);
    return arrays.close(level, children);
  }

  const detail::ByteSource& source_;
  const Header& header_;
  const std::size_t first_, last_;
  const int level_ = chunk_level(header_.depth);
  std::vector<detail::SolidPart> parts_;  // one a chunk, in curve order
};

LabelMap read_labels(const detail::ByteSource& source, std::string_view name, const Header& header, const Work& work) {
  const std::uint64_t voxels = chunk_voxels(header.depth);
  std::vector<std::vector<Run>> parts(header.chunks.size());
  read_chunks(header, name, work, [&](std::size_t i) {
    detail::decode_labels(chunk_bytes(source, header.chunks[i]), voxels, [&](std::uint64_t count, std::uint32_t label) {
      parts[i].push_back({count, label});
    });
  });
  LabelMapBuilder builder(header.depth);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (header.chunks[i].kind == ChunkKind::uniform) builder.add(voxels, header.chunks[i].colour);
    for (const Run& run : parts[i]) builder.add(run.count, run.colour);
    std::vector<Run>().swap(parts[i]);
  }
  return builder.finish(header.frame);
}

// Where a share of the chunks begins, so that all shares have about as many bytes.
std::size_t begin_of(const Header& header, std::uint64_t number, std::uint64_t shares) {
  std::uint64_t all = 0, before = 0;
  for (const ChunkEntry& chunk : header.chunks) all += chunk.stored_bytes + 1;
  std::size_t i = 0;
  // A chunk is the share's in which its middle lies.
  for (; i < header.chunks.size(); ++i) {
    const std::uint64_t bytes = header.chunks[i].stored_bytes + 1;
    if (static_cast<double>(before) + static_cast<double>(bytes) / 2 >=
        static_cast<double>(all) * static_cast<double>(number) / static_cast<double>(shares))
      break;
    before += bytes;
  }
  return i;
}

OctreeFile read(const detail::ByteSource& source, std::string_view name, const Work& work,
                const detail::Share& share = {}) {
  Header header = read_header(source, name);
  if (header.content == Content::labels) {
    LabelMap labels = read_labels(source, name, header, work);
    Octree octree = octree_from_labels(labels);
    return {std::move(octree), std::move(header.metadata), source.size(), std::move(labels)};
  }
  Octree octree = header.version == 1
                      ? read_old_runs(source, name, header)
                      : SolidReader(source, header, begin_of(header, share.number, share.shares),
                                    share.number + 1 == share.shares ? header.chunks.size()
                                                                     : begin_of(header, share.number + 1, share.shares))
                            .read(name, work);
  return {std::move(octree), std::move(header.metadata), source.size(), std::nullopt};
}

}  // namespace

OctreeFile load(const std::filesystem::path& path, const Work& work) {
  detail::InputFile file(path);
  if (file.is_regular()) return read(detail::FileBytes(file), path.string(), work);
  // A pipe: take what it gives; the checks are the same.
  Bytes bytes;
  std::array<std::uint8_t, 1 << 16> buffer;
  while (const std::size_t got = file.read_some(buffer))
    bytes.insert(bytes.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(got));
  return from_bytes(bytes, path.string(), work);
}

OctreeFile detail::share_from_bytes(const std::vector<std::uint8_t>& bytes, const std::string& name, const Share& share,
                                    const Work& work) {
  return read(MemoryBytes(bytes), name, work, share);
}

bool detail::is_shareable(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  const Header header = read_header(MemoryBytes(bytes), name);
  return header.content == Content::solid && header.version > 1;
}

OctreeFile from_bytes(const std::vector<std::uint8_t>& bytes, const std::string& name, const Work& work) {
  return read(detail::MemoryBytes(bytes), name, work);
}

}  // namespace blackleaf
