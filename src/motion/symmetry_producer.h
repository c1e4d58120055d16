// SymmetryProducer: a producer (octree/produce.h) that copies a tree under a symmetry about the universe's centre.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "blackleaf/lattice.h"
#include "lattice_labels.h"
#include "neighbourhood.h"
#include "octree/node_arrays.h"
#include "relabelled.h"

namespace blackleaf::detail {

class SymmetryProducer {
 public:
  using Task = std::uint64_t;  // a source word, or what stands for one of one colour (SourceTree)

  SymmetryProducer(const Octree& source, const LatticeSymmetry& symmetry)
      : source_(source), depth_(source.depth()), labels_(symmetry) {
    for (int k = 0; k <= kMaxDepth; ++k) words_[static_cast<std::size_t>(k)] = source_.words(k);
    for (int k = 2; k <= depth_; ++k) counts_[static_cast<std::size_t>(k)] = source.words(k).size();
    if (depth_ < 3) small_ = brick_level_root(source).brick();
  }

  Task root() const { return source_.root(); }
  Colour classify(const Task& task, const Cube&) const {
    return task == SourceTree::kWhite ? Colour::white : task == SourceTree::kBlack ? Colour::black : Colour::gray;
  }
  Task child(const Task& task, const Cube& cube, int octant) const {
    const unsigned from = labels_.source(static_cast<unsigned>(octant)), bit = 1u << from;
    if ((task & bit) != 0) return SourceTree::kBlack;
    if ((task >> 8 & bit) == 0) return SourceTree::kWhite;
    return source_.words(cube.level)[(task >> 16) + static_cast<unsigned>(std::popcount(task >> 8 & (bit - 1)))];
  }
  Subtree subtree(const Task& task, const Cube& cube, std::uint8_t table, NodeArrays& arrays) const {
    if (depth_ == 1) return Subtree::brick(labels_.octants(static_cast<unsigned>(small_)));
    if (depth_ == 2) return Subtree::brick(labels_.brick(small_));
    return RelabelledCopy<LatticeLabels>(words_.data(), labels_).node(task, cube.level, table, arrays);
  }
  void reserve(NodeArrays& arrays) const {
    for (int k = 2; k <= depth_; ++k) arrays.reserve(k, counts_[static_cast<std::size_t>(k)]);
  }

 private:
  SourceTree source_;
  int depth_;
  LatticeLabels labels_;
  LevelWords words_{};
  std::array<std::size_t, kMaxDepth + 1> counts_{};
  std::uint64_t small_ = 0;  // all of a universe of depth 1 or 2
};

}  // namespace blackleaf::detail
