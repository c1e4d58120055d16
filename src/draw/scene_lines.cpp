// Lines of scenes by parallel projection: what scene_drawer.h asks of a projection.
#include <cmath>
#include <optional>

#include "blackleaf/error.h"
#include "blackleaf/scene.h"
#include "drawer.h"
#include "scene_drawer.h"
#include "strokes.h"
#include "visibility.h"

namespace blackleaf {
namespace {

using detail::EdgeFamily;
using detail::Interval;
using Families = std::array<EdgeFamily, 3>;

Families families_of(const detail::Direction& d) { return {EdgeFamily(0, d), EdgeFamily(1, d), EdgeFamily(2, d)}; }

class Parallel {
 public:
  using Ranked = detail::RankedPiece<std::int64_t, std::int64_t>;
  static constexpr std::size_t kLineClasses = 3;

  explicit Parallel(const View& view) : sight_(view.direction()) {
    for (const EdgeFamily& family : sight_.families)  // two families can share a line class
      if (family.mode != EdgeFamily::Mode::end_on && !lines_[family.line_class])
        lines_[family.line_class].emplace(family, view);
  }

  Stroke stroke(std::size_t line_class, std::int64_t key, std::int64_t low, std::int64_t high) const {
    const detail::PictureLines& lines = *lines_[line_class];
    return {lines.point(key, low), lines.point(key, high)};
  }

  class Sight {
   public:
    struct Edge {
      unsigned axis;
      std::int64_t b, c;
    };

    Sight(const Parallel& projection, const Scene& scene, const SceneOptions& options)
        : families_(projection.sight_.families), drawer_(scene.solids()[0], projection.sight_) {
      const Octree& all = scene.all();
      const detail::Direction& d = projection.sight_.direction;
      backward_ = families_of({-d[0], -d[1], -d[2]});
      const double length = std::sqrt(static_cast<double>(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
      for (std::size_t i = 0; i < 3; ++i) {
        // End-on families draw nothing and are never asked; their place is held by another family's walk.
        const std::size_t k = families_[i].mode == EdgeFamily::Mode::end_on ? (i + 1) % 3 : i;
        walks_.emplace_back(all, families_[k]);
        backward_walks_.emplace_back(all, backward_[k]);
        backward_walks_.back().stop_at(backward_[k].time_of(options.outline_gap / length));
      }
    }
    Sight(const Sight&) = delete;  // walks refer to families
    Sight& operator=(const Sight&) = delete;

    template <class Sink>
    void find(detail::EdgeChoice choice, const detail::EdgeTask& task, Sink& sink) const {
      detail::FeatureEdges<Sink> edges(families_, sink, choice);
      detail::corner_walk(task.around, task.cube, edges);
    }
    Edge edge(unsigned axis, std::int32_t b, std::int32_t c) const { return {axis, b, c}; }
    Interval run(const Edge& edge, std::int32_t a0, std::int32_t a1) const {
      return {a0 * families_[edge.axis].scale, a1 * families_[edge.axis].scale};
    }
    const std::vector<Interval>& visible(const Edge& edge, const Interval& run) {
      return walks_[edge.axis].visible(run, edge.b, edge.c);
    }
    template <class Sink>
    bool find_visible(const detail::EdgeTask& task, const Sink& sink) {
      drawer_.kept().visible.clear();
      drawer_.run(task);
      for (const auto& [edge, visible] : drawer_.kept().visible) sink(edge, visible);
      return true;
    }
    const std::vector<Interval>& outline(const Edge& edge, const Interval& visible) {
      return backward_walks_[edge.axis].visible(visible, edge.b, edge.c);
    }
    std::size_t line_class(const Edge& edge) const { return families_[edge.axis].line_class; }
    Ranked piece(const Edge& edge, const Interval& where, std::uint32_t rank) const {
      const detail::Piece piece = families_[edge.axis].piece(where, edge.b, edge.c);
      return {piece.key, piece.low, piece.high, rank};
    }

   private:
    struct Keep {
      void operator()(const EdgeFamily& family, const Interval& interval, std::int64_t b, std::int64_t c) {
        visible.push_back({{family.a, b, c}, interval});
      }
      std::vector<std::pair<Edge, Interval>> visible;
    };

    const Families& families_;
    Families backward_ = families_;
    detail::Drawer<Keep> drawer_;
    std::vector<detail::VisibilityWalk> walks_, backward_walks_;
  };

 private:
  detail::ParallelSight sight_;
  std::array<std::optional<detail::PictureLines>, kLineClasses> lines_;
};

}  // namespace

std::vector<SceneLines> draw(const Scene& scene, const View& view, const SceneOptions& options, const Work& work) {
  if (!(options.outline_gap > 0))
    throw Error(ErrorCode::bad_argument, "the gap behind outlines is not above zero", "give a number of voxels");
  if (scene.solids().size() == 1 && options.visible && !options.hidden && !options.outline) {
    LineDrawing drawing = draw(scene.solids()[0], view, work);
    std::vector<SceneLines> lines;
    if (!drawing.strokes.empty()) lines.push_back({0, LineKind::visible, std::move(drawing.strokes)});
    return lines;
  }
  return detail::draw_scene(scene, Parallel(view), options, work);
}

}  // namespace blackleaf
