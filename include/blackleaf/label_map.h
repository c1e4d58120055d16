// LabelMap: a universe in which every voxel has a label, kept as MHF92's labelled stream.
//
// Meaning. A label map of depth n gives each of the 8^n voxels of [0, 2^n]^3 one label, a 32-bit number; 0 is
// background by convention. It is stored as the runs of equal labels along the Millar curve (MHF92, section 3):
// neighbours of one label are one run, so equal maps have equal runs, whoever made them.
//
// Encoding. Two arrays: the number on the curve at which run i begins, and its label. Twelve bytes a run. Run i covers
// the numbers [start(i), start(i+1)), the last one ends at 8^n.
//
// Worked example. Depth 1, every voxel 0 but (1,0,0), which is 7, the second on the curve: starts 0, 1, 2; labels 0, 7,
// 0.
//
// What follows: a map with S voxels on the surfaces between labels has O(S) runs; the label of a voxel costs O(depth)
// for its number and a binary search; the solid of any set of labels is one pass over the runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "blackleaf/frame.h"
#include "blackleaf/measures.h"
#include "blackleaf/octree.h"
#include "blackleaf/runs.h"

namespace blackleaf {

/// An immutable labelled universe with its world frame. Copies share their storage and may be used from many threads.
class LabelMap {
 public:
  /// The universe without labels: all 0. Requires: 1 <= depth <= 20.
  explicit LabelMap(int depth = 1, Frame frame = {});
  /// The map of a labelled stream; neighbours of one label become one run, runs of count 0 are dropped. Throws
  /// Error(bad_argument) for a depth outside 1..20, Error(bad_input) unless the counts add up to exactly 8^depth.
  LabelMap(std::span<const Run> runs, int depth, Frame frame = {});

  int depth() const;
  std::int32_t side() const { return std::int32_t{1} << depth(); }
  const Frame& frame() const;
  /// The same labels with another frame. O(1).
  LabelMap with_frame(Frame frame) const;

  /// Runs in curve order, neighbours of different labels.
  std::size_t run_count() const { return starts().size(); }
  /// The number on the curve at which each run begins, increasing, the first 0; and each run's label.
  std::span<const std::uint64_t> starts() const;
  std::span<const std::uint32_t> labels() const;
  /// Voxels in a run. Requires: run < run_count().
  std::uint64_t count(std::size_t run) const;
  /// The same as a stream (MHF92, section 3).
  std::vector<Run> runs() const;

  /// The label of voxel (x,y,z); 0 outside the universe. O(depth + log runs).
  std::uint32_t label(std::int64_t x, std::int64_t y, std::int64_t z) const;
  /// Bytes held by the runs and the fixed part.
  std::size_t memory_bytes() const;

  /// Equality of labels: same depth and same runs. Frames are not compared. O(runs).
  friend bool operator==(const LabelMap& a, const LabelMap& b);

 private:
  friend class LabelMapBuilder;
  struct Storage;
  explicit LabelMap(std::shared_ptr<const Storage> storage) : storage_(std::move(storage)) {}
  std::shared_ptr<const Storage> storage_;
};

/// Collects a labelled stream run by run: the one place where label maps are made.
class LabelMapBuilder {
 public:
  /// Requires: 1 <= depth <= 20.
  explicit LabelMapBuilder(int depth) : depth_(depth) {}
  /// The next `count` voxels on the curve have this label; any count, 0 too. O(1) amortised.
  void add(std::uint64_t count, std::uint32_t label) {
    if (count == 0) return;
    if (labels_.empty() || labels_.back() != label) {
      starts_.push_back(end_);
      labels_.push_back(label);
    }
    end_ += count;
  }
  /// Room for so many runs.
  void reserve(std::size_t runs) {
    starts_.reserve(runs);
    labels_.reserve(runs);
  }
  /// Voxels told so far.
  std::uint64_t end() const { return end_; }
  /// The map. Throws Error(bad_input) unless end() is 8^depth. Leaves the builder empty.
  LabelMap finish(Frame frame = {});

 private:
  friend class LabelMap;
  int depth_;
  std::uint64_t end_ = 0;
  std::vector<std::uint64_t> starts_;
  std::vector<std::uint32_t> labels_;
};

/// The solid of all voxels whose label is wanted; without `wanted`, of all labels but 0. The frame is the map's.
/// O(runs * depth).
Octree octree_from_labels(const LabelMap& map, const std::function<bool(std::uint32_t)>& wanted = {});
/// The solid of one label. O(runs * depth).
Octree octree_from_label(const LabelMap& map, std::uint32_t label);
/// The solid as a map of labels 1 (black) and 0 (white). O(words).
LabelMap label_map(const Octree& octree);

/// Calls visit(cube, label) for the largest aligned cubes of one label that fill the universe, in curve order: the
/// leaves of an octree of many colours. O(runs * depth).
void for_each_label_cube(const LabelMap& map, const std::function<void(const Cube&, std::uint32_t label)>& visit);

/// What is known of one label.
struct LabelFacts {
  std::uint32_t label = 0;
  std::uint64_t volume = 0;  // voxels
  Box bounding_box;          // upper end exclusive
};
/// Every label that occurs but 0, in increasing order. O(runs * depth).
std::vector<LabelFacts> label_facts(const LabelMap& map);

}  // namespace blackleaf
