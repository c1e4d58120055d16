#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/volume_file.h"
#include "blackleaf/voxel_stream.h"
#include "io/image_io.h"
#include "io/nan_count.h"
#include "io/slice_stack.h"
#include "io/value_range.h"
#include "io/volume_octree.h"
#include "io/volume_shape.h"
#include "io/volume_source.h"
#include "octree/parallel.h"

namespace blackleaf {
void detail::check_options(const VolumeOptions& options) {
  const auto fail = [](const char* what, const char* remedy) { throw Error(ErrorCode::bad_argument, what, remedy); };
  if (options.label && (options.low || options.high))
    fail("both a range of values and a label are given", "give one of them");
  for (const auto& bound : {options.low, options.high, options.label})
    if (bound && std::isnan(*bound)) fail("the range of values has a bound that is not a number", "give numbers");
  if (options.low && options.high && *options.low > *options.high)
    throw Error(ErrorCode::bad_argument,
                fmt::format("the range of values from {} to {} is empty", *options.low, *options.high),
                "give the smaller value first");
  if (options.depth < 0 || options.depth > kMaxDepth)
    throw Error(ErrorCode::bad_argument, fmt::format("depth {} is out of range", options.depth),
                "use 1 to 20, or 0 for the smallest that holds the volume");
}

namespace {

// One volume on its way from the source to the octree.
class VolumeJob {
 public:
  VolumeJob(const std::filesystem::path& path, const detail::PlacedVolume& placed, const VolumeOptions& options,
            detail::NanCount& nan, const Work& work)
      : path_(path), placed_(placed), options_(options), nan_(nan), work_(work) {}

  Octree run(detail::VolumeSource& source) {
    size_ = detail::solid_size(source.information());
    return detail::with_type_of(*source.information().component, [&]<class T>(T) { return octree<T>(source); });
  }

 private:
  std::string name() const { return path_.string(); }
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {}", name(), what), remedy);
  }

  // A double tells whole numbers apart up to 2^53 only.
  void check_label() const {
    if (options_.label && std::abs(*options_.label) >= 0x1p53 && std::abs(*options_.label) <= 0x1p64)
      throw Error(ErrorCode::bad_argument,
                  fmt::format("{}: a label of {} cannot be told from its neighbours among 64-bit values", name(),
                              *options_.label),
                  "labels must be below 2^53; give a range of values or renumber the labels");
  }

  template <class T>
  Octree octree(detail::VolumeSource& source) const {
    const ValueRange<T> inside = detail::wanted_range<T>(options_);
    if constexpr (std::is_integral_v<T> && sizeof(T) == 8) {
      check_label();
      // 64-bit values become a mask, in place of themselves: byte i never overtakes value i.
      return stream<T, std::uint8_t>(source, {1, 1}, [&](T* values, std::size_t count) {
        auto* mask = reinterpret_cast<std::uint8_t*>(values);
        for (std::size_t i = 0; i < count; ++i) {
          const bool in = inside(values[i]);
          mask[i] = in;
        }
        return mask;
      });
    } else if constexpr (std::is_floating_point_v<T>) {
      return stream<T, T>(source, inside, [&](T* values, std::size_t count) {
        nan_.add(values, count);
        return values;
      });
    } else {
      return stream<T, T>(source, inside, [](T* values, std::size_t) { return values; });
    }
  }

  // Reads values of type T; prepare(values, count) makes of them the ones that the octree is built from. While some
  // slices are built from, the next are read, if there is a thread for it.
  template <class T, class U, class Prepare>
  Octree stream(detail::VolumeSource& source, ValueRange<U> inside, const Prepare& prepare) const {
    VoxelStream<U> stream(size_, inside, placed_.placement, placed_.frame, work_);
    const auto slice = static_cast<std::size_t>(size_[0] * size_[1]);
    std::vector<T> now, ahead;
    const auto read = [&](std::int64_t slices, std::vector<T>& values) {
      try {
        values.resize(slice * static_cast<std::size_t>(slices));
      } catch (const std::exception&) {  // too long or too much
        fail(fmt::format("needs {} bytes of memory for a slice, more than there are", slice * sizeof(T)),
             "crop or resample it first");
      }
      source.read(slices, values.data());
    };
    const auto build = [&](std::int64_t slices) {
      stream.add(prepare(now.data(), slice * static_cast<std::size_t>(slices)), slices);
    };
    if (detail::thread_count(work_) == 1) {  // in turns: one buffer is oftener still in the caches than two
      while (const std::int64_t slices = stream.wanted()) {
        read(slices, now);
        build(slices);
      }
      return stream.finish();
    }
    std::int64_t slices = stream.wanted();
    read(slices, now);
    while (slices > 0) {
      const std::int64_t next = stream.wanted(slices);
      const auto read_next = [&] {
        if (next > 0) read(next, ahead);
      };
      detail::both(work_, read_next, [&] { build(slices); });
      std::swap(now, ahead);
      slices = next;
    }
    return stream.finish();
  }

  const std::filesystem::path& path_;
  const detail::PlacedVolume& placed_;
  const VolumeOptions& options_;
  detail::NanCount& nan_;
  const Work& work_;
  std::array<std::int64_t, 3> size_{1, 1, 1};
};

}  // namespace

bool is_volume_name(const std::filesystem::path& path) {
  return detail::image_format(path).has_value() || detail::has_slice_suffix(path);
}

bool is_volume(const std::filesystem::path& path) { return is_volume_name(path) || detail::is_stack(path); }

Octree read_volume(const std::filesystem::path& path, const VolumeOptions& options, const Work& work) {
  detail::check_options(options);
  const auto source = detail::open_volume(path, {options.series, options.spacing, options.warn});
  const detail::ImageInformation& information = source->information();
  const auto placed = detail::place_volume(path, information, options.depth, options.centre);
  detail::NanCount nan;
  Octree octree = detail::octree_of(*source, path, placed, options, nan, work);
  detail::tell_nan(nan, *information.component, path, options.warn);
  return octree;
}

Octree detail::octree_of(VolumeSource& source, const std::filesystem::path& path, const PlacedVolume& placed,
                         const VolumeOptions& options, NanCount& nan, const Work& work) {
  return VolumeJob(path, placed, options, nan, work).run(source);
}

void detail::tell_nan(const NanCount& nan, Component component, const std::filesystem::path& path,
                      const std::function<void(const std::string&)>& warn) {
  if (component == Component::f32 || component == Component::f64) nan.tell(path, "taken as outside", warn);
}

}  // namespace blackleaf
