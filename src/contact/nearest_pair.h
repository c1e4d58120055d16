// NearestPair: branch and bound over pairs of nodes of two BoxTrees, b placed anyhow.
//
// Depth first, the child with the smallest lower bound first, so that a good upper bound is found at once. Lower bound
// of a pair: the larger of two distances, of the upright box from the box around the tilted one, and the other way
// round in the tilted box's frame. Bounds are lowered by more than all that rounding can add to them.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "box_pair.h"
#include "box_tree.h"

namespace blackleaf::detail {

/// More than what coordinates and distances of boxes of two trees can be off by: each comes from less than 64
/// operations of doubles of at most `size`.
inline double rounding_slop(double size) { return size * 0x1p-47; }

class NearestPair {
 public:
  /// Requires: neither tree is empty.
  NearestPair(const BoxTree& a, const BoxTree& b, const RigidMap& map_of_b);

  /// Finds leaves whose distance is the least one, if it is less than `below`; stops early at one of at most `enough`.
  /// `closed(a, b)` says whether two leaves touch or interfere where doubles cannot tell: their distance is then 0.
  /// True iff found.
  template <class Closed>
  bool find(double below, double enough, const Closed& closed) {
    best_.distance = below;
    enough_ = enough;
    found_ = false;
    visit({a_.root(), b_.root(), lower(a_.nodes[a_.root()], b_.nodes[b_.root()])}, closed);
    return found_;
  }
  const NearestPoints& best() const { return best_; }

 private:
  struct Candidate {
    std::uint32_t a, b;
    std::array<double, 2> key;  // lower bound; then squared distance of the centres
  };

  std::array<double, 2> lower(const BoxNode& a, const BoxNode& b) const;

  /// Where doubles cannot tell touching from being apart: 1e-9 voxels, or more where coordinates are large.
  double doubtful() const { return std::max(1e-9, 16 * slop_); }

  template <class Closed>
  void visit(const Candidate& pair, const Closed& closed) {
    if (found_ && best_.distance <= enough_) return;
    if (pair.key[0] >= best_.distance) return;
    const BoxNode &a = a_.nodes[pair.a], &b = b_.nodes[pair.b];
    if (a.is_leaf() && b.is_leaf()) {
      NearestPoints points = nearest_points(a, b, map_);
      if (points.distance < doubtful()) {
        if (closed(a, b))
          points.distance = 0;
        else
          points.distance = std::max(points.distance, std::numeric_limits<double>::min());
      }
      if (points.distance < best_.distance) {
        best_ = points;
        found_ = true;
      }
      return;
    }
    const bool split_a = b.is_leaf() || (!a.is_leaf() && a.radius >= b.radius);
    const BoxNode& whole = split_a ? a : b;
    std::array<Candidate, 8> below;
    std::size_t count = 0;
    for (std::uint32_t child = whole.first(); child < whole.first() + whole.count(); ++child) {
      const Candidate next = split_a ? Candidate{child, pair.b, lower(a_.nodes[child], b)}
                                     : Candidate{pair.a, child, lower(a, b_.nodes[child])};
      if (next.key[0] >= best_.distance) continue;
      std::size_t at = count++;
      for (; at > 0 && next.key < below[at - 1].key; --at) below[at] = below[at - 1];
      below[at] = next;
    }
    for (std::size_t i = 0; i < count; ++i) visit(below[i], closed);
  }

  const BoxTree &a_, &b_;
  RigidMap map_;
  std::array<std::array<double, 3>, 3> f_{}, size_{};  // the rotation by rows, and its entries' sizes
  std::array<double, 3> g_{};
  double slop_ = 0, loss_ = 0;  // of coordinates; of lower bounds
  NearestPoints best_;
  double enough_ = 0;
  bool found_ = false;
};

}  // namespace blackleaf::detail
