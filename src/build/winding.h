// Octrees by generalised winding numbers.
#pragma once

#include "grid_mesh.h"
#include "octree/brick.h"

namespace blackleaf::detail {

struct WindingSolid {
  Octree octree;
  std::size_t holes = 0;
  bool overlaps = false;  // winding numbers of the closed surface other than 0 and 1 at voxel centres
};

/// The voxels with a generalised winding number above 1/2, as solid_from_mesh() says; the mesh is taken as it is
/// oriented.
WindingSolid winding_solid(const GridMesh& mesh, const Frame& frame, const Work& work);

}  // namespace blackleaf::detail
