#include <xxhash.h>
#include <zstd.h>

#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/octree_file.h"
#include "blackleaf/runs.h"
#include "file/input_file.h"
#include "file/octree_format.h"

namespace blackleaf {
namespace {

using namespace detail::format;
using Bytes = std::vector<std::uint8_t>;

// Where the bytes come from: a file or memory.
class ByteSource {
 public:
  ByteSource() = default;
  virtual ~ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  virtual std::uint64_t size() const = 0;
  /// Requires: offset + bytes.size() <= size().
  virtual void read_at(std::uint64_t offset, std::span<std::uint8_t> bytes) const = 0;
};

class FileBytes : public ByteSource {
 public:
  explicit FileBytes(const detail::InputFile& file) : file_(file) {}
  std::uint64_t size() const override { return file_.size(); }
  void read_at(std::uint64_t offset, std::span<std::uint8_t> bytes) const override { file_.read_at(offset, bytes); }

 private:
  const detail::InputFile& file_;
};

class MemoryBytes : public ByteSource {
 public:
  explicit MemoryBytes(const Bytes& bytes) : bytes_(bytes) {}
  std::uint64_t size() const override { return bytes_.size(); }
  void read_at(std::uint64_t offset, std::span<std::uint8_t> bytes) const override {
    if (!bytes.empty()) std::memcpy(bytes.data(), bytes_.data() + offset, bytes.size());
  }

