// move/N/tT: 30 degrees about (1,1,1) through the universe's centre and a translation of (5.3, -7.1, 2.9) voxels.
// move-growth/N: how many times as long it takes as at N/2. move-speedup/N: how many times faster two threads are.
// move-memory/N: the most bytes at once while it is done, with the source.
#include "blackleaf/move.h"

#include <cmath>
#include <utility>

#include "allocations.h"
#include "contenders.h"
#include "inputs.h"
#include "octree/brick.h"
#include "octree/produce.h"
#include "paired.h"
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

// The straightforward way from the target's side, which the product was a step up from: each target node's box, moved
// back, is looked up in the source from the root; a brick's voxels one by one. In floating point.
class Naive {
 public:
  struct Task {};

  Naive(const Octree& source, const Motion& motion) : source_(source), back_(motion.inverse()) {}

  Task root() const { return {}; }
  Task child(const Task&, const Cube&, int) const { return {}; }
  Colour classify(const Task&, const Cube& cube) const {
    const double half = 0.5 * cube.side();
    const Eigen::Vector3d centre = back_(Eigen::Vector3d(cube.x, cube.y, cube.z).array() + half);
    const Eigen::Vector3d reach = back_.rotation().cwiseAbs() * Eigen::Vector3d::Constant(half - 0.5);
    const Eigen::Vector3d low = centre - reach, high = centre + reach;
    const Colour colour = of_box(source_.root(), source_.universe(), low, high);
    const bool within = low.minCoeff() >= 0 && high.maxCoeff() <= source_.side();
    return colour == Colour::black && !within ? Colour::gray : colour;
  }
  std::uint64_t brick(const Task&, const Cube& cube) const {
    std::uint64_t bits = 0;
    for (unsigned bit = 0; bit < 64; ++bit) {
      const Eigen::Vector3d at = back_(Eigen::Vector3d(cube.x + static_cast<int>(detail::brick_x(bit)) + 0.5,
                                                       cube.y + static_cast<int>(detail::brick_y(bit)) + 0.5,
                                                       cube.z + static_cast<int>(detail::brick_z(bit)) + 0.5));
      const auto voxel = [](double x) { return static_cast<std::int64_t>(std::floor(x)); };
      bits |= std::uint64_t{source_.contains(voxel(at.x()), voxel(at.y()), voxel(at.z()))} << bit;
    }
    return bits;
  }

 private:
  // White, black, or both, of what a box sees of a node that it meets.
  static Colour of_box(const Node& node, const Cube& cube, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    if (!node.is_gray()) return node.colour();
    bool white = false, black = false;
    for (int octant = 0; octant < 8 && !(white && black); ++octant) {
      const Cube child = cube.child(octant);
      const Eigen::Vector3d begin(child.x, child.y, child.z);
      if ((high.array() < begin.array()).any() || (low.array() > begin.array() + child.side()).any()) continue;
      const Colour colour = of_box(node.child(octant), child, low, high);
      white = white || colour != Colour::black;
      black = black || colour != Colour::white;
    }
    return white && black ? Colour::gray : black ? Colour::black : Colour::white;
  }

  const Octree& source_;
  Motion back_;
};

void naive(benchmark::State& state, int depth) {
  const Octree& octree = bunny(depth);
  const Motion motion = bunny_motion(depth);
  for (auto _ : state) benchmark::DoNotOptimize(detail::produce(Naive(octree, motion), depth, octree.frame(), {1, {}}));
}

