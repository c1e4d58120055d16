// Round trips, canonical bytes, golden files.
#include "blackleaf/octree_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "blackleaf/implicit.h"
#include "blackleaf/leaves.h"
#include "blackleaf/runs.h"
#include "file/octree_format.h"
#include "reference/dense_grid.h"
#include "temporary_folder.h"

namespace blackleaf {
namespace {

using test::expect_error;
using Runs = std::vector<blackleaf::Run>;  // inside a test, "Run" is a function of GoogleTest

Frame odd_frame() {
  Frame frame;
  frame.origin << -123.456, 1e-300, -0.0;
  frame.axes << 0.1, -0.2, 1.0 / 3, 7, 0.5, -1e17, 3.25, std::numeric_limits<double>::denorm_min(), 2;
  frame.unit = "\xC2\xB5m";  // micrometres, beyond ASCII
  return frame;
}

bool same_bits(const Frame& a, const Frame& b) {
  return std::memcmp(a.origin.data(), b.origin.data(), 3 * sizeof(double)) == 0 &&
         std::memcmp(a.axes.data(), b.axes.data(), 9 * sizeof(double)) == 0 && a.unit == b.unit;
}

void expect_round_trip(const Octree& octree, const std::string& metadata) {
  const auto bytes = to_bytes(octree, metadata);
  const OctreeFile file = from_bytes(bytes);
  reference::expect_valid(file.octree);
  EXPECT_TRUE(file.octree == octree);
  EXPECT_TRUE(same_bits(file.octree.frame(), octree.frame()));
  EXPECT_EQ(file.metadata, metadata);
  EXPECT_EQ(file.file_bytes, bytes.size());
}

TEST(OctreeFile, RoundTripsOfRandomSolids) {
  std::mt19937 random(20240501);
  for (int depth = 1; depth <= 6; ++depth)
    for (int i = 0; i < (depth < 6 ? 120 : 20); ++i) {
      SCOPED_TRACE(testing::Message() << "depth " << depth << " case " << i);
      expect_round_trip(reference::octree(reference::random_solid(depth, random)).with_frame(odd_frame()),
                        "{\"a\": [1, 2]}");
    }
}

TEST(OctreeFile, RoundTripsOfLargeUniverses) {
  for (int depth = 7; depth <= 12; ++depth) {
    SCOPED_TRACE(depth);
    const double side = std::ldexp(1.0, depth);
    expect_round_trip(ball(depth, {0.43 * side, 0.51 * side, 0.6 * side}, std::min(0.37 * side, 300.0)), "{}");
    const int n = 1 << depth;
    expect_round_trip(box(depth, {1, 0, 3}, {n - 1, n, n / 2 + 1}), "{}");
    expect_round_trip(Octree(depth, Colour::black), "{}");
    expect_round_trip(Octree(depth), "{}");
  }
  expect_round_trip(ball(20, {3e5, 5e5, 7e5}, 40.5), "{}");
  expect_round_trip(box(20, {0, 0, 0}, {1 << 19, 1 << 20, 1 << 20}), "{}");
  expect_round_trip(box(20, {(1 << 20) - 1, (1 << 20) - 1, (1 << 20) - 1}, {1 << 20, 1 << 20, 1 << 20}), "{}");
  expect_round_trip(Octree(20, Colour::black), "{}");
}

// Chunks meet inside runs, at their borders and around chunks of one colour.
TEST(OctreeFile, RunsAcrossChunkBorders) {
  for (const int depth : {9, 10, 11}) {
    const std::uint64_t chunk = std::uint64_t{1} << (3 * detail::format::chunk_level(depth));
    const std::uint64_t all = std::uint64_t{1} << (3 * depth);
    for (const std::uint64_t cut :
         {std::uint64_t{1}, chunk - 1, chunk, chunk + 1, 2 * chunk, 3 * chunk + 5, all - chunk, all - 1})
      for (const bool first_black : {false, true}) {
        SCOPED_TRACE(testing::Message() << depth << " cut " << cut << " " << first_black);
        const std::uint32_t first = first_black ? 1 : 0;
        const Runs stream = {{cut, first}, {all - cut, 1 - first}};
        const Octree octree = octree_from_runs(stream, depth);
        expect_round_trip(octree, "{}");
        EXPECT_EQ(runs(from_bytes(to_bytes(octree)).octree), stream);
      }
  }
}

// The same solid made from its voxels, from its runs and from its unmerged leaves: the same bytes.
TEST(OctreeFile, BytesDependOnTheSolidAlone) {
  std::mt19937 random(7);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const int depth = 1 + i % 5;
    const Octree octree = reference::octree(reference::random_solid(depth, random));
    Runs leaves;
    for_each_leaf(octree, [&](const Leaf& leaf, bool black) {
      leaves.push_back({std::uint64_t{1} << (3 * leaf.cube.level), black ? 5u : 0u});
    });
    const auto bytes = to_bytes(octree);
    EXPECT_EQ(to_bytes(octree_from_runs(leaves, depth)), bytes);
    EXPECT_EQ(to_bytes(octree_from_monochrome(monochrome(octree), depth)), bytes);
    EXPECT_EQ(to_bytes(from_bytes(bytes).octree), bytes);
  }
  const Octree octree = ball(10, {500, 510, 520}, 200);
  EXPECT_EQ(to_bytes(octree_from_runs(runs(octree), 10)), to_bytes(octree));
}

TEST(OctreeFile, ChunkBordersDependOnTheDepthAlone) {
  using namespace detail::format;
  for (int depth = 1; depth <= 8; ++depth) EXPECT_EQ(chunk_count(depth), 1u);
  EXPECT_EQ(chunk_count(9), 8u);
  for (int depth = 10; depth <= 20; ++depth) EXPECT_EQ(chunk_count(depth), 64u);
  // One colour takes a table entry and no contents.
  EXPECT_EQ(to_bytes(Octree(20)).size(), kFixedBytes + 8 + 64 * entry_bytes(2) + kChecksumBytes);
}

void expect_round_trip(const LabelMap& labels) {
  const auto bytes = to_bytes(labels, "{\"labels\": true}");
  const OctreeFile file = from_bytes(bytes);
  ASSERT_TRUE(file.labels.has_value());
  EXPECT_TRUE(*file.labels == labels);
  EXPECT_TRUE(same_bits(file.labels->frame(), labels.frame()));
  EXPECT_TRUE(file.octree == octree_from_labels(labels));
  EXPECT_EQ(file.metadata, "{\"labels\": true}");
  EXPECT_EQ(to_bytes(*file.labels, file.metadata), bytes);
}

TEST(OctreeFile, RoundTripsOfLabelMaps) {
  std::mt19937_64 random(20261122);
  for (int depth = 1; depth <= 20; ++depth)
    for (int i = 0; i < 20; ++i) {
      SCOPED_TRACE(testing::Message() << "depth " << depth << " case " << i);
      const std::uint64_t all = std::uint64_t{1} << (3 * depth);
      const int bits = 1 + static_cast<int>(random() % static_cast<std::uint64_t>(3 * depth));
      const std::uint32_t labels = i % 3 == 0 ? 2u : i % 3 == 1 ? 200u : 0xFFFFFFFFu;
      LabelMapBuilder builder(depth);
      for (int k = 0; k < 2000 && builder.end() < all; ++k)
        builder.add(std::min(all - builder.end(), random() % (std::uint64_t{1} << bits)),
                    static_cast<std::uint32_t>(random() % labels));
      builder.add(all - builder.end(), i % 2 ? 0xFFFFFFFFu : 0);
      expect_round_trip(builder.finish(odd_frame()));
    }
  expect_round_trip(LabelMap(20));
  expect_round_trip(label_map(ball(9, {250, 260, 270}, 100)));
}

// Nothing that a surface coder likes: noise of every density, checkerboards, single voxels.
TEST(OctreeFile, RoundTripsOfNastySolids) {
  std::mt19937 random(5);
  for (int depth = 1; depth <= 6; ++depth) {
    reference::DenseGrid grid(depth);
    for (const unsigned percent : {1u, 10u, 50u, 90u, 99u}) {
      SCOPED_TRACE(testing::Message() << "depth " << depth << ", " << percent << " % noise");
      for (auto& voxel : grid.voxels) voxel = random() % 100 < percent;
      const Octree octree = reference::octree(grid);
      expect_round_trip(octree, "{}");
      // One bit a voxel and what it takes to learn that there is nothing to learn.
      EXPECT_LE(to_bytes(octree).size(), 300 + grid.voxels.size() / 8 * 3 / 2);
    }
    for (std::size_t i = 0; i < grid.voxels.size(); ++i)
      grid.voxels[i] = ((i ^ i >> depth ^ i >> (2 * depth)) & 1) != 0;
    expect_round_trip(reference::octree(grid), "{}");
  }
  for (const int depth : {1, 2, 3, 8, 9, 15, 20})
    for (int i = 0; i < 20; ++i) {
      const int n = 1 << depth;
      const auto at = [&] { return static_cast<int>(random() % static_cast<unsigned>(n)); };
      const int x = at(), y = at(), z = at();
      expect_round_trip(box(depth, {x, y, z}, {x + 1, y + 1, z + 1}), "{}");
    }
}

TEST(OctreeFile, SameBytesOnAnyNumberOfThreads) {
  const Octree octree = ball(10, {400, 510, 520}, 300.5);
  const LabelMap labels = label_map(octree);
  const auto bytes = to_bytes(octree, "{}", {1, {}}), label_bytes = to_bytes(labels, "{}", {1, {}});
  for (const int threads : {2, 3, 0}) {
    EXPECT_EQ(to_bytes(octree, "{}", {threads, {}}), bytes);
    EXPECT_EQ(to_bytes(labels, "{}", {threads, {}}), label_bytes);
    EXPECT_TRUE(from_bytes(bytes, "x", {threads, {}}).octree == octree);
    EXPECT_TRUE(*from_bytes(label_bytes, "x", {threads, {}}).labels == labels);
  }
  int calls = 0;
  const Work refuse{1, [&](double) { return ++calls < 3; }};
  expect_error(ErrorCode::cancelled, {"interrupted"}, [&] { from_bytes(bytes, "x", refuse); });
  expect_error(ErrorCode::cancelled, {"interrupted"}, [&] { to_bytes(octree, "{}", refuse); });
}

TEST(OctreeFile, SaveAndLoad) {
  const test::TemporaryFolder folder;
  const Octree octree = ball(8, {100, 128, 140}, 77.25).with_frame(odd_frame());
  const std::string metadata = "{\"source\": \"a ball\", \"nested\": {\"unicode\": \"\xE6\xA8\xB9\"}}";
  save(octree, folder / "ball.octree", metadata);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"ball.octree"});
  EXPECT_EQ(test::read_bytes(folder / "ball.octree"), to_bytes(octree, metadata));
  const OctreeFile file = load(folder / "ball.octree");
  EXPECT_TRUE(file.octree == octree);
  EXPECT_TRUE(same_bits(file.octree.frame(), octree.frame()));
  EXPECT_EQ(file.metadata, metadata);
  EXPECT_EQ(file.file_bytes, std::filesystem::file_size(folder / "ball.octree"));
}

