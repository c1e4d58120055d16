// Visibility: which part of a run of lattice edges has a free way to the viewer.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "beam.h"
#include "blackleaf/octree.h"
#include "edge_family.h"
#include "visible_set.h"

namespace blackleaf::detail {

/// One walker serves all runs of one family; it is cheap to make and to be used by one thread at a time.
class VisibilityWalk {
 public:
  /// Requires: the family is not end_on; the octree outlives the walk.
  VisibilityWalk(const Octree& octree, const EdgeFamily& family);

  /// The visible intervals of `run`, a part of the edges along a at (b, c) = (at_b, at_c), closed, in the family's
  /// units; valid until the next call.
  const std::vector<Interval>& visible(const Interval& run, std::int64_t at_b, std::int64_t at_c);
  /// The same step by step. Begins with a run of which all is visible.
  void begin(const Interval& run) { visible_.reset(run.low, run.high); }
  /// Takes an open interval away; true iff nothing is left.
  bool hide(const Interval& part) {
    return visible_.meets(part.low, part.high) && visible_.subtract(part.low, part.high);
  }
  /// Takes away what these nodes of the tree hide; nearest first is fastest. (Rays in lattice planes search the whole
  /// tree.)
  void hide(std::int64_t at_b, std::int64_t at_c, std::span<const Blocker> nodes);
  /// What is left, as visible() returns it.
  const std::vector<Interval>& left() const { return visible_.intervals(); }

  /// What rays meet at this time tau or later does not hide. Requires: tau >= 0.
  void stop_at(std::int64_t tau) { stop_ = tau; }

 private:
  bool search(const Blocker& blocker, std::int64_t at_b, std::int64_t at_c);
  void search_plane(std::int64_t at_b, std::int64_t at_c);

  bool search_gray(int level, std::uint64_t word, std::int64_t along, std::int64_t near_b, std::int64_t near_c);
  bool descend(int level, std::uint64_t word, std::int64_t along, std::int64_t near_b, std::int64_t near_c);
  bool search_brick(std::uint64_t word, std::int64_t along, std::int64_t near_b, std::int64_t near_c);
  bool descend_in_plane(const Node& below, const Node& above, std::int64_t at_b, std::int64_t along,
                        std::int64_t near_c);
  Interval hidden(std::int64_t along, std::int64_t length, std::int64_t enter, std::int64_t leave) const;

  const EdgeFamily& family_;
  Node root_;
  LevelWords levels_;
  std::int64_t time_b_, time_c_;         // tau that a ray needs to cross one voxel along b, along c
  unsigned near_;                        // octant label bits of the children that a ray meets first, along b and c
  std::array<unsigned, 8> octants_{};    // children in the order of visiting: nearest first, along a upward
  std::array<std::uint8_t, 16> rows_{};  // a brick's rows, likewise: the bit of the first voxel; along b, then along c
  std::uint64_t row_mask_ = 0;           // the bits of a row whose first is bit 0
  std::int64_t stop_ = std::numeric_limits<std::int64_t>::max();
  VisibleSet visible_;
};

}  // namespace blackleaf::detail
