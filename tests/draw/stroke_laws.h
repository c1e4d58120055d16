// What holds for the strokes of every drawing.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "blackleaf/drawing.h"

namespace blackleaf {

/// The same strokes in the same order, to the last bit.
inline void expect_same(const std::vector<Stroke>& strokes, const std::vector<Stroke>& expected) {
  ASSERT_EQ(strokes.size(), expected.size());
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    ASSERT_EQ(strokes[i].from, expected[i].from) << i;
    ASSERT_EQ(strokes[i].to, expected[i].to) << i;
  }
}

/// No stroke of zero length, and none that continues another: ends meet only at angles whose sine is above `least`,
/// and nothing is drawn twice.
inline void expect_cannot_be_joined(const std::vector<Stroke>& strokes, double least) {
  using Place = std::pair<std::int64_t, std::int64_t>;
  const auto place = [](const Eigen::Vector2d& p) { return Place{std::llround(p[0] * 1e9), std::llround(p[1] * 1e9)}; };
  std::map<Place, std::vector<Eigen::Vector2d>> ends;  // directions of the strokes that end at a place
  for (const Stroke& s : strokes) {
    const Eigen::Vector2d along = s.to - s.from;
    ASSERT_GT(along.norm(), 0);
    ends[place(s.from)].push_back(along.normalized());
    ends[place(s.to)].push_back(-along.normalized());
  }
  for (const auto& [where, found] : ends)
    for (std::size_t i = 0; i < found.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        ASSERT_GT(std::abs(found[i][0] * found[j][1] - found[i][1] * found[j][0]), least)
            << where.first << " " << where.second;
}

}  // namespace blackleaf
