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

struct Caps {
  std::vector<Triangle> triangles;
  std::size_t loops = 0;
};

/// Triangles whose boundary is the given one reversed: the boundary is taken apart into loops without a repeated
/// vertex, each closed by the fan about the mean of its vertices, which is added to `vertices`; a loop of three by
/// itself. O(edges log(edges)).
Caps caps_of(std::vector<DirectedEdge> boundary, std::vector<GridPoint>& vertices);

}  // namespace blackleaf::detail
