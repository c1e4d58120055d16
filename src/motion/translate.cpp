// Integer translation (AN84). The paper adds the displacement to every leaf's path; here every target node reads off
// the (at most eight) source nodes of its own size that it covers, from the root down. Where the displacement is a
// multiple of a node's side it covers exactly one, which is what the paper's lowest set bit H expresses.
#include <array>
#include <string>

#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "blackleaf/move.h"
#include "extent.h"
#include "octree/brick.h"
#include "window_producer.h"

namespace blackleaf {
namespace {

using detail::CellRange;
using detail::SourceWindow;

// Voxels of a brick by their coordinate along an axis: kPlanes[axis][c].
constexpr auto kPlanes = [] {
  std::array<std::array<std::uint64_t, 4>, 3> planes{};
  for (unsigned bit = 0; bit < 64; ++bit) {
    planes[0][detail::brick_x(bit)] |= std::uint64_t{1} << bit;
    planes[1][detail::brick_y(bit)] |= std::uint64_t{1} << bit;
    planes[2][detail::brick_z(bit)] |= std::uint64_t{1} << bit;
  }
  return planes;
}();

// The brick that begins `by` voxels (0..3) up an axis from `low` and runs into `high`, its upper neighbour.
std::uint64_t between(std::uint64_t low, std::uint64_t high, unsigned axis, unsigned by) {
  std::uint64_t result = 0;
  for (unsigned to = 0; to < 4; ++to) {
    const unsigned from = (to + by) % 4;
    const std::uint64_t plane = (to + by < 4 ? low : high) & kPlanes[axis][from];
    const unsigned at = static_cast<unsigned>(detail::kSpread[from]) << axis;
    const unsigned target = static_cast<unsigned>(detail::kSpread[to]) << axis;
    result |= at >= target ? plane >> (at - target) : plane << (target - at);
  }
  return result;
}

struct Shift {
  static constexpr int kWidth = 2;

  std::array<std::int64_t, 3> by{};  // target = source + by

  CellRange cells(const Cube& cube) const {
    const std::array<std::int64_t, 3> corner = {cube.x, cube.y, cube.z};
    CellRange range;
    for (std::size_t i = 0; i < 3; ++i) {
      range.low[i] = (corner[i] - by[i]) >> cube.level;
      range.high[i] = (corner[i] - by[i] + cube.side() - 1) >> cube.level;
    }
    return range;
  }

  std::uint64_t brick(const SourceWindow<kWidth>& window, const Cube& cube) const {
    const CellRange range = cells(cube);
    const std::array<unsigned, 3> start = {static_cast<unsigned>((cube.x - by[0]) & 3),
                                           static_cast<unsigned>((cube.y - by[1]) & 3),
                                           static_cast<unsigned>((cube.z - by[2]) & 3)};
    std::array<std::uint64_t, 8> bricks{};
    for (unsigned i = 0; i < 8; ++i)
      bricks[i] = window
                      .node(i & 1 ? range.high[0] : range.low[0], i & 2 ? range.high[1] : range.low[1],
                            i & 4 ? range.high[2] : range.low[2])
                      .brick();
    for (unsigned axis = 0; axis < 3; ++axis)
      for (unsigned i = 0; i < 8u >> (axis + 1); ++i)
        bricks[i] = between(bricks[2 * i], bricks[2 * i + 1], axis, start[axis]);
    return bricks[0];
  }
};

}  // namespace

Octree translate(const Octree& octree, const std::array<std::int64_t, 3>& by, Leaving leaving, const Work& work) {
  const auto box = bounding_box(octree);
  if (!box) return octree;
  constexpr std::int64_t kFar = std::int64_t{1} << (kMaxDepth + 2);
  detail::Extent extent;
  bool far = false;
  std::string sides;
  for (std::size_t i = 0; i < 3; ++i) {
    // Beyond kFar everything is outside whatever the universe; keep the fixed-point numbers small.
    const std::int64_t shift = std::clamp(by[i], -kFar, kFar);
    far = far || shift != by[i];
    if (shift != by[i])
      sides += (sides.empty() ? "" : ", ") + ("more than " + std::to_string(kFar)) + " voxels along " +
               (by[i] < 0 ? '-' : '+') + static_cast<char>('x' + i);
    extent.min[i] = (box->min[i] + shift) * (std::int64_t{1} << FixedMotion::kFractionBits);
    extent.max[i] = (box->max[i] + shift) * (std::int64_t{1} << FixedMotion::kFractionBits);
  }
  if (far && leaving != Leaving::clip)
    throw Error(ErrorCode::out_of_universe, "the moved solid leaves every universe: it is moved by " + sides,
                leaving == Leaving::error ? "move it less or clip it (--clip)" : "move it less");
  const auto target = detail::target_universe(octree.depth(), extent, leaving);
  if (far) return Octree(octree.depth(), Colour::white, octree.frame());
  Shift shift;
  for (std::size_t i = 0; i < 3; ++i) shift.by[i] = by[i] + target.offset[i];
  return detail::produce(detail::WindowProducer(shift, octree, target.depth), target.depth,
                         detail::grown_frame(octree.frame(), target), work);
}

}  // namespace blackleaf