// Dense volumes: every target voxel's centre moved back, the nearest source voxel taken; in blocks of this side, so
// that what is read stays in the cache. The side of the universe: row by row.
void dense(benchmark::State& state, int depth, std::int64_t block) {
  const auto& source = bunny_volume(depth);
  const Motion back = bunny_motion(depth).inverse();
  const Eigen::Vector3d step = back.rotation().col(0);
  const std::int64_t side = std::int64_t{1} << depth;
  const auto sides = static_cast<double>(side);
  Volume target(source.size());
  const auto row = [&](std::int64_t x0, std::int64_t y, std::int64_t z) {
    std::uint8_t* out = &target[static_cast<std::size_t>((z << depth | y) << depth | x0)];
    Eigen::Vector3d at = back(
        Eigen::Vector3d(static_cast<double>(x0) + 0.5, static_cast<double>(y) + 0.5, static_cast<double>(z) + 0.5));
    for (std::int64_t x = 0; x < block; ++x, at += step) {
      const bool inside = at.minCoeff() >= 0 && at.maxCoeff() < sides;
      *out++ = inside ? source[static_cast<std::size_t>(
                            (static_cast<std::int64_t>(at.z()) << depth | static_cast<std::int64_t>(at.y())) << depth |
                            static_cast<std::int64_t>(at.x()))]
                      : std::uint8_t{0};
    }
  };
  for (auto _ : state) {
    for (std::int64_t z = 0; z < side; z += block)
      for (std::int64_t y = 0; y < side; y += block)
        for (std::int64_t x = 0; x < side; x += block)
          for (std::int64_t k = z; k < z + block; ++k)
            for (std::int64_t j = y; j < y + block; ++j) row(x, j, k);
    benchmark::ClobberMemory();
  }
}

std::size_t memory(int depth) {
  const Octree& octree = bunny(depth);
  const Motion motion = bunny_motion(depth);
  return octree.memory_bytes() + peak_allocated([&] {
           benchmark::DoNotOptimize(move(octree, motion, Leaving::error, {1, {}}));
         });
}

auto moving(int depth, int threads) {
  return [&octree = bunny(depth), motion = bunny_motion(depth), threads] {
    benchmark::DoNotOptimize(move(octree, motion, Leaving::error, {threads, {}}));
  };
}

}  // namespace

void add_move() {
  const auto few = [](benchmark::internal::Benchmark* added) { added->Iterations(1)->Repetitions(3); };
  for (const int depth : {8, 9, 10, 11, 12, 13, 14})
    for (const int threads : {1, 2}) {
      const std::string key = "move/" + side_name(depth) + "/t" + std::to_string(threads);
      const auto own = contender(key, "ours", [=](benchmark::State& s) { ours(s, depth, threads); });
      if (depth > 12) few(own);
      if (threads != 1 || depth > 10) continue;
      contender(key, "naive", [=](benchmark::State& s) { naive(s, depth); });
      few(contender(key, "dense-blocks", [=](benchmark::State& s) { dense(s, depth, 32); }));
      if (depth > 9) continue;
      few(contender(key, "paper", [=](benchmark::State& s) { paper(s, depth); }));
      few(contender(key, "dense", [=](benchmark::State& s) { dense(s, depth, std::int64_t{1} << depth); }));
    }
  // Many rounds of what is short.
  for (const auto& [depth, rounds] : {std::pair(9, 61), {10, 31}, {11, 15}, {12, 7}, {13, 5}, {14, 3}})
    once("move-growth/" + side_name(depth), "ours", "ratio",
         [=] { return growth(rounds, 4, moving(depth - 1, 1), moving(depth, 1)); });
  for (const auto& [depth, rounds] : {std::pair(9, 200), {10, 100}, {11, 30}, {12, 10}})
    once("move-speedup/" + side_name(depth), "ours", "ratio",
         [=] { return speedup(rounds, moving(depth, 1), moving(depth, 2)); });
  for (const int depth : {9, 10, 11}) {
    const std::string key = "move-memory/" + side_name(depth);
    sized(key, "ours", [=] { return memory(depth); });
    sized(key, "source+target", [=] {
      const Octree& source = bunny(depth);
      return source.memory_bytes() + moved_bunny(depth).memory_bytes();
    });
  }
}

}  // namespace blackleaf::bench
