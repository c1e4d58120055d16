// Lines for tests of pens.
#pragma once

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "blackleaf/picture.h"

namespace blackleaf::test {

/// All straight pieces, each from its lesser end to its greater, sorted: equal for equal sets of drawn pieces.
inline std::vector<std::array<double, 4>> pieces(const Polylines& lines) {
  std::vector<std::array<double, 4>> result;
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t k = 0; k + 1 < lines[i].size(); ++k) {
      std::array<double, 2> a{lines[i][k][0], lines[i][k][1]}, b{lines[i][k + 1][0], lines[i][k + 1][1]};
      if (b < a) std::swap(a, b);
      result.push_back({a[0], a[1], b[0], b[1]});
    }
  std::sort(result.begin(), result.end());
  return result;
}

/// `count` lines between random points of a lattice of `side` points a side, so that many ends meet.
inline Polylines lattice_lines(std::mt19937_64& random, std::size_t count, unsigned side) {
  Polylines lines;
  const auto number = [&] { return static_cast<double>(random() % side); };
  while (lines.size() < count) {
    const Eigen::Vector2d a(number(), number()), b(number(), number());
    if (a != b) lines.add(a, b);
  }
  return lines;
}

/// `count` short lines anywhere on a page of 200 mm.
inline Polylines scattered_lines(std::mt19937_64& random, std::size_t count) {
  Polylines lines;
  std::uniform_real_distribution<double> place(0, 200), step(-3, 3);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d a(place(random), place(random));
    lines.add(a, a + Eigen::Vector2d(step(random), step(random)));
  }
  return lines;
}

inline Picture page_of(Polylines lines, std::vector<double> dashes = {}) {
  Picture picture{200, 200, {}, {}};
  picture.layers.push_back({"visible", {.dashes_mm = std::move(dashes)}, std::move(lines)});
  return picture;
}

}  // namespace blackleaf::test
