#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/label_voxels.h"
#include "blackleaf/volume_file.h"
#include "io/image_io.h"
#include "io/nan_count.h"
#include "io/value_range.h"
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
    assert(!options_.frame || (options_.depth > 0 && !options_.centre));
    if (options_.depth < 0 || options_.depth > kMaxDepth)
      throw Error(ErrorCode::bad_argument, fmt::format("depth {} is out of range", options_.depth),
                  "use 1 to 20, or 0 for the smallest that holds the volume");
    source_ = detail::open_volume(path_, {options_.series, options_.spacing, options_.warn});
    const detail::ImageInformation& information = source_->information();
    size_ = detail::solid_size(information);
    if (options_.frame)
      place_in_frame();
    else
      placed_ = detail::place_volume(path_, information, options_.depth, options_.centre);
    return detail::with_type_of(*information.component, [&]<class T>(T) { return labels<T>(); });
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {}", path_.string(), what), remedy);
  }

  // The volume in the frame that was asked for: of what reaches beyond the universe there is to be no label.
  void place_in_frame() {
    const auto corner = detail::corner_in(path_, source_->information(), *options_.frame);
    const std::int64_t side = std::int64_t{1} << options_.depth;
    Window window;
    window.whole = size_;
    for (std::size_t i = 0; i < 3; ++i) {
      window.begin[i] = std::clamp<std::int64_t>(-corner[i], 0, size_[i]);
      window.end[i] = std::clamp<std::int64_t>(side - corner[i], 0, size_[i]);
      if (window.begin[i] >= window.end[i])
        fail("lies outside the universe that it is to lie in", "give the octree of a universe that holds it");
      placed_.placement.corner[i] = static_cast<std::int32_t>(corner[i] + window.begin[i]);
      size_[i] = window.end[i] - window.begin[i];
    }
    placed_.placement.depth = options_.depth;
    placed_.frame = *options_.frame;
    if (size_ != window.whole) window_ = window;
  }

  // The next slices of what lies in the universe.
  template <class T>
  void read(std::int64_t slices, T* values) {
    if (!window_) return source_->read(slices, values);
    const auto row = static_cast<std::size_t>(window_->whole[0]);
    std::vector<T> slice(row * static_cast<std::size_t>(window_->whole[1]));
    const auto inside = [&](std::size_t axis, std::int64_t at) {
      return window_->begin[axis] <= at && at < window_->end[axis];
    };
    const bool last = next_ + slices == size_[2];
    const std::int64_t to = last ? window_->whole[2] : window_->begin[2] + next_ + slices;
    for (std::int64_t z = next_ == 0 ? 0 : window_->begin[2] + next_; z < to; ++z) {
      source_->read(1, slice.data());
      for (std::int64_t y = 0; y < window_->whole[1]; ++y) {
        const T* const from = slice.data() + row * static_cast<std::size_t>(y);
        for (std::int64_t x = 0; x < window_->whole[0]; ++x)
          if (!(inside(0, x) && inside(1, y) && inside(2, z)) && !is_background(from[x]))
            fail(fmt::format("voxel ({},{},{}) has value {} and lies outside the universe that it is to lie in", x, y,
                             z, from[x]),
                 "give the octree of a universe that holds all labels");
        if (inside(1, y) && inside(2, z)) values = std::copy(from + window_->begin[0], from + window_->end[0], values);
      }
    }
    next_ += slices;
  }

  // Whether a value has label 0.
  template <class T>
  bool is_background(T value) const {
    if (!options_.bands || options_.bands->thresholds.empty()) return value == T{0};
    const double first = options_.bands->thresholds.front();
    return !detail::range_between<T>(first, std::numeric_limits<double>::infinity())(value);
  }

  template <class T>
  LabelMap labels() {
    Labelling<T> labelling = WholeNumbers{};
    if (options_.bands) labelling = *options_.bands;
    LabelVolumeBuilder<T> builder(size_, std::move(labelling), placed_.placement, placed_.frame, work_);
    std::unique_ptr<T[]> now = room<T>(), ahead = size_[2] > portion<T>(0) ? room<T>() : nullptr;
    detail::NanCount nan;
    // While some slices are built from, the next are read.
    read(portion<T>(0), now.get());
    for (std::int64_t z = 0; z < size_[2];) {
      const std::int64_t count = portion<T>(z), next = portion<T>(z + count);
      detail::both(
          work_,
          [&] {
            if (next > 0) read(next, ahead.get());
          },
          [&] {
            nan.add(now.get(), static_cast<std::size_t>(count * size_[0] * size_[1]));
            add(builder, now.get(), count);
          });
      std::swap(now, ahead);
      z += count;
    }
    nan.tell(path_, "taken as label 0", options_.warn);
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
  std::array<std::int64_t, 3> size_{};  // of what lies in the universe
  detail::PlacedVolume placed_;
  // The part of a volume that lies in the universe, if that is not all of it.
  struct Window {
    std::array<std::int64_t, 3> begin{}, end{}, whole{};
  };
  std::optional<Window> window_;
  std::int64_t next_ = 0;  // slice of the window
};

}  // namespace

LabelMap read_label_volume(const std::filesystem::path& path, const LabelVolumeOptions& options, const Work& work) {
  return LabelVolumeJob(path, options, work).run();
}

}  // namespace blackleaf
