// move/N/tT: 30 degrees about (1,1,1) through the universe's centre and a translation of (5.3, -7.1, 2.9) voxels.
#include "blackleaf/move.h"

#include <cmath>

#include "contenders.h"
#include "inputs.h"
#include "papers/wa87.h"

namespace blackleaf::bench {
namespace {

void ours(benchmark::State& state, int depth, int threads) {
  const Octree& octree = bunny(depth);
  const Motion motion = bunny_motion(depth);
  for (auto _ : state) benchmark::DoNotOptimize(move(octree, motion, Leaving::error, {threads, {}}));
}

void paper(benchmark::State& state, int depth) {
  const papers::wa87::Tree source(bunny(depth));
  const FixedMotion motion(bunny_motion(depth));
  for (auto _ : state) benchmark::DoNotOptimize(move(source, motion));
}

// Dense volumes: every target voxel's centre moved back, the nearest source voxel taken, row by row.
void dense(benchmark::State& state, int depth) {
  const auto& source = bunny_volume(depth);
  const Motion back = bunny_motion(depth).inverse();
  const Eigen::Vector3d step = back.rotation().col(0);
  const std::int64_t side = std::int64_t{1} << depth;
  const auto sides = static_cast<double>(side);
  std::vector<std::uint8_t> target(source.size());
  for (auto _ : state) {
    std::uint8_t* out = target.data();
    for (std::int64_t z = 0; z < side; ++z)
      for (std::int64_t y = 0; y < side; ++y) {
        Eigen::Vector3d at = back(Eigen::Vector3d(0.5, static_cast<double>(y) + 0.5, static_cast<double>(z) + 0.5));
        for (std::int64_t x = 0; x < side; ++x, at += step) {
          const bool inside = at.minCoeff() >= 0 && at.maxCoeff() < sides;
          *out++ = inside
                       ? source[static_cast<std::size_t>(
                             (static_cast<std::int64_t>(at.z()) << depth | static_cast<std::int64_t>(at.y())) << depth |
                             static_cast<std::int64_t>(at.x()))]
                       : std::uint8_t{0};
        }
      }
    benchmark::ClobberMemory();
  }
}

}  // namespace

void add_move() {
  for (const int depth : {7, 8, 9, 10})
    for (const int threads : {1, 2}) {
      const std::string key = "move/" + side_name(depth) + "/t" + std::to_string(threads);
      contender(key, "ours", [=](benchmark::State& s) { ours(s, depth, threads); });
      if (threads == 1 && depth <= 9) contender(key, "paper", [=](benchmark::State& s) { paper(s, depth); });
      if (threads == 1 && depth <= 9) contender(key, "dense", [=](benchmark::State& s) { dense(s, depth); });
    }
}

}  // namespace blackleaf::bench
