// draw/SIDE/tT: the exact line drawing of the bunny, isometric, from (1, 1, 1). draw/ballR/tT: the ball of radius R
// about a lattice point, from (12, -16, 15). length/ballR: what is visible of its edges. svg/SIDE: a drawing of the
// bunny as SVG text, svg-bytes/SIDE its size; order/SIDE: its strokes joined and ordered for a pen.
// perspective/SIDE/tT: the bunny seen by an eye in direction (12, -16, 15), two sides of the universe from its middle.
// draw-speedup/SIDE: how many times faster two threads are. draw-edge/1024: an edge's time, times that at 256.
// draw-memory/SIDE: the most bytes allocated at once, with the octree.
#include <bit>
#include <functional>
#include <utility>

#include "allocations.h"
#include "blackleaf/drawing.h"
#include "blackleaf/implicit.h"
#include "blackleaf/pen_order.h"
#include "blackleaf/perspective.h"
#include "blackleaf/picture.h"
#include "contenders.h"
#include "draw/feature_edges.h"
#include "drawn.h"
#include "inputs.h"
#include "paired.h"
#include "papers/va88.h"

namespace blackleaf::bench {
namespace {

using papers::va88::Comparing;

const Eigen::Vector3d kIsometric(1, 1, 1);

void ours(benchmark::State& state, const Octree& octree, const Eigen::Vector3d& direction, int threads) {
  const View view(direction);
  for (auto _ : state) benchmark::DoNotOptimize(draw(octree, view, {threads, {}}));
  state.counters["edges"] = static_cast<double>(unit_feature_edges(octree));
}

// So many drawings in a row.
auto drawing(int depth, int threads, int times = 1) {
  return [&octree = bunny(depth), threads, times] {
    for (int i = 0; i < times; ++i) benchmark::DoNotOptimize(draw(octree, View(kIsometric), {threads, {}}));
  };
}

void from_an_eye(benchmark::State& state, const Octree& octree, int threads) {
  const Eigen::Vector3d middle = Eigen::Vector3d::Constant(octree.side() / 2.0);
  const Perspective perspective(middle + 2 * octree.side() * Eigen::Vector3d(12, -16, 15) / 25, middle);
  for (auto _ : state) benchmark::DoNotOptimize(draw(octree, perspective, {threads, {}}));
}

void svg(benchmark::State& state, const Octree& octree) {
  const Picture picture = lay_out(draw(octree, View(kIsometric)));
  for (auto _ : state) benchmark::DoNotOptimize(to_svg(picture));
}

void pen_order(benchmark::State& state, const Octree& octree) {
  const Picture picture = lay_out(draw(octree, View(kIsometric)));
  for (auto _ : state) benchmark::DoNotOptimize(in_pen_order(picture));
  state.counters["strokes"] = static_cast<double>(pen_travel(picture).strokes);
}

// With the octree, one thread.
std::size_t memory(int depth) {
  const Octree& octree = bunny(depth);
  return octree.memory_bytes() + peak_allocated([&] {
           benchmark::DoNotOptimize(draw(octree, View(kIsometric), {1, {}}));
         });
}

// VA88 compares every box with all boxes in front of it.
void add_paper(const std::string& key, const std::string& who, Comparing comparing, const Eigen::Vector3d& direction,
               bool takes_seconds, const std::function<Octree()>& solid) {
  auto* added = contender(key, who, [=](benchmark::State& state) {
    const Octree octree = solid();
    for (auto _ : state) benchmark::DoNotOptimize(papers::va88::draw(octree, direction, comparing));
  });
  if (takes_seconds) added->Iterations(1)->Repetitions(3);
}

// Counts where corner_walk goes.
struct EdgeCounter {
  std::uint64_t count = 0;

