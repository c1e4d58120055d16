// produce_labels: every label map that is computed node by node, along the Millar curve, on all cores; what produce.h
// is for octrees.
//
//   struct Producer {
//     using Task = ...;                                               // what is known about one target node
//     Task root() const;
//     std::optional<std::uint32_t> label(const Task&, int level) const;  // if it is known to have one; voxels have
//     Task child(const Task&, int level, unsigned octant) const;         // of a node of this level
//   };
//
// Its functions are called from many threads.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "blackleaf/curve.h"
#include "blackleaf/label_map.h"
#include "octree/parallel.h"

namespace blackleaf::detail {

template <class Producer>
class LabelProduction {
  using Task = typename Producer::Task;

 public:
  LabelProduction(const Producer& producer, int depth, const Work& work)
      : producer_(producer), depth_(depth), work_(work) {}

  LabelMap run(Frame frame) {
    cut(producer_.root(), depth_, 0);
    for_each_index(stretches_.size(), work_, [&](std::size_t i) {
      walk(stretches_[i].task, stretches_[i].level, stretches_[i].table, stretches_[i].runs);
    });
    LabelMapBuilder builder(depth_);
    std::size_t runs = 0;
    for (const Stretch& stretch : stretches_) runs += stretch.runs.size();
    builder.reserve(runs);
    for (const Stretch& stretch : stretches_)
      for (const Run& run : stretch.runs) builder.add(run.count, run.colour);
    return builder.finish(std::move(frame));
  }

 private:
  static constexpr int kStretchLevels = 3;  // stretches are nodes at most this far below the root: at most 512

  struct Stretch {
    Task task;
    int level;
    std::uint8_t table;
    std::vector<Run> runs;
  };

  void cut(const Task& task, int level, std::uint8_t table) {
    if (level <= depth_ - kStretchLevels || level == 0 || producer_.label(task, level)) {
      stretches_.push_back({task, level, table, {}});
      return;
    }
    for (const curve::Step step : curve::kSteps[table])
      cut(producer_.child(task, level, step.octant), level - 1, step.table);
  }

  void walk(const Task& task, int level, std::uint8_t table, std::vector<Run>& runs) const {
    if (const std::optional<std::uint32_t> label = producer_.label(task, level)) {
      const std::uint64_t voxels = std::uint64_t{1} << (3 * level);
      if (runs.empty() || runs.back().colour != *label)
        runs.push_back({voxels, *label});
      else
        runs.back().count += voxels;
      return;
    }
    for (const curve::Step step : curve::kSteps[table])
      walk(producer_.child(task, level, step.octant), level - 1, step.table, runs);
  }

  const Producer& producer_;
  const int depth_;
  const Work& work_;
  std::vector<Stretch> stretches_;  // in curve order
};

template <class Producer>
LabelMap produce_labels(const Producer& producer, int depth, Frame frame, const Work& work) {
  return LabelProduction<Producer>(producer, depth, work).run(std::move(frame));
}

}  // namespace blackleaf::detail
