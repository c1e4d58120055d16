// interfere/N: is the bunny in the way of another bunny, both at 0.9 to 1.1 of the distance at which they touch; a
// bunny's longest side is 0.6 N voxels. Two questions:
//   interfere/N        both are octrees of one universe already (AN84's parallel traversal), shifted by whole voxels
//   interfere-moved/N  the second is turned and shifted anyhow, its cubes tilted, nothing voxelised
// Times are for one pair.
#include <cmath>
#include <numbers>
#include <random>

#include "blackleaf/contact.h"
#include "blackleaf/move.h"
#include "contenders.h"
#include "inputs.h"
#include "papers/an84.h"

namespace blackleaf::bench {
namespace {

constexpr int kPairs = 24;
constexpr int kPoses = 200;

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

void ours_moved(benchmark::State& state, int depth) {
  const Octree& octree = bunny(depth);
  static const std::vector<Motion> poses = [&] {
    std::mt19937 random(1987);
    const Eigen::Vector3d centre = Eigen::Vector3d::Constant(octree.side() / 2.0);
    std::vector<Motion> result;
    for (int i = 0; i < kPoses; ++i) {
      const Motion turn = Motion::rotation(random_direction(random),
                                           std::uniform_real_distribution<double>(0, std::numbers::pi)(random))
                              .about(centre);
      const Eigen::Vector3d direction = random_direction(random);
      const auto at = [&](double t) { return Motion::translation(t * direction) * turn; };
      const double touch =
          contact(0, 2.0 * octree.side(), [&](double t) { return interferes(octree, octree, at(t), Meaning::exact); });
      result.push_back(at(touch * std::uniform_real_distribution<double>(0.9, 1.1)(random)));
    }
    return result;
  }();
  for (auto _ : state)
    for (const Motion& pose : poses) benchmark::DoNotOptimize(interferes(octree, octree, pose, Meaning::exact));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * kPoses);
}

}  // namespace

void add_interference() {
  for (const int depth : {7, 8, 9}) {
    contender("interfere/" + side_name(depth), "ours", [=](benchmark::State& s) { ours(s, depth); });
    contender("interfere/" + side_name(depth), "paper", [=](benchmark::State& s) { paper(s, depth); });
    contender("interfere-moved/" + side_name(depth), "ours", [=](benchmark::State& s) { ours_moved(s, depth); });
  }
}

}  // namespace blackleaf::bench
