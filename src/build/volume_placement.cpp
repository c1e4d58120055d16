#include "volume_placement.h"

#include <algorithm>
#include <string>

#include "blackleaf/error.h"

namespace blackleaf {
namespace {

std::string text(const std::array<std::int64_t, 3>& size) {
  return std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]);
}

std::string point(const std::array<std::int64_t, 3>& p) {
  return "(" + std::to_string(p[0]) + ", " + std::to_string(p[1]) + ", " + std::to_string(p[2]) + ")";
}

}  // namespace

int depth_for(const std::array<std::int64_t, 3>& size) {
  const std::int64_t longest = *std::max_element(size.begin(), size.end());
  for (int depth = 1; depth <= kMaxDepth; ++depth)
    if (longest <= std::int64_t{1} << depth) return depth;
  throw Error(ErrorCode::bad_input, "a volume that reaches to " + point(size) + " voxels does not fit any universe",
              "no side may be over 2^20 voxels");
}

namespace detail {

int checked_depth(const std::array<std::int64_t, 3>& size, const VolumePlacement& placement) {
  std::array<std::int64_t, 3> reach{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (size[i] < 1)
      throw Error(ErrorCode::bad_input, "the volume of " + text(size) + " voxels is empty",
                  "give a volume with at least one voxel along every axis");
    if (placement.corner[i] < 0 || size[i] > (std::int64_t{1} << kMaxDepth))
      throw Error(ErrorCode::bad_input,
                  "a volume of " + text(size) + " voxels at " +
                      point({placement.corner[0], placement.corner[1], placement.corner[2]}) +
                      " does not fit any universe",
                  "place it at coordinates of 0 or more, with no side over 2^20 voxels");
    reach[i] = placement.corner[i] + size[i];
  }
  if (placement.depth < 0 || placement.depth > kMaxDepth)
    throw Error(ErrorCode::bad_argument, "depth " + std::to_string(placement.depth) + " is out of range",
                "use 1 to 20, or 0 for the smallest that holds the volume");
  const int depth = placement.depth > 0 ? placement.depth : depth_for(reach);
  if (*std::max_element(reach.begin(), reach.end()) > std::int64_t{1} << depth)
    throw Error(ErrorCode::bad_input,
                "the volume reaches to " + point(reach) + " but a universe of depth " + std::to_string(depth) + " to " +
                    std::to_string(std::int64_t{1} << depth),
                "use depth " + std::to_string(depth_for(reach)) + " or leave it open");
  return depth;
}

}  // namespace detail
}  // namespace blackleaf