 private:
  const Bytes& bytes_;
};

constexpr std::string_view kDamaged = "the file is damaged, restore it from a copy";

template <class T>
T get_at(const Bytes& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

struct Header {
  int depth = 1;
  std::size_t bytes = 0;  // where the first chunk begins
  Frame frame;
  std::string metadata;
  std::vector<ChunkEntry> chunks;
};

// Reads the header and checks everything in it, in the order in which a reader comes to rely on it.
class HeaderReader {
 public:
  HeaderReader(const ByteSource& source, std::string_view name) : source_(source), name_(name) {}

  Header read() {
    check_magic();
    fixed_part();
    whole_header();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, std::string_view remedy = kDamaged) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {}", name_, what), std::string(remedy));
  }
  [[noreturn]] void ends_early(std::string_view where) const {
    fail(fmt::format("ends after {} bytes, {}", source_.size(), where));
  }

  void check_magic() const {
    if (source_.size() == 0) fail("is empty", "it is no .octree file, or its writing was broken off");
    std::array<std::uint8_t, 64> buffer{};
    const auto length = static_cast<std::size_t>(std::min<std::uint64_t>(source_.size(), buffer.size()));
    source_.read_at(0, std::span(buffer).first(length));
    const std::string_view head(reinterpret_cast<const char*>(buffer.data()), length);
    if (head.starts_with(kMagic)) return;
    if (head == kMagic.substr(0, length)) ends_early("inside its first eight");
    if (head.starts_with("\x89OCT"))
      fail("begins with damaged line ends, as from a transfer in text mode", "copy it again in binary mode");
    if (head.starts_with("\x09OCT"))
      fail("was damaged by a transfer that dropped eighth bits", "copy it again in binary mode");
    if (head.starts_with("\xC2\x89OCT") || head.starts_with("\xEF\xBF\xBDOCT") || head.starts_with("?OCT"))
      fail("was damaged by a conversion of its character set", "copy it again in binary mode");
    bool text = true;
    for (const char c : head) text &= (c >= 0x20 && c != 0x7F) || c == '\n' || c == '\r' || c == '\t';
    fail(text ? "is a text file, not an .octree file" : "is not an .octree file", "build one with 'blackleaf build'");
  }

  void fixed_part() {
    if (source_.size() < kVersionAt + sizeof(std::uint32_t)) ends_early("inside its header");
    Bytes fixed(kFixedBytes, 0);
    source_.read_at(
        0, std::span(fixed).first(static_cast<std::size_t>(std::min<std::uint64_t>(source_.size(), kFixedBytes))));
    const auto version = get_at<std::uint32_t>(fixed, kVersionAt);
    if (version != kVersion)
      fail(fmt::format("has format version {}; this program reads version {}", version, kVersion),
           version > kVersion ? "use a newer blackleaf" : kDamaged);
    if (source_.size() < kFixedBytes) ends_early("inside its header");

    header_.depth = fixed[kDepthAt];
    if (header_.depth < 1 || header_.depth > kMaxDepth)
      fail(fmt::format("header: depth {} is not in 1..20", header_.depth));
    unit_bytes_ = get_at<std::uint32_t>(fixed, kUnitBytesAt);
    metadata_bytes_ = get_at<std::uint32_t>(fixed, kMetadataBytesAt);
    if (unit_bytes_ > kMaxUnitBytes) fail(fmt::format("header: a unit's name of {} bytes", unit_bytes_));
    if (metadata_bytes_ > kMaxMetadataBytes) fail(fmt::format("header: metadata of {} bytes", metadata_bytes_));
    const std::size_t chunks = chunk_count(header_.depth);
    if (const auto told = get_at<std::uint32_t>(fixed, kChunksAt); told != chunks)
      fail(fmt::format("header: {} chunks where depth {} has {}", told, header_.depth, chunks));
    header_.chunks.resize(chunks);
    table_ = table_at(unit_bytes_, metadata_bytes_);
    header_.bytes = table_ + chunks * kEntryBytes + kChecksumBytes;
    if (const auto told = get_at<std::uint32_t>(fixed, kHeaderBytesAt); told != header_.bytes)
      fail(fmt::format("header: a length of {} bytes where its parts have {}", told, header_.bytes));
    if (source_.size() < header_.bytes) ends_early(fmt::format("inside its header of {}", header_.bytes));
  }

  void whole_header() {
    Bytes bytes(header_.bytes);  // no more than the file has
    source_.read_at(0, bytes);
    const std::size_t checksum_at = header_.bytes - kChecksumBytes;
    if (get_at<std::uint64_t>(bytes, checksum_at) != XXH3_64bits(bytes.data(), checksum_at))
      fail("header: checksum does not match");

    const auto require_zeros = [&](std::size_t from, std::size_t to) {
      for (; from < to; ++from)
        if (bytes[from] != 0) fail(fmt::format("header: reserved byte {} is not zero", from));
    };
    require_zeros(kReservedAt, kHeaderBytesAt);
    require_zeros(kFixedBytes + unit_bytes_ + metadata_bytes_, table_);

    Frame& frame = header_.frame;
    for (int i = 0; i < 3; ++i) frame.origin[i] = get_at<double>(bytes, kOriginAt + 8 * static_cast<std::size_t>(i));
    for (int i = 0; i < 9; ++i)
      frame.axes(i % 3, i / 3) = get_at<double>(bytes, kAxesAt + 8 * static_cast<std::size_t>(i));
    if (!frame.origin.allFinite() || !frame.axes.allFinite()) fail("header: the frame has numbers that are not finite");
    const char* text = reinterpret_cast<const char*>(bytes.data() + kFixedBytes);
    frame.unit.assign(text, unit_bytes_);
    header_.metadata.assign(text + unit_bytes_, metadata_bytes_);
    if (const auto problem = unit_problem(frame.unit); !problem.empty()) fail(fmt::format("header: {}", problem));
    if (const auto problem = metadata_problem(header_.metadata); !problem.empty())
      fail(fmt::format("header: {}", problem));

    std::uint64_t end = header_.bytes;
    for (std::size_t i = 0; i < header_.chunks.size(); ++i) {
      const std::size_t at = table_ + i * kEntryBytes;
      require_zeros(at + 1, at + 8);
      header_.chunks[i] = {static_cast<ChunkKind>(bytes[at]), get_at<std::uint64_t>(bytes, at + 8),
                           get_at<std::uint64_t>(bytes, at + 16), get_at<std::uint64_t>(bytes, at + 24),
                           get_at<std::uint64_t>(bytes, at + 32)};
      check_entry(i, source_.size() - end);
      end += header_.chunks[i].stored_bytes;
    }
    if (end < source_.size())
      fail(fmt::format("{} bytes follow the last chunk", source_.size() - end),
           "something was appended to the file; restore it from a copy");
  }

  // A chunk's numbers must be possible, and its bytes within the rest of the file.
  void check_entry(std::size_t i, std::uint64_t rest) const {
    const ChunkEntry& entry = header_.chunks[i];
    if (entry.kind > ChunkKind::runs)
      fail(fmt::format("chunk {}: unknown kind {}", i, static_cast<unsigned>(entry.kind)));
    if (entry.kind != ChunkKind::runs) {
      if (entry.runs != 0 || entry.raw_bytes != 0 || entry.stored_bytes != 0 || entry.checksum != 0)
        fail(fmt::format("chunk {}: is of one colour and yet has contents", i));
      return;
    }
    if (entry.stored_bytes > rest)
      fail(fmt::format("ends after {} bytes, {} too early for chunk {}", source_.size(), entry.stored_bytes - rest, i));
    const std::uint64_t voxels = std::uint64_t{1} << (3 * chunk_level(header_.depth));
    // The division keeps the product with kMaxVarintBytes in 64 bits.
    if (entry.runs < 2 || entry.runs > voxels + 1 || entry.raw_bytes < entry.runs ||
        entry.raw_bytes / kMaxVarintBytes > entry.runs || entry.raw_bytes / kMaxExpansion > entry.stored_bytes)
      fail(fmt::format("chunk {}: {} runs in {} bytes, compressed to {}, are not possible", i, entry.runs,
                       entry.raw_bytes, entry.stored_bytes));
  }

  const ByteSource& source_;
  const std::string_view name_;
  Header header_;
  std::size_t unit_bytes_ = 0, metadata_bytes_ = 0, table_ = 0;
};

// Pulls the runs out of the chunks, one at a time, with two small buffers.
class RunReader {
 public:
  RunReader(const ByteSource& source, std::string_view name, const Header& header)
      : source_(source),
        name_(name),
        header_(header),
        context_(ZSTD_createDCtx()),
        hash_(XXH3_createState()),
        at_(header.bytes),
        voxels_(std::uint64_t{1} << (3 * chunk_level(header.depth))),
        in_(std::size_t{1} << 16),
        out_(std::size_t{1} << 16) {
    if (!context_ || !hash_) throw std::bad_alloc();
    ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, kMaxWindowLog);
  }

