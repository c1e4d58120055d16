// Lines of scenes in perspective: what scene_drawer.h asks of a projection, with everything seen from the eye
// (eye_lines.h).
#include <algorithm>
#include <array>
#include <cmath>

#include "blackleaf/error.h"
#include "blackleaf/perspective.h"
#include "eye_edges.h"
#include "eye_lines.h"
#include "eye_walk.h"
#include "scene_drawer.h"
#include "screen.h"

namespace blackleaf {
namespace {

using detail::EyeEdge;
using detail::EyeKey;
using detail::EyePosition;
using detail::EyeWalk;
using detail::kUnit;
using detail::Place;
using detail::Wide;
using Grid = std::array<std::int64_t, 3>;

// The field of view, seen from the eye.
class Window {
 public:
  enum class Meets { nothing, part, whole };

  explicit Window(const Perspective& perspective) : eye_(perspective.eye()), sides_(perspective.sides()) {}

  // What of the lattice box [low, high] is inside: nothing for sure, a part perhaps, or the whole.
  Meets meets(const Cube& cube) const {
    const Grid corner = {cube.x, cube.y, cube.z};
    bool whole = true;
    for (const Grid& n : sides_) {
      Wide low = 0, high = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int64_t from = corner[i] * kUnit - eye_[i],
                           to = from + (std::int64_t{cube.side()} << Perspective::kGridBits);
        low += Wide{n[i]} * (n[i] < 0 ? to : from);
        high += Wide{n[i]} * (n[i] < 0 ? from : to);
      }
      if (high < 0) return Meets::nothing;
      whole = whole && low >= 0;
    }
    return whole ? Meets::whole : Meets::part;
  }

  // What of the interval on the edge's line is inside; an empty interval if that is less than a piece.
  EyeWalk::Interval clip(const EyeEdge& edge, EyeWalk::Interval run) const {
    for (const Grid& n : sides_) {
      const Wide across = Wide{n[edge.b]} * edge.at_b + Wide{n[edge.c]} * edge.at_c;  // below 2^72
      const std::int64_t along = n[edge.a];
      if (along == 0) {
        if (across < 0) return {run.low, run.low};
        continue;
      }
      // along s + across >= 0
      const Place cut = Place::of(along > 0 ? -across : across, std::abs(along));
      if (along > 0 && run.low < cut) run.low = cut;
      if (along < 0 && cut < run.high) run.high = cut;
      if (run.low >= run.high) break;
    }
    return run;
  }

 private:
  Grid eye_;
  std::array<Grid, 4> sides_;
};

// Points of picture lines on the screen. A point seen at X is drawn at D (|d| / u_norm) (U . X) / (-d . X) and likewise
// for v. X is whole and below 2^82, U and V below 2^41 (screen.h): 128 bits hold the products exactly.
class EyeScreen {
 public:
  explicit EyeScreen(const Perspective& perspective)
      : screen_(perspective.view().direction()), d_(perspective.view().direction()) {
    const double scale =
        perspective.distance() * std::sqrt(static_cast<double>(d_[0] * d_[0] + d_[1] * d_[1] + d_[2] * d_[2]));
    u_scale_ = scale / screen_.u_norm;
    v_scale_ = scale / screen_.v_norm;
  }

  Eigen::Vector2d point(std::size_t line_class, const EyeKey& key, const EyePosition& at) const {
    const auto [a, b, c] = detail::axes_of(static_cast<unsigned>(line_class));
    const Wide x_b = Wide{at.across} * key.first, x_c = Wide{at.across} * key.second;
    const auto times = [&, a = a, b = b, c = c](const Grid& n) {
      return static_cast<double>(at.along * n[a] + x_b * n[b] + x_c * n[c]);
    };
    const double depth = -times(d_);
    return {u_scale_ * (times(screen_.u) / depth), v_scale_ * (times(screen_.v) / depth)};
  }

 private:
  detail::Screen screen_;
  Grid d_;
  double u_scale_, v_scale_;
};

class FromEye {
 public:
  using Ranked = detail::RankedPiece<EyeKey, EyePosition>;
  static constexpr std::size_t kLineClasses = detail::kEyeLineClasses;

