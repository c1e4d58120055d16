#include "surface.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "blackleaf/error.h"

namespace blackleaf::detail {
namespace {

// Sets that are united, named by one of their members.
class Partition {
 public:
  explicit Partition(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) { parent_[root(b)] = root(a); }

 private:
  std::vector<std::uint32_t> parent_;
};

void count_doubles(const std::vector<Triangle>& triangles, std::size_t vertices, MeshReport& report) {
  std::vector<std::array<std::uint64_t, 3>> corners(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    std::copy(triangles[i].begin(), triangles[i].end(), corners[i].begin());
    std::sort(corners[i].begin(), corners[i].end());
  }
  const std::vector<std::uint32_t> first = first_equal(corners);
  std::vector<Triangle> once;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (first[i] == i) once.push_back(triangles[i]);
  report.doubled_triangles = triangles.size() - once.size();
  if (report.doubled_triangles == 0) return;
  std::uint64_t open = 0;
  for_each_edge(once, vertices, [&](std::uint32_t, std::span<const EdgeUse> uses) { open += uses.size() % 2 != 0; });
  report.doubled_edges = report.open_edges - std::min(open, report.open_edges);
}

}  // namespace

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

MeshReport report_of(const std::vector<Triangle>& triangles, std::size_t vertices, bool components) {
  MeshReport report;
  for_each_edge(triangles, vertices, [&](std::uint32_t, std::span<const EdgeUse> uses) {
    std::int64_t balance = 0;
    for (const EdgeUse& use : uses) balance += use.direction;
    report.open_edges += uses.size() % 2 != 0;
    report.non_manifold_edges += uses.size() > 2;
    report.misoriented_edges += balance != 0;
  });
  if (report.misoriented_edges > 0 || report.non_manifold_edges > 0)  // open ones are misoriented
    count_doubles(triangles, vertices, report);
  if (!components) return report;
  Partition parts(vertices);
  for (const Triangle& t : triangles) {
    parts.unite(t[0], t[1]);
    parts.unite(t[0], t[2]);
  }
  std::vector<std::uint8_t> seen(vertices, 0);
  for (const Triangle& t : triangles) {
    const std::uint32_t root = parts.root(t[0]);
    report.components += !seen[root];
    seen[root] = 1;
  }
  return report;
}

}  // namespace blackleaf::detail
