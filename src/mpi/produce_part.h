// produce_part: the part of an octree that a stretch of the curve has, computed node by node by one of the producers of
// octree/produce.h; and where to cut the curve so that every process has as much to do.
#pragma once

#include <deque>
#include <functional>
#include <utility>
#include <vector>

#include "blackleaf/work.h"
#include "octree/produce.h"
#include "stretch.h"

namespace blackleaf::mpi {

/// Universes up to this depth are not cut: one process does it all.
inline constexpr int kUncutDepth = 5;

template <class Producer>
class PartProduction {
  using Task = typename Producer::Task;
  using Subtree = detail::Subtree;
  using NodeArrays = detail::NodeArrays;

 public:
  PartProduction(const Producer& producer, int depth, const Stretch& stretch)
      : producer_(producer), depth_(depth), stretch_(stretch) {
    // Units for the threads: at least 64, unless they would be smaller than 8^3.
    while (unit_level_ > 3 && voxels_of(unit_level_) > (stretch.last - stretch.first) / 64) --unit_level_;
  }

  Octree run(Frame frame, const Work& work) {
    outline(producer_.root(), {0, 0, 0, depth_}, 0, 0);
    std::vector<detail::PackedNode> nodes(units_.size());
    detail::for_each_index(nodes.size(), work, [&](std::size_t i) {
      NodeArrays arrays;
      Unit& unit = units_[i];
      nodes[i] =
          arrays.pack(detail::produce_gray_node(producer_, unit.task, unit.cube, unit.table, arrays), unit.cube.level);
    });
    units_.clear();
    NodeArrays arrays;
    std::size_t place = 0, node = 0;
    const Subtree top = join(depth_, 0, nodes, place, node, arrays);
    return arrays.finish(depth_, top, std::move(frame));
  }

 private:
  enum class Place : std::uint8_t { white, black, inner, unit };
  struct Unit {
    Task task;
    Cube cube;
    std::uint8_t table;
  };

  // Walks the top of the tree in curve order: what is decided, what is gone into, and the units that are left.
  void outline(Task task, const Cube& cube, std::uint8_t table, std::uint64_t first) {
    const std::uint64_t end = first + voxels_of(cube.level);
    if (end <= stretch_.first || first >= stretch_.last) {
      places_.push_back(Place::white);
      return;
    }
    const bool inside = first >= stretch_.first && end <= stretch_.last;
    const Colour colour = producer_.classify(task, cube);
    if (colour == Colour::white || (colour == Colour::black && inside)) {
      places_.push_back(colour == Colour::white ? Place::white : Place::black);
      return;
    }
    if (inside && cube.level <= unit_level_) {
      places_.push_back(Place::unit);
      units_.push_back({std::move(task), cube, table});
      return;
    }
    places_.push_back(Place::inner);
    const std::uint64_t step = voxels_of(cube.level - 1);
    for (const curve::Step down : curve::kSteps[table]) {
      const Cube child = cube.child(down.octant);
      if (colour == Colour::black)
        blacken(child, down.table, first);
      else
        outline(producer_.child(task, child, down.octant), child, down.table, first);
      first += step;
    }
  }

  // The same for a node that is black.
  void blacken(const Cube& cube, std::uint8_t table, std::uint64_t first) {
    const std::uint64_t end = first + voxels_of(cube.level);
    if (end <= stretch_.first || first >= stretch_.last) {
      places_.push_back(Place::white);
    } else if (first >= stretch_.first && end <= stretch_.last) {
      places_.push_back(Place::black);
    } else {
      places_.push_back(Place::inner);
      const std::uint64_t step = voxels_of(cube.level - 1);
      for (const curve::Step down : curve::kSteps[table]) {
        blacken(cube.child(down.octant), down.table, first);
        first += step;
      }
    }
  }

  Subtree join(int level, std::uint8_t table, std::vector<detail::PackedNode>& nodes, std::size_t& place,
               std::size_t& node, NodeArrays& arrays) const {
    switch (places_[place++]) {
      case Place::white:
        return Subtree::uniform(Colour::white);
      case Place::black:
        return Subtree::uniform(Colour::black);
      case Place::unit:
        return arrays.append(std::move(nodes[node++]));
      case Place::inner:
        break;
    }
    std::array<Subtree, 8> children;
    for (const curve::Step down : curve::kSteps[table])
      children[down.octant] = join(level - 1, down.table, nodes, place, node, arrays);
    return arrays.close(level, children);
  }

