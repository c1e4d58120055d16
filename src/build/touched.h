// The conservative rule: voxels whose closed cube meets the closed solid.
#pragma once

#include "blackleaf/octree.h"
#include "blackleaf/work.h"
#include "grid_mesh.h"

namespace blackleaf::detail {

/// `inside` and the voxels whose closed cube meets a triangle of the mesh. A voxel that meets no triangle lies wholly
/// inside or wholly outside, where its centre says which: so this is the rule MeshRule::touched if `inside` is the
/// octree by MeshRule::centre. O(pairs of a triangle and a node that meet).
Octree with_touched(const Octree& inside, const GridMesh& mesh, const Work& work);

}  // namespace blackleaf::detail
