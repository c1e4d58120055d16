// Motions and set operations that many ranks compute together. Every rank has the sources whole; the target's curve is
// cut by estimated work (produce_part.h). docs/MPI.md.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "blackleaf/lattice.h"
#include "blackleaf/motion.h"
#include "blackleaf/move.h"
#include "blackleaf/octree.h"
#include "blackleaf/work.h"
#include "ranks.h"
#include "shared_file.h"

namespace blackleaf::mpi {

/// What move(transform(octree, reflection), motion, leaving) gives. A meeting.
SharedOctree move(Ranks& ranks, const Octree& octree, const LatticeSymmetry& reflection, const Motion& motion,
                  Leaving leaving, const Work& work);

/// What translate() gives. A meeting.
SharedOctree translate(Ranks& ranks, const Octree& octree, const std::array<std::int64_t, 3>& by, Leaving leaving,
                       const Work& work);

/// A set operation: white voxels of all operands stay white.
using Operation = Octree (*)(std::span<const Octree>, const Work&);

/// What `operation` gives of some octrees of one depth: each rank takes their parts in one stretch. A meeting.
SharedOctree combine(Ranks& ranks, std::span<const Octree> octrees, Operation operation, const Work& work);

}  // namespace blackleaf::mpi
