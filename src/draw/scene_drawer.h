// Lines of scenes, under any projection. Every feature edge of every solid is found; its visible parts are what the
// union of all solids does not hide. Then
//   - outlines: what of a visible part is not hidden from behind either, by the same search the other way;
//   - hidden lines: all feature edges, as pieces of the lowest rank.
// Each piece has the rank of its kind and solid, and by_rank (priority.h) lets the first pen have each place.
//
// A projection has
//   Ranked                              the RankedPiece of its picture lines
//   kLineClasses                        how many classes of picture lines it has
//   stroke(line_class, key, low, high)  a piece of a picture line as a Stroke
//   Sight                               made from (projection, scene, options), for one thread at a time:
//     find(choice, edges, sink)         calls sink(axis, a0, a1, b, c) for runs of feature edges of a task
//     edge(axis, b, c), run(edge, a0, a1)   what it calls such a run: an edge, and an interval on it, empty if out of
//                                       view
//     visible(edge, interval)           the visible intervals, valid until the next call
//     find_visible(edges, sink)         of the only solid there is: if true, it has called sink(edge, visible interval)
//                                       for all that is visible of a task's edges
//     outline(edge, visible interval)   the parts of it that nothing is close behind
//     line_class(edge), piece(edge, interval, rank)
#pragma once

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <array>
#include <cstdint>
#include <vector>

#include "blackleaf/scene.h"
#include "edge_tasks.h"
#include "feature_edges.h"
#include "octree/parallel.h"
#include "octree/team.h"
#include "priority.h"

namespace blackleaf::detail {

template <class Projection>
struct SceneTask {
  std::size_t solid = 0;
  EdgeTask edges;
  std::array<std::vector<typename Projection::Ranked>, Projection::kLineClasses> pieces;
};

/// Finds the pieces of one task.
template <class Projection>
class SceneDrawer {
 public:
  using Sight = typename Projection::Sight;

  SceneDrawer(Sight& sight, const Scene& scene, const SceneOptions& options, SceneTask<Projection>& task)
      : sight_(sight), solids_(scene.solids().size()), options_(options), task_(task) {}

  void run() {
    const auto see = [&](const auto& edge, const auto& visible) {
      add(edge, LineKind::visible, visible);
      if (!options_.outline) return;
      for (const auto& outline : sight_.outline(edge, visible)) add(edge, LineKind::outline, outline);
    };
    if (solids_ > 1 || !sight_.find_visible(task_.edges, see)) {
      find(solids_ == 1 ? EdgeChoice::candidates : EdgeChoice::not_blocked_at_once,
           [&](const auto& edge, const auto& run) {
             for (const auto& visible : sight_.visible(edge, run)) see(edge, visible);
           });
    }
    if (options_.hidden)
      find(EdgeChoice::all, [&](const auto& edge, const auto& run) { add(edge, LineKind::hidden, run); });
  }

 private:
  // Calls sink(edge, run) for runs of the task's edges that are in view.
  template <class Sink>
  void find(EdgeChoice choice, const Sink& sink) {
    const auto found = [&](unsigned axis, std::int32_t a0, std::int32_t a1, std::int32_t b, std::int32_t c) {
      const auto edge = sight_.edge(axis, b, c);
      const auto run = sight_.run(edge, a0, a1);
      if (run.low < run.high) sink(edge, run);
    };
    sight_.find(choice, task_.edges, found);
  }

  template <class Edge, class Interval>
  void add(const Edge& edge, LineKind kind, const Interval& where) {
    const auto rank = static_cast<std::uint32_t>(static_cast<std::size_t>(kind) * solids_ + task_.solid);
    task_.pieces[sight_.line_class(edge)].push_back(sight_.piece(edge, where, rank));
  }

  Sight& sight_;
  std::size_t solids_;
  const SceneOptions& options_;
  SceneTask<Projection>& task_;
};

/// The pieces of all tasks of one line class, sorted. Their order does not depend on how they were found.
template <class Projection>
std::vector<typename Projection::Ranked> gather(std::vector<SceneTask<Projection>>& tasks, std::size_t line_class,
                                                const Work& work) {
  using Pieces = std::vector<typename Projection::Ranked>;
  Pieces all;
  std::size_t count = 0;
  for (const SceneTask<Projection>& task : tasks) count += task.pieces[line_class].size();
  all.reserve(count);
  for (SceneTask<Projection>& task : tasks) {
    Pieces& pieces = task.pieces[line_class];
    all.insert(all.end(), pieces.begin(), pieces.end());
    Pieces().swap(pieces);
  }
  sort(all, work);
  return all;
}

template <class Projection>
std::vector<SceneLines> draw_scene(const Scene& scene, const Projection& projection, const SceneOptions& options,
                                   const Work& work) {
  const std::size_t solids = scene.solids().size();
  std::vector<SceneTask<Projection>> tasks;
  using Sight = typename Projection::Sight;
  oneapi::tbb::enumerable_thread_specific<Sight> sights([&] { return Sight(projection, scene, options); });
  Team::with(work, [&](Team& team) {
    for (std::size_t solid = 0; solid < solids; ++solid)
      for (const EdgeTask& edges : edge_tasks(scene.solids()[solid], team)) tasks.push_back({solid, edges, {}});
    team.for_each_index(tasks.size(), work,
                        [&](std::size_t i) { SceneDrawer(sights.local(), scene, options, tasks[i]).run(); });
  });

  const std::size_t kinds = 3;
  std::vector<std::vector<Stroke>> strokes(kinds * solids);
  for (std::size_t line_class = 0; line_class < Projection::kLineClasses; ++line_class)
    by_rank(gather(tasks, line_class, work),
            [&](const auto& key, const auto& low, const auto& high, std::uint32_t rank) {
              const Stroke stroke = projection.stroke(line_class, key, low, high);
              // Far from the origin a stroke can be shorter than the doubles tell apart; such a one draws nothing.
              if (stroke.from != stroke.to) strokes[rank].push_back(stroke);
            });
  std::vector<SceneLines> lines;
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    const auto line_kind = static_cast<LineKind>(kind);
    if (line_kind != LineKind::hidden && !options.visible) continue;
    for (std::size_t solid = 0; solid < solids; ++solid) {
      std::vector<Stroke>& drawn = strokes[(kind * solids) + solid];
      if (!drawn.empty()) lines.push_back({solid, line_kind, std::move(drawn)});
    }
  }
  return lines;
}

}  // namespace blackleaf::detail
