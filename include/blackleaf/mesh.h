// Triangle meshes: checking them and building octrees from them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;  // world units
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::string unit = "unit";

  /// The box of the vertices that triangles use; empty without triangles. Requires: every corner refers to a vertex.
  Eigen::AlignedBox3d bounding_box() const;
};

/// A universe for a mesh: its depth and frame (voxels are cubes along the world's axes).
struct MeshPlacement {
  int depth = 8;
  Frame frame;
};
/// The mesh centred in a universe of the given depth, its longest side `fraction` of the universe's side.
/// Throws Error(bad_argument) unless 0 < fraction <= 1 and 1 <= depth <= 20, Error(bad_input) for a mesh without
/// extent or with vertices that are not finite.
MeshPlacement place_by_fraction(const TriangleMesh& mesh, int depth, double fraction);
/// The mesh centred in a universe whose voxels have the given side in the mesh's units; depth 0 takes the smallest
/// universe that holds it. Throws as above, and Error(out_of_universe) when the mesh is larger than the universe.
MeshPlacement place_by_voxel_size(const TriangleMesh& mesh, double voxel_size, int depth = 0);

/// What is wrong with a mesh as the boundary of a solid. Vertices at equal positions count as one.
struct MeshReport {
  std::uint64_t triangles = 0;
  std::uint64_t degenerate_triangles = 0;  // without area, exactly; they bound nothing
  std::uint64_t open_edges = 0;            // edges of an odd number of triangles
  std::uint64_t non_manifold_edges = 0;    // edges of more than two triangles
  std::uint64_t misoriented_edges = 0;     // edges passed unequally often in the two directions
  std::uint64_t components = 0;            // connected through shared vertices
  std::uint64_t doubled_triangles = 0;     // with the corners of an earlier one, turned or not
  std::uint64_t doubled_edges = 0;         // open edges that would not be open without the doubled triangles
  bool closed() const { return open_edges == 0; }
};
/// A triangle with two equal corners has no edges here; one whose three corners lie on a line has its three. Throws
/// Error(bad_input) for a mesh without triangles, corners that refer to no vertex, or vertices that are not finite.
/// O(triangles) expected.
MeshReport check(const TriangleMesh& mesh);

enum class MeshRule {
  centre,   // a voxel is black iff its centre is inside
  touched,  // a voxel is black iff its closed cube meets the closed solid (AN84's conservative rule); the solid is the
            // inside with its surface, and touching from outside, if only at a corner, counts
};

/// The octree of a closed mesh. Vertices are rounded once to a grid of 2^(depth-40) voxels, those outside the universe
/// by at most 2^-16 voxels to its wall; vertices that become equal are one; from there on every decision is integer
/// arithmetic. A centre that lies exactly on the surface counts as if it were moved by an infinitesimal (e, e^2, e^3)
/// in universe coordinates, so solids that share a face share no voxel and axis-aligned boxes come out exact. The frame
/// may be oblique and left-handed; either orientation of the whole surface is accepted. Throws Error(bad_input) for a
/// mesh whose triangles all have no area on that grid, for one that is not closed (with the number of open edges), is
/// oriented inconsistently, or passes through itself where a voxel centre shows it (winding numbers other than 0 and
/// 1), Error(out_of_universe) when it does not fit the universe, Error(bad_argument) for a depth outside 1..20 or axes
/// that do not span space. O(surface voxels log(surface voxels) + triangles) time, O(surface voxels + triangles)
/// memory.
Octree octree_from_mesh(const TriangleMesh& mesh, const MeshPlacement& placement, MeshRule rule = MeshRule::centre,
                        const Work& work = {});

/// How the inside of a mesh is told from its outside.
enum class Inside {
  automatic,  // parity where the mesh is closed, its triangles agree and it does not pass through itself; else winding
  parity,     // a point is inside iff a ray from it crosses the surface an odd number of times; closed meshes only
  winding,    // a point is inside iff its generalised winding number is greater than 1/2
};

struct MeshOptions {
  MeshRule rule = MeshRule::centre;
  Inside inside = Inside::automatic;
};

/// The solid of a mesh and what was made of the mesh's faults.
struct MeshSolid {
  Octree octree;
  Inside inside = Inside::parity;      // how it was decided: parity or winding
  MeshReport found;                    // of the mesh rounded to the universe's grid
  std::uint64_t holes = 0;             // loops of edges that are not passed equally often both ways, after turning
  std::uint64_t turned_triangles = 0;  // to agree with their neighbours, or with their part to face outward
  std::uint64_t one_sided_parts = 0;   // cannot be oriented, like a Moebius strip; left as they were
  bool overlaps = false;               // winding numbers other than 0 and 1 were met at voxel centres
};

/// The octree of any mesh, open, inconsistently oriented or passing through itself. Where the mesh is closed and sound
/// it equals octree_from_mesh(). Otherwise:
///
/// `parity` takes a closed mesh of any orientation, in integers; nested parts alternate between solid and cavity.
/// Throws Error(bad_input) for an open one.
///
/// `winding` first orients the surface: triangles joined by edges of two triangles are turned to agree (the fewer
/// turn); a surface that is inside out as a whole is turned over; a part that still faces inward, or of which triangles
/// had to be turned, becomes a cavity if it lies within the larger parts (the centroids of all its triangles have a
/// winding number of 1 or more about them), else a solid. Then a voxel is black iff w > 1/2, where w is the sum of the
/// solid angles of the triangles seen from its centre, over 4 pi (Jacobson et al. 2013). A centre on the surface counts
/// as moved by an infinitesimal (e, e^2, e^3); w = 1/2 is white. For closed meshes w is an integer and found exactly.
/// For open ones the holes are closed by caps: w is the exact winding number of the closed surface less that of the
/// caps, which is bounded over whole nodes by the lengths and distances of the rims, summed by a hierarchy of dipoles
/// (Barill et al. 2018) with an error bound nearer to 1/2, and in double-double arithmetic where that is not enough;
/// what that cannot tell from 1/2 (about 2^-90 times the number of cap triangles) counts as 1/2. So the answer depends
/// on neither compiler nor threads, nor on the choice of caps.
///
/// MeshRule::touched adds every voxel whose closed cube meets a triangle. Throws as octree_from_mesh() does for meshes
/// without triangles or area, with vertices that are not finite, or outside the universe. O(surface voxels log(surface
/// voxels) + triangles) time and O(surface voxels + triangles) memory; with holes, times O(log(cap triangles)) near the
/// caps.
MeshSolid solid_from_mesh(const TriangleMesh& mesh, const MeshPlacement& placement, const MeshOptions& options = {},
                          const Work& work = {});

/// The boundary of a solid as a watertight mesh of unit squares, two triangles each, outward orientation, in world
/// coordinates (outward in the world also through a left-handed frame); every edge belongs to an even number of
/// triangles, passed equally often in both directions. Throws Error(bad_input) beyond 2^32 - 1 corners. O(surface
/// area).
TriangleMesh boundary_mesh(const Octree& octree);

}  // namespace blackleaf
