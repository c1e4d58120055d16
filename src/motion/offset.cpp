#include "blackleaf/offset.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "blackleaf/set_operations.h"
#include "extent.h"
#include "grow.h"
#include "octree/parallel.h"

namespace blackleaf {
namespace {

using detail::part_of;

// No two voxels of a universe are so far apart: sqrt(3) 2^20 < 2^21.
constexpr double kAll = std::int64_t{1} << 21;

void check(double radius) {
  if (!std::isfinite(radius))
    throw Error(ErrorCode::bad_argument, "the radius is not a finite number", "give it in voxels, like 2.5");
}

void check_size(double radius) {
  check(radius);
  if (radius < 0)
    throw Error(ErrorCode::bad_argument, "the radius of an opening or closing is negative", "give it without a sign");
}

// floor(radius^2), exactly. Requires: 0 <= radius <= kAll.
std::int64_t floor_of_square(double radius) {
  if (radius < 1) return 0;
  // The radius is an integer of 53 bits over 2^shift, 0 <= shift <= 52 because it is at least 1 and below 2^53.
  int exponent = 0;
  const double fraction = std::frexp(radius, &exponent);  // in [1/2, 1)
  const auto digits = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
  const int shift = 53 - exponent;
  __extension__ using Wide = unsigned __int128;
  return static_cast<std::int64_t>((Wide{digits} * digits) >> (2 * shift));
}

// A ball moves the walls of a solid's bounding box by the whole part of its radius.
detail::TargetUniverse universe_of_grown(const Octree& octree, double radius, Leaving leaving) {
  const auto box = bounding_box(octree);
  const auto reach = static_cast<std::int64_t>(radius);
  detail::Extent extent;
  for (std::size_t i = 0; i < 3; ++i) {
    extent.min[i] = (box->min[i] - reach) * (std::int64_t{1} << FixedMotion::kFractionBits);
    extent.max[i] = (box->max[i] + reach) * (std::int64_t{1} << FixedMotion::kFractionBits);
  }
  return detail::target_universe(octree.depth(), extent, leaving, {"the grown solid", "grow it by less"});
}

bool unchanged(const Octree& octree, double size) { return size < 1 || octree.is_empty(); }

// Shrinking is growing the complement, with all that is outside the universe.
Octree shrink(const Octree& octree, double size, const Work& work) {
  if (unchanged(octree, size)) return octree;
  const std::int64_t squared = floor_of_square(std::min(size, kAll));
  return complement(detail::grow({complement(octree), {}, true}, squared, octree.depth(), octree.frame(), work));
}

Octree grow(const Octree& octree, double size, Leaving leaving, const Work& work) {
  if (unchanged(octree, size)) return octree;
  size = std::min(size, kAll);
  const auto target = universe_of_grown(octree, size, leaving);
  return detail::grow({octree, target.offset, false}, floor_of_square(size), target.depth,
                      detail::grown_frame(octree.frame(), target), work);
}

}  // namespace

Octree offset(const Octree& octree, double radius, Leaving leaving, const Work& work) {
  check(radius);
  return radius < 0 ? shrink(octree, -radius, work) : grow(octree, radius, leaving, work);
}

Octree opening(const Octree& octree, double radius, const Work& work) {
  check_size(radius);
  const Octree shrunk = shrink(octree, radius, part_of(work, 0, 0.5));
  return grow(shrunk, radius, Leaving::clip, part_of(work, 0.5, 1));
}

Octree closing(const Octree& octree, double radius, const Work& work) {
  check_size(radius);
  if (unchanged(octree, radius)) return octree;
  const double size = std::min(radius, kAll);
  const auto between = universe_of_grown(octree, size, Leaving::grow);
  const std::int64_t squared = floor_of_square(size);
  const Octree grown = detail::grow({octree, between.offset, false}, squared, between.depth, {}, part_of(work, 0, 0.5));
  // Back in the solid's own universe: the rest of the one between is seen but not made.
  const std::array<std::int64_t, 3> corner = {-between.offset[0], -between.offset[1], -between.offset[2]};
  return complement(
      detail::grow({complement(grown), corner, true}, squared, octree.depth(), octree.frame(), part_of(work, 0.5, 1)));
}

}  // namespace blackleaf
