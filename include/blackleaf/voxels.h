// Building octrees from voxel volumes by one walk along the Millar curve (MHF92).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// A dense volume in memory, x fastest, without gaps: value (x,y,z) is data[x + size[0] * (y + size[1] * z)].
template <class T>
struct VolumeView {
  const T* data = nullptr;
  std::array<std::int64_t, 3> size{};  // voxels along x, y, z
};

/// Where a volume lies in the universe.
struct VolumePlacement {
  int depth = 0;                         // 0: the smallest that holds the volume
  std::array<std::int32_t, 3> corner{};  // universe coordinates of the volume's voxel (0,0,0)
};

/// The smallest depth in 1..20 whose universe holds a volume of this size. Throws Error(bad_input) if none does.
int depth_for(const std::array<std::int64_t, 3>& size);

/// The closed range of values that count as inside; NaN is never inside.
template <class T>
struct ValueRange {
  T low, high;
  bool operator()(T value) const { return low <= value && value <= high; }
};

/// The octree of the voxels whose value satisfies is_inside; voxels outside the volume are white. Every value is read
/// once; blocks of one colour are never built. The frame is that of the universe. T: (u)int8, (u)int16, (u)int32,
/// float, double. is_inside is called from many threads. Throws Error(bad_input) for a volume without voxels or one
/// that does not fit the universe, Error(bad_argument) for a depth outside 0..20. O(voxels).
template <class T>
Octree octree_from_voxels(const VolumeView<T>& volume, ValueRange<T> inside, VolumePlacement placement = {},
                          Frame frame = {}, const Work& work = {});
template <class T>
Octree octree_from_voxels(const VolumeView<T>& volume, const std::function<bool(T)>& inside,
                          VolumePlacement placement = {}, Frame frame = {}, const Work& work = {});

}  // namespace blackleaf
