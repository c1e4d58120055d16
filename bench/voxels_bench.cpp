// voxels/N/tT: the octree of a volume of N^3 bytes.
#include <cstring>
#include <thread>

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

// The least that anybody must do who looks at every voxel: add the volume up, byte by byte, or as words of 64 bits,
// which is as fast as memory comes. Each thread adds up a stretch.
template <class Number>
void read(benchmark::State& state, int depth, std::size_t threads) {
  const auto& volume = bunny_volume(depth);
  const auto sum = [&](std::size_t from, std::size_t to) {
    std::uint64_t total = 0;
    for (std::size_t i = from; i < to; i += sizeof(Number)) {
      Number number = 0;
      std::memcpy(&number, &volume[i], sizeof number);
      total += number;
    }
    return total;
  };
  for (auto _ : state) {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < threads; ++i)
      others.emplace_back(
          [&, i] { benchmark::DoNotOptimize(sum(i * volume.size() / threads, (i + 1) * volume.size() / threads)); });
    benchmark::DoNotOptimize(sum(0, volume.size() / threads));
  }
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
      const auto readers = static_cast<std::size_t>(threads);
      contender(key, "read", [=](benchmark::State& s) { read<std::uint8_t>(s, depth, readers); });
      contender(key, "read-words", [=](benchmark::State& s) { read<std::uint64_t>(s, depth, readers); });
      if (depth <= 9)
        contender(key, "paper", [=](benchmark::State& s) { paper(s, depth, static_cast<unsigned>(threads)); });
    }
}

}  // namespace blackleaf::bench
