// voxels/N/tT: the octree of a volume of N^3 bytes.
#include <numeric>

#include "contenders.h"
#include "inputs.h"
#include "papers/mhf92.h"

namespace blackleaf::bench {
namespace {

void ours(benchmark::State& state, int depth, int threads) {
  const auto& volume = bunny_volume(depth);
  for (auto _ : state)
    benchmark::DoNotOptimize(octree_from_voxels<std::uint8_t>(view(volume, depth), ValueRange<std::uint8_t>{1, 255},
                                                              {depth, {}}, {}, {threads, {}}));
}

// The least that anybody must do who looks at every voxel: add the bytes up.
void read(benchmark::State& state, int depth) {
  const auto& volume = bunny_volume(depth);
  for (auto _ : state) benchmark::DoNotOptimize(std::accumulate(volume.begin(), volume.end(), std::uint64_t{0}));
}

// MHF92: the walk with table look-ups for every voxel, then the octree from its tuples.
void paper(benchmark::State& state, int depth, unsigned processors) {
  using namespace papers::mhf92;
  const auto& volume = bunny_volume(depth);
  const auto from_database = [&](std::uint64_t x, std::uint64_t y, std::uint64_t z) -> std::uint32_t {
    return volume[(z << depth | y) << depth | x];
  };
  for (auto _ : state) benchmark::DoNotOptimize(Tree(depth, walkround_in_parallel(depth, processors, from_database)));
}

}  // namespace

void add_voxels() {
  for (const int depth : {8, 9, 10})
    for (const int threads : {1, 2}) {
      const std::string key = "voxels/" + side_name(depth) + "/t" + std::to_string(threads);
      contender(key, "ours", [=](benchmark::State& s) { ours(s, depth, threads); });
      if (threads == 1) contender(key, "read", [=](benchmark::State& s) { read(s, depth); });
      if (depth <= 9)
        contender(key, "paper", [=](benchmark::State& s) { paper(s, depth, static_cast<unsigned>(threads)); });
    }
}

}  // namespace blackleaf::bench
