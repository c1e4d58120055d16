// Beam: the nodes that can hide something of a cube of edges, found on the way down to the cube.
//
// The points of a closed cube P = [p, p + s]^3 sweep, along the view direction d, the beam P + t d, t > t0 >= 0. A node
// N = [n, n + m]^3 can hide some of P then only if its inside meets the beam: if for some t > t0 along every axis
//   n < p + s + t d   and   p + t d < n + m.
// It hides all of P if one step t d takes the whole of P inside it:
//   n < p + t d   and   p + s + t d < n + m.
// Both are intervals of t. The nodes that meet the beam of a cube are among those that meet the beam of a larger one,
// so each step down splits the gray ones and sorts out; what hides all of P ends the list, and the search for P.
//
// Times are doubles, rounded so that a node which meets the beam is never left out and one that hides all surely does:
// who asks the nodes decides exactly (visibility.h), so the rounding shows in the work done and not in the answer.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "blackleaf/octree.h"
#include "edge_family.h"
#include "octree/node_arrays.h"

namespace blackleaf::detail {

/// A black or gray node and where it stands.
struct Blocker {
  Node node;
  std::int32_t x, y, z;
};

/// Beams of any cubes along d.
class Beams {
 public:
  /// Of what rays meet after `from` times d. Requires: from >= 0.
  Beams(const Direction& d, double from) : from_(from / kCertain) {
    for (unsigned i = 0; i < 3; ++i) {
      sign_[i] = d[i] < 0 ? -1 : 1;
      // Along an axis on which d does not move, what is beside the cube is reached at a time beyond all others.
      pace_[i] = d[i] == 0 ? kNever : 1.0 / static_cast<double>(std::abs(d[i]));
    }
  }

  // An interval of times.
  struct Times {
    double enter, leave;
    bool any() const { return enter < leave * kCertain; }
    bool surely() const { return enter * kCertain < leave; }
    friend Times both(const Times& s, const Times& t) {
      return {s.enter < t.enter ? t.enter : s.enter, t.leave < s.leave ? t.leave : s.leave};
    }
  };
  /// When the cube's middle comes closer than `reach` along an axis to what is so far from it, counted along d.
  /// Distances are exact and rounded once, with their time.
  Times within(double reach, double distance, unsigned axis) const {
    return {(distance - reach) * pace_[axis], (distance + reach) * pace_[axis]};
  }
  /// The same along all axes, of a distance in space, and after t0.
  Times within(double reach, const std::array<double, 3>& distance) const {
    const auto of = [&](unsigned axis) { return within(reach, along(distance[axis], axis), axis); };
    return both(both(after(), of(0)), both(of(1), of(2)));
  }
  Times after() const { return {from_, kNever * kNever}; }
  double along(double distance, unsigned axis) const { return distance * sign_[axis]; }
  int sign(unsigned axis) const { return sign_[axis] < 0 ? -1 : 1; }
  bool moves(unsigned axis) const { return pace_[axis] != kNever; }

 private:
  static constexpr double kNever = 1e30, kCertain = 1 + 1e-14;

  double from_;
  std::array<double, 3> sign_{}, pace_{};  // of d_i; 1 / |d_i|
};

class Beam {
 public:
  /// Requires: the octree and the beams outlive it.
  Beam(const Octree& octree, const Beams& beams) : beams_(beams), root_(brick_level_root(octree)) {
    for (unsigned axis = 0; axis < 3; ++axis)
      if (beams.sign(axis) < 0) near_ |= 1u << axis;
  }

  /// Begins with the whole tree; the next cube to enter is of this level. Requires: level >= 1.
  void start(int level) {
    nodes_.clear();
    begin_[static_cast<std::size_t>(level) + 1] = 0;
    if (!root_.is_white()) nodes_.push_back({root_, 0, 0, 0});
    begin_[static_cast<std::size_t>(level)] = nodes_.size();
  }

