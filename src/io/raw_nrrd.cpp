#include "io/raw_nrrd.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "io/image_io.h"

namespace blackleaf::detail {
namespace {

constexpr std::uint64_t kBytesAtOnce = std::uint64_t{16} << 20;

std::string header_of(const Frame& universe, const Box& box) {
  // Files tell where the centre of the first voxel is.
  const Frame frame = universe.shifted({box.min[0] + 0.5, box.min[1] + 0.5, box.min[2] + 0.5});
  const auto vector = [](const Eigen::Vector3d& v) { return fmt::format("({},{},{})", v[0], v[1], v[2]); };
  return fmt::format(
      "NRRD0004\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\nsizes: {} {} {}\n"
      "space directions: {} {} {}\nkinds: domain domain domain\nencoding: raw\nspace origin: {}\n\n",
      box.max[0] - box.min[0], box.max[1] - box.min[1], box.max[2] - box.min[2], vector(frame.axes.col(0)),
      vector(frame.axes.col(1)), vector(frame.axes.col(2)), vector(frame.origin));
}

// Sets the black voxels of a node that lie in the box.
void fill(const Node& node, const Cube& cube, const Box& box, std::uint8_t* values) {
  std::array<std::int32_t, 3> low = {cube.x, cube.y, cube.z}, high{};
  for (std::size_t i = 0; i < 3; ++i) {
    high[i] = std::min(low[i] + cube.side(), box.max[i]);
    low[i] = std::max(low[i], box.min[i]);
    if (low[i] >= high[i]) return;
  }
  if (node.is_white()) return;
  if (node.is_gray()) {
    for (int octant = 0; octant < 8; ++octant) fill(node.child(octant), cube.child(octant), box, values);
    return;
  }
  const std::int64_t width = box.max[0] - box.min[0], rows = box.max[1] - box.min[1];
  for (std::int64_t z = low[2]; z < high[2]; ++z)
    for (std::int64_t y = low[1]; y < high[1]; ++y)
      std::memset(values + ((z - box.min[2]) * rows + (y - box.min[1])) * width + (low[0] - box.min[0]), 1,
                  static_cast<std::size_t>(high[0] - low[0]));
}

}  // namespace

RawNrrd::RawNrrd(const Octree& octree, const std::filesystem::path& path, bool crop) : octree_(octree) {
  if (image_suffix(path) != ".nrrd")
    throw Error(ErrorCode::bad_argument, fmt::format("{}: raw values are written to .nrrd only", path.string()),
                "name it *.nrrd");
  const Frame& frame = octree.frame();
  if (!frame.origin.allFinite() || !frame.axes.allFinite() || frame.axes.colwise().norm().minCoeff() <= 0)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("{}: the octree's frame has numbers that are not finite or an axis without length", path.string()));
  const std::int32_t side = octree.side();
  box_ = crop ? bounding_box(octree).value_or(Box{{0, 0, 0}, {1, 1, 1}}) : Box{{0, 0, 0}, {side, side, side}};
  header_ = header_of(frame, box_);
}

std::uint64_t RawNrrd::slice_bytes() const {
  return static_cast<std::uint64_t>(box_.max[0] - box_.min[0]) * static_cast<std::uint64_t>(box_.max[1] - box_.min[1]);
}

std::int64_t RawNrrd::slices() const { return box_.max[2] - box_.min[2]; }

void RawNrrd::values(std::int64_t first, std::int64_t last, std::uint8_t* values) const {
  Box slab = box_;
  slab.min[2] = static_cast<std::int32_t>(box_.min[2] + first);
  slab.max[2] = static_cast<std::int32_t>(box_.min[2] + last);
  std::memset(values, 0, slice_bytes() * static_cast<std::uint64_t>(last - first));
  fill(octree_.root(), octree_.universe(), slab, values);
}

void RawNrrd::write_slices(std::int64_t first, std::int64_t last, const Write& write) const {
  const auto at_once = static_cast<std::int64_t>(std::max<std::uint64_t>(1, kBytesAtOnce / slice_bytes()));
  std::vector<std::uint8_t> slab(slice_bytes() * static_cast<std::uint64_t>(std::min(at_once, last - first)));
  for (std::int64_t z = first; z < last; z += at_once) {
    const std::int64_t end = std::min(z + at_once, last);
    values(z, end, slab.data());
    write(header_.size() + slice_bytes() * static_cast<std::uint64_t>(z),
          std::span(slab).first(slice_bytes() * static_cast<std::uint64_t>(end - z)));
  }
}

}  // namespace blackleaf::detail
