#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/label_voxels.h"
#include "blackleaf/volume_file.h"
#include "io/image_io.h"
#include "io/volume_shape.h"
#include "io/volume_source.h"
#include "octree/parallel.h"

namespace blackleaf {
namespace {


// One volume on its way from the file to the label map.
class LabelVolumeJob {
 public:
  LabelVolumeJob(const std::filesystem::path& path, const LabelVolumeOptions& options, const Work& work)
      : path_(path), options_(options), work_(work) {}

  LabelMap run() {
    if (options_.depth < 0 || options_.depth > kMaxDepth)
      throw Error(ErrorCode::bad_argument, fmt::format("depth {} is out of range", options_.depth),
                  "use 1 to 20, or 0 for the smallest that holds the volume");
    source_ = detail::open_volume(path_, {options_.series, options_.spacing, options_.warn});
    const detail::ImageInformation& information = source_->information();
    size_ = detail::solid_size(information);
    placed_ = detail::place_volume(path_, information, options_.depth, options_.centre);
    return detail::with_type_of(*information.component, [&]<class T>(T) { return labels<T>(); });
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {}", path_.string(), what), remedy);
  }

  template <class T>
  LabelMap labels() {
    Labelling<T> labelling = WholeNumbers{};
    if (options_.bands) labelling = *options_.bands;
    LabelVolumeBuilder<T> builder(size_, std::move(labelling), placed_.placement, placed_.frame, work_);
    std::unique_ptr<T[]> now = room<T>(), ahead = size_[2] > portion<T>(0) ? room<T>() : nullptr;
    bool only_nan = std::is_floating_point_v<T>;
    // While some slices are built from, the next are read.
    source_->read(portion<T>(0), now.get());
    for (std::int64_t z = 0; z < size_[2];) {
      const std::int64_t count = portion<T>(z), next = portion<T>(z + count);
      detail::both(
          work_,
          [&] {
            if (next > 0) source_->read(next, ahead.get());
          },
          [&] {
            if constexpr (std::is_floating_point_v<T>)
              only_nan = only_nan && std::all_of(now.get(), now.get() + count * size_[0] * size_[1],
                                                 [](T value) { return std::isnan(value); });
            add(builder, now.get(), count);
          });
      std::swap(now, ahead);
      z += count;
    }
    if (only_nan) fail("every value is NaN", "get it again from its source");
    return builder.finish();
  }

  // Slices to read at once.
  template <class T>
  std::int64_t most() const {
    constexpr std::int64_t kBytesAtOnce = std::int64_t{1} << 23;
    const std::int64_t fit = kBytesAtOnce / (size_[0] * size_[1] * static_cast<std::int64_t>(sizeof(T)));
    return std::clamp<std::int64_t>(fit & ~std::int64_t{3}, 4, 64);
  }
  // Slices to read at once from z on: whole layers of four, counted from the universe's bottom, are not copied.
  template <class T>
  std::int64_t portion(std::int64_t z) const {
    return std::min(most<T>() - ((placed_.placement.corner[2] + z) & 3), size_[2] - z);
  }
  template <class T>
  std::unique_ptr<T[]> room() const {
    const auto values = static_cast<std::size_t>(std::min(most<T>(), size_[2]) * size_[0] * size_[1]);
    std::unique_ptr<T[]> room(new (std::nothrow) T[values]);
    if (!room)
      fail(fmt::format("needs {} bytes of memory for some slices, more than there are", values * sizeof(T)),
           "crop or resample it first");
    return room;
  }

  template <class T>
  void add(LabelVolumeBuilder<T>& builder, const T* values, std::int64_t count) const {
    try {
      builder.add(values, count);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::bad_input) throw;
      fail(error.what(), "");
    }
  }

  const std::filesystem::path& path_;
  const LabelVolumeOptions& options_;
  const Work& work_;
  std::unique_ptr<detail::VolumeSource> source_;
  std::array<std::int64_t, 3> size_{};
  detail::PlacedVolume placed_;
};

}  // namespace

LabelMap read_label_volume(const std::filesystem::path& path, const LabelVolumeOptions& options, const Work& work) {
  return LabelVolumeJob(path, options, work).run();
}

}  // namespace blackleaf
