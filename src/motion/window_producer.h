// WindowProducer: a producer (octree/produce.h) for octrees whose nodes each see a small window of a source tree.
#pragma once

#include "octree/produce.h"
#include "source_window.h"

namespace blackleaf::detail {

/// Map says where target nodes see the source:
///   kWidth                                        the most source cells on an axis
///   CellRange cells(const Cube&) const            the source cells of the cube's own level that its voxels may depend
///   on std::uint64_t brick(const SourceWindow<kWidth>&, const Cube&) const the voxels of a level-2 node
template <class Map>
class WindowProducer {
 public:
  using Window = SourceWindow<Map::kWidth>;
  struct Task {
    Window window;
    bool above_source = false;  // the target node is larger than the whole source
  };

  WindowProducer(Map map, const Octree& source, int depth)
      : map_(std::move(map)), source_(brick_level_root(source)), depth_(depth) {}

  Task root() const { return at({0, 0, 0, depth_ < 2 ? 2 : depth_}); }

  Colour classify(Task& task, const Cube& cube) const {
    if (!task.above_source) return task.window.colour();
    const CellRange range = map_.cells(cube);  // at this level the whole source is in cell (0,0,0)
    for (std::size_t i = 0; i < 3; ++i)
      if (range.low[i] > 0 || range.high[i] < 0) return Colour::white;
    return Colour::gray;
  }

  Task child(const Task& task, const Cube& cube, int) const {
    if (task.above_source) return at(cube);
    return {task.window.narrowed(map_.cells(cube)), false};
  }

  std::uint64_t brick(const Task& task, const Cube& cube) const { return map_.brick(task.window, cube); }

 private:
  Task at(const Cube& cube) const {
    if (cube.level > source_.level()) return {{}, true};
    return {Window::of_root(source_, map_.cells(cube)), false};
  }

  Map map_;
  Node source_;  // at brick level at least
  int depth_;    // of the target
};

}  // namespace blackleaf::detail
