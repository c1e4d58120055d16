// OpenVDB: shifting by whole voxels. It has no function for that; what is active is copied, on one thread.
#include <openvdb/tools/Prune.h>

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

void timed(benchmark::State& state, int depth, const Coord& by) {
  const MaskGrid::Ptr source = mask_grid(bunny(depth));
  const auto limit = at_most(1);
  MaskGrid::Ptr target;
  for (auto _ : state) target = copied(*source, by);
  if (target->activeVoxelCount() != source->activeVoxelCount()) state.SkipWithError("OpenVDB has lost voxels");
}

}  // namespace

void add_openvdb_translate() {
  constexpr int kRepetitions = 3;  // of what takes seconds
  for (const auto& [name, by] :
       {std::pair<std::string, Coord>{"translate", Coord(5, -7, 3)}, {"translate-even", Coord(16, -32, 48)}})
    for (const int depth : {8, 9, 10}) {
      const Coord shift = by;
      contender(name + "/" + side_name(depth) + "/t1", "openvdb-copy",
                [=](benchmark::State& state) { timed(state, depth, shift); })
          ->Iterations(1)
          ->Repetitions(kRepetitions);
    }
}

}  // namespace blackleaf::bench