  explicit FromEye(const Perspective& perspective)
      : eye_(perspective.eye()), window_(perspective), screen_(perspective) {}

  Stroke stroke(std::size_t line_class, const EyeKey& key, const EyePosition& low, const EyePosition& high) const {
    return {screen_.point(line_class, key, low), screen_.point(line_class, key, high)};
  }

  class Sight {
   public:
    using Edge = EyeEdge;
    using Interval = EyeWalk::Interval;

    Sight(const FromEye& projection, const Scene& scene, const SceneOptions&)
        : eye_(projection.eye_),
          window_(projection.window_),
          walk_(scene.all(), eye_, EyeWalk::Way::to_eye),
          backward_walk_(scene.all(), eye_, EyeWalk::Way::away) {}

    template <class Sink>
    void find(detail::EdgeChoice choice, const detail::EdgeTask& task, Sink& sink) {
      const Window::Meets meets = window_.meets(task.cube);
      if (meets == Window::Meets::nothing) return;
      clipped_ = meets == Window::Meets::part;
      detail::EyeEdges<Sink> edges(eye_, sink, choice);
      detail::corner_walk(task.around, task.cube, edges);
    }
    Edge edge(unsigned axis, std::int32_t b, std::int32_t c) const {
      return Edge(axis, seen(b, (axis + 1) % 3), seen(c, (axis + 2) % 3));
    }
    // Edges in one line with the eye draw nothing.
    Interval run(const Edge& edge, std::int32_t a0, std::int32_t a1) const {
      if (edge.end_on()) return {Place::of(0, 1), Place::of(0, 1)};
      const std::int64_t unit = std::abs(edge.at_c);
      const Interval run{Place::of(seen(a0, edge.a), unit, unit), Place::of(seen(a1, edge.a), unit, unit)};
      return clipped_ ? window_.clip(edge, run) : run;
    }
    const std::vector<Interval>& visible(const Edge& edge, const Interval& run) { return walk_.visible(edge, run); }
    template <class Sink>
    bool find_visible(const detail::EdgeTask&, const Sink&) {
      return false;
    }
    const std::vector<Interval>& outline(const Edge& edge, const Interval& visible) {
      return backward_walk_.visible(edge, visible);
    }
    std::size_t line_class(const Edge& edge) const { return edge.line_class(); }
    Ranked piece(const Edge& edge, const Interval& where, std::uint32_t rank) const {
      const detail::EyePiece piece = edge.piece(where.low, where.high);
      return {piece.key, piece.low, piece.high, rank};
    }

   private:
    std::int64_t seen(std::int32_t at, unsigned axis) const { return at * kUnit - eye_[axis]; }

    const Grid& eye_;
    const Window& window_;
    EyeWalk walk_, backward_walk_;
    bool clipped_ = true;
  };

 private:
  Grid eye_;
  Window window_;
  EyeScreen screen_;
};

void check_outside(const Octree& octree, const Grid& eye) {
  for (unsigned corner = 0; corner < 8; ++corner) {  // the voxels that touch the eye
    Grid voxel{};
    for (unsigned i = 0; i < 3; ++i) voxel[i] = (eye[i] - (corner >> i & 1)) >> Perspective::kGridBits;
    if (octree.contains(voxel[0], voxel[1], voxel[2]))
      throw Error(ErrorCode::bad_argument, "the eye is in or on the solid",
                  "move it away from the solid, at least a little");
  }
}

}  // namespace

std::vector<SceneLines> draw(const Scene& scene, const Perspective& perspective, const SceneOptions& options,
                             const Work& work) {
  if (!(options.outline_gap > 0) || std::isfinite(options.outline_gap))
    throw Error(ErrorCode::bad_argument, "in perspective outlines stand out against the background only",
                "leave out the gap behind them");
  check_outside(scene.all(), perspective.eye());
  return detail::draw_scene(scene, FromEye(perspective), options, work);
}

LineDrawing draw(const Octree& octree, const Perspective& perspective, const Work& work) {
  std::vector<SceneLines> lines = draw(Scene({octree}), perspective, {}, work);
  LineDrawing drawing{perspective.view(), {}};
  if (!lines.empty()) drawing.strokes = std::move(lines[0].strokes);
  return drawing;
}

}  // namespace blackleaf
