#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "beam.h"
#include "blackleaf/drawing.h"
#include "edge_tasks.h"
#include "feature_edges.h"
#include "near_field.h"
#include "near_looks.h"
#include "octree/parallel.h"
#include "piece_pool.h"
#include "sorted_pieces.h"
#include "strokes.h"
#include "vicinity.h"
#include "visibility.h"

namespace blackleaf {
namespace {

using detail::EdgeFamily;
using detail::EdgeTask;
using detail::FoundPieces;
using detail::Interval;
using detail::NearEdges;
using detail::NearField;
using detail::NearLooks;
using detail::Piece;
using Families = std::array<EdgeFamily, 3>;

// All that drawers share.
struct Sight {
  detail::Direction direction;
  Families families;
  std::array<std::optional<NearLooks>, 3> looks;  // none for end-on families
  detail::Beams beams;                            // behind what is looked at

  explicit Sight(const detail::Direction& d)
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

// Finds the feature edges of tasks and keeps what is visible of them; for one thread. What the nearest voxels hide is
// found for many edges at once (near_field.h), what is hidden from afar one run at a time, among the nodes that can
// (beam.h).
class Drawer {
 public:
  Drawer(const Octree& octree, const Sight& sight)
      : sight_(sight),
        root_(detail::brick_level_root(octree)),
        blocks_(detail::level_words(octree)),
        beam_(octree, sight.beams) {
    for (const EdgeFamily& family : sight.families) {
      // End-on families draw nothing and are never asked; their place is held by another family's walk.
      const bool drawn = family.mode != EdgeFamily::Mode::end_on;
      walks_.emplace_back(octree, drawn ? family : sight.families[(family.a + 1) % 3]);
    }
  }

  void run(const EdgeTask& task) {
    const Cube& cube = task.cube;
    if (cube.level < NearField::kLevel) {  // so is the universe
      detail::FeatureEdges<Drawer> edges(sight_.families, *this);
      detail::corner_walk(task.around, cube, edges);
      return;
    }
    beam_.start(cube.level);
    walk(detail::Vicinity(root_, cube), cube);
  }

  std::array<FoundPieces, 3>& pieces() { return pieces_; }

  // A run of edges that anything can hide.
  void operator()(unsigned axis, std::int32_t a0, std::int32_t a1, std::int32_t b, std::int32_t c) {
    const EdgeFamily& family = sight_.families[axis];
    keep(family, walks_[axis].visible({a0 * family.scale, a1 * family.scale}, b, c), b, c);
  }

 private:
  // As corner_walk, down to the near fields.
  void walk(const detail::Vicinity& vicinity, const Cube& cube) {
    const detail::Around around = vicinity.around();
    const auto is_gray = [](const Node& node) { return node.is_gray(); };
    const auto is_like_first = [&](const Node& node) { return node.colour() == around[0].colour(); };
    const bool gray = std::any_of(around.begin(), around.end(), is_gray);
    if (!gray && std::all_of(around.begin(), around.end(), is_like_first)) return;
    if (gray && cube.level == NearField::kLevel) return look_around(vicinity, cube);
    if (!beam_.enter(cube)) return;
    if (!gray) {
      detail::FeatureEdges<Drawer>(sight_.families, *this).uniform(cube, around);
    } else {
      for (unsigned octant = 0; octant < 8; ++octant)
        walk(vicinity.child(octant), cube.child(static_cast<int>(octant)));
    }
  }

  // The edges that begin at the corners of a near field's cube.
  void look_around(const detail::Vicinity& vicinity, const Cube& cube) {
    NearField field(vicinity, sight_.direction, blocks_);
    if (!field.begin(sight_.families, found_) || !beam_.enter(cube)) return;
    if (!field.find(sight_.families, sight_.looks, found_)) return;
    for (NearEdges& edges : free_) edges.clear();
    const detail::CornerCube all{0, 0, 0, NearEdges::kSide};
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
  void look_far(const NearField& field, const Cube& cube, const Cube& part, const detail::CornerCube& corners) {
    const auto any = [&](const NearField::Found& found) {
      return found.clear.any(corners) || found.partly.any(corners);
    };
    if (std::none_of(found_.begin(), found_.end(), any) || !beam_.enter(part)) return;
    const std::span<const detail::Blocker> far = beam_.nodes();
    if (!far.empty() && part.level > 2) {
      for (unsigned octant = 0; octant < 8; ++octant)
        look_far(field, cube, part.child(static_cast<int>(octant)), corners.child(octant));
      return;
    }
    for (const EdgeFamily& family : sight_.families) {
      if (!sight_.looks[family.a]) continue;
      detail::VisibilityWalk& walk = walks_[family.a];
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
        const auto hide = [&](const detail::NearLook& look) { return walk.hide(edge.part(look.hides)); };
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
    for (const Interval& interval : visible) pieces_[family.line_class].add(family.piece(interval, b, c));
  }

  const Sight& sight_;
  Node root_;
  detail::NearBlocks blocks_;
  std::vector<detail::VisibilityWalk> walks_;
  detail::Beam beam_;
  std::array<NearField::Found, 3> found_;  // in the near field, by family
  std::array<NearEdges, 3> free_;          // the clear ones of them that nothing can hide from afar
  std::array<FoundPieces, 3> pieces_;      // by line class
};

using Drawers = oneapi::tbb::enumerable_thread_specific<Drawer>;

// All pieces in order, which does not depend on who found them.
std::array<std::vector<Piece>, 3> gather(Drawers& drawers, const Work& work) {
  std::vector<std::array<FoundPieces, 3>*> parts;
  for (Drawer& drawer : drawers) parts.push_back(&drawer.pieces());
  return detail::sorted(parts, work);
}

}  // namespace

LineDrawing draw(const Octree& octree, const View& view, const Work& work) {
  const Sight sight(view.direction());
  const std::vector<EdgeTask> tasks = detail::edge_tasks(octree);
  Drawers drawers([&] { return Drawer(octree, sight); });
  detail::for_each_index(tasks.size(), work, [&](std::size_t i) { drawers.local().run(tasks[i]); });
  std::array<std::vector<Piece>, 3> pieces = gather(drawers, work);
  std::vector<detail::ClassPieces> classes;
  std::array<bool, 3> done{};  // two families can share a line class
  for (const EdgeFamily& family : sight.families) {
    if (family.mode == EdgeFamily::Mode::end_on || done[family.line_class]) continue;
    done[family.line_class] = true;
    classes.push_back({pieces[family.line_class], detail::PictureLines(family, view)});
  }
  LineDrawing drawing{view, detail::strokes_of(classes, work)};
  for (std::vector<Piece>& of_class : pieces) detail::PiecePool::give(of_class);
  return drawing;
}

}  // namespace blackleaf
