// Universes for meshes.
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "blackleaf/error.h"
#include "blackleaf/mesh.h"
#include "rounded_up.h"
#include "surface.h"

namespace blackleaf {
namespace {

// A length that reaches a wall but for rounding counts as reaching it.
constexpr double kRounding = 1e-12;

std::string text(double value) {
  std::string digits(32, '\0');
  digits.resize(static_cast<std::size_t>(std::snprintf(digits.data(), digits.size(), "%.6g", value)));
  return digits;
}

struct Extent {
  Eigen::Vector3d centre;
  double longest;
};

// Voxels have a volume: its size must be one of floating point too.
void require_volume(double voxel_size, const std::string& why, const std::string& remedy) {
  if (!std::isnormal(voxel_size * voxel_size * voxel_size))
    throw Error(ErrorCode::bad_input, why + " makes voxels of side " + text(voxel_size) + ", beyond floating point",
                remedy);
}

Extent extent_of(const TriangleMesh& mesh) {
  detail::require_sound(mesh);
  const Eigen::AlignedBox3d box = mesh.bounding_box();
  const double longest = box.sizes().maxCoeff();
  if (!(longest > 0) || !std::isfinite(longest))
    throw Error(ErrorCode::bad_input,
                longest > 0 ? "the mesh is too large for floating point" : "the mesh has no extent",
                longest > 0 ? "scale it down" : "its vertices must not all lie at one point");
  return {box.min() + 0.5 * box.sizes(), longest};
}

MeshPlacement centred(const TriangleMesh& mesh, const Extent& extent, int depth, double voxel_size) {
  MeshPlacement placement;
  placement.depth = depth;
  placement.frame.axes = Eigen::Matrix3d::Identity() * voxel_size;
  placement.frame.origin = extent.centre.array() - std::ldexp(voxel_size, depth - 1);
  placement.frame.unit = mesh.unit;
  return placement;
}

void require_depth(int depth, int lowest) {
  if (depth < lowest || depth > kMaxDepth)
    throw Error(ErrorCode::bad_argument, "depth " + std::to_string(depth) + " is out of range",
                lowest == 0 ? "use 1 to 20, or 0 for the smallest that holds the mesh" : "use 1 to 20");
}

}  // namespace

MeshPlacement place_by_fraction(const TriangleMesh& mesh, int depth, double fraction) {
  require_depth(depth, 1);
  if (!(fraction > 0 && fraction <= 1))
    throw Error(ErrorCode::bad_argument, "fraction " + text(fraction) + " is out of range",
                "use more than 0, at most 1");
  const Extent extent = extent_of(mesh);
  const double voxel_size = std::ldexp(extent.longest / fraction, -depth);
  if (!std::isfinite(voxel_size) || !(voxel_size > 0))
    throw Error(ErrorCode::bad_argument, "fraction " + text(fraction) + " makes voxels too large for floating point",
                "use a larger fraction");
  require_volume(voxel_size, "a mesh " + text(extent.longest) + " units long", "scale the mesh");
  return centred(mesh, extent, depth, voxel_size);
}

MeshPlacement place_by_voxel_size(const TriangleMesh& mesh, double voxel_size, int depth) {
  require_depth(depth, 0);
  if (!(voxel_size > 0) || !std::isfinite(voxel_size))
    throw Error(ErrorCode::bad_argument, "voxel size " + text(voxel_size) + " is out of range",
                "use a finite size above 0");
  const Extent extent = extent_of(mesh);
  const double voxels = extent.longest / voxel_size * (1 - kRounding);
  if (depth == 0)
    for (depth = 1; depth < kMaxDepth && voxels > std::ldexp(1.0, depth);) ++depth;
  if (!(voxels <= std::ldexp(1.0, depth)))
    throw Error(ErrorCode::out_of_universe,
                "the mesh is " + text(std::fmin(extent.longest / voxel_size, std::numeric_limits<double>::max())) +
                    " voxels long but a universe of depth " + std::to_string(depth) + " has " +
                    std::to_string(std::int64_t{1} << depth),
                "use voxels of side " + detail::rounded_up(std::ldexp(extent.longest, -depth)) + " or more" +
                    (depth < kMaxDepth ? ", or a greater depth" : ""));
  require_volume(voxel_size, "the voxel size", "give one nearer to the size of the mesh");
  return centred(mesh, extent, depth, voxel_size);
}

}  // namespace blackleaf
