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
#include "found_pieces.h"
#include "near_field.h"
#include "near_looks.h"
#include "octree/team.h"
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
using detail::Team;
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
  Drawer(const Octree& octree, const Sight& sight, const detail::ClassBuckets& buckets)
      : sight_(sight),
        root_(detail::brick_level_root(octree)),
        blocks_(detail::level_words(octree)),
        beam_(octree, sight.beams),
        pieces_(buckets) {
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

  FoundPieces& pieces() { return pieces_; }

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
    for (const Interval& interval : visible) pieces_.add(family.line_class, family.piece(interval, b, c));
  }

  const Sight& sight_;
  Node root_;
  detail::NearBlocks blocks_;
  std::vector<detail::VisibilityWalk> walks_;
  detail::Beam beam_;
  std::array<NearField::Found, 3> found_;  // in the near field, by family
  std::array<NearEdges, 3> free_;          // the clear ones of them that nothing can hide from afar
  FoundPieces pieces_;
};

using Drawers = oneapi::tbb::enumerable_thread_specific<Drawer>;

// Buckets for all pieces of edges of the tasks: by class, about 2^bits of them.
detail::ClassBuckets buckets_of(const Families& families, const std::vector<EdgeTask>& tasks, int bits) {
  detail::ClassBuckets buckets;
  if (tasks.empty()) return buckets;
  std::array<detail::Bounds, 3> box;
  for (const EdgeTask& task : tasks) {
    const std::array<std::int64_t, 3> corner = {task.cube.x, task.cube.y, task.cube.z};
    for (std::size_t i = 0; i < 3; ++i) box[i].add(corner[i]), box[i].add(corner[i] + task.cube.side());
  }
  for (const EdgeFamily& family : families) {
    if (family.mode == EdgeFamily::Mode::end_on) continue;
    detail::Bounds keys;  // those of two families in one class are the same
    for (const std::int64_t b : {box[family.b].least, box[family.b].most})
      for (const std::int64_t c : {box[family.c].least, box[family.c].most}) keys.add(family.key(b, c));
    buckets[family.line_class] = {keys, bits};
  }
  return buckets;
}

}  // namespace

LineDrawing draw(const Octree& octree, const View& view, const Work& work) {
  const Sight sight(view.direction());
  std::vector<detail::ClassLines> classes;
  for (const EdgeFamily& family : sight.families) {
    const auto is_of_class = [&](const detail::ClassLines& of) { return of.line_class == family.line_class; };
    if (family.mode == EdgeFamily::Mode::end_on) continue;
    if (std::none_of(classes.begin(), classes.end(), is_of_class))
      classes.push_back({family.line_class, detail::PictureLines(family, view)});
  }
  LineDrawing drawing{view, {}};
  Team::with(work, [&](Team& team) {
    const std::vector<EdgeTask> tasks = detail::edge_tasks(octree, team);
    // Of a surface, a bucket has about as many pieces as there are buckets.
    const detail::ClassBuckets buckets = buckets_of(sight.families, tasks, std::clamp(octree.depth() - 2, 3, 9));
    Drawers drawers([&] { return Drawer(octree, sight, buckets); });
    team.for_each_index(tasks.size(), work, [&](std::size_t i) { drawers.local().run(tasks[i]); });
    std::vector<FoundPieces*> parts;
    for (Drawer& drawer : drawers) parts.push_back(&drawer.pieces());
    drawing.strokes = detail::strokes_of(parts, buckets, classes, team);
  });
  return drawing;
}

}  // namespace blackleaf