  bool next(std::uint64_t& count, bool& black) {
    if (left_ == 0) {
      if (chunk_ == header_.chunks.size()) return false;
      const ChunkEntry& entry = header_.chunks[chunk_];
      if (entry.kind != ChunkKind::runs) {
        count = voxels_;
        black = entry.kind == ChunkKind::black;
        ++chunk_;
        return true;
      }
      begin_chunk(entry);
    }
    const ChunkEntry& entry = header_.chunks[chunk_];
    if (runs_ == entry.runs) fail("its runs do not add up to its voxels");
    count = varint();
    black = runs_ % 2 == 0;
    if (count == 0 && runs_ > 0) fail(fmt::format("run {} has no length", runs_));
    if (count > left_) fail("its runs add up to more than its voxels");
    if (count == voxels_) fail("is of one colour and yet has runs");
    ++runs_;
    left_ -= count;
    if (left_ == 0) end_chunk(entry);
    return true;
  }

 private:
  struct FreeContext {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: chunk {}: {}", name_, chunk_, what), std::string(kDamaged));
  }

  void begin_chunk(const ChunkEntry& entry) {
    XXH3_64bits_reset(hash_.get());
    for (std::uint64_t done = 0; done < entry.stored_bytes;) {
      const std::span part = piece(done, entry);
      XXH3_64bits_update(hash_.get(), part.data(), part.size());
      done += part.size();
    }
    if (XXH3_64bits_digest(hash_.get()) != entry.checksum) fail("checksum does not match");
    ZSTD_DCtx_reset(context_.get(), ZSTD_reset_session_only);
    left_ = voxels_;
    runs_ = fed_ = produced_ = 0;
    input_ = {in_.data(), 0, 0};
    out_at_ = out_end_ = 0;
    frame_ended_ = false;
  }

  // Reads bytes of the current chunk from `done` on into in_, as many as fit.
  std::span<const std::uint8_t> piece(std::uint64_t done, const ChunkEntry& entry) {
    const std::uint64_t size = std::min<std::uint64_t>(in_.size(), entry.stored_bytes - done);
    const std::span part = std::span(in_).first(static_cast<std::size_t>(size));
    source_.read_at(at_ + done, part);
    return part;
  }

