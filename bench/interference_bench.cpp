// interfere/N: is the bunny in the way of another bunny, turned and shifted anyhow, both near contact; a bunny's
// longest side is 0.6 N voxels. Exact: tilted cubes, nothing voxelised. interfere-voxelised/N: the same of the voxels
// that `move` would make. interfere-batch/N/tT: 10,000 such questions at once; for one. interfere-parallel/N: both are
// octrees of one universe already (AN84's parallel traversal), shifted by whole voxels. prepare/N: preparing one bunny.
// overlap/N: the octree of what two bunnies share.
#include <cmath>
#include <functional>
#include <random>

#include "blackleaf/contact.h"
#include "blackleaf/move.h"
#include "blackleaf/set_operations.h"
#include "contact_poses.h"
#include "contenders.h"
#include "inputs.h"
#include "paired.h"
#include "papers/an84.h"

namespace blackleaf::bench {
namespace {

constexpr int kPairs = 24;

Eigen::Vector3d random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

/// The largest t at which interferes(t), by bisection.
template <class Interferes>
double contact(double low, double high, const Interferes& interferes) {
  for (int i = 0; i < 12; ++i) {
    const double middle = (low + high) / 2;
    (interferes(middle) ? low : high) = middle;
  }
  return high;
}

/// A bunny as in a universe of the given depth, in the middle of a universe four times as large on a side.
const Octree& roomy_bunny(int depth) {
  static const int first = depth;
  static const Octree octree =
      octree_from_mesh(bunny_mesh(), place_by_fraction(bunny_mesh(), depth + 2, kFraction / 4));
  if (depth != first) std::abort();  // one depth in a process is all that is asked for
  return octree;
}

const std::vector<Octree>& shifted_bunnies(int depth) {
  static const std::vector<Octree> shifted = [&] {
    std::mt19937 random(1984);
    const Octree& octree = roomy_bunny(depth);
    std::vector<Octree> result;
    for (int i = 0; i < kPairs; ++i) {
      const Eigen::Vector3d direction = random_direction(random);
      const auto at = [&](double t) {
        std::array<std::int64_t, 3> by{};
        for (std::size_t axis = 0; axis < 3; ++axis)
          by[axis] = std::llround(t * direction[static_cast<Eigen::Index>(axis)]);
        return translate(octree, by);
      };
      const double touch = contact(0, octree.side() / 4.0, [&](double t) { return interferes(octree, at(t)); });
      result.push_back(at(touch * std::uniform_real_distribution<double>(0.9, 1.1)(random)));
    }
    return result;
  }();
  return shifted;
}

void ours(benchmark::State& state, int depth) {
  const Octree& octree = roomy_bunny(depth);
  const auto& others = shifted_bunnies(depth);
  for (auto _ : state)
    for (const Octree& other : others) benchmark::DoNotOptimize(interferes(octree, other));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * kPairs);
}

void paper(benchmark::State& state, int depth) {
  using papers::an84::Tree;
  const Tree tree(roomy_bunny(depth));
  std::vector<Tree> others;
  for (const Octree& other : shifted_bunnies(depth)) others.emplace_back(other);
  for (auto _ : state)
    for (const Tree& other : others) benchmark::DoNotOptimize(interferes(tree, other));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * kPairs);
}

constexpr std::size_t kBatch = 10000;

// Asks about 10,000 poses at once.
std::function<void()> batch(int depth, int threads) {
  const auto& poses = contact_poses(depth);
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < kBatch; ++i) motions.push_back(poses[i % poses.size()]);
  return [solid = PreparedSolid(bunny(depth)), motions, threads] {
    benchmark::DoNotOptimize(interferes(solid, solid, motions, Meaning::exact, {threads, {}}));
  };
}

void timed_batch(benchmark::State& state, int depth, int threads) {
  const auto ask = batch(depth, threads);
  for (auto _ : state) ask();
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(kBatch));
}

// What two bunnies share that overlap by a tenth of their distance of contact.
void overlapping(benchmark::State& state, int depth, bool whole) {
  const Octree& octree = bunny(depth);
  const Motion motion = Motion::translation({0.1 * octree.side(), 0.2 * octree.side(), 0}) * bunny_motion(depth);
  for (auto _ : state)
    benchmark::DoNotOptimize(whole ? intersect(octree, move(octree, motion, Leaving::clip, {1, {}}), {1, {}})
                                   : overlap(octree, octree, motion, {1, {}}));
}

}  // namespace

void add_interference() {
  for (const int depth : {7, 8, 9}) {
    const std::string side = side_name(depth);
    const auto prepared = [=](Meaning meaning) -> Ask {
      return [solid = PreparedSolid(bunny(depth)), meaning](const Motion& pose) {
        return interferes(solid, solid, pose, meaning);
      };
    };
    add_timed_poses("interfere/" + side, "ours", depth, [=] { return prepared(Meaning::exact); });
    add_timed_poses("interfere/" + side, "unprepared", depth, [=]() -> Ask {
      return [&octree = bunny(depth)](const Motion& pose) { return interferes(octree, octree, pose, Meaning::exact); };
    });
    add_timed_poses("interfere-voxelised/" + side, "ours", depth, [=] { return prepared(Meaning::voxelised); });
    add_timed_poses("interfere-voxelised/" + side, "exact", depth, [=] { return prepared(Meaning::exact); });
    contender("interfere-parallel/" + side, "ours", [=](benchmark::State& s) { ours(s, depth); });
    contender("interfere-parallel/" + side, "paper", [=](benchmark::State& s) { paper(s, depth); });
    contender("prepare/" + side, "ours", [=](benchmark::State& s) {
      for (auto _ : s) benchmark::DoNotOptimize(PreparedSolid(bunny(depth)));
    });
  }
  for (const int threads : {1, 2})
    contender("interfere-batch/256/t" + std::to_string(threads), "ours",
              [=](benchmark::State& s) { timed_batch(s, 8, threads); });
  once("interfere-batch-speedup/256", "ours", "ratio", [] { return speedup(15, batch(8, 1), batch(8, 2)); });
  contender("overlap/512/t1", "ours", [](benchmark::State& s) { overlapping(s, 9, false); });
  contender("overlap/512/t1", "move-and-intersect", [](benchmark::State& s) { overlapping(s, 9, true); });
}

}  // namespace blackleaf::bench
