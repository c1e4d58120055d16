// Drawer: the visible parts of one solid's feature edges by parallel projection.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "beam.h"
#include "edge_tasks.h"
#include "feature_edges.h"
#include "near_field.h"
#include "near_looks.h"
#include "vicinity.h"
#include "visibility.h"

namespace blackleaf::detail {

/// All that drawers share.
struct ParallelSight {
  Direction direction;
  std::array<EdgeFamily, 3> families;
  std::array<std::optional<NearLooks>, 3> looks;  // none for end-on families
  Beams beams;                                    // behind what is looked at

  explicit ParallelSight(const Direction& d)
      : direction(d), families{EdgeFamily(0, d), EdgeFamily(1, d), EdgeFamily(2, d)}, beams(d, look()) {}

 private:
  // How many times d rays go before they meet anything that is not among the looks.
  double look() {
    double until = std::numeric_limits<double>::max();
    for (const EdgeFamily& family : families)
      if (family.mode != EdgeFamily::Mode::end_on) until = std::min(until, looks[family.a].emplace(family).until());
    return until;
  }
};

/// Finds the feature edges of tasks and calls keep(family, visible, b, c) for what is visible of each: an interval of
/// positions of the edge of that family at (b, c). For one thread. What the nearest voxels hide is found for many edges
/// at once (near_field.h), what is hidden from afar one run at a time, among the nodes that can (beam.h).
template <class Keep>
class Drawer {
 public:
  /// Keep is made from the other arguments.
  template <class... Arguments>
  Drawer(const Octree& octree, const ParallelSight& sight, Arguments&&... arguments)
      : sight_(sight),
        root_(brick_level_root(octree)),
        blocks_(level_words(octree)),
        beam_(octree, sight.beams),
        keep_(std::forward<Arguments>(arguments)...) {
    for (const EdgeFamily& family : sight.families) {
      // End-on families draw nothing and are never asked; their place is held by another family's walk.
      const bool drawn = family.mode != EdgeFamily::Mode::end_on;
      walks_.emplace_back(octree, drawn ? family : sight.families[(family.a + 1) % 3]);
    }
  }

  /// Requires: a task of the same octree.
  void run(const EdgeTask& task) {
    const Cube& cube = task.cube;
    if (cube.level < NearField::kLevel) {  // so is the universe
      FeatureEdges<Drawer> edges(sight_.families, *this);
      corner_walk(task.around, cube, edges);
      return;
    }
    beam_.start(cube.level);
    walk(Vicinity(root_, cube), cube);
  }

  Keep& kept() { return keep_; }

  // A run of edges that anything can hide.
  void operator()(unsigned axis, std::int32_t a0, std::int32_t a1, std::int32_t b, std::int32_t c) {
    const EdgeFamily& family = sight_.families[axis];
    keep(family, walks_[axis].visible({a0 * family.scale, a1 * family.scale}, b, c), b, c);
  }

 private:
  // As corner_walk, down to the near fields.
  void walk(const Vicinity& vicinity, const Cube& cube) {
    const Around around = vicinity.around();
    const auto is_gray = [](const Node& node) { return node.is_gray(); };
    const auto is_like_first = [&](const Node& node) { return node.colour() == around[0].colour(); };
    const bool gray = std::any_of(around.begin(), around.end(), is_gray);
    if (!gray && std::all_of(around.begin(), around.end(), is_like_first)) return;
    if (gray && cube.level == NearField::kLevel) return look_around(vicinity, cube);
    if (!beam_.enter(cube)) return;
    if (!gray) {
      FeatureEdges<Drawer>(sight_.families, *this).uniform(cube, around);
    } else {
      for (unsigned octant = 0; octant < 8; ++octant)
        walk(vicinity.child(octant), cube.child(static_cast<int>(octant)));
    }
  }

