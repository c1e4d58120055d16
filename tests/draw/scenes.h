// Random scenes for tests of drawings.
#pragma once

#include <random>
#include <vector>

#include "blackleaf/scene.h"
#include "reference/dense_scene.h"
#include "reference/stroke_difference.h"

namespace blackleaf {

inline Scene scene_of(const std::vector<reference::DenseGrid>& grids) {
  std::vector<Octree> solids;
  for (const reference::DenseGrid& grid : grids) solids.push_back(reference::octree(grid));
  return Scene(std::move(solids));
}

/// Solids that overlap, touch, or share the universe as labels do.
inline std::vector<reference::DenseGrid> random_scene(int depth, std::mt19937& random) {
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  std::vector<reference::DenseGrid> grids;
  for (int i = pick(1, 4); i > 0; --i) grids.push_back(reference::random_solid(depth, random));
  switch (pick(0, 3)) {
    case 0:  // labels: every voxel belongs to the first that has it
      for (std::size_t i = 0; i < grids[0].voxels.size(); ++i) {
        bool taken = false;
        for (reference::DenseGrid& grid : grids) {
          grid.voxels[i] = grid.voxels[i] && !taken;
          taken = taken || grid.voxels[i];
        }
      }
      break;
    case 1:  // all voxels of one of several colours
      for (std::size_t i = 0; i < grids[0].voxels.size(); ++i) {
        const auto owner = static_cast<std::size_t>(pick(0, int(grids.size()) - 1));
        for (std::size_t k = 0; k < grids.size(); ++k) grids[k].voxels[i] = grids[0].voxels[i] && k == owner;
      }
      break;
    default:
      break;
  }
  return grids;
}

/// The same lines of the same kinds and solids, in order.
inline void expect_same_layers(std::vector<SceneLines> drawn, const reference::DenseScene::Layers& expected,
                               double tolerance = 1e-9) {
  reference::DenseScene::Layers found;
  std::pair<LineKind, std::size_t> last{};
  for (SceneLines& lines : drawn) {
    const std::pair pen{lines.kind, lines.solid};
    EXPECT_TRUE(found.empty() || last < pen);
    last = pen;
    found[pen] = std::move(lines.strokes);
  }
  for (const auto& [pen, strokes] : expected) {
    SCOPED_TRACE("kind " + std::to_string(int(pen.first)) + " of solid " + std::to_string(pen.second));
    EXPECT_EQ(reference::difference(found[pen], strokes, tolerance), "");
    found.erase(pen);
  }
  for (const auto& [pen, strokes] : found)
    if (!strokes.empty()) ADD_FAILURE() << "kind " << int(pen.first) << " of solid " << pen.second << " has strokes";
}

}  // namespace blackleaf
