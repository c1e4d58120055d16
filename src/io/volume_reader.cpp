#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/volume_file.h"
#include "blackleaf/voxels.h"
#include "file/input_file.h"
#include "io/image_io.h"
#include "io/value_range.h"
#include "io/volume_header.h"

namespace blackleaf {
namespace {

using detail::Component;
using detail::ImageInformation;
using detail::ImageReader;

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

std::string text(const std::vector<std::int64_t>& size) { return fmt::format("{}", fmt::join(size, " x ")); }

// One volume on its way from the file to the octree.
class VolumeJob {
 public:
  VolumeJob(const std::filesystem::path& path, const VolumeOptions& options, const Work& work)
      : path_(path), options_(options), work_(work) {}

  Octree run() {
    check_options(options_);
    const auto format = detail::image_format(path_);
    if (const detail::InputFile file(path_); !file.is_regular() || !format || file.size() == 0) {
      if (!file.is_regular()) throw Error(ErrorCode::io, name() + ": is not an ordinary file", "copy it to one first");
      if (!format) fail("has no suffix of a volume", "use .nrrd, .nhdr, .nii, .nii.gz, .mha, .mhd, .hdr or .img");
      fail("is empty", "get it again from its source");
    }
    detail::check_header(path_, *format);
    ImageReader reader(path_, *format);
    const ImageInformation& information = reader.information();
    check_shape(information);
    const std::uint64_t bytes = voxels_ * detail::bytes_of(*information.component);
    detail::check_believable(path_, *format, voxels_, bytes);
    place();
    switch (*information.component) {
      case Component::u8:
        return octree<std::uint8_t>(reader);
      case Component::i8:
        return octree<std::int8_t>(reader);
      case Component::u16:
        return octree<std::uint16_t>(reader);
      case Component::i16:
        return octree<std::int16_t>(reader);
      case Component::u32:
        return octree<std::uint32_t>(reader);
      case Component::i32:
        return octree<std::int32_t>(reader);
      case Component::u64:
        return octree<std::uint64_t>(reader);
      case Component::i64:
        return octree<std::int64_t>(reader);
      case Component::f32:
        return octree<float>(reader);
      case Component::f64:
        return octree<double>(reader);
    }
    fail("has values of an unknown type", "");
  }

 private:
  std::string name() const { return path_.string(); }
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {}", name(), what), remedy);
  }

  void check_shape(const ImageInformation& information) {
    const auto& size = information.size;
    if (std::any_of(size.begin(), size.end(), [](std::int64_t side) { return side <= 0; }) || size.empty())
      fail(fmt::format("has no voxels ({})", text(size)), "get it again from its source");
    if (size.size() > 3 && std::any_of(size.begin() + 3, size.end(), [](std::int64_t side) { return side != 1; }))
      fail(fmt::format("has {} dimensions ({}); a solid has three", size.size(), text(size)),
           "extract one volume of it first");
    if (information.components != 1)
      fail(fmt::format("has {} values a voxel; a solid needs one", information.components),
           "extract one component first");
    if (!information.component) fail("has values that are not numbers", "convert it to numbers first");
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& geometry = information.geometry;
      origin_[static_cast<int>(i)] = geometry.origin[i];
      axes_.col(static_cast<int>(i)) << geometry.axes[i][0], geometry.axes[i][1], geometry.axes[i][2];
    }
    if (!origin_.allFinite() || !axes_.allFinite())
      fail("has an origin or axes that are not finite", "mend its header");
    // The volume of a voxel, of that of a box with edges as long.
    const Eigen::RowVector3d lengths{axes_.col(0).stableNorm(), axes_.col(1).stableNorm(), axes_.col(2).stableNorm()};
    Eigen::Matrix3d directions = axes_;
    for (int i = 0; i < 3; ++i) directions.col(i) /= lengths[i];
    const double spanned = std::abs(directions.col(0).dot(directions.col(1).cross(directions.col(2))));
    if (!(spanned > 1e-9))  // nor is it with an axis of no length
      fail("its axes do not span space: one has no length or lies in the plane of the others",
           "mend its header or get it again from its source");
    for (std::size_t i = 0; i < std::min<std::size_t>(3, size.size()); ++i) size_[i] = size[i];
    if (*std::max_element(size_.begin(), size_.end()) > std::int64_t{1} << kMaxDepth)
      fail(fmt::format("is too large ({}) for any universe", text(size)), "no side may be over 2^20 voxels");
    voxels_ = static_cast<std::uint64_t>(size_[0] * size_[1] * size_[2]);  // at most 2^60
  }

  void place() {
    const int least = depth_for(size_);
    placement_.depth = options_.depth > 0 ? options_.depth : least;
    if (placement_.depth < least)
      fail(fmt::format("its {} voxels do not fit a universe of depth {}", text({size_.begin(), size_.end()}),
                       placement_.depth),
           fmt::format("use depth {} or more", least));
    const std::int64_t side = std::int64_t{1} << placement_.depth;
    for (std::size_t i = 0; i < 3; ++i)
      if (options_.centre) placement_.corner[i] = static_cast<std::int32_t>((side - size_[i]) / 2);
    // The file tells where the centre of voxel (0,0,0) is; frames start from the universe's corner.
    const Eigen::Vector3d corner(placement_.corner[0], placement_.corner[1], placement_.corner[2]);
    frame_ = {origin_ - axes_ * (corner + Eigen::Vector3d::Constant(0.5)), axes_, "mm"};
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
  Octree octree(ImageReader& reader) const {
    if constexpr (std::is_integral_v<T> && sizeof(T) == 8) check_label();
    const std::unique_ptr<T[]> values(new (std::nothrow) T[voxels_]());  // zeros
    if (!values)
      fail(fmt::format("needs {} bytes of memory, more than there are", voxels_ * sizeof(T)),
           "crop or resample it first");
    reader.read(values.get());
    const ValueRange<T> inside = detail::wanted_range<T>(options_);
    if constexpr (std::is_integral_v<T> && sizeof(T) == 8) {
      // 64-bit values become a mask, in place of themselves: byte i never overtakes value i.
      auto* mask = reinterpret_cast<std::uint8_t*>(values.get());
      for (std::uint64_t i = 0; i < voxels_; ++i) {
        const bool in = inside(values[i]);
        mask[i] = in;
      }
      return octree_from_voxels<std::uint8_t>({mask, size_}, ValueRange<std::uint8_t>{1, 1}, placement_, frame_, work_);
    } else {
      Octree result = octree_from_voxels<T>({values.get(), size_}, inside, placement_, frame_, work_);
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
  Eigen::Vector3d origin_;  // of the centre of the file's first voxel
  Eigen::Matrix3d axes_;
  VolumePlacement placement_;
  Frame frame_;
};

}  // namespace

bool is_volume_name(const std::filesystem::path& path) { return detail::image_format(path).has_value(); }

Octree read_volume(const std::filesystem::path& path, const VolumeOptions& options, const Work& work) {
  return VolumeJob(path, options, work).run();
}

}  // namespace blackleaf