  // The edges that begin at the corners of a near field's cube.
  void look_around(const Vicinity& vicinity, const Cube& cube) {
    NearField field(vicinity, sight_.direction, blocks_);
    if (!field.begin(sight_.families, found_) || !beam_.enter(cube)) return;
    if (!field.find(sight_.families, sight_.looks, found_)) return;
    for (NearEdges& edges : free_) edges.clear();
    const CornerCube all{0, 0, 0, NearEdges::kSide};
    for (unsigned octant = 0; octant < 8; ++octant)
      look_far(field, cube, cube.child(static_cast<int>(octant)), all.child(octant));
    for (const EdgeFamily& family : sight_.families) {
      if (!sight_.looks[family.a]) continue;
      free_[family.a].for_each_run(family.a, all, [&](const NearEdges::Corner& at, unsigned count) {
        const Edge edge(family, cube, at);
        const Interval run = edge.run(count);
        keep(family, {&run, 1}, edge.b, edge.c);
      });
    }
  }

  // What can be hidden from afar in a part of the cube, and what cannot.
  void look_far(const NearField& field, const Cube& cube, const Cube& part, const CornerCube& corners) {
    const auto any = [&](const NearField::Found& found) {
      return found.clear.any(corners) || found.partly.any(corners);
    };
    if (std::none_of(found_.begin(), found_.end(), any) || !beam_.enter(part)) return;
    const std::span<const Blocker> far = beam_.nodes();
    if (!far.empty() && part.level > 2) {
      for (unsigned octant = 0; octant < 8; ++octant)
        look_far(field, cube, part.child(static_cast<int>(octant)), corners.child(octant));
      return;
    }
    for (const EdgeFamily& family : sight_.families) {
      if (!sight_.looks[family.a]) continue;
      VisibilityWalk& walk = walks_[family.a];
      const NearField::Found& found = found_[family.a];
      const auto search = [&](const Edge& edge) {
        if (!far.empty()) walk.hide(edge.b, edge.c, far);
        keep(edge.family, walk.left(), edge.b, edge.c);
      };
      if (far.empty())
        free_[family.a].add(found.clear, corners);
      else
        found.clear.for_each_run(family.a, corners, [&](const NearEdges::Corner& at, unsigned count) {
          const Edge edge(family, cube, at);
          walk.begin(edge.run(count));
          search(edge);
        });
      found.partly.for_each(corners, [&](const NearEdges::Corner& at) {
        const Edge edge(family, cube, at);
        walk.begin(edge.run(1));
        const auto hide = [&](const NearLook& look) { return walk.hide(edge.part(look.hides)); };
        if (!field.any_of(family, *sight_.looks[family.a], found, at, hide)) search(edge);
      });
    }
  }

  // An edge, where it is.
  struct Edge {
    const EdgeFamily& family;
    std::int64_t begin, b, c;

    Edge(const EdgeFamily& f, const Cube& cube, const NearEdges::Corner& at) : family(f) {
      const std::array<std::int32_t, 3> corner = {cube.x, cube.y, cube.z};
      const auto place = [&](unsigned axis) { return corner[axis] + std::int64_t{at[axis]}; };
      begin = place(f.a) * f.scale, b = place(f.b), c = place(f.c);
    }
    Interval run(unsigned count) const { return {begin, begin + count * family.scale}; }
    Interval part(const Interval& part) const { return {begin + part.low, begin + part.high}; }
  };

  void keep(const EdgeFamily& family, std::span<const Interval> visible, std::int64_t b, std::int64_t c) {
    for (const Interval& interval : visible) keep_(family, interval, b, c);
  }

  const ParallelSight& sight_;
  Node root_;
  NearBlocks blocks_;
  std::vector<VisibilityWalk> walks_;
  Beam beam_;
  std::array<NearField::Found, 3> found_;  // in the near field, by family
  std::array<NearEdges, 3> free_;          // the clear ones of them that nothing can hide from afar
  Keep keep_;
};

}  // namespace blackleaf::detail
