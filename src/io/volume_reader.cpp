#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/volume_file.h"
#include "blackleaf/voxels.h"
#include "io/image_io.h"
#include "io/value_range.h"
#include "io/volume_shape.h"
#include "io/volume_source.h"

namespace blackleaf {
namespace {

using detail::Component;
using detail::ImageInformation;

void check_options(const VolumeOptions& options) {
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

// One volume on its way from the file to the octree.
class VolumeJob {
 public:
  VolumeJob(const std::filesystem::path& path, const VolumeOptions& options, const Work& work)
      : path_(path), options_(options), work_(work) {}

  Octree run() {
    check_options(options_);
    const auto source = detail::open_volume(path_);
    const ImageInformation& information = source->information();
    size_ = detail::solid_size(information);
    voxels_ = static_cast<std::uint64_t>(size_[0] * size_[1] * size_[2]);
    placed_ = detail::place_volume(path_, information, options_.depth, options_.centre);
    switch (*information.component) {
      case Component::u8:
        return octree<std::uint8_t>(*source);
      case Component::i8:
        return octree<std::int8_t>(*source);
      case Component::u16:
        return octree<std::uint16_t>(*source);
      case Component::i16:
        return octree<std::int16_t>(*source);
      case Component::u32:
        return octree<std::uint32_t>(*source);
      case Component::i32:
        return octree<std::int32_t>(*source);
      case Component::u64:
        return octree<std::uint64_t>(*source);
      case Component::i64:
        return octree<std::int64_t>(*source);
      case Component::f32:
        return octree<float>(*source);
      case Component::f64:
        return octree<double>(*source);
    }
    fail("has values of an unknown type", "");
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
    if constexpr (std::is_integral_v<T> && sizeof(T) == 8) check_label();
    const std::unique_ptr<T[]> values(new (std::nothrow) T[voxels_]());  // zeros
    if (!values)
      fail(fmt::format("needs {} bytes of memory, more than there are", voxels_ * sizeof(T)),
           "crop or resample it first");
    source.read(size_[2], values.get());
    const ValueRange<T> inside = detail::wanted_range<T>(options_);
    if constexpr (std::is_integral_v<T> && sizeof(T) == 8) {
      // 64-bit values become a mask, in place of themselves: byte i never overtakes value i.
      auto* mask = reinterpret_cast<std::uint8_t*>(values.get());
      for (std::uint64_t i = 0; i < voxels_; ++i) {
        const bool in = inside(values[i]);
        mask[i] = in;
      }
      return octree_from_voxels<std::uint8_t>({mask, size_}, ValueRange<std::uint8_t>{1, 1}, placed_.placement,
                                              placed_.frame, work_);
    } else {
      Octree result = octree_from_voxels<T>({values.get(), size_}, inside, placed_.placement, placed_.frame, work_);
      if constexpr (std::is_floating_point_v<T>) {
        if (result.is_empty() &&
            std::all_of(values.get(), values.get() + voxels_, [](T value) { return std::isnan(value); }))
          fail("every value is NaN", "get it again from its source");
      }
      return result;
    }
  }

  const std::filesystem::path& path_;
  const VolumeOptions& options_;
  const Work& work_;
  std::array<std::int64_t, 3> size_{1, 1, 1};
  std::uint64_t voxels_ = 0;
  detail::PlacedVolume placed_;
};

}  // namespace

bool is_volume_name(const std::filesystem::path& path) { return detail::image_format(path).has_value(); }

Octree read_volume(const std::filesystem::path& path, const VolumeOptions& options, const Work& work) {
  return VolumeJob(path, options, work).run();
}

}  // namespace blackleaf
