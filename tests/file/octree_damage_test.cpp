// Every damage is refused with one clear line, quickly and without large allocations; nothing damaged is ever accepted.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <xxhash.h>
#include <zstd.h>

#include <bit>
#include <cstring>
#include <limits>
#include <random>

#include "blackleaf/implicit.h"
#include "blackleaf/label_map.h"
#include "blackleaf/measures.h"
#include "blackleaf/octree_file.h"
#include "blackleaf/runs.h"
#include "file/octree_format.h"
#include "reference/dense_grid.h"
#include "reference/memory_limits.h"
#include "temporary_folder.h"

namespace blackleaf {
namespace {

using namespace detail::format;
using test::expect_error;
using Runs = std::vector<blackleaf::Run>;  // inside a test, "Run" is a function of GoogleTest
using Bytes = std::vector<std::uint8_t>;

template <class T>
void put(Bytes& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}
template <class T>
T get(const Bytes& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// Makes the header's checksum right again, so that what lies behind it is tested.
void reseal(Bytes& bytes) {
  const std::size_t header = get<std::uint32_t>(bytes, kHeaderBytesAt);
  put(bytes, header - 8, std::uint64_t{XXH3_64bits(bytes.data(), header - 8)});
}

Bytes compress(const Bytes& raw, bool content_size = true) {
  Bytes out(ZSTD_compressBound(raw.size()));
  ZSTD_CCtx* context = ZSTD_createCCtx();
  ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, content_size ? 1 : 0);
  out.resize(ZSTD_compress2(context, out.data(), out.size(), raw.data(), raw.size()));
  ZSTD_freeCCtx(context);
  return out;
}

constexpr std::size_t kTable = table_at(5, 2);  // of files with the unit "voxel" and the metadata "{}"

// A white universe as version 1 wrote it.
Bytes old_file(int depth) {
  const Bytes now = to_bytes(Octree(depth));
  Bytes bytes(now.begin(), now.begin() + static_cast<std::ptrdiff_t>(kTable));
  bytes.resize(kTable + chunk_count(depth) * entry_bytes(1) + kChecksumBytes, 0);
  put(bytes, kVersionAt, std::uint32_t{1});
  put(bytes, kHeaderBytesAt, static_cast<std::uint32_t>(bytes.size()));
  reseal(bytes);
  return bytes;
}

// A file of version 1 whose first chunk has any contents, all checksums right.
Bytes forge(const Bytes& stored, std::uint64_t runs, std::uint64_t raw_bytes, int depth = 2) {
  Bytes bytes = old_file(depth);
  put(bytes, kTable, std::uint8_t{2});
  put(bytes, kTable + 8, runs);
  put(bytes, kTable + 16, raw_bytes);
  put(bytes, kTable + 24, std::uint64_t{stored.size()});
  put(bytes, kTable + 32, std::uint64_t{XXH3_64bits(stored.data(), stored.size())});
  reseal(bytes);
  bytes.insert(bytes.end(), stored.begin(), stored.end());
  return bytes;
}

// A file of version 2 whose first chunk has any contents, all checksums right.
Bytes forge_new(const Bytes& stored, int depth, Content content) {
  Bytes bytes = content == Content::solid ? to_bytes(Octree(depth)) : to_bytes(LabelMap(depth));
  put(bytes, kTable, std::uint64_t{1} << 56 | stored.size());
  put(bytes, kTable + 8, std::uint64_t{XXH3_64bits(stored.data(), stored.size())});
  reseal(bytes);
  bytes.insert(bytes.end(), stored.begin(), stored.end());
  return bytes;
}

// The contents of the first chunk of a file with one chunk.
Bytes contents(const Bytes& file) {
  return Bytes(file.begin() + static_cast<std::ptrdiff_t>(get<std::uint32_t>(file, kHeaderBytesAt)), file.end());
}

void expect_refused(const Bytes& bytes, const std::vector<std::string>& pieces) {
  expect_error(ErrorCode::bad_input, pieces, [&] { from_bytes(bytes, "some.octree"); });
}

Bytes small_file() {
  std::mt19937 random(3);
  reference::DenseGrid grid(3);
  for (auto& voxel : grid.voxels) voxel = random() % 3 == 0;
  Frame frame;
  frame.origin << 1.5, -2, 3;
  frame.unit = "mm";
  return to_bytes(reference::octree(grid).with_frame(frame), "{\"name\": \"noise\"}");
}

// A map of five labels in blocks and grains.
LabelMap small_map() {
  std::mt19937 random(9);
  LabelMapBuilder builder(3);
  while (builder.end() < 512)
    builder.add(std::min<std::uint64_t>(1 + random() % 20, 512 - builder.end()),
                static_cast<std::uint32_t>(random() % 5));
  return builder.finish();
}

TEST(OctreeDamage, TruncationAtEveryLength) {
  for (const Bytes& whole :
       {small_file(), to_bytes(ball(9, {256, 250, 270}, 20.5)), to_bytes(small_map()), forge(compress({1, 63}), 2, 2)})
    for (std::size_t length = 0; length < whole.size(); ++length) {
      SCOPED_TRACE(length);
      const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
      expect_refused(cut,
                     {"some.octree: ", length == 0 ? "is empty" : "ends after " + std::to_string(length) + " bytes"});
    }
}

TEST(OctreeDamage, EveryFlipOfEveryByte) {
  for (Bytes bytes : {small_file(), to_bytes(small_map()), forge(compress({1, 63}), 2, 2)}) {
    for (std::size_t at = 0; at < bytes.size(); ++at)
      for (unsigned mask = 1; mask < 256; mask += at < kTable ? 9 : 1) {
        bytes[at] ^= static_cast<std::uint8_t>(mask);
        try {
          from_bytes(bytes);
          ADD_FAILURE() << "byte " << at << " ^ " << mask << " went unnoticed";
        } catch (const Error& error) {
          if (error.code() != ErrorCode::bad_input) ADD_FAILURE() << at << ": " << error.what();
        }
        bytes[at] ^= static_cast<std::uint8_t>(mask);
      }
    EXPECT_NO_THROW(from_bytes(bytes));
  }
}

// Contents as a hostile writer would make them, with all checksums right: refused, or read as something whose file is
// this one, byte for byte, if it is a solid (labels may be packed otherwise).
void expect_refused_or_right(const Bytes& bytes, int& accepted) {
  try {
    const OctreeFile file = from_bytes(bytes);
    ++accepted;
    ASSERT_EQ(validate(file.octree), "");
    if (file.labels)
      ASSERT_TRUE(*from_bytes(to_bytes(*file.labels, file.metadata)).labels == *file.labels);
    else
      ASSERT_EQ(to_bytes(file.octree, file.metadata), bytes);
  } catch (const Error& error) {
    ASSERT_EQ(static_cast<int>(error.code()), static_cast<int>(ErrorCode::bad_input)) << error.what();
  }
}

TEST(OctreeDamage, FlipsWithChecksumsMended) {
  std::mt19937 random(11);
  for (const Bytes& whole : {small_file(), to_bytes(small_map()), to_bytes(ball(6, {30, 31, 33}, 20.5))}) {
    const std::size_t header = get<std::uint32_t>(whole, kHeaderBytesAt);
    int accepted = 0;
    for (int i = 0; i < 20000; ++i) {
      Bytes bytes = whole;
      for (int flips = 1 + i % 3; flips > 0; --flips)
        bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
      put(bytes, header - 16, std::uint64_t{XXH3_64bits(bytes.data() + header, bytes.size() - header)});
      put(bytes, header - 8, std::uint64_t{XXH3_64bits(bytes.data(), header - 8)});
      expect_refused_or_right(bytes, accepted);
    }
    EXPECT_GT(accepted, 100);  // frames and metadata are anyone's to choose: the test reaches past the checksums
  }
}

// Chunks are read side by side and in another order than they stand; what is wrong with some must not rub off on the
// others: the first that is damaged is named, whichever they are and on however many threads.
TEST(OctreeDamage, TheFirstDamagedChunkIsNamed) {
  std::mt19937 random(13);
  const Bytes whole = to_bytes(ball(9, {250, 262, 249}, 41.5));
  const std::size_t header = get<std::uint32_t>(whole, kHeaderBytesAt);
  ASSERT_EQ(chunk_count(9), 8u);
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(i);
    const auto damaged = static_cast<unsigned>(1 + random() % 255);
    Bytes bytes = whole;
    std::size_t at = header;
    for (unsigned chunk = 0; chunk < 8; ++chunk) {
      const std::size_t entry = kTable + chunk * entry_bytes(kVersion);
      const std::uint64_t size = get<std::uint64_t>(whole, entry) & 0xFFFFFFFF;
      ASSERT_GT(size, 100u);
      if (damaged >> chunk & 1) {
        bytes[at + random() % size] ^= static_cast<std::uint8_t>(1 + random() % 255);
        put(bytes, entry + 8, std::uint64_t{XXH3_64bits(bytes.data() + at, size)});
      }
      at += size;
    }
    reseal(bytes);
    const std::string name = "some.octree: chunk " + std::to_string(std::countr_zero(damaged)) + ": ";
    for (const int threads : {1, 2, 3})
      expect_error(ErrorCode::bad_input, {name}, [&] { from_bytes(bytes, "some.octree", Work{threads, {}}); });
  }
}

// Beginnings and ends of two files' contents, cut and joined.
TEST(OctreeDamage, Splices) {
  std::mt19937 random(12);
  int accepted = 0;
  const auto splice = [&](const Bytes& a, const Bytes& b, int depth, Content content) {
    for (int i = 0; i < 3000; ++i) {
      Bytes bytes(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(random() % (a.size() + 1)));
      bytes.insert(bytes.end(), b.begin() + static_cast<std::ptrdiff_t>(random() % b.size()), b.end());
      if (bytes != a && bytes != b) expect_refused_or_right(forge_new(bytes, depth, content), accepted);
    }
  };
  splice(contents(to_bytes(ball(6, {30, 31, 33}, 20.5))), contents(to_bytes(ball(6, {33, 29, 35}, 17.25))), 6,
         Content::solid);
  splice(contents(to_bytes(small_map())), contents(to_bytes(label_map(ball(3, {4, 3.5, 4}, 2.5)))), 3, Content::labels);
  EXPECT_EQ(accepted, 0);
}

// Contents of random bytes are refused soon, in whatever universe, without much memory.
TEST(OctreeDamage, RandomContents) {
  std::mt19937 random(13);
  int accepted = 0;
  for (int i = 0; i < 6000; ++i) {
    Bytes bytes(random() % 200);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(i % 4 == 0 ? 0 : random());
    if (bytes.size() >= 8) bytes[2] |= 1, bytes[6] |= 1;  // states of the coder
    expect_refused_or_right(forge_new(bytes, 1 + i % 20, i % 3 ? Content::solid : Content::labels), accepted);
  }
  EXPECT_LT(accepted, 100);
}

TEST(OctreeDamage, RandomBytesBehindTheMagic) {
  std::mt19937 random(5);
  for (int i = 0; i < 20000; ++i) {
    Bytes bytes(random() % 600);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    if (bytes.size() >= 20) {
      std::memcpy(bytes.data(), kMagic.data(), 8);
      put(bytes, kVersionAt, static_cast<std::uint32_t>(1 + random() % 2));
      if (i % 2) bytes[kDepthAt] = static_cast<std::uint8_t>(1 + random() % 20);
    }
    EXPECT_THROW(from_bytes(bytes), Error);
  }
}

TEST(OctreeDamage, KindsOfFilesThatAreNotOctrees) {
  const auto of = [](std::string_view text) { return Bytes(text.begin(), text.end()); };
  expect_refused(of("solid bunny\n facet normal 0 0 1\n"), {"some.octree: is a text file"});
  expect_refused(of("\x7F"
                    "ELF\x02\x01\x01"),
                 {"is not an .octree file"});
  Bytes bytes = small_file();
  const auto replaced = [&](std::string_view from, std::string_view to) {
    Bytes out;
    for (std::size_t i = 0; i < bytes.size();) {
      if (i + from.size() <= bytes.size() && std::memcmp(bytes.data() + i, from.data(), from.size()) == 0) {
        out.insert(out.end(), to.begin(), to.end());
        i += from.size();
      } else {
        out.push_back(bytes[i++]);
      }
    }
    return out;
  };
  expect_refused(replaced("\r\n", "\n"), {"line ends"});
  expect_refused(replaced("\n", "\r\n"), {"line ends"});
  expect_refused(replaced("\r", "\n"), {"line ends"});
  expect_refused(replaced("\n", "\r"), {"line ends"});
  expect_refused(replaced("\x89", "\xC2\x89"), {"character set"});
  expect_refused(replaced("\x89", "\x09"), {"eighth bits"});
  put(bytes, kVersionAt, std::uint32_t{3});
  expect_refused(bytes, {"format version 3", "reads versions 1 to 2", "newer"});
}

TEST(OctreeDamage, HostileHeadersOfVersion2) {
  const Bytes good = to_bytes(octree_from_runs(Runs{{1, 1}, {63, 0}}, 2));
  const auto with = [&](std::size_t at, auto value) {
    Bytes bytes = good;
    put(bytes, at, value);
    reseal(bytes);
    return bytes;
  };
  ASSERT_EQ(good[kTable + 7], 1);
  expect_refused(with(kContentAt, std::uint8_t{2}), {"contents of unknown kind 2"});
  expect_refused(with(kReservedAt, std::uint8_t{1}), {"reserved byte 14"});
  expect_refused(with(kTable + 7, std::uint8_t{2}), {"chunk 0: unknown kind 2"});
  expect_refused(with(kTable + 7, std::uint8_t{0}), {"chunk 0: is of one colour and yet has contents"});
  expect_refused(with(kTable + 6, std::uint8_t{1}), {"ends after", "too early for chunk 0"});
  expect_refused(with(kTable, std::uint64_t{1} << 56 | 1), {"bytes follow the last chunk"});
  expect_refused(with(kTable + 8, std::uint64_t{0}), {"chunk 0: checksum does not match", "restore it from a copy"});
  const auto colour = [&](Bytes bytes, std::uint64_t value) {
    put(bytes, kTable, value);
    reseal(bytes);
    return bytes;
  };
  expect_refused(colour(to_bytes(Octree(3)), 2), {"chunk 0: unknown colour 2"});
  expect_refused(colour(to_bytes(LabelMap(3)), std::uint64_t{1} << 32), {"chunk 0: unknown colour 4294967296"});
  EXPECT_TRUE(from_bytes(colour(to_bytes(Octree(3)), 1)).octree == Octree(3, Colour::black));
}

TEST(OctreeDamage, HostileContentsOfVersion2) {
  const Bytes brick = contents(to_bytes(octree_from_runs(Runs{{1, 1}, {63, 0}}, 2)));
  EXPECT_NO_THROW(from_bytes(forge_new(brick, 2, Content::solid)));
  expect_refused(forge_new({}, 2, Content::solid), {"chunk 0: is too short"});
  expect_refused(forge_new(Bytes(8, 0), 2, Content::solid), {"chunk 0: begins with no state"});
  Bytes longer = brick;
  longer.insert(longer.end(), 2, 0);
  expect_refused(forge_new(longer, 2, Content::solid), {"chunk 0: goes on after its last node"});
  longer.pop_back();
  expect_refused(forge_new(longer, 2, Content::solid), {"chunk 0: is too short"});
  // A brick with voxels beyond octant 0 is no universe of depth 1.
  expect_refused(forge_new(contents(to_bytes(octree_from_runs(Runs{{63, 0}, {1, 1}}, 2))), 1, Content::solid),
                 {"chunk 0: has voxels that are not its universe's"});
}

TEST(OctreeDamage, HostileLabels) {
  const auto refused = [](const Bytes& raw, const std::vector<std::string>& pieces) {
    expect_refused(forge_new(compress(raw), 1, Content::labels), pieces);
  };
  EXPECT_NO_THROW(from_bytes(forge_new(compress({2, 0, 5, 0, 3, 1, 5}), 1, Content::labels)));
  refused({2, 0, 5, 0, 3, 1, 4}, {"less than its voxels"});
  refused({2, 0, 5, 0, 3, 1, 6}, {"more than its voxels"});
  refused({2, 0, 5, 0, 3, 1, 5, 0}, {"bytes follow its last run"});
  refused({2, 0, 5, 0, 0, 1, 8}, {"a run has no length"});
  refused({2, 0, 5, 0, 3, 0, 5}, {"no label of its own"});
  refused({2, 0, 5, 0, 3, 2, 5}, {"no label of its own"});
  refused({2, 5, 0, 0, 3, 1, 5}, {"not in order"});
  refused({3, 0, 5, 1, 0, 3, 1, 5}, {"does not occur"});
  refused({1, 0, 0, 8}, {"has 1 labels"});
  refused({9, 0}, {"has 9 labels"});
  refused({0x80}, {"less than its voxels"});
  refused({0x82, 0}, {"more bytes than it needs"});
  expect_refused(forge_new({1, 2, 3}, 1, Content::labels), {"chunk 0: cannot be decompressed"});
}

TEST(OctreeDamage, HostileHeaders) {
  const Bytes good = forge(compress({1, 63}), 2, 2);
  EXPECT_NO_THROW(from_bytes(good));
  ASSERT_EQ(good[kTable], 2);
  const auto with = [&](std::size_t at, auto value) {
    Bytes bytes = good;
    put(bytes, at, value);
    reseal(bytes);
    return bytes;
  };
  const auto unsealed = [&](std::size_t at, auto value) {
    Bytes bytes = good;
    put(bytes, at, value);
    return bytes;
  };
  expect_refused(with(kDepthAt, std::uint8_t{0}), {"depth 0"});
  expect_refused(with(kDepthAt, std::uint8_t{21}), {"depth 21"});
  expect_refused(with(kContentAt, std::uint8_t{1}), {"contents of unknown kind 1"});
  expect_refused(with(kReservedAt + 1, std::uint8_t{1}), {"reserved byte 15"});
  expect_refused(unsealed(kHeaderBytesAt, std::uint32_t{0}), {"header: a length of 0"});
  expect_refused(unsealed(kHeaderBytesAt, ~std::uint32_t{0}), {"header: a length of 4294967295"});
  expect_refused(with(kChunksAt, ~std::uint32_t{0}), {"4294967295 chunks"});
  expect_refused(with(kChunksAt, std::uint32_t{0}), {"0 chunks"});
  expect_refused(with(kUnitBytesAt, ~std::uint32_t{0}), {"unit's name of 4294967295"});
  expect_refused(with(kMetadataBytesAt, ~std::uint32_t{0}), {"metadata of 4294967295"});
  expect_refused(with(kUnitBytesAt, std::uint32_t{250}), {"header: a length"});
  expect_refused(with(kOriginAt, std::numeric_limits<double>::quiet_NaN()), {"frame", "not finite"});
  expect_refused(with(kAxesAt + 64, std::numeric_limits<double>::infinity()), {"frame", "not finite"});
  expect_refused(with(kFixedBytes, '\n'), {"unit's name has control characters"});
  expect_refused(with(kFixedBytes, '\xFF'), {"unit's name is not UTF-8"});
  expect_refused(with(kFixedBytes + 5, '['), {"metadata are not a JSON object"});
  expect_refused(with(kFixedBytes + 7, 'x'), {"reserved byte 135"});
  expect_refused(with(kTable, std::uint8_t{3}), {"chunk 0: unknown kind 3"});
  expect_refused(with(kTable, std::uint8_t{0}), {"chunk 0: is of one colour and yet has contents"});
  expect_refused(with(kTable + 7, std::uint8_t{1}), {"reserved byte 143"});
  expect_refused(with(kTable + 8, std::uint64_t{0}), {"chunk 0: 0 runs"});
  expect_refused(with(kTable + 8, ~std::uint64_t{0}), {"chunk 0", "not possible"});
  expect_refused(with(kTable + 16, ~std::uint64_t{0}), {"chunk 0", "not possible"});
  expect_refused(with(kTable + 24, ~std::uint64_t{0}), {"ends after", "too early for chunk 0"});
  expect_refused(with(kTable + 24, std::uint64_t{1}), {"bytes follow the last chunk"});
  expect_refused(with(kTable + 32, std::uint64_t{0}), {"chunk 0: checksum does not match", "restore it from a copy"});
  Bytes longer = good;
  longer.push_back(0);
  expect_refused(longer, {"1 bytes follow the last chunk"});
}

TEST(OctreeDamage, HostileChunks) {
  expect_refused(forge(compress({1, 62}), 2, 2), {"chunk 0: its runs do not add up"});
  expect_refused(forge(compress({1, 62, 1}), 2, 3), {"chunk 0: its runs do not add up"});
  expect_refused(forge(compress({1, 64}), 2, 2), {"chunk 0: its runs add up to more"});
  expect_refused(forge(compress({1, 63, 1}), 3, 3), {"has 2 runs where its entry says 3"});
  expect_refused(forge(compress({1, 63, 1}), 2, 3), {"bytes follow its last run"});
  expect_refused(forge(compress({1, 63, 1}), 2, 2), {"more than its entry says"});
  expect_refused(forge(compress({1, 63}), 2, 3), {"has 2 bytes where its entry says 3"});
  expect_refused(forge(compress({1}), 2, 2), {"less than its entry says"});
  expect_refused(forge(compress({1, 0, 63}), 3, 3), {"run 1 has no length"});
  expect_refused(forge(compress({0, 0, 64}), 3, 3), {"run 1 has no length"});
  expect_refused(forge(compress({64, 0}), 2, 2), {"of one colour"});
  expect_refused(forge(compress({0, 64}), 2, 2), {"of one colour"});
  expect_refused(forge(compress({0x81, 0, 63}), 2, 3), {"run 0 is written with more bytes than it needs"});
  expect_refused(forge(compress({1, 0xBF, 0x80, 0}), 2, 4), {"run 1 is written with more bytes than it needs"});
  expect_refused(forge(compress(Bytes(18, 0xFF)), 2, 18), {"run 0 is longer than any universe"});
  expect_refused(forge({1, 2, 3, 4, 5, 6, 7, 8, 9}, 2, 2), {"chunk 0: cannot be decompressed"});
  Bytes two = compress({1, 63}), skippable = two;
  const Bytes second = compress({1, 63});
  two.insert(two.end(), second.begin(), second.end());
  expect_refused(forge(two, 2, 2), {"chunk 0: bytes follow its compressed data"});
  const Bytes frame = {0x50, 0x2A, 0x4D, 0x18, 1, 0, 0, 0, 7};
  skippable.insert(skippable.end(), frame.begin(), frame.end());
  expect_refused(forge(skippable, 2, 2), {"chunk 0: bytes follow its compressed data"});
  Bytes cut = compress({1, 63});
  cut.pop_back();
  expect_refused(forge(cut, 2, 2), {"chunk 0"});
  EXPECT_NO_THROW(from_bytes(forge(compress({0, 1, 63}), 3, 3)));
  EXPECT_NO_THROW(from_bytes(forge(compress({1, 63}, false), 2, 2)));
}

// The address space is limited while these are read: a reader that believed them could not get its memory.
class SmallMemory {
 public:
  SmallMemory() {
    ::getrlimit(RLIMIT_DATA, &old_);
    rlimit limit = old_;
    limit.rlim_cur = std::size_t{1} << 29;
    if (test::kMemoryLimits) ::setrlimit(RLIMIT_DATA, &limit);
  }
  ~SmallMemory() { ::setrlimit(RLIMIT_DATA, &old_); }
  SmallMemory(const SmallMemory&) = delete;
  SmallMemory& operator=(const SmallMemory&) = delete;

