#include "file/file_header.h"

#include <xxhash.h>

#include <cstring>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/damage.h"

namespace blackleaf::detail::format {
namespace {

using Bytes = std::vector<std::uint8_t>;

// In the head of an entry: the kind above, the length or the colour below.
constexpr int kKindShift = 56;
// In version 1: 0 white, 1 black, 2 runs.
constexpr unsigned kOldRuns = 2;

template <class T>
T get_at(const Bytes& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

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
    if (version < kOldestVersion || version > kVersion)
      fail(
          fmt::format("has format version {}; this program reads versions {} to {}", version, kOldestVersion, kVersion),
          version > kVersion ? "use a newer blackleaf" : kDamaged);
    header_.version = version;
    if (source_.size() < kFixedBytes) ends_early("inside its header");

    header_.depth = fixed[kDepthAt];
    if (header_.depth < 1 || header_.depth > kMaxDepth)
      fail(fmt::format("header: depth {} is not in 1..20", header_.depth));
    if (fixed[kContentAt] > (version == 1 ? 0 : static_cast<unsigned>(Content::labels)))
      fail(fmt::format("header: contents of unknown kind {}", fixed[kContentAt]));
    header_.content = static_cast<Content>(fixed[kContentAt]);
    unit_bytes_ = get_at<std::uint32_t>(fixed, kUnitBytesAt);
    metadata_bytes_ = get_at<std::uint32_t>(fixed, kMetadataBytesAt);
    if (unit_bytes_ > kMaxUnitBytes) fail(fmt::format("header: a unit's name of {} bytes", unit_bytes_));
    if (metadata_bytes_ > kMaxMetadataBytes) fail(fmt::format("header: metadata of {} bytes", metadata_bytes_));
    const std::size_t chunks = chunk_count(header_.depth);
    if (const auto told = get_at<std::uint32_t>(fixed, kChunksAt); told != chunks)
      fail(fmt::format("header: {} chunks where depth {} has {}", told, header_.depth, chunks));
    header_.chunks.resize(chunks);
    table_ = table_at(unit_bytes_, metadata_bytes_);
    header_.bytes = table_ + chunks * entry_bytes(version) + kChecksumBytes;
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
      const std::size_t at = table_ + i * entry_bytes(header_.version);
      ChunkEntry& entry = header_.chunks[i];
      entry = header_.version == 1 ? old_entry(i, bytes, at) : new_entry(i, bytes, at);
      entry.offset = end;
      if (entry.stored_bytes > source_.size() - end)
        fail(fmt::format("ends after {} bytes, {} too early for chunk {}", source_.size(),
                         entry.stored_bytes - (source_.size() - end), i));
      end += entry.stored_bytes;
    }
    if (end < source_.size())
      fail(fmt::format("{} bytes follow the last chunk", source_.size() - end),
           "something was appended to the file; restore it from a copy");
  }

  ChunkEntry new_entry(std::size_t i, const Bytes& bytes, std::size_t at) const {
    const auto head = get_at<std::uint64_t>(bytes, at);
    ChunkEntry entry;
    entry.kind = static_cast<ChunkKind>(head >> kKindShift);
    entry.checksum = get_at<std::uint64_t>(bytes, at + 8);
    const std::uint64_t value = head & ((std::uint64_t{1} << kKindShift) - 1);
    if (entry.kind > ChunkKind::coded)
      fail(fmt::format("chunk {}: unknown kind {}", i, static_cast<unsigned>(entry.kind)));
    if (entry.kind == ChunkKind::coded) {
      entry.stored_bytes = value;
      return entry;
    }
    if (entry.checksum != 0) fail(fmt::format("chunk {}: is of one colour and yet has contents", i));
    if (value > (header_.content == Content::solid ? 1 : std::numeric_limits<std::uint32_t>::max()))
      fail(fmt::format("chunk {}: unknown colour {}", i, value));
    entry.colour = static_cast<std::uint32_t>(value);
    return entry;
  }

  // An entry of version 1: its numbers must be possible.
  ChunkEntry old_entry(std::size_t i, const Bytes& bytes, std::size_t at) const {
    const unsigned kind = bytes[at];
    for (std::size_t k = at + 1; k < at + 8; ++k)
      if (bytes[k] != 0) fail(fmt::format("header: reserved byte {} is not zero", k));
    ChunkEntry entry;
    entry.kind = kind == kOldRuns ? ChunkKind::runs : ChunkKind::uniform;
    entry.colour = kind == kOldRuns ? 0 : kind;
    entry.runs = get_at<std::uint64_t>(bytes, at + 8);
    entry.raw_bytes = get_at<std::uint64_t>(bytes, at + 16);
    entry.stored_bytes = get_at<std::uint64_t>(bytes, at + 24);
    entry.checksum = get_at<std::uint64_t>(bytes, at + 32);
    if (kind > kOldRuns) fail(fmt::format("chunk {}: unknown kind {}", i, kind));
    if (kind != kOldRuns) {
      if (entry.runs != 0 || entry.raw_bytes != 0 || entry.stored_bytes != 0 || entry.checksum != 0)
        fail(fmt::format("chunk {}: is of one colour and yet has contents", i));
      return entry;
    }
    // The division keeps the product with kMaxVarintBytes in 64 bits.
    if (entry.runs < 2 || entry.runs > chunk_voxels(header_.depth) + 1 || entry.raw_bytes < entry.runs ||
        entry.raw_bytes / kMaxVarintBytes > entry.runs || entry.raw_bytes / kMaxExpansion > entry.stored_bytes)
      fail(fmt::format("chunk {}: {} runs in {} bytes, compressed to {}, are not possible", i, entry.runs,
                       entry.raw_bytes, entry.stored_bytes));
    return entry;
  }

