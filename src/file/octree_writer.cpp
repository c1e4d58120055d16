#include <xxhash.h>
#include <zstd.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/label_map.h"
#include "blackleaf/octree_file.h"
#include "blackleaf/runs.h"
#include "file/atomic_write.h"
#include "file/file_header.h"
#include "file/label_chunks.h"
#include "file/octree_format.h"

namespace blackleaf {
namespace {

using namespace detail::format;
using Bytes = std::vector<std::uint8_t>;

// Run lengths of real surfaces at depths 9 to 11: level 3 gains up to a tenth for twice the time, level 9 a fifth for
// ten times the time (docs/FILE_FORMAT.md has the figures). Level 1 keeps writing as fast as walking the tree.
constexpr int kCompressionLevel = 1;

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

struct OldEntry {
  int kind;
  std::uint64_t runs, raw_bytes, stored_bytes, checksum;
};

// Compresses chunk after chunk: one zstd frame each, with its content's size, on one thread, so that the bytes depend
// on nothing but the chunk and the version of zstd.
class Compressor {
 public:
  Compressor() : context_(ZSTD_createCCtx()) {
    if (!context_) throw std::bad_alloc();
    check(ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, kCompressionLevel));
    check(ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_windowLog, kMaxWindowLog));
    check(ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_contentSizeFlag, 1));
    check(ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_checksumFlag, 0));
  }

  /// Appends the frame to `out` and returns its size.
  std::size_t append(const Bytes& raw, Bytes& out) {
    const std::size_t at = out.size();
    out.resize(at + ZSTD_compressBound(raw.size()));
    const std::size_t size = ZSTD_compress2(context_.get(), out.data() + at, out.size() - at, raw.data(), raw.size());
    check(size);
    out.resize(at + size);
    return size;
  }

 private:
  static void check(std::size_t code) {
    if (ZSTD_isError(code)) throw std::runtime_error(fmt::format("zstd: {}", ZSTD_getErrorName(code)));
  }

  std::unique_ptr<ZSTD_CCtx, FreeContext> context_;
};

// Cuts the runs of a universe at the chunks' borders and encodes them.
class ChunkWriter {
 public:
  explicit ChunkWriter(int depth) : chunk_voxels_(std::uint64_t{1} << (3 * chunk_level(depth))), left_(chunk_voxels_) {}

  void add(std::uint64_t count, bool black) {
    while (count > 0) {
      const std::uint64_t part = std::min(count, left_);
      if (part == chunk_voxels_) {
        entries_.push_back({black ? true : false, 0, 0, 0, 0});
      } else {
        if (left_ == chunk_voxels_ && !black) put(0);
        put(part);
        left_ -= part;
        if (left_ == 0) finish_chunk();
      }
      count -= part;
    }
  }

  const std::vector<OldEntry>& entries() const { return entries_; }
  const Bytes& stored() const { return stored_; }

 private:
  void put(std::uint64_t count) {
    for (++runs_; count >= 0x80; count >>= 7) raw_.push_back(static_cast<std::uint8_t>(count | 0x80));
    raw_.push_back(static_cast<std::uint8_t>(count));
  }

  void finish_chunk() {
    const std::size_t at = stored_.size();
    const std::size_t size = compressor_.append(raw_, stored_);
    entries_.push_back({2, runs_, raw_.size(), size, XXH3_64bits(stored_.data() + at, size)});
    raw_.clear();
    runs_ = 0;
    left_ = chunk_voxels_;
  }

  const std::uint64_t chunk_voxels_;
  std::uint64_t left_;      // voxels of the current chunk not yet told
  std::uint64_t runs_ = 0;  // counts in raw_
  Bytes raw_;               // varints of the current chunk
  Bytes stored_;            // all finished chunks
  std::vector<OldEntry> entries_;
  Compressor compressor_;
};

template <class T>
void put_at(Bytes& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

void check_arguments(const Frame& frame, const std::string& metadata) {
  if (!frame.origin.allFinite() || !frame.axes.allFinite())
    throw Error(ErrorCode::bad_argument, "the octree's frame has numbers that are not finite");
  if (const auto problem = unit_problem(frame.unit); !problem.empty())
    throw Error(ErrorCode::bad_argument, std::string(problem));
  if (const auto problem = metadata_problem(metadata); !problem.empty())
    throw Error(ErrorCode::bad_argument, std::string(problem));
}

}  // namespace

