// EyeWalk: which part of a run of lattice edges has a free way to the eye, or away from it. VisibilityWalk for
// perspective.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blackleaf/octree.h"
#include "eye_lines.h"
#include "visible_set.h"

namespace blackleaf::detail {

/// Serves all edges; cheap to make and to be used by one thread at a time.
class EyeWalk {
 public:
  enum class Way { to_eye, away };
  struct Interval {
    Place low, high;
  };

  /// `eye` in units of 2^-16 voxel. Requires: the octree outlives the walk; the eye is not in the closed solid.
  EyeWalk(const Octree& octree, const std::array<std::int64_t, 3>& eye, Way way = Way::to_eye);

  /// The intervals of `run` on the edge's line from which the way is free, closed; valid until the next call. Requires:
  /// not edge.end_on(); run.low < run.high; the edge lies in the universe.
  const std::vector<Interval>& visible(const EyeEdge& edge, const Interval& run);

 private:
  enum class Kind { node, brick, byte };
  // What a node spans along one axis across the edge, measured from the eye toward the edge, and the times of `high`
  // and `low`, in doubles: rounded once, never if that is not between edge and eye. Toward the eye time runs from
  // `first`, away from it from `last`.
  struct Slab {
    std::int64_t low, high;
    double last, first;
  };
  struct Time;

  Slab whole(std::int64_t at, unsigned axis) const;
  static std::array<Slab, 2> halves(const Slab& slab, std::int64_t half, double at);
  bool nothing_met(const Slab& b, const Slab& c, double first, double last) const;
  bool may_hide(std::int64_t along, std::int64_t length, double first, double last) const;
  Time first_of(std::int64_t at, const Slab& slab) const;
  Time last_of(std::int64_t at, const Slab& slab) const;
  bool subtract(std::int64_t along, std::int64_t length, const Slab* b, const Slab& c);

  template <Kind kKind>
  bool descend(int level, std::uint64_t word, std::int64_t along, const Slab& slab_b, const Slab& slab_c);
  template <Kind kKind>
  bool descend_child(int level, std::uint64_t word, unsigned octant, std::int64_t along, const Slab& slab_b,
                     const Slab& slab_c);
  bool descend_in_plane(const Node& below, const Node& above, std::int64_t plane, std::int64_t along,
                        const Slab& slab_c);

  std::array<std::int64_t, 3> eye_;
  Way way_;
  double begin_, end_;  // times that count lie between
  Node root_;
  std::array<const std::uint64_t*, kMaxDepth + 1> levels_{};
  // The edge at hand: axes, its place |X_b|, |X_c|, also as doubles, octant labels by quadrant (farthest from the
  // eye first) and along a, how much doubles may err.
  unsigned a_ = 0, b_ = 0, c_ = 0;
  std::int64_t at_b_ = 0, at_c_ = 0;
  double rough_b_ = 0, rough_c_ = 0;
  std::array<unsigned, 8> octants_{};
  double slack_ = 0;
  BasicVisibleSet<Interval> visible_;
};

}  // namespace blackleaf::detail
