// The input that every benchmark shares: the Stanford bunny, its longest side 0.6 of the universe, centred.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "blackleaf/mesh.h"
#include "blackleaf/motion.h"
#include "blackleaf/octree.h"
#include "blackleaf/voxels.h"

namespace blackleaf::bench {

inline constexpr double kFraction = 0.6;

/// "512", the side of a universe of depth 9, as keys have it.
std::string side_name(int depth);

const TriangleMesh& bunny_mesh();
MeshPlacement bunny_placement(int depth);
/// The vertices of bunny_mesh() in voxel units of the universe.
std::vector<Eigen::Vector3d> bunny_points(int depth);
/// Made once in a process.
const Octree& bunny(int depth);
/// The whole universe as bytes 0 and 1, x fastest; made once in a process.
const std::vector<std::uint8_t>& bunny_volume(int depth);
VolumeView<std::uint8_t> view(const std::vector<std::uint8_t>& volume, int depth);

/// 30 degrees about (1,1,1) through the universe's centre, then a translation of (5.3, -7.1, 2.9) voxels.
Motion bunny_motion(int depth);

}  // namespace blackleaf::bench
