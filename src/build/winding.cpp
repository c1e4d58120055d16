// Winding numbers of open surfaces, without a dense volume.
//
// Let caps C close the holes of a surface S. The winding number of S + C is an integer, W, found exactly by columns;
// that of S is w = W - w_C. So w > 1/2 where W is at least k, the least integer greater than w_C + 1/2: far from the
// holes |w_C| < 1/2 and k = 1. The sets {W >= j}, one in the other, are octrees; a node of the result is a node of one
// of them wherever k is the same at all its centres, and is divided only where that is not so and matters.
#include "winding.h"

#include <vector>

#include "caps.h"
#include "column_octree.h"
#include "octree/parallel.h"
#include "octree/produce.h"
#include "winding_field.h"

namespace blackleaf::detail {
namespace {

class WindingProducer {
 public:
  struct Task {
    std::vector<Node> sets;  // one when decided
    Levels levels;
    bool decided = false;
  };

  // sets[i] is where W >= lowest + 1 + i; W lies in [lowest, lowest + sets.size()].
  WindingProducer(const std::vector<Octree>& sets, int lowest, const WindingField& field)
      : sets_(sets), all_{lowest, lowest + static_cast<int>(sets.size()) + 1}, field_(field) {}

  Task root() const {
    Task task{{}, all_, false};
    for (const Octree& set : sets_) task.sets.push_back(brick_level_root(set));
    return task;
  }
  Colour classify(Task& task, const Cube& cube) const {
    if (task.decided) return task.sets.front().colour();
    // No two sets differ here.
    if (at(task, task.levels.low, cube).is_white()) return Colour::white;
    if (at(task, task.levels.high, cube).is_black()) return Colour::black;
    task.levels = field_.levels(cube, task.levels);
    const Node widest = at(task, task.levels.low, cube);
    if (task.levels.low == task.levels.high) {
      task.sets.assign(1, widest);
      task.decided = true;
      return widest.colour();
    }
    if (widest.is_white()) return Colour::white;
    return at(task, task.levels.high, cube).is_black() ? Colour::black : Colour::gray;
  }
  Task child(const Task& task, const Cube&, int octant) const {
    Task below{{}, task.levels, task.decided};
    below.sets.reserve(task.sets.size());
    for (const Node& set : task.sets) below.sets.push_back(set.child(octant));
    return below;
  }
  std::uint64_t brick(const Task& task, const Cube& cube) const {
    if (task.decided) return task.sets.front().brick();
    std::uint64_t bits = at(task, task.levels.high, cube).brick();
    const std::uint64_t open = at(task, task.levels.low, cube).brick() & ~bits;
    for (int i = 0; i < 64; ++i) {
      if (!(open >> i & 1)) continue;
      const Cube voxel = cube.child(i >> 3).child(i & 7);
      const int level = std::clamp(field_.level(voxel.x, voxel.y, voxel.z), task.levels.low, task.levels.high);
      bits |= at(task, level, cube).brick() & std::uint64_t{1} << i;
    }
    return bits;
  }

 private:
  // Where W >= level in a node.
  Node at(const Task& task, int level, const Cube& cube) const {
    if (level <= all_.low) return Node::uniform(cube.level, Colour::black);
    if (level >= all_.high) return Node::uniform(cube.level, Colour::white);
    return task.sets[static_cast<std::size_t>(level - all_.low - 1)];
  }

  const std::vector<Octree>& sets_;
  const Levels all_;
  const WindingField& field_;
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
  GridMesh closed = mesh;
  const Caps caps = caps_of(
      boundaries(mesh.triangles, mesh.vertices.size(), std::vector<std::uint32_t>(mesh.triangles.size(), 0), 1).front(),
      closed.vertices);
  closed.triangles.insert(closed.triangles.end(), caps.triangles.begin(), caps.triangles.end());
  result.holes = caps.loops;

  const bool open = !caps.triangles.empty();
  Windings windings;
  const Octree first = level_set(closed, 1, frame, windings, part_of(work, 0, open ? 0.2 : 1));
  result.overlaps = windings.lowest < 0 || windings.highest > 1;
  if (!open) {
    result.octree = first;
    return result;
  }
  // Every triangle of the caps adds at most 1/2 to w_C, so no level beyond these is asked for.
  const int most = static_cast<int>(std::min<std::size_t>(caps.triangles.size() / 2 + 2, 1 << 20));
  const int lowest = std::max(windings.lowest, -most), highest = std::min(windings.highest, most);
  std::vector<Octree> sets;
  for (int level = lowest + 1; level <= highest; ++level)
    sets.push_back(level == 1 ? first : level_set(closed, level, frame, windings, part_of(work, 0.2, 0.2)));
  const WindingField field(closed, caps.triangles);
  result.octree = produce(WindingProducer(sets, lowest, field), mesh.depth, frame, part_of(work, 0.3, 1));
  return result;
}

}  // namespace blackleaf::detail
