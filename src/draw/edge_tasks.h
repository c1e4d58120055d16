// Cutting the corner walk (octree/corner_walk.h) into tasks for threads.
#pragma once

#include <algorithm>
#include <vector>

#include "octree/corner_walk.h"
#include "octree/team.h"

namespace blackleaf::detail {

// Tasks are corner cubes so far below the root, for enough of them, and so large at least, for enough to do in each.
inline constexpr int kTaskLevels = 3, kLeastTaskLevel = 5;

/// A corner cube and the nodes around it: arguments of corner_walk.
struct EdgeTask {
  Cube cube;
  Around around;
};

inline void cut_tasks(const Around& around, const Cube& cube, int level, std::vector<EdgeTask>& tasks) {
  const auto is_gray = [](const Node& node) { return node.is_gray(); };
  const auto same = [&](const Node& node) { return node.colour() == around[0].colour(); };
  const bool uniform = std::none_of(around.begin(), around.end(), is_gray);
  if (uniform && std::all_of(around.begin(), around.end(), same)) return;
  if (uniform || cube.level <= level) {
    tasks.push_back({cube, around});
    return;
  }
  for (unsigned octant = 0; octant < 8; ++octant) {
    Around below;
    for (unsigned i = 0; i < 8; ++i) below[i] = around[octant | i].child(static_cast<int>(~(octant ^ i) & 7));
    cut_tasks(below, cube.child(static_cast<int>(octant)), level, tasks);
  }
}

/// Corner cubes that together cover every place where black and white meet: kTaskLevels below the root but of level
/// kLeastTaskLevel at least, or larger ones that need no cutting.
inline std::vector<EdgeTask> edge_tasks(const Octree& octree, Team& team) {
  const Node root = brick_level_root(octree), white = Node::uniform(root.level(), Colour::white);
  const std::int32_t side = std::int32_t{1} << root.level();
  const int level = std::max(std::min(root.level(), kLeastTaskLevel), root.level() - kTaskLevels);
  std::vector<EdgeTask> large;
  for (unsigned octant = 0; octant < 8; ++octant) {
    Around around;
    around.fill(white);
    around[~octant & 7] = root;
    const Cube cube{octant & 1 ? side : 0, octant & 2 ? side : 0, octant & 4 ? side : 0, root.level()};
    cut_tasks(around, cube, std::max(level, root.level() - 1), large);
  }
  std::vector<std::vector<EdgeTask>> cut(large.size());
  team.for_each_index(large.size(), [&](std::size_t i) { cut_tasks(large[i].around, large[i].cube, level, cut[i]); });
  std::vector<EdgeTask> tasks;
  std::size_t count = 0;
  for (const std::vector<EdgeTask>& of : cut) count += of.size();
  tasks.reserve(count);
  for (const std::vector<EdgeTask>& of : cut) tasks.insert(tasks.end(), of.begin(), of.end());
  return tasks;
}

}  // namespace blackleaf::detail