  static std::uint64_t features(std::uint64_t A, std::uint64_t B, std::uint64_t C, std::uint64_t D) {
    return ((A ^ B) | (C ^ D)) & ((A ^ C) | (B ^ D));
  }
  void uniform(const Cube& cube, const detail::Around& around) {
    const auto bits = [&](unsigned i) { return around[i].is_black() ? std::uint64_t{1} : 0; };
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned b = 1u << (axis + 1) % 3, c = 1u << (axis + 2) % 3;
      if (features(bits(7), bits(7 - b), bits(7 - c), bits(7 - b - c)))
        count += static_cast<std::uint64_t>(cube.side());
    }
  }
  void bricks(const Cube&, const detail::Around& around) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned b = (axis + 1) % 3, c = (axis + 2) % 3, low_b = 7 - (1u << b), low_c = 7 - (1u << c);
      const std::uint64_t A = around[7].brick(), B = detail::moved_up(A, around[low_b].brick(), b);
      const std::uint64_t C = detail::moved_up(A, around[low_c].brick(), c);
      const std::uint64_t below = detail::moved_up(around[low_c].brick(), around[low_b & low_c].brick(), b);
      count += static_cast<std::uint64_t>(std::popcount(features(A, B, C, detail::moved_up(B, below, c))));
    }
  }
};

}  // namespace

Octree ball_of_radius(int radius) {
  int depth = 1;
  while ((1 << depth) < 2 * radius) ++depth;
  return ball(depth, Eigen::Vector3d::Constant(1 << (depth - 1)), radius);
}

const Eigen::Vector3d& ball_direction() {
  static const Eigen::Vector3d direction(12, -16, 15);
  return direction;
}

std::uint64_t unit_feature_edges(const Octree& octree) {
  EdgeCounter counter;
  detail::corner_walk(octree, counter);
  return counter.count;
}

void add_drawing() {
  for (const int depth : {8, 10}) {
    contender("svg/" + side_name(depth), "ours", [=](benchmark::State& s) { svg(s, bunny(depth)); });
    sized("svg-bytes/" + side_name(depth), "ours",
          [=] { return to_svg(lay_out(draw(bunny(depth), View(kIsometric)))).size(); });
    contender("order/" + side_name(depth), "ours", [=](benchmark::State& s) { pen_order(s, bunny(depth)); });
  }
  for (const int depth : {8, 9, 10}) {
    const std::string key = "draw-memory/" + side_name(depth);
    sized(key, "ours", [=] { return memory(depth); });
    sized(key, "strokes+octree", [=] {
      return draw(bunny(depth), View(kIsometric)).strokes.size() * sizeof(Stroke) + bunny(depth).memory_bytes();
    });
  }
  // Many in a row of what is short, as a thread that sleeps takes a tenth of a millisecond to come.
  for (const auto& [depth, times] : {std::pair(8, 16), {10, 1}})
    once("draw-speedup/" + side_name(depth), "ours", "ratio",
         [=] { return speedup(40, drawing(depth, 1, times), drawing(depth, 2, times)); });
  once("draw-edge/1024", "ours", "ratio", [] {
    const auto edges = [](int depth) { return static_cast<double>(unit_feature_edges(bunny(depth))); };
    return growth(15, 16, drawing(8, 1), drawing(10, 1)) * edges(8) / edges(10);
  });
  for (const int threads : {1, 2}) {
    const std::string suffix = "/t" + std::to_string(threads);
    for (const int depth : {6, 7, 8, 9, 10}) {
      const std::string key = "draw/" + side_name(depth) + suffix;
      contender(key, "ours", [=](benchmark::State& s) { ours(s, bunny(depth), kIsometric, threads); });
      if (depth < 10)
        contender("perspective/" + side_name(depth) + suffix, "ours",
                  [=](benchmark::State& s) { from_an_eye(s, bunny(depth), threads); });
      if (threads > 1) continue;
      const auto solid = [=] { return bunny(depth); };
      if (depth <= 7) add_paper(key, "paper", Comparing::every_edge, kIsometric, depth == 7, solid);
      if (depth <= 8) add_paper(key, "paper-extents", Comparing::extents, kIsometric, depth == 8, solid);
    }
    for (const int radius : {8, 16, 32, 64}) {
      const std::string ball = "ball" + std::to_string(radius), key = "draw/" + ball + suffix;
      contender(key, "ours", [=](benchmark::State& s) { ours(s, ball_of_radius(radius), ball_direction(), threads); });
      if (threads > 1) continue;
      const auto solid = [=] { return ball_of_radius(radius); };
      if (radius <= 64) add_paper(key, "paper", Comparing::every_edge, ball_direction(), radius >= 32, solid);
      if (radius <= 64) add_paper(key, "paper-extents", Comparing::extents, ball_direction(), radius >= 32, solid);
      counted("length/" + ball, "ours", [=] { return draw(ball_of_radius(radius), View(ball_direction())).length(); });
    }
  }
}

}  // namespace blackleaf::bench