  const Producer& producer_;
  const int depth_;
  const Stretch stretch_;
  int unit_level_ = depth_ - 1;
  std::vector<Place> places_;  // in pre-order along the curve
  std::deque<Unit> units_;     // in curve order; not a vector: tasks may be large
};

/// The part of the octree that `producer` tells of. Requires: a stretch that begins and ends between nodes of level 3,
/// the whole, or nothing; of a universe up to kUncutDepth one of the last two.
template <class Producer>
Octree produce_part(const Producer& producer, int depth, Frame frame, const Stretch& stretch, const Work& work) {
  if (stretch.empty()) return Octree(depth, Colour::white, std::move(frame));
  if (stretch == whole(depth)) return detail::produce(producer, depth, std::move(frame), work);
  return PartProduction<Producer>(producer, depth, stretch).run(std::move(frame), work);
}

/// Looks at the top of an octree that is not made yet: calls visit(task, cube, first) for its gray nodes of one level
/// within a stretch, in curve order.
template <class Producer, class Visit>
void for_each_gray(const Producer& producer, typename Producer::Task task, const Cube& cube, std::uint8_t table,
                   std::uint64_t first, const Stretch& stretch, int level, const Visit& visit) {
  if (first + voxels_of(cube.level) <= stretch.first || first >= stretch.last) return;
  if (producer.classify(task, cube) != Colour::gray) return;
  if (cube.level == level) {
    visit(task, cube, first);
    return;
  }
  const std::uint64_t step = voxels_of(cube.level - 1);
  for (const curve::Step down : curve::kSteps[table]) {
    const Cube child = cube.child(down.octant);
    for_each_gray(producer, producer.child(task, child, down.octant), child, down.table, first, stretch, level, visit);
    first += step;
  }
}

/// So many units a process: each is a small part of its work, so cuts between them balance to a few percent.
inline constexpr std::size_t kUnitsEach = 64;

/// How the weights of units come together: given this process's weights and 0 for all others, makes them those of all.
using Exchange = std::function<void(std::vector<std::uint64_t>& weights)>;

/// Cuts for so many processes, this being number `self`. Units are the gray nodes of the first level that has
/// kUnitsEach a process. Every process weighs its share of them, a unit by the gray nodes two levels below it: the work
/// is that of the surface. `exchange` is given this process's weights, the others 0, and makes them those of all.
template <class Producer>
Cuts balanced_cuts(const Producer& producer, int depth, int processes, int self, const Exchange& exchange) {
  if (depth <= kUncutDepth || processes == 1) return uncut(depth, processes);
  const Cube root{0, 0, 0, depth};
  const auto wanted = kUnitsEach * static_cast<std::size_t>(processes);
  std::vector<std::uint64_t> numbers;
  int level = depth;
  do {
    level -= level > depth - 2 ? 2 : 1;
    numbers.clear();
    for_each_gray(producer, producer.root(), root, 0, 0, whole(depth), level,
                  [&](const auto&, const Cube&, std::uint64_t first) { numbers.push_back(first); });
  } while (level > 3 && numbers.size() < wanted && !numbers.empty());
  if (numbers.empty()) return uncut(depth, processes);
  std::vector<std::uint64_t> weights(numbers.size(), 0);
  const auto share = [&](int process) {
    return numbers.size() * static_cast<std::size_t>(process) / static_cast<std::size_t>(processes);
  };
  const std::size_t begin = share(self), end = share(self + 1);
  if (begin < end) {
    const Stretch mine{numbers[begin], numbers[end - 1] + voxels_of(level)};
    std::size_t unit = begin;
    for_each_gray(producer, producer.root(), root, 0, 0, mine, std::max(3, level - 2),
                  [&](const auto&, const Cube&, std::uint64_t first) {
                    while (unit + 1 < end && first >= numbers[unit + 1]) ++unit;
                    ++weights[unit];
                  });
    // The unit itself is work, even if what is below it turns out to be of one colour.
    for (std::size_t i = begin; i < end; ++i) ++weights[i];
  }
  exchange(weights);
  return cuts_by_weight(depth, numbers, weights, processes);
}

}  // namespace blackleaf::mpi
