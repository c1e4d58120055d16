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
// which is asked when one thread makes all of them.
//
// Its functions are called from many threads. In a universe of depth 1 the root is asked for as a brick whose octant 0
// is the universe; what it says of the other voxels is ignored (classify must then not answer black unless octant 0 is
// black and not white unless it is white).
//
// The curve is cut into the stretches of nodes of one level; each is produced into arrays of its own and they are
// joined in curve order, as MHF92 (section 4) joins its processors' tuples. The result does not depend on the cut.
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "blackleaf/work.h"
#include "node_arrays.h"
#include "parallel.h"

namespace blackleaf::detail {

template <class Producer>
Subtree produce_node(const Producer& producer, typename Producer::Task& task, const Cube& cube, std::uint8_t table,
                     NodeArrays& arrays);

/// produce_node() for a node of which the producer has said that it is gray.
template <class Producer>
Subtree produce_gray_node(const Producer& producer, typename Producer::Task& task, const Cube& cube, std::uint8_t table,
                          NodeArrays& arrays) {
  if constexpr (requires { producer.subtree(task, cube, table, arrays); }) {
    return producer.subtree(task, cube, table, arrays);
  } else {
    if constexpr (requires { producer.bricks(task, cube); })
      if (cube.level == 3) return arrays.close(3, producer.bricks(task, cube));
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

/// The node of level 2 at least that `cube` is, entered with `table`; `task` is what the producer knows of it.
template <class Producer>
Subtree produce_node(const Producer& producer, typename Producer::Task& task, const Cube& cube, std::uint8_t table,
                     NodeArrays& arrays) {
  bool ask = true;
  if constexpr (requires { producer.subtree(task, cube, table, arrays); })
    ask = false;
  else if constexpr (requires { producer.bricks(task, cube); })
    ask = cube.level != 3;
  if (ask) {
    const Colour colour = producer.classify(task, cube);
    if (colour != Colour::gray) return Subtree::uniform(colour);
  }
  return produce_gray_node(producer, task, cube, table, arrays);
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
    } else if (thread_count(work_) == 1) {
      if constexpr (requires { producer_.reserve(arrays); }) producer_.reserve(arrays);
      Progress progress(work_, std::size_t{1} << (3 * kStretchLevels));
      Task task = producer_.root();
      top = walk(task, root, 0, arrays, progress);
    } else {
      outline(producer_.root(), root, 0);
      std::vector<PackedNode> nodes(stretches_.size());
      for_each_index(nodes.size(), work_, [&](std::size_t i) { nodes[i] = produce(stretches_[i]); });
      stretches_.clear();
      std::size_t next_part = 0, next_node = 0;
      top = join(root, 0, nodes, next_part, next_node, arrays);
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
  };

  PackedNode produce(Stretch& stretch) const {
    NodeArrays arrays;
    return arrays.pack(produce_gray_node(producer_, stretch.task, stretch.cube, stretch.table, arrays),
                       stretch.cube.level);
  }

  // The same as produce_node, and progress is told.
  Subtree walk(Task& task, const Cube& cube, std::uint8_t table, NodeArrays& arrays, Progress& progress) const {
    const int levels = cube.level - (depth_ - kStretchLevels);  // down to stretches
    Subtree result;
    if (levels == 0) {
      result = produce_node(producer_, task, cube, table, arrays);
    } else {
      const Colour colour = producer_.classify(task, cube);
      if (colour == Colour::gray) {
        std::array<Subtree, 8> children;
        for (const curve::Step step : curve::kSteps[table]) {
          const Cube child = cube.child(step.octant);
          auto below = producer_.child(task, child, step.octant);
          children[step.octant] = walk(below, child, step.table, arrays, progress);
        }
        return arrays.close(cube.level, children);
      }
      result = Subtree::uniform(colour);
    }
    progress.step(std::size_t{1} << (3 * levels));
    return result;
  }

  static Subtree byte(Subtree top) {
    if (top.colour != Colour::gray) return top;
    const std::uint64_t bits = top.word & 0xFF;
    return {bits, bits == 0 ? Colour::white : bits == 0xFF ? Colour::black : Colour::gray};
  }

  // Walks the top of the tree in curve order; writes what it decides to parts_ and leaves the rest as stretches.
  void outline(Task task, const Cube& cube, std::uint8_t table) {
    const Colour colour = producer_.classify(task, cube);
    parts_.push_back(colour);
    if (colour != Colour::gray) return;
    if (cube.level == depth_ - kStretchLevels) {
      stretches_.push_back({std::move(task), cube, table});
      return;
    }
    for (const curve::Step step : curve::kSteps[table]) {
      const Cube child = cube.child(step.octant);
      outline(producer_.child(task, child, step.octant), child, step.table);
    }
  }

  Subtree join(const Cube& cube, std::uint8_t table, std::vector<PackedNode>& nodes, std::size_t& part,
               std::size_t& node, NodeArrays& arrays) const {
    const Colour colour = parts_[part++];
    if (colour != Colour::gray) return Subtree::uniform(colour);
    if (cube.level == depth_ - kStretchLevels) return arrays.append(std::move(nodes[node++]));
    std::array<Subtree, 8> children;
    for (const curve::Step step : curve::kSteps[table])
      children[step.octant] = join(cube.child(step.octant), step.table, nodes, part, node, arrays);
    return arrays.close(cube.level, children);
  }

  const Producer& producer_;
  const int depth_;
  const Work& work_;
  std::vector<Colour> parts_;      // verdicts on the nodes above the stretches, in pre-order along the curve
  std::deque<Stretch> stretches_;  // in curve order; not a vector: tasks may be large
};

template <class Producer>
Octree produce(const Producer& producer, int depth, Frame frame, const Work& work) {
  return Production<Producer>(producer, depth, work).run(std::move(frame));
}

}  // namespace blackleaf::detail
