#include "blackleaf/pen_order.h"

#include <algorithm>

#include "plot/chains.h"
#include "plot/tour.h"

namespace blackleaf {
namespace {

using detail::Ends;
using detail::Visit;
using Chain = std::vector<Eigen::Vector2d>;

Chain chain_of(std::span<const Eigen::Vector2d> points) { return {points.begin(), points.end()}; }

// The same closed chain from where the way from `from` to it and on to `to` is shortest.
void turn_closed(Chain& chain, const Eigen::Vector2d& from, const Eigen::Vector2d* to) {
  const auto way = [&](const Eigen::Vector2d& p) { return (p - from).norm() + (to != nullptr ? (p - *to).norm() : 0); };
  std::size_t best = 0;
  for (std::size_t i = 1; i + 1 < chain.size(); ++i)
    if (way(chain[i]) < way(chain[best])) best = i;
  if (best == 0) return;
  chain.pop_back();
  std::rotate(chain.begin(), chain.begin() + static_cast<std::ptrdiff_t>(best), chain.end());
  chain.push_back(chain.front());
}

// The lines in order; `at` is where the pen comes from and where it ends.
Polylines ordered(const Polylines& lines, bool dashed, Joining joining, Eigen::Vector2d& at) {
  Polylines chains = dashed ? lines : detail::joined(lines);
  std::vector<Ends> ends;
  ends.reserve(chains.size());
  for (std::size_t i = 0; i < chains.size(); ++i) ends.push_back({chains[i].front(), chains[i].back()});
  const std::vector<Visit> tour = detail::short_tour(ends, at);
  Polylines result;
  result.reserve(joining == Joining::strokes ? chains.segment_count() : chains.size(), chains.points().size());
  for (std::size_t i = 0; i < tour.size(); ++i) {
    Chain chain = chain_of(chains[tour[i].chain]);
    if (tour[i].reversed) std::reverse(chain.begin(), chain.end());
    if (!dashed && chain.size() > 2 && detail::same_point(chain.front(), chain.back())) {
      const Ends* next = i + 1 < tour.size() ? &ends[tour[i + 1].chain] : nullptr;
      turn_closed(chain, at, next == nullptr ? nullptr : tour[i + 1].reversed ? &next->last : &next->first);
    }
    at = chain.back();
    if (joining == Joining::chains || dashed) {
      result.add(chain);
    } else {
      for (std::size_t k = 0; k + 1 < chain.size(); ++k) result.add(chain[k], chain[k + 1]);
    }
  }
  return result;
}

}  // namespace

PenTravel pen_travel(const Picture& picture) {
  PenTravel travel;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  for (const Layer& layer : picture.layers) {
    const Polylines& lines = layer.lines;
    travel.strokes += lines.segment_count();
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto line = lines[i];
      if (i == 0 || !detail::same_point(at, line.front())) {
        travel.up_mm += (line.front() - at).norm();
        ++travel.lifts;
      }
      for (std::size_t k = 0; k + 1 < line.size(); ++k) travel.down_mm += (line[k + 1] - line[k]).norm();
      at = line.back();
    }
  }
  return travel;
}

Picture in_pen_order(const Picture& picture, Joining joining) {
  Picture result{picture.width_mm, picture.height_mm, {}, picture.views, picture.title, picture.source};
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  for (const Layer& layer : picture.layers)
    result.layers.push_back({layer.name, layer.pen, ordered(layer.lines, !layer.pen.dashes_mm.empty(), joining, at)});
  // Each layer's tour is short for itself only; should that ever not pay, the picture stays as it was.
  return pen_travel(result).up_mm <= pen_travel(picture).up_mm ? result : picture;
}

}  // namespace blackleaf
