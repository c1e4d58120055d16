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

void* allocate_large_pages(std::size_t bytes);
void free_large_pages(void* memory);

/// Memory for large arrays in pages of 2 MiB where the system has them, so that what is timed is memory and not the
/// look-up of its pages.
template <class T>
struct LargePages {
  using value_type = T;
  LargePages() = default;
  template <class U>
  explicit LargePages(const LargePages<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(allocate_large_pages(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t) { free_large_pages(memory); }
  bool operator==(const LargePages&) const = default;
};

/// Voxels, x fastest.
using Volume = std::vector<std::uint8_t, LargePages<std::uint8_t>>;

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
const Volume& bunny_volume(int depth);
VolumeView<std::uint8_t> view(const Volume& volume, int depth);

/// 30 degrees about (1,1,1) through the universe's centre, then a translation of (5.3, -7.1, 2.9) voxels.
Motion bunny_motion(int depth);
/// The bunny moved by it; made once in a process.
const Octree& moved_bunny(int depth);

}  // namespace blackleaf::bench
