#include "blackleaf/runs_file.h"

#include <gtest/gtest.h>

#include <random>

#include "blackleaf/implicit.h"
#include "blackleaf/runs.h"
#include "reference/dense_grid.h"
#include "reference/dense_labels.h"
#include "temporary_folder.h"

namespace blackleaf {
namespace {

using test::expect_error;
using Runs = std::vector<blackleaf::Run>;  // inside a test, "Run" is a function of GoogleTest

TEST(RunsFile, RoundTrips) {
  const test::TemporaryFolder folder;
  std::mt19937 random(99);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const Octree octree = reference::octree(reference::random_solid(1 + i % 5, random));
    write_runs(octree, folder / "a.runs");
    EXPECT_TRUE(read_runs(folder / "a.runs") == octree);
  }
  for (const Octree& octree : {ball(9, {200, 250, 300}, 150.5), Octree(20, Colour::black), Octree(20), Octree(1)}) {
    write_runs(octree, folder / "a.runs");
    EXPECT_TRUE(read_runs(folder / "a.runs") == octree);
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.runs"});
}

TEST(RunsFile, TextIsTheStream) {
  const test::TemporaryFolder folder;
  write_runs(octree_from_runs(Runs{{3, 0}, {4, 1}, {1, 0}}, 1), folder / "a.runs");
  EXPECT_EQ(test::read_text(folder / "a.runs"), "3 0\n4 1\n1 0\n");
}

TEST(RunsFile, ToleratesLineEndsBlanksAndManyColours) {
  const test::TemporaryFolder folder;
  const Octree expected = octree_from_runs(Runs{{3, 0}, {4, 1}, {1, 0}}, 1);
  for (const char* text :
       {"3 0\n4 1\n1 0\n", "3 0\r\n4 1\r\n1 0\r\n", "3 0\n4 1\n1 0", "\n\n3 0\n\n  \n4 1\r\n\r\n1 0\n\n",
        " 3\t0 \n1 7\n2 4294967295\n0 0\n1 1\n1 0", "1 0\n2 0\n0 5\n4 25\n1 0\n0 1\n"}) {
    SCOPED_TRACE(text);
    test::write_file(folder / "a.runs", text);
    EXPECT_TRUE(read_runs(folder / "a.runs") == expected);
  }
}

TEST(RunsFile, ErrorsNameTheLine) {
  const test::TemporaryFolder folder;
  const auto expect_refused = [&](std::string_view text, const std::vector<std::string>& pieces) {
    SCOPED_TRACE(text.substr(0, 60));
    test::write_file(folder / "a.runs", text);
    expect_error(ErrorCode::bad_input, pieces, [&] { read_runs(folder / "a.runs"); });
  };
  for (const char* line : {"x", "3", "3 x", "x 0", "-3 0", "3 -1", "3.5 0", "3 0 0", "3 4294967296",
                           "99999999999999999999 1", "3,0", "0x3 0", "+3 0"})
    expect_refused("1 0\n\n" + std::string(line) + "\n4 1\n", {"a.runs: line 3 is not \"count colour\""});
  expect_refused("", {"a.runs: is empty"});
  expect_refused("9 0\n", {"line 1", "add up to 9", "not 8^n"});
  expect_refused("8 0\n1 1\n", {"line 2", "add up to 9"});
  expect_refused("1 0\n", {"add up to 1"});
  expect_refused("1152921504606846976 1\n1 0\n", {"line 2 brings the counts above the 8^20"});
  expect_refused("8 1\n18446744073709551615 0\n", {"line 2 brings the counts above"});
  expect_refused("4 1\n" + std::string(200000, '7'), {"line 2 has no end"});
  expect_error(ErrorCode::io, {"none.runs: no such file"}, [&] { read_runs(folder / "none.runs"); });
  expect_error(ErrorCode::io, {"is a folder"}, [&] { read_runs(folder.path()); });
}

TEST(RunsFile, LabelsRoundTrip) {
  const test::TemporaryFolder folder;
  std::mt19937 random(98);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    reference::DenseLabels grid(1 + i % 5);
    const std::int64_t side = grid.side();
    grid.labels = reference::random_labels({side, side, side}, {0, 1, 300, 4294967295u}, random);
    const LabelMap map(grid.runs(), grid.depth);
    write_runs(map, folder / "a.runs");
    EXPECT_TRUE(read_label_runs(folder / "a.runs") == map);
    EXPECT_TRUE(read_runs(folder / "a.runs") == octree_from_labels(map));
  }
  write_runs(LabelMap(20), folder / "a.runs");
  EXPECT_TRUE(read_label_runs(folder / "a.runs") == LabelMap(20));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.runs"});
}

TEST(RunsFile, LabelTextIsTheStreamAndIsMerged) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.runs", " 1\t7 \n2 7\r\n0 9\n\n4 300\n1 0");
  const LabelMap map = read_label_runs(folder / "a.runs");
  EXPECT_EQ(map.runs(), (Runs{{3, 7}, {4, 300}, {1, 0}}));
  write_runs(map, folder / "b.runs");
  EXPECT_EQ(test::read_text(folder / "b.runs"), "3 7\n4 300\n1 0\n");
  test::write_file(folder / "a.runs", "1 0\n3 -1\n4 1\n");
  expect_error(ErrorCode::bad_input, {"a.runs: line 2 is not \"count colour\""},
               [&] { read_label_runs(folder / "a.runs"); });
  test::write_file(folder / "a.runs", "9 4\n");
  expect_error(ErrorCode::bad_input, {"line 1", "not 8^n"}, [&] { read_label_runs(folder / "a.runs"); });
}

// Lines that lie across the borders of the reader's buffer.
TEST(RunsFile, LongFiles) {
  const test::TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 1 << 17; ++i) text += i % 2 ? "1 1\n" : "1  0\r\n";
  for (int i = 0; i < 1 << 17; ++i) text += i % 3 ? "1 1\n" : "\n1 0\n";
  test::write_file(folder / "a.runs", text);
  const Octree octree = read_runs(folder / "a.runs");
  ASSERT_EQ(octree.depth(), 6);
  Runs expected;
  for (unsigned i = 0; i < 1u << 17; ++i) expected.push_back({1, i % 2});
  for (unsigned i = 0; i < 1u << 17; ++i) expected.push_back({1, i % 3 ? 1u : 0u});
  EXPECT_TRUE(octree == octree_from_runs(expected, 6));
}

}  // namespace
}  // namespace blackleaf
