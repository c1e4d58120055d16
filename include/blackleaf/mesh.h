// Triangle meshes: checking them and building octrees from closed ones.
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
/// mesh that is not closed (with the number of open edges), is oriented inconsistently, or passes through itself where
/// a voxel centre shows it (winding numbers other than 0 and 1), Error(out_of_universe) when it does not fit the
/// universe, Error(bad_argument) for a depth outside 1..20 or axes that do not span space. O(surface voxels log(surface
/// voxels) + triangles) time, O(surface voxels + triangles) memory.
Octree octree_from_mesh(const TriangleMesh& mesh, const MeshPlacement& placement, MeshRule rule = MeshRule::centre,
                        const Work& work = {});

/// The boundary of a solid as a watertight mesh of unit squares, two triangles each, outward orientation, in world
/// coordinates (outward in the world also through a left-handed frame); every edge belongs to an even number of
/// triangles, passed equally often in both directions. Throws Error(bad_input) beyond 2^32 - 1 corners. O(surface
/// area).
TriangleMesh boundary_mesh(const Octree& octree);

}  // namespace blackleaf
