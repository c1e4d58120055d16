// MoveProducer: a producer (octree/produce.h) for a solid that has been moved.
#pragma once

#include <array>
#include <bit>
#include <vector>

#include "centre_kernel.h"
#include "moved_back.h"
#include "neighbourhood.h"
#include "octree/node_arrays.h"

namespace blackleaf::detail {

class MoveProducer {
 public:
  struct Task {
    Neighbourhood source;           // if the node is gray and not larger than the whole source
    Colour colour = Colour::white;  // gray: not known
    bool above_source = false;
  };

  /// `depth` is the target's. Requires: the source outlives the producer.
  MoveProducer(const FixedMotion& motion, const Octree& source, int depth);

  Task root() const;
  Colour classify(const Task& task, const Cube&) const { return task.colour; }
  Task child(const Task& task, const Cube& cube, int octant) const;
  std::array<Subtree, 8> bricks(const Task& task, const Cube& cube) const;
  /// Universes smaller than 8^3 are octant 0 of one of that size.
  std::uint64_t brick(const Task& task, const Cube&) const;
  /// A moved solid has about as many nodes as before.
  void reserve(NodeArrays& arrays) const;

 private:
  void enter(Task& task, const Cube& cube) const;
  std::uint64_t exactly(const MovedBack::Point& first, const BrickLookUp& found, std::uint64_t which) const;

  MovedBack back_;
  SourceTree source_;
  int depth_;
  CentreSteps cut_steps_;
  std::array<MovedBack::Point, 8> octants_{};              // from the first centre of a node of level 3 to its bricks'
  std::vector<std::array<std::uint16_t, 3>> planes_side_;  // what is added to coordinates: see the constructor
};

}  // namespace blackleaf::detail
