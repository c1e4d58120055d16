// Caps: surfaces that close the holes of a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "grid_mesh.h"

namespace blackleaf::detail {

using DirectedEdge = std::array<std::uint32_t, 2>;

/// The boundary of each part of a surface: the edges that its triangles pass more often in one direction, in that
/// direction, as often as it is more. As many of them end at a vertex as begin there. `part_of` names the part of each
/// triangle. O(vertices + triangles log(triangles of a vertex)).
std::vector<std::vector<DirectedEdge>> boundaries(const std::vector<Triangle>& triangles, std::size_t vertices,
                                                  const std::vector<std::uint32_t>& part_of, std::size_t parts);

/// Triangles that close holes. The holes' rims are loops, which the boundary passes from vertex to vertex and from the
/// last to the first.
struct Caps {
  std::vector<Triangle> triangles;  // loop by loop, two fewer than its vertices
  std::vector<std::uint32_t> rims;  // the vertices of the loops, one loop after the other
  std::vector<std::size_t> ends;    // by loop: where its vertices end in `rims`

  std::size_t loops() const { return ends.size(); }
};

/// Triangles whose boundary is the given one reversed: the boundary is taken apart into loops without a repeated
/// vertex. Each is halved by a chord, the halves by chords again, so that most triangles are as small as the rim's
/// edges and only a few large ones span the hole. O(edges log(edges)).
Caps caps_of(std::vector<DirectedEdge> boundary);

}  // namespace blackleaf::detail
