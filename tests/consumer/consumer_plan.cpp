#include <blackleaf/implicit.h>
#include <blackleaf/plan.h>

#include <cstdio>

int main() {
  using namespace blackleaf;
  const Octree post = box(5, {14, 14, 0}, {18, 18, 32}), stone = ball(5, {6, 16, 16}, 3);
  const Pose start, goal{0, {20, 0, 0}, Eigen::Quaterniond::Identity()};
  const Plan way = plan(post, stone, start, goal);
  const bool clear = way.path && path_is_clear(post, stone, *way.path);
  std::printf("%zu poses, %g voxels, clear %d\n", way.path ? way.path->poses().size() : 0, way.length, clear);
  return clear ? 0 : 1;
}
