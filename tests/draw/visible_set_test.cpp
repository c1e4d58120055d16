// VisibleSet against a row of unit cells.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "draw/visible_set.h"

namespace blackleaf::detail {
namespace {

constexpr int kCells = 24;
using Cells = std::array<bool, kCells>;  // cell i is the open interval (i, i + 1)

std::vector<std::array<std::int64_t, 2>> runs(const Cells& cells) {
  std::vector<std::array<std::int64_t, 2>> result;
  for (int i = 0; i < kCells; ++i) {
    if (!cells[static_cast<std::size_t>(i)]) continue;
    const bool joins = !result.empty() && result.back()[1] == i;
    if (joins)
      result.back()[1] = i + 1;
    else
      result.push_back({i, i + 1});
  }
  return result;
}

TEST(VisibleSet, LikeCells) {
  for (unsigned seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    VisibleSet set;
    set.reset(0, kCells);
    Cells cells;
    cells.fill(true);
    for (int step = 0; step < 30; ++step) {
      const auto low = std::uniform_int_distribution<std::int64_t>(-3, kCells + 2)(random);
      const auto high = low + std::uniform_int_distribution<std::int64_t>(1, seed % 2 ? 3 : 12)(random);
      bool meets = false;
      for (int i = 0; i < kCells; ++i) meets = meets || (cells[static_cast<std::size_t>(i)] && low <= i && i < high);
      ASSERT_EQ(set.meets(low, high), meets);
      if (!meets) continue;
      for (int i = 0; i < kCells; ++i)
        if (low <= i && i < high) cells[static_cast<std::size_t>(i)] = false;
      const bool nothing_left = set.subtract(low, high);
      std::vector<std::array<std::int64_t, 2>> found;
      for (const Interval& interval : set.intervals()) found.push_back({interval.low, interval.high});
      // Cells that touch stay apart in neither: a cut leaves a gap of at least one cell.
      ASSERT_EQ(found, runs(cells));
      ASSERT_EQ(nothing_left, found.empty());
      if (nothing_left) break;
    }
  }
}

}  // namespace
}  // namespace blackleaf::detail
