// GridMesh: a triangle mesh rounded to integers, the form in which every decision about it is exact.
//
// Unit: 2^(depth-40) voxels. A universe of depth n has sides of 2^40 units and voxels of 2^F units, F = 40 - n >= 20;
// the centre of voxel i lies at (2 i + 1) 2^(F-1), an integer. Vertices lie in [0, 2^40].
//
// Bounds, used throughout: differences of coordinates are below 2^40 + 1 in size, components of a normal (two products)
// below 2^81 + 2^42, a normal times a difference of points (three products) below 2^123: all fit 128 bits.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blackleaf/mesh.h"
#include "surface.h"

namespace blackleaf::detail {

__extension__ using Wide = __int128;

constexpr int kGridBits = 40;
using GridPoint = std::array<std::int64_t, 3>;

struct GridMesh {
  int depth = 1;
  std::vector<GridPoint> vertices;
  std::vector<Triangle> triangles;           // of welded vertices; none with two equal corners
  MeshReport report(bool components) const;  // of the rounded mesh, but for its degenerate triangles

  int fraction_bits() const { return kGridBits - depth; }
  std::int64_t centre(std::int64_t index) const { return (2 * index + 1) << (fraction_bits() - 1); }
  /// How many voxel centres of an axis lie strictly before a coordinate in [0, 2^40].
  std::int64_t centres_before(std::int64_t coordinate) const {
    const std::int64_t half = std::int64_t{1} << (fraction_bits() - 1);
    return (coordinate + half - 1) >> fraction_bits();
  }
};

/// Component i of the triangle's normal (b - a) x (c - a).
inline Wide normal(const GridPoint& a, const GridPoint& b, const GridPoint& c, std::size_t i) {
  const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
  return Wide{b[j] - a[j]} * (c[k] - a[k]) - Wide{b[k] - a[k]} * (c[j] - a[j]);
}

/// Rounds the mesh to the universe's grid. Throws as octree_from_mesh does, but for what says that it does not bound a
/// solid.
GridMesh grid_mesh(const TriangleMesh& mesh, const MeshPlacement& placement);

/// Throws Error(bad_input) unless every edge of the rounded mesh, of which `report` tells, belongs to an even number of
/// triangles and, if `oriented`, is passed equally often in both directions.
void require_closed(const MeshReport& report, bool oriented);

}  // namespace blackleaf::detail
