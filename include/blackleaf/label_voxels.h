// Building label maps from voxel volumes: MHF92's labelled run stream of label maps and quantised images.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <variant>
#include <vector>

#include "blackleaf/label_map.h"
#include "blackleaf/voxels.h"
#include "blackleaf/work.h"

namespace blackleaf {

namespace detail {
template <class T>
class LabelEngine;
}

/// The label of a voxel is its value, which must be a whole number from 0 to 2^32 - 1.
struct WholeNumbers {};
/// The label of a voxel is the number of thresholds that are not above its value: 0 below the first, as many as there
/// are from the last on. NaN has label 0. The thresholds increase; they are compared as exact numbers.
struct Bands {
  std::vector<double> thresholds;
};
/// The label of a voxel is what a function says of its value. The function is called from many threads, for neighbours
/// of one value not always anew; it must depend on nothing but the value.
template <class T>
using LabelOf = std::function<std::uint32_t(T)>;

/// How values become labels.
template <class T>
using Labelling = std::variant<WholeNumbers, Bands, LabelOf<T>>;

/// The labels of a volume in memory; voxels outside it have label 0. Every value is read once; blocks of one label are
/// found while the volume is read front to back, and only the others are looked at voxel by voxel, in curve order. The
/// frame is that of the universe. T: (u)int8, (u)int16, (u)int32, (u)int64, float, double. Throws Error(bad_input) for
/// a volume without voxels, for one that does not fit the universe, and for a value that is no label (which one and
/// where: the first in the order of the data); Error(bad_argument) for a depth outside 0..20 and for thresholds that
/// are none, not finite, not increasing or more than 65535. O(voxels); MHF92, sections 3 and 4.
template <class T>
LabelMap label_map_from_voxels(const VolumeView<T>& volume, const Labelling<T>& labelling = WholeNumbers{},
                               VolumePlacement placement = {}, Frame frame = {}, const Work& work = {});

/// The same for a volume that comes slice by slice (a slice is all values of one z, x fastest, without gaps). Memory is
/// that of the label map, of up to three slices, and of 64 slices what does not have one label.
template <class T>
class LabelVolumeBuilder {
 public:
  /// Errors as above. `size` is that of the whole volume. Progress is that of all slices.
  explicit LabelVolumeBuilder(const std::array<std::int64_t, 3>& size, Labelling<T> labelling = WholeNumbers{},
                              VolumePlacement placement = {}, Frame frame = {}, Work work = {});
  ~LabelVolumeBuilder();
  LabelVolumeBuilder(LabelVolumeBuilder&&) noexcept;
  LabelVolumeBuilder& operator=(LabelVolumeBuilder&&) noexcept;

  /// The next slices, any number at a time; multiples of four from a z of the universe that is one are not copied.
  /// Requires: no more than the volume has. After an exception no more can be added.
  void add(const T* slices, std::int64_t count);
  /// The label map. Requires: all slices have been added. Leaves the builder empty.
  LabelMap finish();

 private:
  std::unique_ptr<detail::LabelEngine<T>> engine_;
};

}  // namespace blackleaf
