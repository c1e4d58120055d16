// Motions that take the lattice to itself: relabelling and shifting instead of resampling.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "blackleaf/lattice.h"
#include "blackleaf/motion.h"
#include "extent.h"

namespace blackleaf::detail {

/// X' = S (X - C) + C + by, C the centre of the source's universe.
struct LatticeMove {
  LatticeSymmetry symmetry;
  std::array<std::int64_t, 3> by{};
};

/// The lattice move that does what `motion` does in a universe of the given depth, if there is one. There is when the
/// rotation is one of quarter turns and the shift is on no axis in the middle between whole numbers: moved back, a
/// voxel centre then lies inside a voxel, the one from which the nearest whole shift takes it.
std::optional<LatticeMove> lattice_move(const FixedMotion& motion, int depth);

/// The shift that makes a symmetry about the centre of a universe of the given depth one about another point. Throws
/// Error(bad_argument) unless it is whole.
std::array<std::int64_t, 3> shift_after(const LatticeSymmetry& symmetry, const Eigen::Vector3d& about, int depth);

/// The solid moved into the universe of `target`, which may only be larger than the source's by growing, with `offset`
/// already in `move.by`. What is outside is dropped.
Octree moved(const Octree& octree, const LatticeMove& move, int depth, const Frame& frame, const Work& work);

}  // namespace blackleaf::detail
