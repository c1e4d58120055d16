// Sweeps of label maps. A centre takes the largest label that any motion brings it, and a label is brought to it iff
// the sweep of that label's solid is black there. So the solids are swept one by one, and then all looked at together,
// from the largest label down: the first that is black gives a node its label, whatever those below it are.
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blackleaf/measures.h"
#include "blackleaf/runs.h"
#include "blackleaf/sweep.h"
#include "octree/parallel.h"
#include "produce_labels.h"
#include "sweep_into.h"

namespace blackleaf {
namespace {

struct Labelled {
  std::uint32_t label;
  Octree solid;
};

// The solid of every label but 0, in decreasing order. One pass over the runs.
std::vector<Labelled> solids_of(const LabelMap& map) {
  struct Stream {
    std::vector<Run> runs;  // white and black in turn
    std::uint64_t end = 0;
  };
  std::map<std::uint32_t, Stream, std::greater<>> streams;
  for (std::size_t i = 0; i < map.run_count(); ++i) {
    const std::uint32_t label = map.labels()[i];
    if (label == 0) continue;
    Stream& stream = streams[label];
    stream.runs.push_back({map.starts()[i] - stream.end, 0});
    stream.runs.push_back({map.count(i), 1});
    stream.end = map.starts()[i] + map.count(i);
  }
  const std::uint64_t voxels = std::uint64_t{1} << (3 * map.depth());
  std::vector<Labelled> solids;
  for (auto& [label, stream] : streams) {
    stream.runs.push_back({voxels - stream.end, 0});
    solids.push_back({label, octree_from_runs(stream.runs, map.depth(), map.frame())});
    stream.runs = {};
  }
  return solids;
}

// Solids of one universe, the earlier painted over the later.
class Painted {
 public:
  struct Layer {
    std::uint32_t label;
    Node node;
  };
  using Task = std::vector<Layer>;  // those that are not white here, up to the first that is black

  explicit Painted(std::span<const Labelled> solids) {
    for (const auto& [label, solid] : solids)
      if (!add(root_, {label, solid.root()})) break;
  }

  const Task& root() const { return root_; }

  std::optional<std::uint32_t> label(const Task& task, int) const {
    if (task.empty()) return 0;
    if (task.front().node.is_black()) return task.front().label;
    return std::nullopt;
  }

  Task child(const Task& task, int, unsigned octant) const {
    Task below;
    for (const auto& [label, node] : task)
      if (!add(below, {label, node.child(static_cast<int>(octant))})) break;
    return below;
  }

 private:
  // False if nothing below the layer can be seen.
  static bool add(Task& task, const Layer& layer) {
    if (!layer.node.is_white()) task.push_back(layer);
    return !layer.node.is_black();
  }

  Task root_;
};

LabelMap sweep_labels_into(const detail::TargetUniverse& target, const LabelMap& map, std::span<const Motion> motions,
                           const Work& work) {
  constexpr double kSweeping = 0.9;  // of the time, about
  std::vector<Labelled> solids = solids_of(map);
  for (std::size_t i = 0; i < solids.size(); ++i) {
    Octree& solid = solids[i].solid;
    const double part = kSweeping / static_cast<double>(solids.size());
    const auto begin = static_cast<double>(i) * part;
    solid =
        detail::sweep_into(target, solid, *bounding_box(solid), motions, detail::part_of(work, begin, begin + part));
  }
  return detail::produce_labels(Painted(solids), target.depth, detail::grown_frame(map.frame(), target),
                                detail::part_of(work, kSweeping, 1));
}

}  // namespace

LabelMap sweep(const LabelMap& map, std::span<const Motion> motions, Leaving leaving, const Work& work) {
  const Octree solid = octree_from_labels(map);
  const std::optional<Box> box = bounding_box(solid);
  if (!box) return map;
  return sweep_labels_into(detail::universe_for(solid, *box, motions, leaving), map, motions, work);
}

LabelMap sweep(const LabelMap& map, const Path& path, double step, Leaving leaving, const Work& work) {
  return sweep(map, motions_along(octree_from_labels(map), path, step), leaving, work);
}

RoomForLabels room_for(const LabelMap& map, std::span<const Motion> motions, Leaving leaving, const Work& work) {
  RoomForLabels room{map, {motions.begin(), motions.end()}};
  const Octree solid = octree_from_labels(map);
  const std::optional<Box> box = bounding_box(solid);
  if (!box) return room;
  const detail::TargetUniverse target = detail::universe_for(solid, *box, motions, leaving);
  if (target.depth == map.depth()) return room;
  const std::array<Motion, 1> rest;
  room.labels = sweep_labels_into(target, map, rest, work);
  detail::move_with(target, room.motions);
  return room;
}

}  // namespace blackleaf