std::vector<std::uint8_t> to_bytes(const Octree& octree, const std::string& metadata) {
  const Frame& frame = octree.frame();
  check_arguments(frame, metadata);

  ChunkWriter chunks(octree.depth());
  for_each_run(octree, [&](std::uint64_t count, bool black) { chunks.add(count, black); });

  const std::size_t table = table_at(frame.unit.size(), metadata.size());
  const std::size_t checksum_at = table + chunks.entries().size() * entry_bytes(1);
  const std::size_t header_bytes = checksum_at + kChecksumBytes;
  Bytes bytes(header_bytes, 0);
  std::memcpy(bytes.data(), kMagic.data(), kMagic.size());
  put_at(bytes, kVersionAt, std::uint32_t{1});
  put_at(bytes, kDepthAt, static_cast<std::uint8_t>(octree.depth()));
  put_at(bytes, kHeaderBytesAt, static_cast<std::uint32_t>(header_bytes));
  put_at(bytes, kChunksAt, static_cast<std::uint32_t>(chunks.entries().size()));
  for (int i = 0; i < 3; ++i) put_at(bytes, kOriginAt + 8 * static_cast<std::size_t>(i), frame.origin[i]);
  for (int i = 0; i < 9; ++i) put_at(bytes, kAxesAt + 8 * static_cast<std::size_t>(i), frame.axes(i % 3, i / 3));
  put_at(bytes, kUnitBytesAt, static_cast<std::uint32_t>(frame.unit.size()));
  put_at(bytes, kMetadataBytesAt, static_cast<std::uint32_t>(metadata.size()));
  std::memcpy(bytes.data() + kFixedBytes, frame.unit.data(), frame.unit.size());
  std::memcpy(bytes.data() + kFixedBytes + frame.unit.size(), metadata.data(), metadata.size());
  std::size_t at = table;
  for (const OldEntry& entry : chunks.entries()) {
    put_at(bytes, at, static_cast<std::uint8_t>(entry.kind));
    put_at(bytes, at + 8, entry.runs);
    put_at(bytes, at + 16, entry.raw_bytes);
    put_at(bytes, at + 24, entry.stored_bytes);
    put_at(bytes, at + 32, entry.checksum);
    at += entry_bytes(1);
  }
  put_at(bytes, checksum_at, std::uint64_t{XXH3_64bits(bytes.data(), checksum_at)});
  bytes.insert(bytes.end(), chunks.stored().begin(), chunks.stored().end());
  return bytes;
}

void save(const Octree& octree, const std::filesystem::path& path, const std::string& metadata) {
  detail::write_atomically(path, to_bytes(octree, metadata));
}

std::vector<std::uint8_t> to_bytes(const LabelMap& labels, const std::string& metadata) {
  const std::uint64_t voxels = chunk_voxels(labels.depth());
  std::vector<Chunk> chunks(chunk_count(labels.depth()));
  std::vector<Run> runs;  // of the current chunk
  std::size_t chunk = 0;
  std::uint64_t left = voxels;  // of the current chunk
  for (std::size_t i = 0; i < labels.run_count(); ++i) {
    for (std::uint64_t rest = labels.count(i); rest > 0;) {
      const std::uint64_t part = std::min(rest, left);
      runs.push_back({part, labels.labels()[i]});
      rest -= part;
      left -= part;
      if (left > 0) continue;
      if (runs.size() == 1)
        chunks[chunk].colour = runs[0].colour;
      else
        chunks[chunk] = {ChunkKind::coded, 0, detail::encode_labels(runs)};
      ++chunk;
      runs.clear();
      left = voxels;
    }
  }
  return file_bytes(Content::labels, labels.depth(), labels.frame(), metadata, chunks);
}

void save(const LabelMap& labels, const std::filesystem::path& path, const std::string& metadata) {
  detail::write_atomically(path, to_bytes(labels, metadata));
}

}  // namespace blackleaf
