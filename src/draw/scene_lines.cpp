// Lines of scenes. Every feature edge of every solid is found as in draw.cpp; its visible parts are what the union of
// all solids does not hide. Then
//   - outlines: what of a visible part is also seen from behind within the gap, by the same search with -d;
//   - hidden lines: all feature edges, as pieces of the lowest rank.
// Each piece has the rank of its kind and solid, and by_rank (priority.h) lets the first pen have each place.
#include <cmath>
#include <optional>

#include "blackleaf/error.h"
#include "blackleaf/scene.h"
#include "edge_tasks.h"
#include "feature_edges.h"
#include "octree/parallel.h"
#include "priority.h"
#include "strokes.h"
#include "visibility.h"

namespace blackleaf {
namespace {

using detail::EdgeChoice;
using detail::EdgeFamily;
using detail::Interval;
using Families = std::array<EdgeFamily, 3>;
using Ranked = detail::RankedPiece<std::int64_t, std::int64_t>;
using Pieces = std::array<std::vector<Ranked>, 3>;  // by line class

struct SolidTask {
  std::size_t solid = 0;
  detail::EdgeTask edges;
  Pieces pieces;
};

Families families_of(const detail::Direction& d) { return {EdgeFamily(0, d), EdgeFamily(1, d), EdgeFamily(2, d)}; }

// Finds the pieces of one task.
class SceneDrawer {
 public:
  SceneDrawer(const Scene& scene, const detail::Direction& d, const SceneOptions& options)
      : scene_(scene), options_(options), families_(families_of(d)), backward_(families_of({-d[0], -d[1], -d[2]})) {
    const double length = std::sqrt(static_cast<double>(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
    for (std::size_t i = 0; i < 3; ++i) {
      // End-on families draw nothing and are never asked; their place is held by another family's walk.
      const std::size_t k = families_[i].mode == EdgeFamily::Mode::end_on ? (i + 1) % 3 : i;
      walks_.emplace_back(scene.all(), families_[k]);
      backward_walks_.emplace_back(scene.all(), backward_[k]);
      backward_walks_.back().stop_at(backward_[k].time_of(options.outline_gap / length));
    }
  }

  void run(SolidTask& task) {
    task_ = &task;
    const bool alone = scene_.solids().size() == 1;
    ask_ = true;
    walk(alone ? EdgeChoice::candidates : EdgeChoice::not_blocked_at_once);
    ask_ = false;
    if (options_.hidden) walk(EdgeChoice::all);
  }

  void operator()(unsigned axis, std::int32_t a0, std::int32_t a1, std::int32_t b, std::int32_t c) {
    const EdgeFamily& family = families_[axis];
    if (!ask_) return add(family, LineKind::hidden, {a0 * family.scale, a1 * family.scale}, b, c);
    for (const Interval& visible : walks_[axis].visible(a0, a1, b, c)) {
      add(family, LineKind::visible, visible, b, c);
      if (!options_.outline) continue;
      for (const Interval& outline : backward_walks_[axis].visible(visible, b, c))
        add(family, LineKind::outline, outline, b, c);
    }
  }

 private:
  void walk(EdgeChoice choice) {
    detail::FeatureEdges<SceneDrawer> edges(families_, *this, choice);
    detail::corner_walk(task_->edges.around, task_->edges.cube, edges);
  }

  void add(const EdgeFamily& family, LineKind kind, const Interval& where, std::int32_t b, std::int32_t c) {
    const detail::Piece piece = family.piece(where, b, c);
    const std::size_t rank = static_cast<std::size_t>(kind) * scene_.solids().size() + task_->solid;
    task_->pieces[family.line_class].push_back({piece.key, piece.low, piece.high, static_cast<std::uint32_t>(rank)});
  }

  const Scene& scene_;
  const SceneOptions& options_;
  Families families_, backward_;
  std::vector<detail::VisibilityWalk> walks_, backward_walks_;
  SolidTask* task_ = nullptr;
  bool ask_ = true;  // whether edges are to be looked at, or taken as they are
};

// The pieces of all tasks of one line class, sorted.
std::vector<Ranked> gather(std::vector<SolidTask>& tasks, std::size_t line_class, const Work& work) {
  std::vector<Ranked> all;
  std::size_t count = 0;
  for (const SolidTask& task : tasks) count += task.pieces[line_class].size();
  all.reserve(count);
  for (SolidTask& task : tasks) {
    std::vector<Ranked>& pieces = task.pieces[line_class];
    all.insert(all.end(), pieces.begin(), pieces.end());
    std::vector<Ranked>().swap(pieces);
  }
  detail::sort(all, work);
  return all;
}

}  // namespace

std::vector<SceneLines> draw(const Scene& scene, const View& view, const SceneOptions& options, const Work& work) {
  if (!(options.outline_gap > 0))
    throw Error(ErrorCode::bad_argument, "the gap behind outlines is not above zero", "give a number of voxels");
  const std::size_t solids = scene.solids().size();
  if (solids == 1 && options.visible && !options.hidden && !options.outline) {
    LineDrawing drawing = draw(scene.solids()[0], view, work);
    std::vector<SceneLines> lines;
    if (!drawing.strokes.empty()) lines.push_back({0, LineKind::visible, std::move(drawing.strokes)});
    return lines;
  }
  std::vector<SolidTask> tasks;
  for (std::size_t solid = 0; solid < solids; ++solid)
    for (const detail::EdgeTask& edges : detail::edge_tasks(scene.solids()[solid])) tasks.push_back({solid, edges, {}});
  const detail::Direction& d = view.direction();
  detail::for_each_index(tasks.size(), work, [&](std::size_t i) { SceneDrawer(scene, d, options).run(tasks[i]); });

  const std::size_t kinds = 3;
  std::vector<std::vector<Stroke>> by_rank(kinds * solids);
  std::array<bool, 3> done{};  // two families can share a line class
  for (const EdgeFamily& family : families_of(d)) {
    if (family.mode == EdgeFamily::Mode::end_on || done[family.line_class]) continue;
    done[family.line_class] = true;
    const detail::PictureLines picture(family, view);
    detail::by_rank(gather(tasks, family.line_class, work),
                    [&](std::int64_t key, std::int64_t low, std::int64_t high, std::uint32_t rank) {
                      const Stroke stroke{picture.point(key, low), picture.point(key, high)};
                      if (stroke.from != stroke.to) by_rank[rank].push_back(stroke);
                    });
  }
  std::vector<SceneLines> lines;
  for (std::size_t rank = 0; rank < by_rank.size(); ++rank) {
    const auto kind = static_cast<LineKind>(rank / solids);
    if (by_rank[rank].empty() || (kind != LineKind::hidden && !options.visible)) continue;
    lines.push_back({rank % solids, kind, std::move(by_rank[rank])});
  }
  return lines;
}

}  // namespace blackleaf
