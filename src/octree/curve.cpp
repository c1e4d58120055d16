#include "blackleaf/curve.h"

#include <cassert>

namespace blackleaf::curve {

Voxel voxel(int order, std::uint64_t number) {
  assert(order >= 1 && order <= kMaxDepth && number >> (3 * order) == 0);
  const Cube c = cube(order, number, 0);
  return {c.x, c.y, c.z};
}

Cube cube(int order, std::uint64_t number, int level) {
  Cube c{0, 0, 0, order};
  unsigned table = 0;
  while (c.level > level) {
    const Step step = kSteps[table][number >> (3 * (c.level - 1)) & 7];
    c = c.child(step.octant);
    table = step.table;
  }
  return c;
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
