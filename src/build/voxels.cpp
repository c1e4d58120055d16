#include "blackleaf/voxels.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "block_tree.h"
#include "octree/parallel.h"
#include "octree/produce.h"
#include "volume_placement.h"
#include "volume_scan.h"

namespace blackleaf {
namespace {

using Point = std::array<std::int64_t, 3>;

// A volume is cut into beams of blocks along x, at most this long. What a beam leaves of itself, at most 64 KiB and its
// gray bricks, stays in a core's cache until its blocks are made.
constexpr std::int64_t kBeamBlocks = 32;

template <class T, class Inside>
class VolumeBuild {
 public:
  VolumeBuild(const VolumeView<T>& volume, const Inside& inside, const detail::PlacedBox& box)
      : volume_(volume), inside_(inside), box_(box), tree_(box.depth, box.low, box.high) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      first_[axis] = box.low[axis] / kBeam[axis];
      count_[axis] = (box.high[axis] - 1) / kBeam[axis] + 1 - first_[axis];
    }
  }

  Octree run(Frame frame, const Work& work) {
    const auto beams = static_cast<std::size_t>(count_[0] * count_[1] * count_[2]);
    detail::for_each_index(beams, work, [&](std::size_t i) { beam(static_cast<std::int64_t>(i)); });
    return tree_.finish(std::move(frame));
  }

 private:
  static constexpr std::int64_t kSide = detail::BlockTree::kSide;
  static constexpr Point kBeam = {kBeamBlocks * kSide, kSide, kSide};

  void beam(std::int64_t i) {
    const Point beam = {first_[0] + i % count_[0], first_[1] + i / count_[0] % count_[1],
                        first_[2] + i / count_[0] / count_[1]};
    Point low, high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::max(beam[axis] * kBeam[axis], box_.low[axis]);
      high[axis] = std::min((beam[axis] + 1) * kBeam[axis], box_.high[axis]);
    }
    detail::VolumeBricks bricks(low, high);
    std::vector<std::uint64_t> gray;
    detail::VolumeScan<T, Inside>(volume_, box_.low, inside_, bricks).strips(0, bricks.strips(), gray);
    const detail::BrickProducer producer(bricks);
    detail::NodeArrays scratch;
    const auto at = [](std::int64_t x) { return static_cast<std::int32_t>(x & -kSide); };
    for (std::int64_t x = low[0] & -kSide; x < high[0]; x += kSide)
      tree_.produce(producer, {at(x), at(low[1]), at(low[2]), detail::BlockTree::kLevel}, scratch);
  }

  const VolumeView<T>& volume_;
  const Inside& inside_;
  const detail::PlacedBox& box_;
  detail::BlockTree tree_;
  Point first_, count_;  // beams
};

template <class T, class Inside>
Octree build(const VolumeView<T>& volume, const Inside& inside, const VolumePlacement& placement, Frame frame,
             const Work& work) {
  const detail::PlacedBox box = detail::placed_box(volume.size, placement);
  if (box.depth > detail::BlockTree::kLevel)
    return VolumeBuild<T, Inside>(volume, inside, box).run(std::move(frame), work);
  detail::VolumeBricks bricks(box.low, box.high);
  std::vector<std::uint64_t> gray;
  detail::VolumeScan<T, Inside>(volume, box.low, inside, bricks).strips(0, bricks.strips(), gray);
  return detail::produce(detail::BrickProducer(bricks), box.depth, std::move(frame), work);
}

}  // namespace

template <class T>
Octree octree_from_voxels(const VolumeView<T>& volume, ValueRange<T> inside, VolumePlacement placement, Frame frame,
                          const Work& work) {
  return build(volume, detail::InRange<T>{inside.low, inside.high}, placement, std::move(frame), work);
}

template <class T>
Octree octree_from_voxels(const VolumeView<T>& volume, const std::function<bool(T)>& inside, VolumePlacement placement,
                          Frame frame, const Work& work) {
  return build(volume, inside, placement, std::move(frame), work);
}

#define BLACKLEAF_INSTANTIATE(T)                                                                                     \
  template Octree octree_from_voxels<T>(const VolumeView<T>&, ValueRange<T>, VolumePlacement, Frame, const Work&);   \
  template Octree octree_from_voxels<T>(const VolumeView<T>&, const std::function<bool(T)>&, VolumePlacement, Frame, \
                                        const Work&);
BLACKLEAF_INSTANTIATE(std::uint8_t)
BLACKLEAF_INSTANTIATE(std::int8_t)
BLACKLEAF_INSTANTIATE(std::uint16_t)
BLACKLEAF_INSTANTIATE(std::int16_t)
BLACKLEAF_INSTANTIATE(std::uint32_t)
BLACKLEAF_INSTANTIATE(std::int32_t)
BLACKLEAF_INSTANTIATE(float)
BLACKLEAF_INSTANTIATE(double)
#undef BLACKLEAF_INSTANTIATE

}  // namespace blackleaf
