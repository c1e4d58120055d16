// OpenVDB: shifting by whole voxels. It has no function for that; there is resampling, and copying what is active.
#include <openvdb/tools/GridTransformer.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/Prune.h>

#include "blackleaf/measures.h"
#include "contenders.h"
#include "inputs.h"
#include "peers/openvdb_grids.h"

namespace blackleaf::bench {
namespace {

using openvdb::Coord;
using openvdb::MaskGrid;

MaskGrid::Ptr copied(const MaskGrid& source, const Coord& by) {
  MaskGrid::Ptr target = MaskGrid::create();
  auto accessor = target->getAccessor();
  for (auto active = source.cbeginValueOn(); active; ++active) {
    if (active.isVoxelValue())
      accessor.setValueOn(active.getCoord() + by);
    else
      target->tree().fill(openvdb::CoordBBox(active.getBoundingBox().min() + by, active.getBoundingBox().max() + by),
                          true);
  }
  openvdb::tools::prune(target->tree());
  return target;
}

MaskGrid::Ptr resampled(const MaskGrid& source, const Coord& by) {
  openvdb::Mat4R matrix = openvdb::Mat4R::identity();
  matrix.setTranslation(openvdb::Vec3d(by.x(), by.y(), by.z()));
  MaskGrid::Ptr target = MaskGrid::create();
  openvdb::tools::GridTransformer(matrix).transformGrid<openvdb::tools::PointSampler>(source, *target);
  return target;
}

template <class Move>
void timed(benchmark::State& state, int depth, int threads, const Coord& by, const Move& move) {
  const MaskGrid::Ptr source = mask_grid(bunny(depth));
  const auto limit = at_most(threads);
  MaskGrid::Ptr target;
  for (auto _ : state) target = move(*source, by);
  if (target->activeVoxelCount() != source->activeVoxelCount()) state.SkipWithError("OpenVDB has lost voxels");
}

}  // namespace

void add_openvdb_translate() {
  constexpr int kRepetitions = 3;  // of what takes seconds
  for (const auto& [name, by] :
       {std::pair<std::string, Coord>{"translate", Coord(5, -7, 3)}, {"translate-even", Coord(16, -32, 48)}})
    for (const int depth : {8, 9, 10})
      for (const int threads : {1, 2}) {
        const std::string key = name + "/" + side_name(depth) + "/t" + std::to_string(threads);
        const Coord shift = by;
        if (threads == 1)
          contender(key, "openvdb-copy", [=](benchmark::State& s) { timed(s, depth, threads, shift, copied); })
              ->Iterations(1)
              ->Repetitions(kRepetitions);
        contender(key, "openvdb", [=](benchmark::State& s) { timed(s, depth, threads, shift, resampled); })
            ->Iterations(1)
            ->Repetitions(kRepetitions);
      }
}

}  // namespace blackleaf::bench