  const ByteSource& source_;
  const std::string_view name_;
  Header header_;
  std::size_t unit_bytes_ = 0, metadata_bytes_ = 0, table_ = 0;
};

template <class T>
void put_at(Bytes& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

}  // namespace

Header read_header(const ByteSource& source, std::string_view name) { return HeaderReader(source, name).read(); }

void check_arguments(const Frame& frame, std::string_view metadata) {
  if (!frame.origin.allFinite() || !frame.axes.allFinite())
    throw Error(ErrorCode::bad_argument, "the octree's frame has numbers that are not finite");
  if (const auto problem = unit_problem(frame.unit); !problem.empty())
    throw Error(ErrorCode::bad_argument, std::string(problem));
  if (const auto problem = metadata_problem(metadata); !problem.empty())
    throw Error(ErrorCode::bad_argument, std::string(problem));
}

Bytes chunk_bytes(const ByteSource& source, const ChunkEntry& entry) {
  Bytes bytes(entry.stored_bytes);  // no more than the file has
  source.read_at(entry.offset, bytes);
  if (XXH3_64bits(bytes.data(), bytes.size()) != entry.checksum) throw Damage{"checksum does not match"};
  return bytes;
}

ChunkEntry entry_of(const Chunk& chunk) {
  ChunkEntry entry;
  entry.kind = chunk.kind;
  entry.colour = chunk.colour;
  if (chunk.kind == ChunkKind::uniform) return entry;
  entry.stored_bytes = chunk.contents.size();
  entry.checksum = XXH3_64bits(chunk.contents.data(), chunk.contents.size());
  return entry;
}

Bytes header_bytes(Content content, int depth, const Frame& frame, std::string_view metadata,
                   const std::vector<ChunkEntry>& chunks) {
  const std::size_t table = table_at(frame.unit.size(), metadata.size());
  const std::size_t checksum_at = table + chunks.size() * entry_bytes(kVersion);
  Bytes bytes(checksum_at + kChecksumBytes, 0);
  std::memcpy(bytes.data(), kMagic.data(), kMagic.size());
  put_at(bytes, kVersionAt, kVersion);
  put_at(bytes, kDepthAt, static_cast<std::uint8_t>(depth));
  put_at(bytes, kContentAt, content);
  put_at(bytes, kHeaderBytesAt, static_cast<std::uint32_t>(bytes.size()));
  put_at(bytes, kChunksAt, static_cast<std::uint32_t>(chunks.size()));
  for (int i = 0; i < 3; ++i) put_at(bytes, kOriginAt + 8 * static_cast<std::size_t>(i), frame.origin[i]);
  for (int i = 0; i < 9; ++i) put_at(bytes, kAxesAt + 8 * static_cast<std::size_t>(i), frame.axes(i % 3, i / 3));
  put_at(bytes, kUnitBytesAt, static_cast<std::uint32_t>(frame.unit.size()));
  put_at(bytes, kMetadataBytesAt, static_cast<std::uint32_t>(metadata.size()));
  std::memcpy(bytes.data() + kFixedBytes, frame.unit.data(), frame.unit.size());
  std::memcpy(bytes.data() + kFixedBytes + frame.unit.size(), metadata.data(), metadata.size());
  std::size_t at = table;
  for (const ChunkEntry& chunk : chunks) {
    const std::uint64_t value = chunk.kind == ChunkKind::uniform ? chunk.colour : chunk.stored_bytes;
    put_at(bytes, at, static_cast<std::uint64_t>(chunk.kind) << kKindShift | value);
    put_at(bytes, at + 8, chunk.checksum);
    at += entry_bytes(kVersion);
  }
  put_at(bytes, checksum_at, std::uint64_t{XXH3_64bits(bytes.data(), checksum_at)});
  return bytes;
}

Bytes file_bytes(Content content, int depth, const Frame& frame, std::string_view metadata,
                 const std::vector<Chunk>& chunks) {
  std::vector<ChunkEntry> entries;
  std::size_t contents = 0;
  for (const Chunk& chunk : chunks) {
    entries.push_back(entry_of(chunk));
    contents += chunk.contents.size();
  }
  Bytes bytes = header_bytes(content, depth, frame, metadata, entries);
  bytes.reserve(bytes.size() + contents);
  for (const Chunk& chunk : chunks) bytes.insert(bytes.end(), chunk.contents.begin(), chunk.contents.end());
  return bytes;
}

}  // namespace blackleaf::detail::format