TEST(OctreeFile, RefusesWhatCannotBeKept) {
  for (const char* metadata :
       {"", "[]", "1", "\"text\"", "{", "{}x", "{\"a\":}", "{\"a\": \"\xFF\"}", "\xEF\xBB\xBF{}"})
    expect_error(ErrorCode::bad_argument, {"JSON object"}, [&] { to_bytes(Octree(3), metadata); });
  EXPECT_EQ(from_bytes(to_bytes(Octree(3), " { } ")).metadata, " { } ");
  expect_error(ErrorCode::bad_argument, {"16 MiB"},
               [] { to_bytes(Octree(3), "{\"a\": \"" + std::string(std::size_t{1} << 24, 'x') + "\"}"); });
  Frame frame;
  frame.origin[1] = std::numeric_limits<double>::quiet_NaN();
  expect_error(ErrorCode::bad_argument, {"not finite"}, [&] { to_bytes(Octree(3).with_frame(frame)); });
  frame = {};
  frame.axes(2, 1) = std::numeric_limits<double>::infinity();
  expect_error(ErrorCode::bad_argument, {"not finite"}, [&] { to_bytes(Octree(3).with_frame(frame)); });
  for (const std::string& unit :
       {std::string("a\nb"), std::string("\0", 1), std::string("\xC3"), std::string("\xC0\x80"),
        std::string("\xED\xA0\x80"), std::string("\xF4\x90\x80\x80"), std::string("\x80"), std::string(256, 'm')}) {
    frame = {};
    frame.unit = unit;
    expect_error(ErrorCode::bad_argument, {"unit"}, [&] { to_bytes(Octree(3).with_frame(frame)); });
  }
  frame.unit = std::string(255, 'm');
  EXPECT_EQ(from_bytes(to_bytes(Octree(3).with_frame(frame))).octree.frame().unit, frame.unit);
  frame.unit = "\xF0\x9D\x95\x9E \xE2\x82\xAC";
  EXPECT_EQ(from_bytes(to_bytes(Octree(3).with_frame(frame))).octree.frame().unit, frame.unit);
}

