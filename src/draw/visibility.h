// Visibility: which part of a run of lattice edges has a free way to the viewer.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "blackleaf/octree.h"
#include "edge_family.h"
#include "visible_set.h"

namespace blackleaf::detail {

/// One walker serves all runs of one family; it is cheap to make and to be used by one thread at a time.
class VisibilityWalk {
 public:
  /// Requires: the family is not end_on; the octree outlives the walk.
  VisibilityWalk(const Octree& octree, const EdgeFamily& family);

  /// The visible intervals of the run of edges [a0, a1] x {at_b} x {at_c}, closed, in the family's units; valid until
  /// the next call.
  const std::vector<Interval>& visible(std::int64_t a0, std::int64_t a1, std::int64_t at_b, std::int64_t at_c) {
    return visible({a0 * family_.scale, a1 * family_.scale}, at_b, at_c);
  }
  /// The same for any part of such a run, in the family's units.
  const std::vector<Interval>& visible(const Interval& run, std::int64_t at_b, std::int64_t at_c);

  /// What rays meet at this time tau or later does not hide. Requires: tau >= 0.
  void stop_at(std::int64_t tau) { stop_ = tau; }

 private:
  enum class Kind { node, brick, byte };

  template <Kind kKind>
  bool descend(int level, std::uint64_t word, std::int64_t along, std::int64_t near_b, std::int64_t near_c);
  template <Kind kKind>
  bool descend_child(int level, std::uint64_t word, unsigned octant, std::int64_t along, std::int64_t near_b,
                     std::int64_t near_c);
  bool descend_in_plane(const Node& below, const Node& above, std::int64_t at_b, std::int64_t along,
                        std::int64_t near_c);
  Interval hidden(std::int64_t along, std::int64_t length, std::int64_t enter, std::int64_t leave) const;

  const EdgeFamily& family_;
  Node root_;
  std::array<const std::uint64_t*, kMaxDepth + 1> levels_{};
  std::int64_t time_b_, time_c_;       // tau that a ray needs to cross one voxel along b, along c
  unsigned near_;                      // octant label bits of the children that a ray meets first, along b and c
  std::array<unsigned, 8> octants_{};  // children in the order of visiting: nearest first, along a upward
  std::int64_t stop_ = std::numeric_limits<std::int64_t>::max();
  VisibleSet visible_;
};

}  // namespace blackleaf::detail
