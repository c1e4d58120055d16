// Solids as OpenVDB's grids.
#pragma once

#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include "blackleaf/octree.h"

namespace blackleaf::bench {

/// OpenVDB takes as many threads as TBB gives: at most so many while the result lives.
inline tbb::global_control at_most(int threads) {
  return {tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)};
}

/// The solid as active voxels and tiles, pruned.
openvdb::MaskGrid::Ptr mask_grid(const Octree& octree);

}  // namespace blackleaf::bench
