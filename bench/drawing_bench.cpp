// draw/INPUT/tT: the exact line drawing seen from (12, -16, 15). ball32 is the ball of radius 32 about a lattice point.
// perspective/SIDE/tT: the same seen by an eye in that direction, two sides of the universe away from its middle.
// svg/SIDE: a drawing of the bunny as SVG text, svg-bytes/SIDE its size; order/SIDE: its strokes joined and ordered for
// a pen.
#include "blackleaf/drawing.h"
#include "blackleaf/implicit.h"
#include "blackleaf/pen_order.h"
#include "blackleaf/perspective.h"
#include "blackleaf/picture.h"
#include "contenders.h"
#include "inputs.h"
#include "papers/va88.h"

namespace blackleaf::bench {
namespace {

const View& the_view() {
  static const View view(Eigen::Vector3d(12, -16, 15));
  return view;
}

Octree ball_of_radius(int radius) {
  int depth = 1;
  while ((1 << depth) < 2 * radius) ++depth;
  return ball(depth, Eigen::Vector3d::Constant(1 << (depth - 1)), radius);
}

void ours(benchmark::State& state, const Octree& octree, int threads) {
  for (auto _ : state) benchmark::DoNotOptimize(draw(octree, the_view(), {threads, {}}));
}

void from_an_eye(benchmark::State& state, const Octree& octree, int threads) {
  const Eigen::Vector3d middle = Eigen::Vector3d::Constant(octree.side() / 2.0);
  const Perspective perspective(middle + 2 * octree.side() * Eigen::Vector3d(12, -16, 15) / 25, middle);
  for (auto _ : state) benchmark::DoNotOptimize(draw(octree, perspective, {threads, {}}));
}

void svg(benchmark::State& state, const Octree& octree) {
  const Picture picture = lay_out(draw(octree, the_view()));
  for (auto _ : state) benchmark::DoNotOptimize(to_svg(picture));
}

void pen_order(benchmark::State& state, const Octree& octree) {
  const Picture picture = lay_out(draw(octree, the_view()));
  for (auto _ : state) benchmark::DoNotOptimize(in_pen_order(picture));
  state.counters["strokes"] = static_cast<double>(pen_travel(picture).strokes);
}

// VA88 compares every box with all boxes in front of it.
void paper(benchmark::State& state, const Octree& octree) {
  for (auto _ : state) benchmark::DoNotOptimize(papers::va88::draw(octree, Eigen::Vector3d(12, -16, 15)));
}

}  // namespace

void add_drawing() {
  for (const int depth : {8, 10}) {
    contender("svg/" + side_name(depth), "ours", [=](benchmark::State& s) { svg(s, bunny(depth)); });
    sized("svg-bytes/" + side_name(depth), "ours",
          [=] { return to_svg(lay_out(draw(bunny(depth), the_view()))).size(); });
    contender("order/" + side_name(depth), "ours", [=](benchmark::State& s) { pen_order(s, bunny(depth)); });
  }
  for (const int threads : {1, 2}) {
    const std::string suffix = "/t" + std::to_string(threads);
    for (const int depth : {6, 7, 8, 9}) {
      const std::string key = "draw/" + side_name(depth) + suffix;
      contender(key, "ours", [=](benchmark::State& s) { ours(s, bunny(depth), threads); });
      if (threads == 1 && depth <= 7) contender(key, "paper", [=](benchmark::State& s) { paper(s, bunny(depth)); });
      contender("perspective/" + side_name(depth) + suffix, "ours",
                [=](benchmark::State& s) { from_an_eye(s, bunny(depth), threads); });
    }
    for (const int radius : {8, 16, 32, 64}) {
      const std::string key = "draw/ball" + std::to_string(radius) + suffix;
      contender(key, "ours", [=](benchmark::State& s) { ours(s, ball_of_radius(radius), threads); });
      if (threads == 1 && radius <= 32)
        contender(key, "paper", [=](benchmark::State& s) { paper(s, ball_of_radius(radius)); });
    }
  }
}

}  // namespace blackleaf::bench
