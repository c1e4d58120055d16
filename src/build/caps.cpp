#include "caps.h"

#include <algorithm>
#include <limits>

namespace blackleaf::detail {
namespace {

// Closes the loop that goes along rim[first..last] and back by the chord.
void close(const std::vector<std::uint32_t>& rim, std::size_t first, std::size_t last,
           std::vector<Triangle>& triangles) {
  if (last - first < 2) return;
  const std::size_t middle = first + (last - first) / 2;
  triangles.push_back({rim[last], rim[middle], rim[first]});
  close(rim, first, middle, triangles);
  close(rim, middle, last, triangles);
}

}  // namespace

std::vector<std::vector<DirectedEdge>> boundaries(const std::vector<Triangle>& triangles, std::size_t vertices,
                                                  const std::vector<std::uint32_t>& part_of, std::size_t parts) {
  std::vector<std::vector<DirectedEdge>> result(parts);
  std::vector<std::pair<std::uint32_t, std::int32_t>> shares;  // the parts at an edge
  for_each_edge(triangles, vertices, [&](std::uint32_t low, std::span<const EdgeUse> uses) {
    shares.clear();
    for (const EdgeUse& use : uses) shares.emplace_back(part_of[use.triangle], use.direction);
    std::sort(shares.begin(), shares.end());
    for (std::size_t i = 0; i < shares.size();) {
      const std::uint32_t part = shares[i].first;
      std::int64_t balance = 0;
      for (; i < shares.size() && shares[i].first == part; ++i) balance += shares[i].second;
      const std::uint32_t high = uses.front().other;
      const DirectedEdge edge = balance > 0 ? DirectedEdge{low, high} : DirectedEdge{high, low};
      result[part].insert(result[part].end(), static_cast<std::size_t>(std::abs(balance)), edge);
    }
  });
  return result;
}

Caps caps_of(std::vector<DirectedEdge> boundary) {
  Caps caps;
  std::sort(boundary.begin(), boundary.end());
  // The vertices of the boundary by their place in it: the edges that leave one stand together.
  std::vector<std::uint32_t> names;
  std::vector<std::size_t> first;  // by vertex: the first edge that leaves it
  for (std::size_t i = 0; i < boundary.size(); ++i)
    if (i == 0 || boundary[i][0] != boundary[i - 1][0]) {
      names.push_back(boundary[i][0]);
      first.push_back(i);
    }
  std::vector<std::size_t> next = first;  // by vertex: the first of those that have not been walked
  first.push_back(boundary.size());
  const auto place = [&](std::uint32_t name) {
    return static_cast<std::size_t>(std::lower_bound(names.begin(), names.end(), name) - names.begin());
  };
  constexpr std::size_t kOff = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> on_path(names.size(), kOff);  // where on the path, or off it
  std::vector<std::size_t> path;
  const auto take_off = [&](std::size_t from) {
    const std::size_t begin = caps.rims.size();
    for (std::size_t i = from; i < path.size(); ++i) {
      caps.rims.push_back(names[path[i]]);
      on_path[path[i]] = kOff;
    }
    path.resize(from);
    caps.ends.push_back(caps.rims.size());
    close(caps.rims, begin, caps.rims.size() - 1, caps.triangles);
  };
  // As many edges enter a vertex as leave it, so a walk along unused edges only ever stops where it began; whenever it
  // comes back to a vertex of its path, what lies between is a loop.
  for (std::size_t start = 0; start < names.size(); ++start) {
    while (next[start] < first[start + 1]) {
      std::size_t at = start;
      do {
        on_path[at] = path.size();
        path.push_back(at);
        at = place(boundary[next[at]++][1]);
        if (on_path[at] != kOff) take_off(on_path[at]);
      } while (!path.empty());
    }
  }
  return caps;
}

}  // namespace blackleaf::detail
