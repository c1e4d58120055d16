// Solids as OctoMap's trees.
#pragma once

#include <octomap/OcTree.h>

#include <memory>

namespace blackleaf::bench {

/// The bunny as occupied cells of side 1, voxel (x,y,z) being [x,x+1] and so on; made once in a process.
std::shared_ptr<octomap::OcTree> bunny_octomap(int depth);

}  // namespace blackleaf::bench
