// Slow, readable twin of curve.h: MHF92, sections 2.2 and 2.3, one step a level.
#pragma once

#include "blackleaf/curve.h"

namespace blackleaf::reference {

inline curve::Voxel voxel_by_steps(int order, std::uint64_t number) {
  curve::Voxel voxel;
  unsigned table = 0;
  for (int level = order - 1; level >= 0; --level) {
    const curve::Step step = curve::kSteps[table][number >> (3 * level) & 7];
    voxel.x += (step.octant & 1) << level;
    voxel.y += (step.octant >> 1 & 1) << level;
    voxel.z += (step.octant >> 2) << level;
    table = step.table;
  }
  return voxel;
}

inline std::uint64_t number_by_steps(int order, const curve::Voxel& voxel) {
  std::uint64_t number = 0;
  unsigned table = 0;
  for (int level = order - 1; level >= 0; --level) {
    const auto bit = [level](std::int32_t coordinate) { return static_cast<unsigned>(coordinate >> level & 1); };
    const curve::Step step = curve::kDigits[table][bit(voxel.x) + 2 * bit(voxel.y) + 4 * bit(voxel.z)];
    number = 8 * number + step.octant;
    table = step.table;
  }
  return number;
}

}  // namespace blackleaf::reference
