// Traffic: other solids on their ways, and whether the object keeps clear of them at all times.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "world.h"

namespace blackleaf::detail {

/// The path between two times, at rest where it has not begun or has ended. Requires: from <= to.
Path part_of(const Path& path, double from, double to);

class Traffic {
 public:
  /// Throws Error(bad_argument) when a depth differs from the environment's.
  Traffic(std::span<const Mover> movers, const World& world);

  bool is_empty() const { return movers_.empty(); }
  /// When all of them have come to rest; 0 if none moves after that.
  double end() const { return end_; }
  /// The first of all times of their paths, 0 at most.
  double begin() const { return begin_; }

  /// Whether the object keeps clear of all of them from one time to a later one, on its way from one pose to another.
  /// With the margin.
  bool is_free(const Pose& from, const Pose& to) const;
  /// Whether it may rest at a pose from a time on, for good.
  bool may_rest(const Pose& pose, double from) const;
  /// The last check, at all times, at rest before and after.
  bool is_clear(const Path& path, const Work& work) const;

  /// The nearest approach to any of them at the pose's time; none if that is more than `up_to` voxels away.
  struct Near {
    std::size_t mover = 0;
    MovedDistance at;
  };
  std::optional<Near> nearest(const Pose& pose, double up_to) const;

 private:
  struct Prepared {
    PreparedSolid solid;
    Path path;
  };
  const World& world_;
  std::vector<Prepared> movers_;
  double begin_ = 0, end_ = 0;
};

}  // namespace blackleaf::detail
