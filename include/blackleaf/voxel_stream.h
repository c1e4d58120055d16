// Building octrees from volumes that do not fit memory: slices go in, front to back, and only the octree stays.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>

#include "blackleaf/octree.h"
#include "blackleaf/voxels.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// Takes a volume slice by slice (a slice is all values of one z, x fastest) and builds its octree on the way. The
/// octree is, bit for bit, that of octree_from_voxels, however many slices come at once.
///
///     VoxelStream<std::uint16_t> stream({2048, 2048, 5000}, ValueRange<std::uint16_t>{1200, 65535});
///     while (const std::int64_t slices = stream.wanted()) {
///       read_next(file, buffer, slices);
///       stream.add(buffer.data(), slices);
///     }
///     const Octree octree = stream.finish();
///
/// Memory: the octree, about as much again while its parts are joined, and for the at most 64 slices that are not yet
/// part of it one bit for every 16 voxels and the bits of the blocks of 4^3 that have both colours.
template <class T>
class VoxelStream {
 public:
  /// T, `inside`, `placement`, `frame`, `work` and errors as octree_from_voxels. Progress is the fraction of slices.
  VoxelStream(const std::array<std::int64_t, 3>& size, ValueRange<T> inside, VolumePlacement placement = {},
              Frame frame = {}, Work work = {});
  VoxelStream(const std::array<std::int64_t, 3>& size, std::function<bool(T)> inside, VolumePlacement placement = {},
              Frame frame = {}, Work work = {});
  ~VoxelStream();
  VoxelStream(VoxelStream&&) noexcept;
  VoxelStream& operator=(VoxelStream&&) noexcept;

  /// How many slices it would like next, once `ahead` more than now have been added: about 4 MiB of them, at least one;
  /// 0 when there are no more. Any other number of slices is as good but not as fast.
  std::int64_t wanted(std::int64_t ahead = 0) const;
  /// The next `count` slices; they are not kept. Throws Error(cancelled) when progress refuses: then the stream is of
  /// no more use. Requires: 0 <= count, that many slices are missing. O(voxels in them).
  void add(const T* slices, std::int64_t count);
  /// The octree. Requires: all slices have been added; called once. O(octree).
  Octree finish();

 private:
  class Builder;
  template <class Inside>
  class BuilderOf;
  std::unique_ptr<Builder> builder_;
};

}  // namespace blackleaf
