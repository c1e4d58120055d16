// Triangle surfaces as graphs: welding vertices, counting how often edges are passed.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blackleaf/mesh.h"

namespace blackleaf::detail {

using Triangle = std::array<std::uint32_t, 3>;

/// Throws Error(bad_input) unless the mesh has triangles, every corner refers to a vertex, and every vertex that a
/// triangle uses is finite.
void require_sound(const TriangleMesh& mesh);

/// For every key the index of the first equal one. O(keys) expected.
std::vector<std::uint32_t> first_equal(const std::vector<std::array<std::uint64_t, 3>>& keys);

inline bool collapsed(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// One triangle's passage along an edge.
struct EdgeUse {
  std::uint32_t other;     // the edge's larger end
  std::uint32_t triangle;  // its index
  std::int32_t direction;  // +1: passed from the smaller end to the larger
};

/// Calls visit(smaller end, uses) for every edge of a welded surface: a span of its EdgeUses, by increasing triangle,
/// edges by increasing ends. Triangles with two equal corners must have been left out; `vertices` is at least one more
/// than the largest index used. O(vertices + triangles log(triangles of a vertex)).
template <class Visit>
void for_each_edge(const std::vector<Triangle>& triangles, std::size_t vertices, const Visit& visit) {
  // Buckets by the smaller end (counting sort), then each bucket, a handful of edges, by the larger.
  std::vector<std::uint64_t> end(vertices + 1, 0);
  for (const Triangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) ++end[std::min(t[i], t[(i + 1) % 3]) + std::size_t{1}];
  for (std::size_t v = 0; v < vertices; ++v) end[v + 1] += end[v];
  std::vector<EdgeUse> uses(end[vertices]);
  for (std::uint32_t index = 0; index < triangles.size(); ++index)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = triangles[index][i], to = triangles[index][(i + 1) % 3];
      uses[end[std::min(from, to)]++] = {std::max(from, to), index, from < to ? 1 : -1};
    }
  std::uint64_t begin = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto first = uses.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = uses.begin() + static_cast<std::ptrdiff_t>(end[v]);
    std::sort(first, last, [](const EdgeUse& a, const EdgeUse& b) {
      return a.other != b.other ? a.other < b.other : a.triangle < b.triangle;
    });
    for (auto use = first; use != last;) {
      auto stop = use;
      while (stop != last && stop->other == use->other) ++stop;
      visit(static_cast<std::uint32_t>(v), std::span<const EdgeUse>(use, stop));
      use = stop;
    }
    begin = end[v];
  }
}

/// What check() says of a welded surface: all but its number of triangles and of degenerate ones. `components` is left
/// at 0 unless asked for.
MeshReport report_of(const std::vector<Triangle>& triangles, std::size_t vertices, bool components);

}  // namespace blackleaf::detail