  // Decompresses the next bytes into out_; false at the end of the frame.
  bool refill() {
    const ChunkEntry& entry = header_.chunks[chunk_];
    out_at_ = out_end_ = 0;
    while (out_end_ == 0 && !frame_ended_) {
      if (input_.pos == input_.size && fed_ < entry.stored_bytes) {
        const std::span part = piece(fed_, entry);
        input_ = {part.data(), part.size(), 0};
        fed_ += part.size();
      }
      ZSTD_outBuffer output{out_.data(), out_.size(), 0};
      const std::size_t before = input_.pos;
      const std::size_t code = ZSTD_decompressStream(context_.get(), &output, &input_);
      if (ZSTD_isError(code)) fail(fmt::format("cannot be decompressed ({})", ZSTD_getErrorName(code)));
      frame_ended_ = code == 0;
      out_end_ = output.pos;
      if (out_end_ == 0 && !frame_ended_ && input_.pos == before && fed_ == entry.stored_bytes)
        fail("its compressed data end too early");
    }
    produced_ += out_end_;
    if (produced_ > entry.raw_bytes) fail("its compressed data hold more than its entry says");
    return out_end_ > 0;
  }

  std::uint8_t byte() {
    if (out_at_ == out_end_ && !refill()) fail("its compressed data hold less than its entry says");
    return out_[out_at_++];
  }

  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 7 * static_cast<int>(kMaxVarintBytes); shift += 7) {
      const std::uint8_t group = byte();
      value |= std::uint64_t{group & 0x7Fu} << shift;
      if (group & 0x80) continue;
      if (group == 0 && shift > 0) fail(fmt::format("run {} is written with more bytes than it needs", runs_));
      return value;
    }
    fail(fmt::format("run {} is longer than any universe", runs_));
  }

  void end_chunk(const ChunkEntry& entry) {
    if (runs_ != entry.runs) fail(fmt::format("has {} runs where its entry says {}", runs_, entry.runs));
    if (out_at_ != out_end_ || refill()) fail("bytes follow its last run");
    if (produced_ != entry.raw_bytes)
      fail(fmt::format("has {} bytes where its entry says {}", produced_, entry.raw_bytes));
    if (input_.pos != input_.size || fed_ != entry.stored_bytes) fail("bytes follow its compressed data");
    at_ += entry.stored_bytes;
    ++chunk_;
  }

  const ByteSource& source_;
  const std::string_view name_;
  const Header& header_;
  std::unique_ptr<ZSTD_DCtx, FreeContext> context_;
  std::unique_ptr<XXH3_state_t, FreeContext> hash_;
  std::uint64_t at_;                      // where the current chunk begins
  const std::uint64_t voxels_;            // in every chunk
  std::size_t chunk_ = 0;                 // the current chunk, or the next one when left_ is 0
  std::uint64_t left_ = 0;                // voxels of the current chunk not yet told
  std::uint64_t runs_ = 0;                // counts read of the current chunk
  std::uint64_t fed_ = 0, produced_ = 0;  // compressed bytes taken, raw bytes made
  Bytes in_, out_;
  ZSTD_inBuffer input_{nullptr, 0, 0};
  std::size_t out_at_ = 0, out_end_ = 0;
  bool frame_ended_ = false;
};

OctreeFile read(const ByteSource& source, std::string_view name) {
  Header header = HeaderReader(source, name).read();
  RunReader runs(source, name, header);
  Octree octree = octree_from_source([&](std::uint64_t& count, bool& black) { return runs.next(count, black); },
                                     header.depth, header.frame);
  return {std::move(octree), std::move(header.metadata), source.size()};
}

}  // namespace

OctreeFile load(const std::filesystem::path& path) {
  detail::InputFile file(path);
  if (file.is_regular()) return read(FileBytes(file), path.string());
  // A pipe: take what it gives; the checks are the same.
  Bytes bytes;
  std::array<std::uint8_t, 1 << 16> buffer;
  while (const std::size_t got = file.read_some(buffer))
    bytes.insert(bytes.end(), buffer.begin(), buffer.begin() + got);
  return from_bytes(bytes, path.string());
}

OctreeFile from_bytes(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  return read(MemoryBytes(bytes), name);
}

}  // namespace blackleaf
