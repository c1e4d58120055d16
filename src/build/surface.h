// Triangle surfaces as graphs: welding vertices, counting how often edges are passed.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "blackleaf/mesh.h"

namespace blackleaf::detail {

using Triangle = std::array<std::uint32_t, 3>;

/// Throws Error(bad_input) unless the mesh has triangles, every corner refers to a vertex, and every vertex that a
/// triangle uses is finite.
void require_sound(const TriangleMesh& mesh);

/// For every key the index of the first equal one. O(keys) expected.
std::vector<std::uint32_t> first_equal(const std::vector<std::array<std::uint64_t, 3>>& keys);

/// How the edges of a welded surface are used; see MeshReport.
struct EdgeCounts {
  std::uint64_t open = 0, non_manifold = 0, misoriented = 0;
};

/// Triangles with two equal corners must have been left out; `vertices` is one more than the largest index used.
EdgeCounts count_edges(const std::vector<Triangle>& triangles, std::size_t vertices);

inline bool collapsed(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

}  // namespace blackleaf::detail
