#include "io/volume_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/header_text.h"

namespace blackleaf::detail {
namespace {

std::string text(const std::vector<std::int64_t>& size) { return fmt::format("{}", fmt::join(size, " x ")); }

Frame frame_of(const ImageGeometry& geometry) {
  Frame frame;
  for (std::size_t i = 0; i < 3; ++i) {
    frame.origin[static_cast<int>(i)] = geometry.origin[i];
    frame.axes.col(static_cast<int>(i)) << geometry.axes[i][0], geometry.axes[i][1], geometry.axes[i][2];
  }
  frame.unit = geometry.unit;
  return frame;
}

// Files tell where the centre of voxel (0,0,0) is; frames start from a corner.
const Eigen::Vector3d kToCentre = Eigen::Vector3d::Constant(0.5);

}  // namespace

std::array<std::int64_t, 3> solid_size(const ImageInformation& information) {
  std::array<std::int64_t, 3> size{1, 1, 1};
  for (std::size_t i = 0; i < std::min<std::size_t>(3, information.size.size()); ++i) size[i] = information.size[i];
  return size;
}

void check_shape(const std::filesystem::path& path, const ImageInformation& information) {
  const auto& size = information.size;
  if (std::any_of(size.begin(), size.end(), [](std::int64_t side) { return side <= 0; }) || size.empty())
    refuse(path, fmt::format("has no voxels ({})", text(size)), kAgain);
  if (size.size() > 3 && std::any_of(size.begin() + 3, size.end(), [](std::int64_t side) { return side != 1; }))
    refuse(path, fmt::format("has {} dimensions ({}); a solid has three", size.size(), text(size)),
           "extract one volume of it first");
  if (information.components != 1)
    refuse(path, fmt::format("has {} values a voxel; a solid needs one", information.components),
           "extract one component first");
  if (!information.component) refuse(path, "has values that are not numbers", "convert it to numbers first");
  const Frame frame = frame_of(information.geometry);
  if (!frame.origin.allFinite() || !frame.axes.allFinite())
    refuse(path, "has an origin or axes that are not finite", "mend its header");
  // The volume of a voxel, of that of a box with edges as long.
  Eigen::Matrix3d directions = frame.axes;
  for (int i = 0; i < 3; ++i) directions.col(i) /= frame.axes.col(i).stableNorm();
  const double spanned = std::abs(directions.col(0).dot(directions.col(1).cross(directions.col(2))));
  if (!(spanned > 1e-9))  // nor is it with an axis of no length
    refuse(path, "its axes do not span space: one has no length or lies in the plane of the others", kMendHeader);
  const std::array<std::int64_t, 3> sides = solid_size(information);
  if (*std::max_element(sides.begin(), sides.end()) > std::int64_t{1} << kMaxDepth)
    refuse(path, fmt::format("is too large ({}) for any universe", text(size)), "no side may be over 2^20 voxels");
}

PlacedVolume place_volume(const std::filesystem::path& path, const ImageInformation& information, int depth,
                          bool centre) {
  const std::array<std::int64_t, 3> size = solid_size(information);
  const int least = depth_for(size);
  PlacedVolume placed;
  placed.placement.depth = depth > 0 ? depth : least;
  if (placed.placement.depth < least)
    refuse(path,
           fmt::format("its {} voxels do not fit a universe of depth {}", text({size.begin(), size.end()}), depth),
           fmt::format("use depth {} or more", least));
  const std::int64_t side = std::int64_t{1} << placed.placement.depth;
  auto& corner = placed.placement.corner;
  for (std::size_t i = 0; i < 3; ++i)
    if (centre) corner[i] = static_cast<std::int32_t>((side - size[i]) / 2);
  placed.frame = frame_of(information.geometry).shifted(-Eigen::Vector3d(corner[0], corner[1], corner[2]) - kToCentre);
  return placed;
}

std::array<std::int64_t, 3> corner_in(const std::filesystem::path& path, const ImageInformation& information,
                                      const Frame& frame) {
  const auto corner = whole_shift(frame_of(information.geometry).shifted(-kToCentre), frame);
  if (!corner)
    refuse(path, "its voxels are not those of the universe that it is to lie in, shifted by whole voxels",
           "resample it, or let it have a universe of its own");
  return *corner;
}

}  // namespace blackleaf::detail
