#include <algorithm>
#include <array>
#include <ctime>
#include <memory>

#include "blackleaf/implicit.h"
#include "blackleaf/measures.h"
#include "blackleaf/set_operations.h"
#include "contenders.h"
#include "inputs.h"
#include "plan_scene.h"

namespace blackleaf::bench {
namespace {

Octree scaled_box(int depth, std::array<std::int32_t, 3> min, std::array<std::int32_t, 3> max) {
  for (std::size_t i = 0; i < 3; ++i) {
    min[i] <<= depth - 6;
    max[i] <<= depth - 6;
  }
  return box(depth, min, max);
}

}  // namespace

NarrowPassage::NarrowPassage(int depth)
    : environment(subtract(scaled_box(depth, {31, 0, 0}, {33, 64, 64}), scaled_box(depth, {31, 26, 26}, {33, 38, 38}))),
      object(unite(scaled_box(depth, {8, 26, 30}, {24, 30, 34}), scaled_box(depth, {8, 26, 30}, {12, 42, 34}))),
      scale(1 << (depth - 6)) {
  goal.translation = Eigen::Vector3d(34, 0, 0) * scale;
  options.seconds = 300;
  options.shorten = false;
}

void add_timed_plans(const std::string& key, const std::string& who,
                     const std::function<std::function<bool(std::uint32_t)>()>& prepare) {
  contender(key, who, [=](benchmark::State& state) {
    const auto solve = prepare();
    for (auto _ : state) {
      std::array<double, 10> seconds{};
      for (std::uint32_t seed = 1; seed <= seconds.size(); ++seed) {
        const std::clock_t start = std::clock();
        if (!solve(seed)) {
          state.SkipWithError(("no way was found with seed " + std::to_string(seed)).c_str());
          return;
        }
        seconds[seed - 1] = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      }
      std::sort(seconds.begin(), seconds.end());
      state.counters["s"] = (seconds[4] + seconds[5]) / 2;
    }
  })->Iterations(1);
}

void add_plan() {
  for (const int depth : {6, 7, 8})
    add_timed_plans(depth == 6 ? "plan/narrow" : "plan/narrow-" + side_name(depth), "ours", [depth] {
      const auto scene = std::make_shared<NarrowPassage>(depth);
      return [scene](std::uint32_t seed) {
        PlanOptions options = scene->options;
        options.seed = seed;
        return plan(scene->environment, scene->object, scene->start, scene->goal, options).path.has_value();
      };
    });
}

}  // namespace blackleaf::bench
