// Comparing drawings whose strokes may come in another order.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "blackleaf/drawing.h"

namespace blackleaf::reference {

/// Empty if the two lists hold the same strokes, whatever their order and sense, ends within `tolerance`; else what
/// differs first.
inline std::string difference(std::vector<Stroke> a, std::vector<Stroke> b, double tolerance) {
  const auto show = [](const Stroke& s) {
    return "(" + std::to_string(s.from[0]) + ", " + std::to_string(s.from[1]) + ")-(" + std::to_string(s.to[0]) + ", " +
           std::to_string(s.to[1]) + ")";
  };
  const auto prepare = [&](std::vector<Stroke>& strokes) {
    for (Stroke& s : strokes) {
      const Eigen::Vector2d along = s.to - s.from;
      if (std::abs(along[0]) > tolerance ? along[0] < 0 : along[1] < 0) std::swap(s.from, s.to);
    }
    std::sort(strokes.begin(), strokes.end(), [](const Stroke& s, const Stroke& t) { return s.from[0] < t.from[0]; });
  };
  prepare(a);
  prepare(b);
  std::vector<bool> used(b.size(), false);
  std::size_t start = 0;
  for (const Stroke& s : a) {
    while (start < b.size() && b[start].from[0] < s.from[0] - tolerance) ++start;
    bool found = false;
    for (std::size_t i = start; i < b.size() && b[i].from[0] <= s.from[0] + tolerance && !found; ++i)
      if (!used[i] && (b[i].from - s.from).norm() <= tolerance && (b[i].to - s.to).norm() <= tolerance)
        used[i] = found = true;
    if (!found)
      return "only in the first of " + std::to_string(a.size()) + "/" + std::to_string(b.size()) + ": " + show(s);
  }
  for (std::size_t i = 0; i < b.size(); ++i)
    if (!used[i])
      return "only in the second of " + std::to_string(a.size()) + "/" + std::to_string(b.size()) + ": " + show(b[i]);
  return "";
}

}  // namespace blackleaf::reference
