#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <string>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/label_map.h"
#include "blackleaf/leaves.h"
#include "blackleaf/measures.h"
#include "blackleaf/volume_file.h"
#include "file/atomic_write.h"
#include "io/image_io.h"
#include "io/raw_nrrd.h"

namespace blackleaf {
namespace {

using detail::ImageFormat;

constexpr std::uint64_t kMostVoxels = std::uint64_t{1} << 33;

// The values of a box of voxels, x fastest.
template <class T>
struct Values {
  const Box& box;
  std::array<std::int64_t, 3> size;
  T* values;

  // Sets a cube. Requires: it lies in the box.
  void fill(const Cube& c, T value) const {
    const std::int32_t side = c.side();
    for (std::int32_t z = c.z; z < c.z + side; ++z)
      for (std::int32_t y = c.y; y < c.y + side; ++y) {
        const std::int64_t row = (std::int64_t{z} - box.min[2]) * size[1] + (y - box.min[1]);
        std::fill_n(values + row * size[0] + (c.x - box.min[0]), side, value);
      }
  }
};

detail::ImageGeometry geometry_of(const Frame& frame) {
  detail::ImageGeometry geometry;
  for (std::size_t i = 0; i < 3; ++i) {
    geometry.origin[i] = frame.origin[static_cast<int>(i)];
    for (std::size_t row = 0; row < 3; ++row)
      geometry.axes[i][row] = frame.axes(static_cast<int>(row), static_cast<int>(i));
  }
  return geometry;
}

// What a format cannot say of a frame is an error, not a silent change.
void check_geometry(const std::filesystem::path& path, ImageFormat format, const Frame& frame,
                    const std::array<std::int64_t, 3>& size) {
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::bad_argument,
                fmt::format("{}: {} cannot hold {}", path.string(), detail::format_name(format), what),
                "write .nrrd instead");
  };
  if (!frame.origin.allFinite() || !frame.axes.allFinite())
    throw Error(ErrorCode::bad_argument,
                fmt::format("{}: the octree's frame has numbers that are not finite", path.string()));
  const Eigen::Vector3d lengths = frame.axes.colwise().norm();
  if (lengths.minCoeff() <= 0)
    throw Error(ErrorCode::bad_argument,
                fmt::format("{}: the octree's frame has an axis without length", path.string()));
  if (format == ImageFormat::nrrd) return;
  Eigen::Matrix3d directions = frame.axes;
  for (int i = 0; i < 3; ++i) directions.col(i) /= lengths[i];
  const Eigen::Matrix3d products = directions.transpose() * directions - Eigen::Matrix3d::Identity();
  if (products.cwiseAbs().maxCoeff() > 1e-6) fail("axes that are not at right angles");
  if (format == ImageFormat::nifti &&
      *std::max_element(size.begin(), size.end()) > std::numeric_limits<std::int16_t>::max())
    fail(fmt::format("a side of more than {} voxels", std::numeric_limits<std::int16_t>::max()));
}

constexpr Box kOneVoxel{{0, 0, 0}, {1, 1, 1}};

constexpr Box universe(std::int32_t side) { return {{0, 0, 0}, {side, side, side}}; }

// The volume whose values `fill` sets; all others are 0. Requires: `fill` sets nothing outside the box.
template <class T, class Fill>
void write(const std::filesystem::path& path, detail::Component component, const Frame& universe_frame, const Box& box,
           bool crop, const Fill& fill) {
  const std::string suffix = detail::image_suffix(path);
  if (suffix != ".nrrd" && suffix != ".nii" && suffix != ".nii.gz" && suffix != ".mha")
    throw Error(ErrorCode::bad_argument, fmt::format("{}: volumes are not written as '{}'", path.string(), suffix),
                "use .nrrd, .nii, .nii.gz or .mha");
  const ImageFormat format = *detail::image_format(path);
  std::array<std::int64_t, 3> size{};
  for (std::size_t i = 0; i < 3; ++i) size[i] = std::int64_t{box.max[i]} - box.min[i];
  const auto voxels = static_cast<std::uint64_t>(size[0] * size[1] * size[2]);
  if (voxels > kMostVoxels)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("{}: a volume of {} x {} x {} voxels is more than 2^33", path.string(), size[0], size[1], size[2]),
        crop ? "build the octree at a smaller depth" : "crop it to its bounding box or build it at a smaller depth");
  const Frame frame = universe_frame.shifted({box.min[0] + 0.5, box.min[1] + 0.5, box.min[2] + 0.5});
  check_geometry(path, format, frame, size);

  detail::AtomicFile file(path, suffix);
  const std::unique_ptr<T[]> values(new (std::nothrow) T[voxels]());
  if (!values)
    throw Error(
        ErrorCode::io,
        fmt::format("{}: a volume needs {} bytes of memory, more than there are", path.string(), voxels * sizeof(T)),
        "crop it to its bounding box or build it at a smaller depth");
  fill(Values<T>{box, size, values.get()});
  try {
    detail::write_image(file.temporary(), format, size, geometry_of(frame), component, values.get());
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("{}: {}", path.string(), error.what()));
  }
  file.commit();
}

template <class T>
void write_labels(const LabelMap& labels, const std::filesystem::path& path, detail::Component component,
                  const Box& box, bool crop) {
  write<T>(path, component, labels.frame(), box, crop, [&](const Values<T>& values) {
    for_each_label_cube(labels, [&](const Cube& cube, std::uint32_t label) {
      if (label != 0) values.fill(cube, static_cast<T>(label));
    });
  });
}

}  // namespace

void write_volume(const Octree& octree, const std::filesystem::path& path, bool crop) {
  const Box box = crop ? bounding_box(octree).value_or(kOneVoxel) : universe(octree.side());
  write<std::uint8_t>(path, detail::Component::u8, octree.frame(), box, crop, [&](const Values<std::uint8_t>& values) {
    for_each_black_leaf(octree, [&](const Leaf& leaf) { values.fill(leaf.cube, 1); });
  });
}

void write_raw_volume(const Octree& octree, const std::filesystem::path& path, bool crop) {
  const detail::RawNrrd volume(octree, path, crop);
  detail::AtomicFile file(path);
  const auto bytes = [](const std::string& text) {
    return std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  };
  file.write(bytes(volume.header()));
  volume.write_slices(0, volume.slices(), [&](std::uint64_t, std::span<const std::uint8_t> part) { file.write(part); });
  file.commit();
}

void write_volume(const LabelMap& labels, const std::filesystem::path& path, bool crop) {
  const auto all = labels.labels();
  const std::uint32_t largest = *std::max_element(all.begin(), all.end());
  const Box box = crop ? bounding_box(octree_from_labels(labels)).value_or(kOneVoxel) : universe(labels.side());
  if (largest <= 0xFF) return write_labels<std::uint8_t>(labels, path, detail::Component::u8, box, crop);
  if (largest <= 0xFFFF) return write_labels<std::uint16_t>(labels, path, detail::Component::u16, box, crop);
  write_labels<std::uint32_t>(labels, path, detail::Component::u32, box, crop);
}

}  // namespace blackleaf
