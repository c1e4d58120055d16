// Winding numbers of open surfaces, without a dense volume.
//
// Let caps C close the holes of a surface S. The winding number of S + C is an integer, W, found exactly by columns;
// that of S is w = W - w_C. So w > 1/2 where W is at least k, the least integer greater than w_C + 1/2: far from the
// holes |w_C| < 1/2 and k = 1. The sets {W >= j}, one in the other, are octrees.
//
// A bound of the slope of w, up to its jumps at S, and of w_C, up to its jumps at C, follows from the rims of the holes
// alone (rim_field.h). So a node is decided by one of these numbers at one place, together with that bound: where no
// cap meets it, k is the same at all its centres if w_C does not come near a half on it, and the node is a node of {W
// >= k}; where no triangle of S meets it, it has one colour if w does not come near 1/2 on it. What is divided down to
// voxels are thus the surface w = 1/2 within the holes, the rims, and where caps pass through the surface.
#include "winding.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

#include "caps.h"
#include "column_octree.h"
#include "octree/brick.h"
#include "octree/parallel.h"
#include "octree/produce.h"
#include "rim_field.h"
#include "triangle_boxes.h"
#include "winding_field.h"

namespace blackleaf::detail {
namespace {

// The parts of an open surface and what is known of them.
struct OpenSurface {
  TriangleBoxes surface, caps;
  RimField rims;
  WindingField field;        // of the caps
  std::vector<Octree> sets;  // where W >= lowest + 1, lowest + 2, ...
  int lowest;
};

class WindingProducer {
 public:
  struct Task {
    std::vector<Node> sets;  // one when decided
    Levels levels;           // of k at all centres of the node
    bool decided = false;
    std::vector<std::uint32_t> caps, surface;  // those that may come between centres of the node; surface only if caps
  };

  WindingProducer(const OpenSurface& open, int depth)
      : open_(open),
        all_{open.lowest, open.lowest + static_cast<int>(open.sets.size()) + 1},
        fraction_bits_(kGridBits - depth) {}

  Task root() const {
    Task task{{}, all_, false, {}, {}};
    for (const Octree& set : open_.sets) task.sets.push_back(brick_level_root(set));
    for (std::uint32_t i = 0; i < open_.caps.size(); ++i) task.caps.push_back(i);
    for (std::uint32_t i = 0; i < open_.surface.size(); ++i) task.surface.push_back(i);
    return task;
  }
  Colour classify(Task& task, const Cube& cube) const {
    if (task.decided) return task.sets.front().colour();
    if (const auto colour = colour_between(task, task.levels)) return *colour;
    Verdict verdict{task.levels, {}};
    for (const double tolerance : {0x1p-2, 0x1p-5}) {
      verdict = examine(task, cube, task.caps, task.surface,
                        [&](const GridPoint& p) { return open_.field.sum(p, tolerance); });
      if (verdict.colour) return *verdict.colour;
      task.levels = verdict.levels;
      if (task.levels.low == task.levels.high) break;
    }
    if (task.levels.low == task.levels.high) {
      const Node set = at(task, task.levels.low, cube.level);
      task.sets.assign(1, set);
      task.decided = true;
      return set.colour();
    }
    return colour_between(task, task.levels).value_or(Colour::gray);
  }
  Task child(const Task& task, const Cube& cube, int octant) const {
    Task below{{}, task.levels, task.decided, {}, {}};
    below.sets.reserve(task.sets.size());
    for (const Node& set : task.sets) below.sets.push_back(set.child(octant));
    if (!task.decided) keep_near(task, cube, below.caps, below.surface);
    return below;
  }
  std::uint64_t brick(const Task& task, const Cube& cube) const {
    if (task.decided) return task.sets.front().brick();
    std::uint64_t bits = at(task, task.levels.high, 2).brick();
    const std::uint64_t open = at(task, task.levels.low, 2).brick() & ~bits;
    if (open == 0) return bits;
    const Evaluator field(open_.field, middle(cube));
    std::vector<std::uint32_t> caps, surface;
    for (int octant = 0; octant < 8; ++octant) {
      const std::uint64_t octet = std::uint64_t{0xFF} << 8 * octant;
      if (!(open & octet)) continue;
      const Cube eighth = cube.child(octant);
      Verdict verdict{task.levels, {}};
      if (std::popcount(open & octet) > 2) {  // else not worth it
        keep_near(task, eighth, caps, surface);
        verdict = examine(task, eighth, caps, surface, [&](const GridPoint& p) { return field.rough(p); });
      }
      if (verdict.colour) {
        if (*verdict.colour == Colour::black) bits |= open & octet;
        continue;
      }
      bits |= at(task, verdict.levels.high, 2).brick() & octet;
      const std::uint64_t left = at(task, verdict.levels.low, 2).brick() & ~bits & octet;
      for (int i = 8 * octant; i < 8 * octant + 8; ++i) {
        if (!(left >> i & 1)) continue;
        const int level = std::clamp(field.level(middle(eighth.child(i & 7))), verdict.levels.low, verdict.levels.high);
        bits |= at(task, level, 2).brick() & std::uint64_t{1} << i;
      }
    }
    return bits;
  }

