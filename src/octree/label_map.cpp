#include "blackleaf/label_map.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <map>
#include <string>
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
  starts_.shrink_to_fit();
  labels_.shrink_to_fit();
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

std::vector<LabelFacts> label_facts(const LabelMap& map) {
  std::map<std::uint32_t, LabelFacts> facts;
  for (std::size_t run = 0; run < map.run_count(); ++run) {
    const std::uint32_t label = map.labels()[run];
    if (label == 0) continue;
    const auto [place, is_new] = facts.try_emplace(label);
    LabelFacts& known = place->second;
    if (is_new) {
      known.label = label;
      known.bounding_box = {{map.side(), map.side(), map.side()}, {0, 0, 0}};
    }
    std::uint64_t at = map.starts()[run], left = map.count(run);
    known.volume += left;
    // The run as the largest aligned cubes.
    while (left > 0) {
      int level = at == 0 ? map.depth() : std::min(map.depth(), std::countr_zero(at) / 3);
      while (voxels_of(level) > left) --level;
      const Cube cube = curve::cube(map.depth(), at, level);
      const std::array<std::int32_t, 3> corner = {cube.x, cube.y, cube.z};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        known.bounding_box.min[axis] = std::min(known.bounding_box.min[axis], corner[axis]);
        known.bounding_box.max[axis] = std::max(known.bounding_box.max[axis], corner[axis] + cube.side());
      }
      at += voxels_of(level);
      left -= voxels_of(level);
    }
  }
  std::vector<LabelFacts> result;
  for (const auto& [label, known] : facts) result.push_back(known);
  return result;
}

}  // namespace blackleaf
