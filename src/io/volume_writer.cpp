#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/leaves.h"
#include "blackleaf/measures.h"
#include "blackleaf/volume_file.h"
#include "file/atomic_write.h"
#include "io/image_io.h"

namespace blackleaf {
namespace {

using detail::ImageFormat;

constexpr std::uint64_t kMostVoxels = std::uint64_t{1} << 33;

// Sets the black voxels of a box, leaf by leaf, row by row.
void fill(const Octree& octree, const Box& box, const std::array<std::int64_t, 3>& size, std::uint8_t* values) {
  for_each_black_leaf(octree, [&](const Leaf& leaf) {
    const Cube& c = leaf.cube;
    const std::int32_t side = c.side();
    // The box holds every black voxel, so leaves need no cutting.
    for (std::int32_t z = c.z; z < c.z + side; ++z)
      for (std::int32_t y = c.y; y < c.y + side; ++y) {
        const std::int64_t row = (std::int64_t{z} - box.min[2]) * size[1] + (y - box.min[1]);
        std::memset(values + row * size[0] + (c.x - box.min[0]), 1, static_cast<std::size_t>(side));
      }
  });
}

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

}  // namespace

void write_volume(const Octree& octree, const std::filesystem::path& path, bool crop) {
  const std::string suffix = detail::image_suffix(path);
  if (suffix != ".nrrd" && suffix != ".nii" && suffix != ".nii.gz" && suffix != ".mha")
    throw Error(ErrorCode::bad_argument, fmt::format("{}: volumes are not written as '{}'", path.string(), suffix),
                "use .nrrd, .nii, .nii.gz or .mha");
  const ImageFormat format = *detail::image_format(path);
  const std::int32_t side = octree.side();
  Box box{{0, 0, 0}, {side, side, side}};
  if (crop) box = bounding_box(octree).value_or(Box{{0, 0, 0}, {1, 1, 1}});
  std::array<std::int64_t, 3> size{};
  for (std::size_t i = 0; i < 3; ++i) size[i] = std::int64_t{box.max[i]} - box.min[i];
  const auto voxels = static_cast<std::uint64_t>(size[0] * size[1] * size[2]);
  if (voxels > kMostVoxels)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("{}: a volume of {} x {} x {} voxels is more than 2^33", path.string(), size[0], size[1], size[2]),
        crop ? "build the octree at a smaller depth" : "crop it to its bounding box or build it at a smaller depth");
  const Frame frame = octree.frame().shifted({box.min[0] + 0.5, box.min[1] + 0.5, box.min[2] + 0.5});
  check_geometry(path, format, frame, size);

  detail::AtomicFile file(path, suffix);
  const std::unique_ptr<std::uint8_t[]> values(new (std::nothrow) std::uint8_t[voxels]());
  if (!values)
    throw Error(ErrorCode::io,
                fmt::format("{}: a volume needs {} bytes of memory, more than there are", path.string(), voxels),
                "crop it to its bounding box or build it at a smaller depth");
  fill(octree, box, size, values.get());
  try {
    detail::write_image(file.temporary(), format, size, geometry_of(frame), values.get());
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("{}: {}", path.string(), error.what()));
  }
  file.commit();
}

}  // namespace blackleaf
