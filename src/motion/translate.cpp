// Integer translation (AN84). The paper adds the displacement to every leaf's path; here every target node reads off
// the (at most eight) source nodes of its own size that it covers, from the root down.
#include <algorithm>
#include <array>
#include <string>

#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "blackleaf/move.h"
#include "extent.h"
#include "octree/produce.h"
#include "shift_producer.h"

namespace blackleaf {

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
  std::array<std::int64_t, 3> shift{};
  for (std::size_t i = 0; i < 3; ++i) shift[i] = by[i] + target.offset[i];
  if (shift == std::array<std::int64_t, 3>{} && target.depth == octree.depth()) return octree;
  return detail::produce(detail::ShiftProducer(shift, octree, target.depth), target.depth,
                         detail::grown_frame(octree.frame(), target), work);
}

}  // namespace blackleaf
