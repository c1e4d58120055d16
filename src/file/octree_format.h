// The layout of .octree files, versions 1 and 2, as docs/FILE_FORMAT.md draws it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace blackleaf::detail::format {

static_assert(std::endian::native == std::endian::little,
              "files are little-endian; big-endian machines need swaps here");

// Like PNG's: a byte above 127, a line end of each kind and the old end-of-file sign, so that a transfer that takes the
// file for text shows in its first eight bytes.
inline constexpr std::string_view kMagic{"\x89OCT\r\n\x1A\n", 8};
inline constexpr std::uint32_t kVersion = 2;        // what is written
inline constexpr std::uint32_t kOldestVersion = 1;  // what is still read

// Offsets of the fixed part. The byte that says what the file holds was reserved in version 1.
inline constexpr std::size_t kVersionAt = 8, kDepthAt = 12, kContentAt = 13, kReservedAt = 14, kHeaderBytesAt = 16,
                             kChunksAt = 20, kOriginAt = 24, kAxesAt = 48, kUnitBytesAt = 120, kMetadataBytesAt = 124;
inline constexpr std::size_t kFixedBytes = 128, kChecksumBytes = 8;

/// Bytes of an entry of the chunk table.
constexpr std::size_t entry_bytes(std::uint32_t version) { return version == 1 ? 40 : 16; }

// The remedy of all messages about files that were once right.
inline constexpr std::string_view kDamaged = "the file is damaged, restore it from a copy";

inline constexpr std::size_t kMaxUnitBytes = 255;
inline constexpr std::size_t kMaxMetadataBytes = std::size_t{1} << 24;

// The largest zstd window a reader must provide, 2^23 bytes: bounds the memory that a hostile file can ask for.
inline constexpr int kMaxWindowLog = 23;
// A zstd block of 4 bytes can stand for 2^17 bytes and no more: a chunk that claims to grow by more is lying.
inline constexpr std::uint64_t kMaxExpansion = std::uint64_t{1} << 15;
// Run lengths stay below 2^60, nine groups of seven bits.
inline constexpr std::size_t kMaxVarintBytes = 9;

/// A number in groups of seven bits, the lowest first. byte() gives the next byte; fail(what) is told what is wrong
/// with a number and does not return.
template <class Byte, class Fail>
std::uint64_t read_varint(const Byte& byte, const Fail& fail) {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 7 * static_cast<int>(kMaxVarintBytes); shift += 7) {
    const std::uint8_t group = byte();
    value |= std::uint64_t{group & 0x7Fu} << shift;
    if (group & 0x80) continue;
    if (group == 0 && shift > 0) fail("is written with more bytes than it needs");
    return value;
  }
  fail("is longer than any universe");
  return 0;
}

enum class Content : std::uint8_t { solid = 0, labels = 1 };

enum class ChunkKind : std::uint8_t {
  uniform = 0,  // one colour or label throughout
  coded = 1,    // version 2: by the coder of the file's content
  runs = 2,     // version 1: run lengths under zstd
};

struct ChunkEntry {
  ChunkKind kind = ChunkKind::uniform;
  std::uint32_t colour = 0;        // of a chunk of one colour: 0 white, 1 black, or its label
  std::uint64_t offset = 0;        // of the contents in the file
  std::uint64_t stored_bytes = 0;  // of the contents
  std::uint64_t checksum = 0;      // XXH3-64 of the contents
  // Of run lengths (version 1) only:
  std::uint64_t runs = 0;       // counts in the chunk, the leading zero included
  std::uint64_t raw_bytes = 0;  // of the varints
};

/// Chunks are the nodes of this level: at most 64 of them, and none smaller than 2^24 voxels unless it is the universe.
constexpr int chunk_level(int depth) { return std::min(depth, std::max(8, depth - 2)); }
constexpr std::size_t chunk_count(int depth) { return std::size_t{1} << (3 * (depth - chunk_level(depth))); }
constexpr std::uint64_t chunk_voxels(int depth) { return std::uint64_t{1} << (3 * chunk_level(depth)); }

/// Where the chunk table begins: behind the unit and the metadata, at a multiple of eight.
constexpr std::size_t table_at(std::size_t unit_bytes, std::size_t metadata_bytes) {
  return (kFixedBytes + unit_bytes + metadata_bytes + 7) / 8 * 8;
}

/// A reason why this text cannot be a unit's name, or empty: it must be UTF-8 without control characters.
std::string_view unit_problem(std::string_view unit);
/// A reason why this text cannot be the metadata, or empty: it must be a JSON object.
std::string_view metadata_problem(std::string_view metadata);

}  // namespace blackleaf::detail::format