 private:
  static constexpr double kRoot3 = 1.7320508075688774;  // rounded up

  struct Verdict {
    Levels levels;
    std::optional<Colour> colour;
  };

  // The field at the centres of a brick's voxels.
  class Evaluator {
   public:
    Evaluator(const WindingField& field, const GridPoint& middle)
        : field_(field), middle_(middle), coarse_(field.around(middle, kReach, 0x1p-3)) {}

    Turns rough(const GridPoint& p) const { return field_.sum(coarse_, p); }
    int level(const GridPoint& p) const {
      Levels levels = levels_of(rough(p), 0);
      if (levels.low == levels.high) return levels.low;
      if (!fine_) fine_ = field_.around(middle_, kReach, 0x1p-7);
      levels = levels_of(field_.sum(*fine_, p), 0);
      return levels.low == levels.high ? levels.low : field_.level(p);
    }

   private:
    static constexpr double kReach = 1.5 * kRoot3 + 0x1p-10;
    const WindingField& field_;
    const GridPoint middle_;
    const WindingField::Around coarse_;
    mutable std::optional<WindingField::Around> fine_;  // made when it is needed
  };

  // Where W >= level in a node.
  Node at(const Task& task, int level, int node_level) const {
    if (level <= all_.low) return Node::uniform(node_level, Colour::black);
    if (level >= all_.high) return Node::uniform(node_level, Colour::white);
    return task.sets[static_cast<std::size_t>(level - all_.low - 1)];
  }
  // The node's colour if it is the same whichever of the levels is taken.
  std::optional<Colour> colour_between(const Task& task, const Levels& levels) const {
    if (at(task, levels.low, 2).is_white()) return Colour::white;
    if (at(task, levels.high, 2).is_black()) return Colour::black;
    return {};
  }

  // The middle of a cube.
  GridPoint middle(const Cube& cube) const {
    const auto axis = [&](std::int32_t from) { return (2 * std::int64_t{from} + cube.side()) << (fraction_bits_ - 1); };
    return {axis(cube.x), axis(cube.y), axis(cube.z)};
  }
  static Place place(const Cube& cube) {
    const double half = 0.5 * cube.side();
    return {cube.x + half, cube.y + half, cube.z + half};
  }

  void keep_near(const Task& task, const Cube& cube, std::vector<std::uint32_t>& caps,
                 std::vector<std::uint32_t>& surface) const {
    caps.clear();
    surface.clear();
    const Place centre = place(cube);
    const double half = 0.5 * (cube.side() - 1);  // only centres count
    for (const std::uint32_t i : task.caps)
      if (open_.caps.near(i, centre, half)) caps.push_back(i);
    if (caps.empty()) return;
    for (const std::uint32_t i : task.surface)
      if (open_.surface.near(i, centre, half)) surface.push_back(i);
  }

