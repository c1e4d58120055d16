// LatticeLabels: what a lattice symmetry does to octant labels, masks of octants and bricks, by tables.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "blackleaf/lattice.h"
#include "octree/brick.h"

namespace blackleaf::detail {

/// For RelabelledCopy (relabelled.h).
class LatticeLabels {
 public:
  static constexpr bool kSame = false;

  explicit LatticeLabels(const LatticeSymmetry& symmetry) {
    for (unsigned octant = 0; octant < 8; ++octant)
      source_[symmetry.octant(octant)] = static_cast<std::uint8_t>(octant);
    for (unsigned mask = 0; mask < 256; ++mask)
      for (unsigned octant = 0; octant < 8; ++octant)
        octants_[mask] = static_cast<std::uint8_t>(octants_[mask] | (mask >> source_[octant] & 1u) << octant);
    // A brick's index has two bits of each coordinate: axes change places by exchanging bits of the index, and a
    // coordinate is reversed by exchanging the voxels that differ in one of its bits.
    std::array<int, 3> axes = {0, 1, 2};
    for (unsigned i = 0; i < 2; ++i)
      for (unsigned j = i + 1; j < 3; ++j)
        if (axes[j] == symmetry.source(static_cast<int>(i))) {
          std::swap(axes[i], axes[j]);
          for (const unsigned level : {0u, 3u}) exchange(1u << (i + level), 1u << (j + level));
        }
    for (unsigned i = 0; i < 3; ++i)
      if (symmetry.reversed(static_cast<int>(i)))
        for (const unsigned level : {0u, 3u}) exchange(0, 1u << (i + level));
  }

  unsigned octants(unsigned mask) const { return octants_[mask]; }
  unsigned source(unsigned octant) const { return source_[octant]; }
  std::uint64_t brick(std::uint64_t bits) const {
    for (std::size_t i = 0; i < count_; ++i) bits = exchange_bits(bits, steps_[i].shift, steps_[i].mask);
    return bits;
  }

 private:
  struct Step {
    unsigned shift = 0;
    std::uint64_t mask = 0;
  };

  // Exchanges the voxels whose index has `lower` and not `upper` with those that have it the other way round.
  void exchange(unsigned lower, unsigned upper) {
    Step& step = steps_[count_++];
    step.shift = upper - lower;
    for (unsigned bit = 0; bit < 64; ++bit)
      if ((bit & lower) == lower && (bit & upper) == 0) step.mask |= std::uint64_t{1} << bit;
  }

  std::array<std::uint8_t, 8> source_{};     // by the target's octant
  std::array<std::uint8_t, 256> octants_{};  // by the source's mask
  std::array<Step, 10> steps_{};             // at most two exchanges of axes and three reversals, on two levels
  std::size_t count_ = 0;
};

}  // namespace blackleaf::detail