Frame golden_frame() {
  Frame frame;
  frame.origin << -90.5, 126, -72.25;
  frame.axes << -0.5, 0, 0.25, 0, 0.75, 0, 0.125, 0, 1.5;
  frame.unit = "mm";
  return frame;
}

Octree golden_octree() {
  Runs stream = runs(ball(9, {200, 250, 300}, 150.5));
  stream.back().count -= 5;  // make the last chunk one of two colours
  stream.push_back({5, 1});
  return octree_from_runs(stream, 9).with_frame(golden_frame());
}

const std::string kGoldenMetadata = "{\"source\": \"the ball about (200, 250, 300) and the last five voxels\"}";

// The labels of golden_octree: 7 in the lower half along the curve, 1000000 in the upper.
LabelMap golden_labels() {
  LabelMapBuilder builder(9);
  const std::uint64_t half = std::uint64_t{1} << 26;
  for (const blackleaf::Run& run : runs(golden_octree())) {
    const std::uint64_t below = builder.end() < half ? std::min(run.count, half - builder.end()) : 0;
    builder.add(below, run.colour ? 7 : 0);
    builder.add(run.count - below, run.colour ? 1000000 : 0);
  }
  return builder.finish(golden_frame());
}

// The golden files were written when their versions were made. Their contents, told here, must always be read from
// them.
TEST(OctreeFile, GoldenFiles) {
  const std::filesystem::path data = BLACKLEAF_TEST_DATA;
  for (const char* name : {"version1.octree", "version2.octree", "version2_labels.octree"}) {
    SCOPED_TRACE(name);
    const OctreeFile file = load(data / name);
    EXPECT_TRUE(file.octree == golden_octree());
    EXPECT_TRUE(same_bits(file.octree.frame(), golden_frame()));
    EXPECT_EQ(file.metadata, kGoldenMetadata);
    EXPECT_EQ(file.labels.has_value(), std::string_view(name) == "version2_labels.octree");
    if (file.labels) {
      EXPECT_TRUE(*file.labels == golden_labels());
    }
  }
  // What is written today is version 2, byte for byte.
  EXPECT_EQ(to_bytes(golden_octree(), kGoldenMetadata), test::read_bytes(data / "version2.octree"));
}

// One voxel in a universe of depth 2, every byte of its contents: eight bytes and one symbol each fit into the states.
TEST(OctreeFile, BytesOfOneVoxel) {
  const auto bytes = to_bytes(box(2, {0, 0, 0}, {1, 1, 1}));
  const std::vector<std::uint8_t> contents(bytes.end() - 8, bytes.end());
  EXPECT_EQ(bytes.size(), detail::format::table_at(5, 2) + 16 + 8 + 8);
  EXPECT_EQ(contents, (std::vector<std::uint8_t>{0xEC, 0x7B, 0xF9, 0x00, 0xC0, 0x2A, 0x03, 0x00}));
}

}  // namespace
}  // namespace blackleaf