  // What one place tells about all centres of a cube of level 1 at least. `task` is of the cube, or of the brick that
  // it is an eighth of. `field` is the winding number of the caps.
  template <class Field>
  Verdict examine(const Task& task, const Cube& cube, const std::vector<std::uint32_t>& caps,
                  const std::vector<std::uint32_t>& surface, const Field& field) const {
    if (caps.empty()) {
      const double h = 0.5 * (cube.side() - 1) * kRoot3;
      const double slope = open_.rims.slope(place(cube), h, 0.5 / h);
      if (!std::isfinite(slope)) return {task.levels, {}};
      const Levels found = levels_of(field(middle(cube)), h * slope);
      return {{std::clamp(found.low, task.levels.low, task.levels.high),
               std::clamp(found.high, task.levels.low, task.levels.high)},
              {}};
    }
    if (surface.empty()) {
      // The voxel beyond the middle: W is known at centres only.
      const std::int32_t half = cube.side() / 2;
      const Cube voxel{cube.x + half, cube.y + half, cube.z + half, 0};
      const double h = half * kRoot3;
      const double slope = open_.rims.slope(place(voxel), h, 1 / h);
      if (!std::isfinite(slope)) return {task.levels, {}};
      const Turns caps_turns = field(middle(voxel));
      const double above = winding(task, voxel) - caps_turns.value - 0.5;
      if (std::abs(above) > caps_turns.error + h * slope + kFieldRounding)
        return {task.levels, above > 0 ? Colour::black : Colour::white};
    }
    return {task.levels, {}};
  }

  // W at a voxel of a node; all_.low if it is less, all_.high - 1 if it is more.
  int winding(const Task& task, const Cube& voxel) const {
    int result = all_.low;
    for (Node node : task.sets) {
      const auto octant = [&](int level) {
        return (voxel.x >> level & 1) | (voxel.y >> level & 1) << 1 | (voxel.z >> level & 1) << 2;
      };
      for (int level = node.level() - 1; level >= 2 && node.is_gray(); --level) node = node.child(octant(level));
      if (node.is_gray())
        result += static_cast<int>(node.brick() >> (8 * octant(1) + octant(0)) & 1);
      else
        result += node.is_black();
    }
    return result;
  }

  const OpenSurface& open_;
  const Levels all_;
  const int fraction_bits_;
};

// The voxels with winding numbers of at least `level`.
Octree level_set(const GridMesh& mesh, int level, const Frame& frame, Windings& windings, const Work& work) {
  const bool complement = level <= 0;
  const InsideRule rule =
      complement ? InsideRule{InsideRule::Kind::at_most, level - 1} : InsideRule{InsideRule::Kind::at_least, level};
  const Slabs slabs = slabs_of(mesh, rule, part_of(work, 0, 0.6));
  windings = slabs.windings;
  return octree_of_columns(slabs, mesh.depth, frame, complement, part_of(work, 0.6, 1));
}

}  // namespace

WindingSolid winding_solid(const GridMesh& mesh, const Frame& frame, const Work& work) {
  WindingSolid result;
  const Caps caps =
      caps_of(boundaries(mesh.triangles, mesh.vertices.size(), std::vector<std::uint32_t>(mesh.triangles.size(), 0), 1)
                  .front());
  GridMesh closed = mesh;
  closed.triangles.insert(closed.triangles.end(), caps.triangles.begin(), caps.triangles.end());
  result.holes = caps.loops();

  const bool is_open = result.holes > 0;
  Windings windings;
  const Octree first = level_set(closed, 1, frame, windings, part_of(work, 0, is_open ? 0.2 : 1));
  result.overlaps = windings.lowest < 0 || windings.highest > 1;
  if (!is_open) {
    result.octree = first;
    return result;
  }
  // Every triangle of the caps adds at most 1/2 to w_C, so no level beyond these is asked for.
  const int most = static_cast<int>(std::min<std::size_t>(caps.triangles.size() / 2 + 2, 1 << 20));
  const int lowest = std::max(windings.lowest, -most), highest = std::min(windings.highest, most);
  OpenSurface open{TriangleBoxes(mesh, mesh.triangles),
                   TriangleBoxes(mesh, caps.triangles),
                   RimField(mesh, caps),
                   WindingField(mesh, caps.triangles),
                   {},
                   lowest};
  for (int level = lowest + 1; level <= highest; ++level)
    open.sets.push_back(level == 1 ? first : level_set(closed, level, frame, windings, part_of(work, 0.2, 0.2)));
  result.octree = produce(WindingProducer(open, mesh.depth), mesh.depth, frame, part_of(work, 0.3, 1));
  return result;
}

}  // namespace blackleaf::detail
