#include "caps.h"

#include <algorithm>
#include <limits>

#include "blackleaf/error.h"

namespace blackleaf::detail {
namespace {

std::uint32_t mean_of(const std::vector<std::uint32_t>& loop, std::vector<GridPoint>& vertices) {
  std::array<Wide, 3> sum{};
  for (const std::uint32_t v : loop)
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += vertices[v][axis];
  if (vertices.size() >= std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::bad_input, "the mesh has too many vertices and holes", "split it");
  GridPoint mean{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    mean[axis] = static_cast<std::int64_t>(sum[axis] / static_cast<std::int64_t>(loop.size()));
  vertices.push_back(mean);
  return static_cast<std::uint32_t>(vertices.size() - 1);
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

Caps caps_of(std::vector<DirectedEdge> boundary, std::vector<GridPoint>& vertices) {
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
  std::vector<std::uint32_t> loop;
  const auto close = [&](std::size_t from) {
    loop.clear();
    for (std::size_t i = from; i < path.size(); ++i) {
      loop.push_back(names[path[i]]);
      on_path[path[i]] = kOff;
    }
    path.resize(from);
    ++caps.loops;
    if (loop.size() == 3) {
      caps.triangles.push_back({loop[2], loop[1], loop[0]});
      return;
    }
    const std::uint32_t apex = mean_of(loop, vertices);
    for (std::size_t i = 0; i < loop.size(); ++i)
      caps.triangles.push_back({loop[(i + 1) % loop.size()], loop[i], apex});
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
        if (on_path[at] != kOff) close(on_path[at]);
      } while (!path.empty());
    }
  }
  return caps;
}

}  // namespace blackleaf::detail