  /// Narrows the beam to a cube; false iff all of it is hidden. Requires: start(cube.level), or the last cube entered
  /// of the level above holds this one and was not hidden.
  bool enter(const Cube& cube) {
    half_ = 0.5 * cube.side(), level_ = cube.level;
    middle_ = {cube.x + half_, cube.y + half_, cube.z + half_};
    const auto level = static_cast<std::size_t>(level_);
    first_ = begin_[level];
    nodes_.resize(first_);
    for (std::size_t i = begin_[level + 1]; i < first_; ++i) {
      const Blocker larger = nodes_[i];
      if (sort_out(larger)) return false;
    }
    begin_[level - 1] = nodes_.size();
    return true;
  }

  /// What can hide something of the cube entered last, nearest first: no gray node is larger than the cube unless there
  /// are very many.
  std::span<const Blocker> nodes() const { return std::span(nodes_).subspan(first_); }

 private:
  static constexpr std::size_t kMany = 64;  // a longer list is not refined: its gray nodes stay as they are

  using Times = Beams::Times;

  static double half_of(const Node& node) { return 0.5 * static_cast<double>(std::int64_t{1} << node.level()); }
  // From the cube's middle to the node's.
  std::array<double, 3> distance(const Blocker& b) const {
    const double half = half_of(b.node);
    return {b.x + half - middle_[0], b.y + half - middle_[1], b.z + half - middle_[2]};
  }

  bool meets(const Blocker& b) const { return beams_.within(half_of(b.node) + half_, distance(b)).any(); }
  // Requires: the node is larger than the cube.
  bool hides_all(const Blocker& b) const {
    const double reach = half_of(b.node) - half_;
    const auto between = distance(b);
    for (unsigned axis = 0; axis < 3; ++axis)  // beside the cube for ever
      if (!beams_.moves(axis) && std::abs(between[axis]) >= reach) return false;
    return beams_.within(reach, between).surely();
  }

  // Takes over a node of the larger cube's list, or what of it meets the beam; true iff it hides everything.
  bool sort_out(const Blocker& b) {
    if (!meets(b)) return false;
    if (b.node.is_gray() && b.node.level() > level_ && nodes_.size() - first_ < kMany) return split(b);
    nodes_.push_back(b);
    return b.node.is_black() && b.node.level() > level_ && hides_all(b);
  }

  bool split(const Blocker& b) {
    const int below = b.node.level() - 1;
    const std::int32_t side = std::int32_t{1} << below;
    const double half = 0.5 * side, reach = half + half_;
    std::array<std::array<Times, 2>, 3> times;
    const std::array<std::int32_t, 3> corner = {b.x, b.y, b.z};
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double lower = corner[axis] + half - middle_[axis];
      times[axis] = {beams_.within(reach, beams_.along(lower, axis), axis),
                     beams_.within(reach, beams_.along(lower + side, axis), axis)};
    }
    for (Times& x : times[0]) x = both(x, beams_.after());
    std::array<Times, 4> of_quadrant;
    for (unsigned q = 0; q < 4; ++q) of_quadrant[q] = both(times[1][q & 1], times[2][q >> 1]);
    const std::uint64_t word = b.node.word();
    const auto there = static_cast<unsigned>((word | word >> 8) & 0xFF);
    for (unsigned i = 0; i < 8; ++i) {
      const unsigned octant = i ^ near_;
      const Times t = both(times[0][octant & 1], of_quadrant[octant >> 1]);
      if (!(there >> octant & 1) || !t.any()) continue;
      const Blocker child{b.node.child(static_cast<int>(octant)), b.x + (octant & 1 ? side : 0),
                          b.y + (octant & 2 ? side : 0), b.z + (octant & 4 ? side : 0)};
      if (child.node.is_gray() && below > level_) {
        if (split(child)) return true;
      } else {
        nodes_.push_back(child);
        if (child.node.is_black() && below > level_ && hides_all(child)) return true;
      }
    }
    return false;
  }

  const Beams& beams_;
  Node root_;
  unsigned near_ = 0;               // the octant that d reaches first
  std::array<double, 3> middle_{};  // of the cube
  double half_ = 0;                 // of its side
  int level_ = 0;
  std::vector<Blocker> nodes_;  // the whole tree, then for each cube on the way down what its beam meets
  std::array<std::size_t, kMaxDepth + 2> begin_{};  // where in it, by level of the cube
  std::size_t first_ = 0;                           // and those of the cube entered last
};

}  // namespace blackleaf::detail
