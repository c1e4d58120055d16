#include "blackleaf/curve.h"

#include <cassert>

namespace blackleaf::curve {

Voxel voxel(int order, std::uint64_t number) {
  const Cube c = cube(order, number, 0);
  return {c.x, c.y, c.z};
}

Cube cube(int order, std::uint64_t number, int level) {
  assert(order >= 1 && order <= kMaxDepth && level >= 0 && level <= order && number >> (3 * order) == 0);
  std::uint32_t x = 0, y = 0, z = 0;
  unsigned table = 0;
  for (int shift = 3 * (order - 1); shift >= 3 * level; shift -= 3) {
    const Step step = kSteps[table][number >> shift & 7];
    x = x << 1 | (step.octant & 1);
    y = y << 1 | (step.octant >> 1 & 1);
    z = z << 1 | step.octant >> 2;
    table = step.table;
  }
  const auto at = [level](std::uint32_t bits) { return static_cast<std::int32_t>(bits << level); };
  return {at(x), at(y), at(z), level};
}

std::uint64_t number(int order, Voxel voxel) { return first_number(order, {voxel.x, voxel.y, voxel.z, 0}); }

std::uint64_t first_number(int order, const Cube& cube) {
  assert(order >= 1 && order <= kMaxDepth && cube.level >= 0 && cube.level <= order);
  assert(((cube.x | cube.y | cube.z) & (cube.side() - 1)) == 0);
  assert(cube.x >= 0 && cube.y >= 0 && cube.z >= 0 && ((cube.x | cube.y | cube.z) >> order) == 0);
  std::uint64_t number = 0;
  unsigned table = 0;
  for (int bit = order - 1; bit >= 0; --bit) {
    if (bit < cube.level) return number << (3 * cube.level);
    const unsigned octant =
        static_cast<unsigned>((cube.x >> bit & 1) | (cube.y >> bit & 1) << 1 | (cube.z >> bit & 1) << 2);
    const Step step = kDigits[table][octant];
    number = number << 3 | step.octant;
    table = step.table;
  }
  return number;
}

}  // namespace blackleaf::curve
