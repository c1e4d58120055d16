// Octrees of meshes: which way of telling inside from outside is taken.
#include "blackleaf/mesh.h"

#include "blackleaf/error.h"
#include "column_octree.h"
#include "octree/parallel.h"
#include "orient.h"
#include "touched.h"
#include "winding.h"

namespace blackleaf {
namespace {

// The part of the work before the surface's own voxels are added.
Work inside_part(const Work& work, MeshRule rule) {
  return rule == MeshRule::touched ? detail::part_of(work, 0, 0.5) : work;
}

Octree with_surface(const Octree& inside, const detail::GridMesh& grid, MeshRule rule, const Work& work) {
  if (rule == MeshRule::centre) return inside;
  return detail::with_touched(inside, grid, detail::part_of(work, 0.5, 1));
}

// How many of the triangles have no area on the grid. A mesh of these alone is an error.
std::uint64_t without_area(const TriangleMesh& mesh, const detail::GridMesh& grid) {
  std::uint64_t count = mesh.triangles.size() - grid.triangles.size();
  for (const detail::Triangle& t : grid.triangles) {
    bool flat = true;
    for (std::size_t i = 0; i < 3; ++i)
      flat = flat && detail::normal(grid.vertices[t[0]], grid.vertices[t[1]], grid.vertices[t[2]], i) == 0;
    count += flat;
  }
  if (count == mesh.triangles.size())
    throw Error(
        ErrorCode::bad_input,
        count == 1 ? "its one triangle has no area" : "none of its " + std::to_string(count) + " triangles has an area",
        "give a surface that bounds a solid");
  return count;
}

}  // namespace

Octree octree_from_mesh(const TriangleMesh& mesh, const MeshPlacement& placement, MeshRule rule, const Work& work) {
  const detail::GridMesh grid = detail::grid_mesh(mesh, placement);
  without_area(mesh, grid);
  detail::require_closed(grid.report(false), true);
  const Work part = inside_part(work, rule);
  const detail::Slabs slabs = detail::slabs_of(grid, {}, detail::part_of(part, 0, 0.6));
  detail::require_simple(slabs.windings, grid.depth, placement.frame);
  const Octree inside =
      detail::octree_of_columns(slabs, grid.depth, placement.frame, false, detail::part_of(part, 0.6, 1));
  return with_surface(inside, grid, rule, work);
}

MeshSolid solid_from_mesh(const TriangleMesh& mesh, const MeshPlacement& placement, const MeshOptions& options,
                          const Work& work) {
  detail::GridMesh grid = detail::grid_mesh(mesh, placement);
  MeshSolid solid;
  solid.found = grid.report(true);
  solid.found.triangles = mesh.triangles.size();
  solid.found.degenerate_triangles = without_area(mesh, grid);
  const Work part = inside_part(work, options.rule);
  const bool parity = options.inside == Inside::parity;
  if (parity) detail::require_closed(solid.found, false);

  // What bounds a solid as it is needs no more than its columns.
  if (parity || (solid.found.closed() && solid.found.misoriented_edges == 0)) {
    const detail::InsideRule rule{parity ? detail::InsideRule::Kind::odd : detail::InsideRule::Kind::not_zero, 0};
    const detail::Slabs slabs = detail::slabs_of(grid, rule, detail::part_of(part, 0, 0.5));
    solid.overlaps = slabs.windings.flaw().columns > 0;
    if (parity || !solid.overlaps) {
      const Octree inside =
          detail::octree_of_columns(slabs, grid.depth, placement.frame, false, detail::part_of(part, 0.5, 1));
      solid.inside = options.inside == Inside::winding ? Inside::winding : Inside::parity;
      solid.octree = with_surface(inside, grid, options.rule, work);
      return solid;
    }
  }
  const detail::Orientation orientation = detail::orient(grid);
  solid.inside = Inside::winding;
  solid.turned_triangles = orientation.turned;
  solid.one_sided_parts = orientation.one_sided;
  const detail::WindingSolid inside = detail::winding_solid(grid, placement.frame, part);
  solid.holes = inside.holes;
  solid.overlaps = inside.overlaps;
  solid.octree = with_surface(inside.octree, grid, options.rule, work);
  return solid;
}

}  // namespace blackleaf
