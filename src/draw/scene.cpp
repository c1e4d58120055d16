#include "blackleaf/scene.h"

#include <cassert>

#include "blackleaf/error.h"
#include "blackleaf/implicit.h"
#include "blackleaf/move.h"
#include "blackleaf/set_operations.h"
#include "octree/parallel.h"
#include "octree/same_depth.h"

namespace blackleaf {

struct Scene::Storage {
  std::vector<Octree> solids;
  Octree all;
  std::vector<std::array<Octree, 6>> cut;  // by solid: 2 axis + upward; none for scenes that are not cut
  Octree nothing;
};

Scene::Scene(std::shared_ptr<const Storage> storage) : storage_(std::move(storage)) {}

Scene::Scene(std::vector<Octree> solids, const Work& work) {
  assert(!solids.empty());
  for (const Octree& solid : solids) detail::require_same_depth(solids.front(), solid);
  Octree all = solids.size() == 1 ? solids.front() : unite(solids, work);
  const int depth = all.depth();
  storage_ = std::make_shared<const Storage>(Storage{std::move(solids), std::move(all), {}, Octree(depth)});
}

std::span<const Octree> Scene::solids() const { return storage_->solids; }
const Octree& Scene::all() const { return storage_->all; }

const Octree& Scene::cut_voxels(std::size_t solid, unsigned axis, bool upward) const {
  assert(solid < storage_->solids.size() && axis < 3);
  return storage_->cut.empty() ? storage_->nothing : storage_->cut[solid][2 * axis + (upward ? 1 : 0)];
}

Scene Scene::without(std::span<const Box> removed, const Work& work) const {
  const Storage& before = *storage_;
  const int depth = before.all.depth();
  std::vector<Octree> boxes;
  boxes.reserve(removed.size());
  for (const Box& b : removed) boxes.push_back(box(depth, b.min, b.max));
  if (boxes.empty()) return *this;
  const Octree gone = unite(boxes, {work.threads, {}});
  // The voxels that touch what the union has lost, by the side on which they do.
  const Octree lost = intersect(before.all, gone, {work.threads, {}});
  std::vector<Octree> beside;
  const auto beside_along = [&](unsigned side) {
    std::array<std::int64_t, 3> by{};
    by[side / 2] = side % 2 ? -1 : 1;  // what lies above a voxel comes down to it
    return translate(lost, by, Leaving::clip, {work.threads, {}});
  };
  for (unsigned side = 0; side < 6; ++side) beside.push_back(beside_along(side));

  Storage after{before.solids, before.all, {}, before.nothing};
  after.cut.assign(before.solids.size(),
                   {before.nothing, before.nothing, before.nothing, before.nothing, before.nothing, before.nothing});
  detail::for_each_index(before.solids.size(), work, [&](std::size_t i) {
    const Octree kept = subtract(before.solids[i], gone, {1, {}});
    for (unsigned side = 0; side < 6; ++side) {
      Octree& faces = after.cut[i][side];
      faces = intersect(kept, beside[side], {1, {}});
      // Faces that an earlier cut has made.
      if (!before.cut.empty()) faces = unite(faces, intersect(before.cut[i][side], kept, {1, {}}), {1, {}});
    }
    after.solids[i] = kept;
  });
  after.all = subtract(before.all, gone, {work.threads, {}});
  return Scene(std::make_shared<const Storage>(std::move(after)));
}

std::vector<LabelledSolid> solids_of_labels(const LabelMap& map, const Work& work) {
  // The runs of each label with gaps between them, as monochrome streams: black first.
  struct Stream {
    std::uint32_t label = 0;
    std::uint64_t end = 0;  // voxels told so far
    std::vector<std::uint64_t> counts;
  };
  std::vector<std::uint32_t> labels(map.labels().begin(), map.labels().end());
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  if (!labels.empty() && labels.front() == 0) labels.erase(labels.begin());
  std::vector<Stream> streams(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) streams[i].label = labels[i];
  for (std::size_t run = 0; run < map.run_count(); ++run) {
    const std::uint32_t label = map.labels()[run];
    if (label == 0) continue;
    const auto place = std::lower_bound(labels.begin(), labels.end(), label) - labels.begin();
    Stream& stream = streams[static_cast<std::size_t>(place)];
    const std::uint64_t start = map.starts()[run];
    if (start > 0) {
      if (stream.counts.empty()) stream.counts.push_back(0);
      stream.counts.push_back(start - stream.end);
    }
    stream.counts.push_back(map.count(run));
    stream.end = start + map.count(run);
  }
  std::vector<LabelledSolid> solids(streams.size());
  const std::uint64_t voxels = std::uint64_t{1} << (3 * map.depth());
  detail::for_each_index(streams.size(), work, [&](std::size_t i) {
    Stream& stream = streams[i];
    if (stream.end < voxels) stream.counts.push_back(voxels - stream.end);
    solids[i] = {stream.label, octree_from_monochrome(stream.counts, map.depth(), map.frame())};
    std::vector<std::uint64_t>().swap(stream.counts);
  });
  return solids;
}

}  // namespace blackleaf
