// mesh/N/tT: the octree of a closed mesh in a universe of N^3 voxels.
#include "blackleaf/mesh.h"

#include "contenders.h"
#include "inputs.h"

namespace blackleaf::bench {

void add_mesh() {
  for (const int depth : {8, 9, 10})
    for (const int threads : {1, 2})
      contender("mesh/" + side_name(depth) + "/t" + std::to_string(threads), "ours", [=](benchmark::State& state) {
        const MeshPlacement placement = bunny_placement(depth);
        for (auto _ : state)
          benchmark::DoNotOptimize(octree_from_mesh(bunny_mesh(), placement, MeshRule::centre, {threads, {}}));
      });
}

}  // namespace blackleaf::bench
