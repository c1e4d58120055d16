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
  /// `closed(a, b, distance)` says whether two leaves touch or interfere where doubles cannot tell, at the distance
  /// that they make of it; it is then 0.
  /// True iff found.
  template <class Closed>
  bool find(double below, double enough, const Closed& closed) {
    know(below);
    enough_ = enough;
    found_ = false;
    visit({a_.root(), b_.root(), {}}, closed);
    return found_;
  }
  const NearestPoints& best() const { return best_; }

 private:
  /// Squared lower bound of the distance of two nodes, before `loss_` is taken off; squared distance of their centres.
  using Key = std::array<double, 2>;
  using Bounds = std::array<Key, 8>;  // of the children of a node
  struct Candidate {
    std::uint32_t a, b;
    Key key;
  };

  /// Of `count` neighbours from `first` on, nodes of a, with a node of b; and the other way round.
  void bounds_of_a(const BoxNode* first, std::size_t count, const BoxNode& b, Bounds& bounds) const;
  void bounds_of_b(const BoxNode& a, const BoxNode* first, std::size_t count, Bounds& bounds) const;

  /// A lower bound by the planes of the nodes, at most what they are apart along the normals; before `loss_`.
  double plane_gap(const BoxNode& a, const BoxNode& b) const;

  /// No pair whose squared lower bound is as much is nearer than what is known.
  void know(double distance) {
    best_.distance = distance;
    hopeless_ = (distance + loss_) * (distance + loss_);
  }

  /// Where doubles cannot tell touching from being apart: 1e-9 voxels, or more where coordinates are large.
  double doubtful() const { return std::max(1e-9, 16 * slop_); }

  template <class Closed>
  void visit(const Candidate& pair, const Closed& closed) {
    if (found_ && best_.distance <= enough_) return;
    if (pair.key[0] >= hopeless_) return;
    const BoxNode &a = a_.nodes[pair.a], &b = b_.nodes[pair.b];
    if ((a.has_plane() || b.has_plane()) && plane_gap(a, b) - loss_ >= best_.distance) return;
    if (a.is_leaf() && b.is_leaf()) {
      NearestPoints points = nearest_points(a, b, map_);
      if (points.distance < doubtful())
        points.distance =
            closed(a, b, points.distance) ? 0 : std::max(points.distance, std::numeric_limits<double>::min());
      if (points.distance < best_.distance) {
        best_ = points;
        know(points.distance);
        found_ = true;
      }
      return;
    }
    const bool split_a = b.is_leaf() || (!a.is_leaf() && a.radius >= b.radius);
    const BoxNode& whole = split_a ? a : b;
    const std::uint32_t first = whole.first();
    Bounds bounds;
    if (split_a)
      bounds_of_a(&a_.nodes[first], whole.count(), b, bounds);
    else
      bounds_of_b(a, &b_.nodes[first], whole.count(), bounds);
    std::array<Candidate, 8> below;
    std::size_t count = 0;
    for (std::uint32_t child = 0; child < whole.count(); ++child) {
      const Candidate next{split_a ? first + child : pair.a, split_a ? pair.b : first + child, bounds[child]};
      if (next.key[0] >= hopeless_) continue;
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
  double enough_ = 0, hopeless_ = 0;
  bool found_ = false;
};

}  // namespace blackleaf::detail
