// RunWriter: how the papers' pointer trees are handed back to the product: as a stream of runs.
#pragma once

#include <cstdint>
#include <vector>

#include "blackleaf/curve.h"
#include "blackleaf/octree.h"
#include "blackleaf/runs.h"

namespace blackleaf::papers {

/// Writes a pointer tree as an octree. Child(node, octant) gives {colour, node below}; it is asked along the Millar
/// curve, and leaves become runs. O(nodes).
template <class Link, class Child>
Octree octree_of_links(const Link& root, int depth, const Child& child) {
  std::vector<Run> runs;
  const auto visit = [&](const auto& self, const Link& link, int level, std::uint8_t table) -> void {
    if (link.colour != Colour::gray) {
      runs.push_back({std::uint64_t{1} << (3 * level), link.colour == Colour::black ? 1u : 0u});
      return;
    }
    for (const curve::Step step : curve::kSteps[table]) self(self, child(link, step.octant), level - 1, step.table);
  };
  visit(visit, root, depth, 0);
  return octree_from_runs(runs, depth);
}

}  // namespace blackleaf::papers
