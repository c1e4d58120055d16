#include <array>
#include <vector>

#include "beam.h"
#include "blackleaf/drawing.h"
#include "edge_tasks.h"
#include "feature_edges.h"
#include "octree/parallel.h"
#include "strokes.h"
#include "visibility.h"

namespace blackleaf {
namespace {

using detail::EdgeFamily;
using detail::EdgeTask;
using detail::Piece;
using Families = std::array<EdgeFamily, 3>;
using Pieces = std::array<std::vector<Piece>, 3>;  // by line class

struct Task {
  EdgeTask edges;
  Pieces pieces;
};

// Finds the feature edges of one task and keeps what is visible of them.
class Drawer {
 public:
  Drawer(const Octree& octree, const detail::Direction& d, const Families& families)
      : families_(families), beam_(octree, d) {
    for (const EdgeFamily& family : families) {
      // End-on families draw nothing and are never asked; their place is held by another family's walk.
      const bool drawn = family.mode != EdgeFamily::Mode::end_on;
      walks_.emplace_back(octree, drawn ? family : families[(family.a + 1) % 3]);
    }
  }

  void run(Task& task) {
    pieces_ = &task.pieces;
    beam_.start(task.edges.cube.level);
    detail::FeatureEdges<Drawer> edges(families_, *this);
    detail::corner_walk(task.edges.around, task.edges.cube, edges);
  }

  // Most bricks have no edge that is asked for: their beam is narrowed at the first one.
  bool enter(const Cube& cube) {
    cube_ = cube;
    narrow_ = cube.level > 2;
    hidden_ = narrow_ && !beam_.enter(cube);
    return !hidden_;
  }

  void operator()(unsigned axis, std::int32_t a0, std::int32_t a1, std::int32_t b, std::int32_t c) {
    if (!narrow_) {
      narrow_ = true;
      hidden_ = !beam_.enter(cube_);
    }
    if (hidden_) return;
    const EdgeFamily& family = families_[axis];
    const detail::Interval run{a0 * family.scale, a1 * family.scale};
    for (const detail::Interval& visible : walks_[axis].visible(run, b, c, beam_.nodes()))
      (*pieces_)[family.line_class].push_back(family.piece(visible, b, c));
  }

 private:
  const Families& families_;
  std::vector<detail::VisibilityWalk> walks_;
  detail::Beam beam_;
  Cube cube_;  // entered last
  bool narrow_ = false, hidden_ = false;
  Pieces* pieces_ = nullptr;
};

// The pieces of all tasks, each class sorted. Their order after sorting does not depend on how they were found.
Pieces gather(std::vector<Task>& tasks, const Work& work) {
  Pieces all;
  for (std::size_t k = 0; k < all.size(); ++k) {
    std::size_t count = 0;
    for (const Task& task : tasks) count += task.pieces[k].size();
    all[k].reserve(count);
    for (Task& task : tasks) {
      all[k].insert(all[k].end(), task.pieces[k].begin(), task.pieces[k].end());
      std::vector<Piece>().swap(task.pieces[k]);
    }
    detail::sort(all[k], work);
  }
  return all;
}

}  // namespace

LineDrawing draw(const Octree& octree, const View& view, const Work& work) {
  const detail::Direction& d = view.direction();
  const Families families = {EdgeFamily(0, d), EdgeFamily(1, d), EdgeFamily(2, d)};
  std::vector<Task> tasks;
  for (const EdgeTask& edges : detail::edge_tasks(octree)) tasks.push_back({edges, {}});
  detail::for_each_index(tasks.size(), work, [&](std::size_t i) { Drawer(octree, d, families).run(tasks[i]); });
  const Pieces pieces = gather(tasks, work);
  LineDrawing drawing{view, {}};
  std::array<bool, 3> done{};  // two families can share a line class
  for (const EdgeFamily& family : families) {
    if (family.mode == EdgeFamily::Mode::end_on || done[family.line_class]) continue;
    done[family.line_class] = true;
    detail::append_strokes(pieces[family.line_class], family, view, drawing.strokes);
  }
  return drawing;
}

}  // namespace blackleaf
