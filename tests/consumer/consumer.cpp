#include <blackleaf/contact.h>
#include <blackleaf/drawing.h>
#include <blackleaf/implicit.h>
#include <blackleaf/move.h>
#include <blackleaf/octree_file.h>

#include <cstdio>

int main() {
  using namespace blackleaf;
  const Octree stone = ball(6, {20, 32, 32}, 10), wall = box(6, {40, 0, 0}, {44, 64, 64});
  const Octree moved = move(stone, Motion::translation({12, 0, 0}));
  const bool before = interferes(stone, wall), after = interferes(moved, wall);
  const bool kept = from_bytes(to_bytes(moved)).octree == moved;
  const LineDrawing drawing = draw(moved, View({3, -4, 2}));
  std::printf("before %d, after %d, kept %d, strokes %zu\n", before, after, kept, drawing.strokes.size());
  return !before && after && kept && !drawing.strokes.empty() ? 0 : 1;
}