 private:
  rlimit old_{};
};

TEST(OctreeDamage, Bombs) {
  const Bytes zeros = compress(Bytes(std::size_t{1} << 28, 0));  // 256 MB of "no length"
  const Bytes ones = compress(Bytes(std::size_t{1} << 24, 1));   // alternating voxels, more than the universe has
  const SmallMemory limit;
  expect_refused(forge(zeros, std::uint64_t{1} << 28, std::uint64_t{1} << 28, 18), {"run 1 has no length"});
  expect_refused(forge(zeros, 65, 65), {"chunk 0"});
  expect_refused(forge(ones, 64, 64), {"chunk 0", "more than its entry says"});
  expect_refused(forge(zeros, std::uint64_t{1} << 40, std::uint64_t{1} << 40, 18), {"not possible"});
  // A window of 2^31 bytes asked for by the frame's own header.
  const Bytes window = {0x28, 0xB5, 0x2F, 0xFD, 0x00, 0xA8, 0x11, 0x00, 0x00, 0x01, 0x3F};
  expect_refused(forge(window, 2, 2), {"chunk 0: cannot be decompressed"});
}

TEST(OctreeDamage, FilesThatCannotBeRead) {
  const test::TemporaryFolder folder;
  expect_error(ErrorCode::io, {"missing.octree: no such file"}, [&] { load(folder / "missing.octree"); });
  expect_error(ErrorCode::io, {"is a folder"}, [&] { load(folder.path()); });
  test::write_file(folder / "empty.octree", "");
  expect_error(ErrorCode::bad_input, {"empty.octree: is empty"}, [&] { load(folder / "empty.octree"); });
  test::write_file(folder / "text.octree", "hello\n");
  expect_error(ErrorCode::bad_input, {"text.octree: is a text file"}, [&] { load(folder / "text.octree"); });
  expect_error(ErrorCode::io, {"x.octree: cannot be read"}, [&] { load(folder / "text.octree" / "x.octree"); });
  Bytes bytes = to_bytes(ball(9, {256, 250, 270}, 120));
  bytes.back() ^= 1;
  test::write_file(folder / "bunny.octree", bytes);
  expect_error(ErrorCode::bad_input,
               {"bunny.octree: chunk 7: checksum does not match; the file is damaged, restore it from a copy"},
               [&] { load(folder / "bunny.octree"); });
  // A terabyte of nothing behind a good beginning is refused at once.
  bytes.back() ^= 1;
  test::write_file(folder / "huge.octree", bytes);
  std::filesystem::resize_file(folder / "huge.octree", std::uintmax_t{1} << 40);
  const SmallMemory limit;
  expect_error(ErrorCode::bad_input, {"bytes follow the last chunk"}, [&] { load(folder / "huge.octree"); });
}

}  // namespace
}  // namespace blackleaf
