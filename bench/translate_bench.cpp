// translate/N/tT: a shift by (5, -7, 3) voxels, odd on every axis. translate-even/N/tT: by (16, -32, 48). "move" is the
// general engine by the same vector, which move() itself would give to translate().
#include "blackleaf/move.h"
#include "contenders.h"
#include "inputs.h"
#include "motion/move_general.h"
#include "papers/an84.h"

namespace blackleaf::bench {
namespace {

using Shift = std::array<std::int64_t, 3>;

void ours(benchmark::State& state, int depth, const Shift& by, int threads) {
  const Octree& octree = bunny(depth);
  for (auto _ : state) benchmark::DoNotOptimize(translate(octree, by, Leaving::error, {threads, {}}));
}

void general(benchmark::State& state, int depth, const Shift& by, int threads) {
  const Octree& octree = bunny(depth);
  const Motion motion =
      Motion::translation({static_cast<double>(by[0]), static_cast<double>(by[1]), static_cast<double>(by[2])});
  for (auto _ : state) benchmark::DoNotOptimize(detail::move_by_look_up(octree, motion, Leaving::error, {threads, {}}));
}

// AN84 changes its tree in place; making the tree is not timed.
void paper(benchmark::State& state, int depth, const Shift& by) {
  for (auto _ : state) {
    state.PauseTiming();
    {
      papers::an84::Tree tree(bunny(depth));
      state.ResumeTiming();
      tree.translate(by);
      benchmark::DoNotOptimize(tree.nodes());
      state.PauseTiming();
    }
    state.ResumeTiming();
  }
}

}  // namespace

void add_translate() {
  for (const auto& [name, by] :
       {std::pair<std::string, Shift>{"translate", {5, -7, 3}}, {"translate-even", {16, -32, 48}}})
    for (const int depth : {8, 9, 10})
      for (const int threads : {1, 2}) {
        const std::string key = name + "/" + side_name(depth) + "/t" + std::to_string(threads);
        contender(key, "ours", [=](benchmark::State& s) { ours(s, depth, by, threads); });
        contender(key, "move", [=](benchmark::State& s) { general(s, depth, by, threads); });
        if (threads == 1 && depth <= 9) contender(key, "paper", [=](benchmark::State& s) { paper(s, depth, by); });
      }
}

}  // namespace blackleaf::bench
