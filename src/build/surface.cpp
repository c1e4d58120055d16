#include "surface.h"

#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "blackleaf/error.h"

namespace blackleaf::detail {

void require_sound(const TriangleMesh& mesh) {
  if (mesh.triangles.empty())
    throw Error(ErrorCode::bad_input, "the mesh has no triangles", "give a closed surface of triangles");
  if (mesh.vertices.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::bad_input, "the mesh has more than 2^32 - 1 vertices", "split it");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t corner : mesh.triangles[i]) {
      if (corner >= mesh.vertices.size())
        throw Error(ErrorCode::bad_input,
                    "triangle " + std::to_string(i) + " refers to vertex " + std::to_string(corner) +
                        ", but the mesh has " + std::to_string(mesh.vertices.size()) + " vertices",
                    "mend the triangle's indices (they count from 0)");
      if (!mesh.vertices[corner].allFinite())
        throw Error(ErrorCode::bad_input, "vertex " + std::to_string(corner) + " is not finite",
                    "mend its coordinates or remove its triangles");
    }
}

std::vector<std::uint32_t> first_equal(const std::vector<std::array<std::uint64_t, 3>>& keys) {
  constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();
  const std::size_t slots = std::bit_ceil(2 * keys.size() + 1);
  std::vector<std::uint32_t> table(slots, kFree);
  std::vector<std::uint32_t> first(keys.size());
  for (std::uint32_t i = 0; i < keys.size(); ++i) {
    std::uint64_t hash = 0;
    for (const std::uint64_t part : keys[i]) {
      hash = (hash ^ part) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 29;
    }
    std::size_t slot = (hash * 0xD1B54A32D192ED03u >> 20) & (slots - 1);
    while (table[slot] != kFree && keys[table[slot]] != keys[i]) slot = (slot + 1) & (slots - 1);
    if (table[slot] == kFree) table[slot] = i;
    first[i] = table[slot];
  }
  return first;
}

EdgeCounts count_edges(const std::vector<Triangle>& triangles, std::size_t vertices) {
  // Buckets by the smaller end (counting sort), then each bucket, a handful of edges, by the larger.
  struct Use {
    std::uint32_t other;
    std::int32_t direction;  // +1: passed from the smaller end to the larger
  };
  std::vector<std::uint64_t> end(vertices + 1, 0);
  for (const Triangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) ++end[std::min(t[i], t[(i + 1) % 3]) + std::size_t{1}];
  for (std::size_t v = 0; v < vertices; ++v) end[v + 1] += end[v];
  std::vector<Use> uses(end[vertices]);
  for (const Triangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = t[i], to = t[(i + 1) % 3];
      uses[end[std::min(from, to)]++] = {std::max(from, to), from < to ? 1 : -1};
    }
  EdgeCounts counts;
  std::uint64_t begin = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto first = uses.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = uses.begin() + static_cast<std::ptrdiff_t>(end[v]);
    std::sort(first, last, [](const Use& a, const Use& b) { return a.other < b.other; });
    for (auto use = first; use != last;) {
      std::int64_t passes = 0, balance = 0;
      const std::uint32_t other = use->other;
      for (; use != last && use->other == other; ++use) {
        ++passes;
        balance += use->direction;
      }
      counts.open += passes % 2 != 0;
      counts.non_manifold += passes > 2;
      counts.misoriented += balance != 0;
    }
    begin = end[v];
  }
  return counts;
}

}  // namespace blackleaf::detail
