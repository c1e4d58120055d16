// produce: every octree that is computed node by node is computed here, along the Millar curve, on all cores.
//
// A producer answers questions about target nodes and carries what it knows of a node down to the node's children:
//
//   struct Producer {
//     using Task = ...;                                   // what is known about one target node; cheap to copy
//     Task root() const;
//     Colour classify(Task&, const Cube&) const;          // black or white if all of it is; gray: split it
//     Task child(const Task&, const Cube& child, int octant) const;
//     std::uint64_t brick(const Task&, const Cube&) const; // the 64 voxels of a level-2 node
//   };
//
// and, if it knows a shortcut,
//
//     std::array<Subtree, 8> bricks(const Task&, const Cube&) const;  // the children of a level-3 node
//
// which is then asked instead of the three above for nodes of level 3, or even
//
//     Subtree subtree(Task&, const Cube&, std::uint8_t table, NodeArrays&) const;  // all of a node
//
// which is then asked instead of all others for every node below the top three levels, and must make its nodes in the
// order of the Millar curve, which enters the node with `table`. A producer that can guess how many nodes there will be
// has
//
//     void reserve(NodeArrays&) const;  // makes room for them
//
//
// Its functions are called from many threads. In a universe of depth 1 the root is asked for as a brick whose octant 0
// is the universe; what it says of the other voxels is ignored (classify must then not answer black unless octant 0 is
// black and not white unless it is white).
//
// The curve is cut into the stretches of nodes of one level; each is produced into arrays of its own and they are
// joined in curve order, as MHF92 (section 4) joins its processors' tuples. The result does not depend on the cut.
#pragma once

#include <array>
#include <vector>

#include "blackleaf/work.h"
#include "node_arrays.h"
#include "parallel.h"

namespace blackleaf::detail {

/// The node of level 2 at least that `cube` is, entered with `table`; `task` is what the producer knows of it.
template <class Producer>
Subtree produce_node(const Producer& producer, typename Producer::Task& task, const Cube& cube, std::uint8_t table,
                     NodeArrays& arrays) {
  if constexpr (requires { producer.subtree(task, cube, table, arrays); }) {
    return producer.subtree(task, cube, table, arrays);
  } else {
    if constexpr (requires { producer.bricks(task, cube); })
      if (cube.level == 3) return arrays.close(3, producer.bricks(task, cube));
    const Colour colour = producer.classify(task, cube);
    if (colour != Colour::gray) return Subtree::uniform(colour);
    if (cube.level == 2) return Subtree::brick(producer.brick(task, cube));
    std::array<Subtree, 8> children;
    for (const curve::Step step : curve::kSteps[table]) {
      const Cube child = cube.child(step.octant);
      auto below = producer.child(task, child, step.octant);
      children[step.octant] = produce_node(producer, below, child, step.table, arrays);
    }
    return arrays.close(cube.level, children);
  }
}

template <class Producer>
class Production {
  using Task = typename Producer::Task;

 public:
  Production(const Producer& producer, int depth, const Work& work) : producer_(producer), depth_(depth), work_(work) {}

  Octree run(Frame frame) {
    const Cube root{0, 0, 0, depth_ < 2 ? 2 : depth_};
    NodeArrays arrays;
    Subtree top;
    if (depth_ <= kSerialDepth) {
      Task task = producer_.root();
      top = produce_node(producer_, task, root, 0, arrays);
      if (depth_ == 1) top = byte(top);
    } else {
      outline(producer_.root(), root, 0);
      if constexpr (requires { producer_.reserve(arrays); }) producer_.reserve(arrays);
      if (thread_count(work_) == 1) {
        // No need for arrays of their own: one thread walks the curve.
        for_each_index(stretches_.size(), work_, [&](std::size_t i) { produce(stretches_[i], arrays); });
      } else {
        std::vector<NodeArrays> own(stretches_.size());
        for_each_index(own.size(), work_, [&](std::size_t i) { produce(stretches_[i], own[i]); });
        for (std::size_t i = 0; i < own.size(); ++i)
          stretches_[i].result = arrays.append(own[i], stretches_[i].result, stretches_[i].cube.level);
      }
      std::size_t next_part = 0, next_stretch = 0;
      top = join(root, 0, next_part, next_stretch, arrays);
    }
    return arrays.finish(depth_, top, std::move(frame));
  }

 private:
  static constexpr int kSerialDepth = 5;    // smaller universes are not worth cutting
  static constexpr int kStretchLevels = 3;  // stretches are nodes this far below the root: at most 512

  struct Stretch {
    Task task;
    Cube cube;
    std::uint8_t table;
    Subtree result;
  };

  void produce(Stretch& stretch, NodeArrays& arrays) const {
    stretch.result = produce_node(producer_, stretch.task, stretch.cube, stretch.table, arrays);
  }

  static Subtree byte(Subtree top) {
    if (top.colour != Colour::gray) return top;
    const std::uint64_t bits = top.word & 0xFF;
    return {bits, bits == 0 ? Colour::white : bits == 0xFF ? Colour::black : Colour::gray};
  }

  // Walks the top of the tree in curve order; writes what it decides to parts_ and leaves the rest as stretches.
  void outline(Task task, const Cube& cube, std::uint8_t table) {
    if (cube.level == depth_ - kStretchLevels) {
      parts_.push_back(Colour::gray);
      stretches_.push_back({std::move(task), cube, table, {}});
      return;
    }
    const Colour colour = producer_.classify(task, cube);
    parts_.push_back(colour);
    if (colour != Colour::gray) return;
    for (const curve::Step step : curve::kSteps[table]) {
      const Cube child = cube.child(step.octant);
      outline(producer_.child(task, child, step.octant), child, step.table);
    }
  }

  Subtree join(const Cube& cube, std::uint8_t table, std::size_t& part, std::size_t& stretch,
               NodeArrays& arrays) const {
    const Colour colour = parts_[part++];
    if (cube.level == depth_ - kStretchLevels) return stretches_[stretch++].result;
    if (colour != Colour::gray) return Subtree::uniform(colour);
    std::array<Subtree, 8> children;
    for (const curve::Step step : curve::kSteps[table])
      children[step.octant] = join(cube.child(step.octant), step.table, part, stretch, arrays);
    return arrays.close(cube.level, children);
  }

  const Producer& producer_;
  const int depth_;
  const Work& work_;
  std::vector<Colour> parts_;       // verdicts on the nodes above the stretches, in pre-order along the curve
  std::vector<Stretch> stretches_;  // in curve order
};

template <class Producer>
Octree produce(const Producer& producer, int depth, Frame frame, const Work& work) {
  return Production<Producer>(producer, depth, work).run(std::move(frame));
}

}  // namespace blackleaf::detail
