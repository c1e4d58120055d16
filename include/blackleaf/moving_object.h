// MovingObject: a solid that moves again and again without wearing off (WA87, section 3).
#pragma once

#include <utility>

#include "blackleaf/motion.h"
#include "blackleaf/move.h"
#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// A compact source tree and its current motion. Moving composes motions, to 106 bits, and never touches the source; an
/// octree is computed from the source when one is asked for. So errors do not add up: a motion followed by its inverse,
/// at once or after any number of others undone in turn, gives the very same octree again, and 3,600 steps of 0.1
/// degree bring the source back, bit for bit (docs/MOTION.md has the bounds). An immutable value; copies share the
/// source.
class MovingObject {
 public:
  explicit MovingObject(Octree source, Motion motion = {}) : source_(std::move(source)), motion_(std::move(motion)) {}

  const Octree& source() const { return source_; }
  const Motion& motion() const { return motion_; }
  /// The object after a further motion: (R'R, R'T + T').
  MovingObject moved(const Motion& further) const { return MovingObject(source_, further * motion_); }
  /// The octree at the current motion. As move().
  Octree octree(Leaving leaving = Leaving::error, const Work& work = {}) const { return at(motion_, leaving, work); }
  /// The octree of the source under `motion`, whatever the current one is. As move().
  Octree at(const Motion& motion, Leaving leaving = Leaving::error, const Work& work = {}) const {
    return move(source_, motion, leaving, work);
  }

 private:
  Octree source_;
  Motion motion_;
};

}  // namespace blackleaf
