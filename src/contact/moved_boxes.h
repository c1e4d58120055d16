// MovedBoxes: where a motion takes the boxes of a solid, in doubles, and whether they touch others, in integers.
#pragma once

#include <optional>

#include "blackleaf/motion.h"
#include "box_pair.h"
#include "exact_boxes.h"

namespace blackleaf::detail {

class MovedBoxes {
 public:
  /// A motion beyond FixedMotion::kMaxTranslation is taken in doubles: it touches nothing.
  explicit MovedBoxes(const Motion& motion);

  /// X = F y + g is the exact inverse of FixedMotion's (A X + b) / 2^38, rounded to doubles.
  const RigidMap& map() const { return map_; }
  /// True iff the closed boxes share a point: the upright `a` and `b` moved.
  bool touch(const BoxNode& a, const BoxNode& b) const;

 private:
  RigidMap map_;
  std::optional<ExactBoxes> exact_;
};

}  // namespace blackleaf::detail
