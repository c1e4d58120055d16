// sweep/N/tT: from (-0.15, -0.05, 0) to (0.15, 0.05, 0) of the universe's side, turning by 60 degrees about (1,1,1)
// through its centre, steps below one voxel. Against it: every moved octree made, and all united.
#include "blackleaf/sweep.h"

#include <cmath>

#include "blackleaf/set_operations.h"
#include "contenders.h"
#include "inputs.h"

namespace blackleaf::bench {
namespace {

Path bunny_path(int depth) {
  const double side = std::exp2(depth);
  const Eigen::AngleAxisd turn(M_PI / 3, Eigen::Vector3d(1, 1, 1).normalized());
  return Path({{0, Eigen::Vector3d(-0.15, -0.05, 0) * side, Eigen::Quaterniond::Identity()},
               {1, Eigen::Vector3d(0.15, 0.05, 0) * side, Eigen::Quaterniond(turn)}},
              Eigen::Vector3d::Constant(side / 2));
}

void ours(benchmark::State& state, int depth, int threads) {
  const Octree& octree = bunny(depth);
  const Path path = bunny_path(depth);
  for (auto _ : state) benchmark::DoNotOptimize(sweep(octree, path, 1, Leaving::clip, {threads, {}}));
}

void each_move(benchmark::State& state, int depth) {
  const Octree& octree = bunny(depth);
  const std::vector<Motion> motions = motions_along(octree, bunny_path(depth));
  for (auto _ : state) {
    Octree all(depth);
    for (const Motion& motion : motions) all = unite(all, move(octree, motion, Leaving::clip, {1, {}}), {1, {}});
    benchmark::DoNotOptimize(all);
  }
}

}  // namespace

void add_sweep() {
  for (const int depth : {8, 9, 10})
    for (const int threads : {1, 2}) {
      const std::string key = "sweep/" + side_name(depth) + "/t" + std::to_string(threads);
      contender(key, "ours", [=](benchmark::State& s) { ours(s, depth, threads); });
      if (threads == 1 && depth <= 9)
        contender(key, "moves", [=](benchmark::State& s) { each_move(s, depth); })->Iterations(1)->Repetitions(3);
    }
}

}  // namespace blackleaf::bench
