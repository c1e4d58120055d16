#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <vector>

#include "blackleaf/drawing.h"
#include "drawer.h"
#include "edge_tasks.h"
#include "found_pieces.h"
#include "octree/team.h"
#include "strokes.h"

namespace blackleaf {
namespace {

using detail::EdgeFamily;
using detail::EdgeTask;
using detail::FoundPieces;
using detail::Interval;
using detail::Team;
using Families = std::array<EdgeFamily, 3>;

// Puts pieces into their buckets.
struct KeepPieces {
  explicit KeepPieces(const detail::ClassBuckets& buckets) : pieces(buckets) {}
  void operator()(const EdgeFamily& family, const Interval& visible, std::int64_t b, std::int64_t c) {
    pieces.add(family.line_class, family.piece(visible, b, c));
  }
  FoundPieces pieces;
};

using Drawer = detail::Drawer<KeepPieces>;
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
  const detail::ParallelSight sight(view.direction());
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
    for (Drawer& drawer : drawers) parts.push_back(&drawer.kept().pieces);
    drawing.strokes = detail::strokes_of(parts, buckets, classes, team);
  });
  return drawing;
}

}  // namespace blackleaf
