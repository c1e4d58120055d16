#include "blackleaf/label_map.h"

#include <algorithm>
#include <cassert>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "blackleaf/curve.h"
#include "blackleaf/error.h"

namespace blackleaf {
namespace {

constexpr std::uint64_t voxels_of(int level) { return std::uint64_t{1} << (3 * level); }

}  // namespace

struct LabelMap::Storage {
  int depth = 1;
  std::shared_ptr<const LabelMapBuilder> runs;  // complete
  Frame frame;
};

LabelMap::LabelMap(int depth, Frame frame) {
  assert(depth >= 1 && depth <= kMaxDepth);
  LabelMapBuilder builder(depth);
  builder.add(voxels_of(depth), 0);
  *this = builder.finish(std::move(frame));
}

LabelMap::LabelMap(std::span<const Run> runs, int depth, Frame frame) {
  if (depth < 1 || depth > kMaxDepth)
    throw Error(ErrorCode::bad_argument, "depth " + std::to_string(depth) + " is out of range", "use 1 to 20");
  LabelMapBuilder builder(depth);
  for (const Run& run : runs) {
    if (run.count > voxels_of(depth) - builder.end())
      throw Error(ErrorCode::bad_input,
                  "the stream is longer than the 8^" + std::to_string(depth) + " voxels of its universe",
                  "give the depth it was made for");
    builder.add(run.count, run.colour);
  }
  *this = builder.finish(std::move(frame));
}

LabelMap LabelMapBuilder::finish(Frame frame) {
  if (end_ != voxels_of(depth_))
    throw Error(ErrorCode::bad_input,
                "the stream tells of " + std::to_string(end_) + " voxels, not of the 8^" + std::to_string(depth_) +
                    " of its universe",
                "give the depth it was made for");
  // Room that was told in advance is nearly right; to move everything for the rest would cost more than it saves.
  if (starts_.capacity() - starts_.size() > starts_.size() / 8) {
    starts_.shrink_to_fit();
    labels_.shrink_to_fit();
  }
  auto runs = std::make_shared<LabelMapBuilder>(depth_);
  runs->end_ = std::exchange(end_, 0);
  runs->starts_ = std::exchange(starts_, {});
  runs->labels_ = std::exchange(labels_, {});
  return LabelMap(std::make_shared<const LabelMap::Storage>(LabelMap::Storage{depth_, runs, std::move(frame)}));
}

int LabelMap::depth() const { return storage_->depth; }
const Frame& LabelMap::frame() const { return storage_->frame; }
LabelMap LabelMap::with_frame(Frame frame) const {
  return LabelMap(std::make_shared<const Storage>(Storage{storage_->depth, storage_->runs, std::move(frame)}));
}

std::span<const std::uint64_t> LabelMap::starts() const { return storage_->runs->starts_; }
std::span<const std::uint32_t> LabelMap::labels() const { return storage_->runs->labels_; }

std::uint64_t LabelMap::count(std::size_t run) const {
  const auto& starts = storage_->runs->starts_;
  assert(run < starts.size());
  return (run + 1 < starts.size() ? starts[run + 1] : voxels_of(depth())) - starts[run];
}

std::vector<Run> LabelMap::runs() const {
  std::vector<Run> result;
  result.reserve(run_count());
  for (std::size_t run = 0; run < run_count(); ++run) result.push_back({count(run), labels()[run]});
  return result;
}

std::uint32_t LabelMap::label(std::int64_t x, std::int64_t y, std::int64_t z) const {
  if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= side()) return 0;
  const std::uint64_t number = curve::number(
      depth(), {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), static_cast<std::int32_t>(z)});
  const auto after = std::upper_bound(starts().begin(), starts().end(), number);
  return labels()[static_cast<std::size_t>(after - starts().begin()) - 1];
}

std::size_t LabelMap::memory_bytes() const {
  return sizeof(Storage) + sizeof(LabelMapBuilder) + run_count() * (sizeof(std::uint64_t) + sizeof(std::uint32_t));
}

bool operator==(const LabelMap& a, const LabelMap& b) {
  return a.depth() == b.depth() && std::ranges::equal(a.starts(), b.starts()) &&
         std::ranges::equal(a.labels(), b.labels());
}

Octree octree_from_labels(const LabelMap& map, const std::function<bool(std::uint32_t)>& wanted) {
  std::size_t run = 0;
  return octree_from_source(
      [&](std::uint64_t& count, bool& black) {
        if (run == map.run_count()) return false;
        const std::uint32_t label = map.labels()[run];
        count = map.count(run++);
        black = wanted ? wanted(label) : label != 0;
        return true;
      },
      map.depth(), map.frame());
}

Octree octree_from_label(const LabelMap& map, std::uint32_t label) {
  return octree_from_labels(map, [label](std::uint32_t other) { return other == label; });
}

LabelMap label_map(const Octree& octree) {
  LabelMapBuilder builder(octree.depth());
  for_each_run(octree, [&](std::uint64_t count, bool black) { builder.add(count, black ? 1 : 0); });
  return builder.finish(octree.frame());
}

namespace {

// The cubes of a map, from the root down: a node of one label is one run's, or a part of it.
template <class Visit>
class CubeWalk {
 public:
  CubeWalk(const LabelMap& map, Visit& visit) : map_(map), visit_(visit), left_(map.count(0)) {}

  void node(const Cube& cube, std::uint8_t table) {
    const std::uint64_t voxels = voxels_of(cube.level);
    if (left_ >= voxels) {
      visit_(cube, map_.labels()[run_]);
      left_ -= voxels;
      if (left_ == 0 && ++run_ < map_.run_count()) left_ = map_.count(run_);
      return;
    }
    for (const curve::Step step : curve::kSteps[table]) node(cube.child(step.octant), step.table);
  }

 private:
  const LabelMap& map_;
  Visit& visit_;
  std::size_t run_ = 0;
  std::uint64_t left_;  // voxels of the run
};

template <class Visit>
void visit_cubes(const LabelMap& map, Visit&& visit) {
  CubeWalk<std::remove_reference_t<Visit>>(map, visit).node({0, 0, 0, map.depth()}, 0);
}

}  // namespace

void for_each_label_cube(const LabelMap& map, const std::function<void(const Cube&, std::uint32_t)>& visit) {
  visit_cubes(map, visit);
}

std::vector<LabelFacts> label_facts(const LabelMap& map) {
  std::unordered_map<std::uint32_t, LabelFacts> found;
  LabelFacts* known = nullptr;  // the one met last is often met again
  visit_cubes(map, [&](const Cube& cube, std::uint32_t label) {
    if (label == 0) return;
    if (known == nullptr || known->label != label)
      known = &found.try_emplace(label, LabelFacts{label, 0, {{map.side(), map.side(), map.side()}, {0, 0, 0}}})
                   .first->second;
    known->volume += voxels_of(cube.level);
    const std::array<std::int32_t, 3> corner = {cube.x, cube.y, cube.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      known->bounding_box.min[axis] = std::min(known->bounding_box.min[axis], corner[axis]);
      known->bounding_box.max[axis] = std::max(known->bounding_box.max[axis], corner[axis] + cube.side());
    }
  });
  std::vector<LabelFacts> facts;
  facts.reserve(found.size());
  for (const auto& entry : found) facts.push_back(entry.second);
  std::ranges::sort(facts, {}, &LabelFacts::label);
  return facts;
}

}  // namespace blackleaf
