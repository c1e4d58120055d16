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
//   Sight                               made from (projection, union of all solids, options), for one thread at a time:
//     find(choice, edges, sink)         calls sink(axis, a0, a1, b, c) for runs of feature edges of a task
//     edge(axis, b, c), run(edge, a0, a1)   what it calls such a run: an edge, and an interval on it, empty if out of
//     view visible(edge, interval)           the visible intervals, valid until the next call outline(edge, interval)
//     those of a visible one that nothing is close behind line_class(edge), piece(edge, interval, rank)
#pragma once

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
  SceneDrawer(const Projection& projection, const Scene& scene, const SceneOptions& options,
              SceneTask<Projection>& task)
      : solids_(scene.solids().size()), options_(options), task_(task), sight_(projection, scene.all(), options) {}

  void run() {
    ask_ = true;
    sight_.find(solids_ == 1 ? EdgeChoice::candidates : EdgeChoice::not_blocked_at_once, task_.edges, *this);
    ask_ = false;
    if (options_.hidden) sight_.find(EdgeChoice::all, task_.edges, *this);
  }

  void operator()(unsigned axis, std::int32_t a0, std::int32_t a1, std::int32_t b, std::int32_t c) {
    const auto edge = sight_.edge(axis, b, c);
    const auto run = sight_.run(edge, a0, a1);
    if (!(run.low < run.high)) return;
    if (!ask_) return add(edge, LineKind::hidden, run);
    for (const auto& visible : sight_.visible(edge, run)) {
      add(edge, LineKind::visible, visible);
      if (!options_.outline) continue;
      for (const auto& outline : sight_.outline(edge, visible)) add(edge, LineKind::outline, outline);
    }
  }

 private:
  template <class Edge, class Interval>
  void add(const Edge& edge, LineKind kind, const Interval& where) {
    const auto rank = static_cast<std::uint32_t>(static_cast<std::size_t>(kind) * solids_ + task_.solid);
    task_.pieces[sight_.line_class(edge)].push_back(sight_.piece(edge, where, rank));
  }

  std::size_t solids_;
  const SceneOptions& options_;
  SceneTask<Projection>& task_;
  typename Projection::Sight sight_;
  bool ask_ = true;  // whether edges are to be looked at, or taken as they are
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
  Team::with(work, [&](Team& team) {
    for (std::size_t solid = 0; solid < solids; ++solid)
      for (const EdgeTask& edges : edge_tasks(scene.solids()[solid], team)) tasks.push_back({solid, edges, {}});
    team.for_each_index(tasks.size(), work,
                        [&](std::size_t i) { SceneDrawer<Projection>(projection, scene, options, tasks[i]).run(); });
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
