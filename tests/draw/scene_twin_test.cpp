// draw(scene) against its slow twin, over random scenes and directions of every kind.
#include <gtest/gtest.h>

#include <random>

#include "blackleaf/scene.h"
#include "directions.h"
#include "reference/dense_scene.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
using reference::DenseScene;

Scene scene_of(const std::vector<DenseGrid>& grids) {
  std::vector<Octree> solids;
  for (const DenseGrid& grid : grids) solids.push_back(reference::octree(grid));
  return Scene(std::move(solids));
}

void expect_like_twin(const std::vector<DenseGrid>& grids, const Eigen::Vector3d& direction,
                      const SceneOptions& options) {
  SCOPED_TRACE("view " + show(direction) + " gap " + std::to_string(options.outline_gap));
  const View view(direction);
  const DenseScene::Layers expected = DenseScene::lines(grids, view.direction(), options);
  DenseScene::Layers found;
  std::pair<LineKind, std::size_t> last{};
  for (SceneLines& lines : draw(scene_of(grids), view, options)) {
    const std::pair pen{lines.kind, lines.solid};
    EXPECT_TRUE(found.empty() || last < pen);
    last = pen;
    found[pen] = std::move(lines.strokes);
  }
  for (const auto& [pen, strokes] : expected) {
    SCOPED_TRACE("kind " + std::to_string(int(pen.first)) + " of solid " + std::to_string(pen.second));
    EXPECT_EQ(reference::difference(found[pen], strokes, 1e-9), "");
    found.erase(pen);
  }
  for (const auto& [pen, strokes] : found)
    if (!strokes.empty()) ADD_FAILURE() << "kind " << int(pen.first) << " of solid " << pen.second << " has strokes";
}

// Solids that overlap, touch, or share the universe as labels do.
std::vector<DenseGrid> random_scene(int depth, std::mt19937& random) {
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  std::vector<DenseGrid> grids;
  for (int i = pick(1, 4); i > 0; --i) grids.push_back(reference::random_solid(depth, random));
  switch (pick(0, 3)) {
    case 0:  // labels: every voxel belongs to the first that has it
      for (std::size_t i = 0; i < grids[0].voxels.size(); ++i) {
        bool taken = false;
        for (DenseGrid& grid : grids) {
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

SceneOptions random_options(std::mt19937& random) {
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  SceneOptions options;
  options.hidden = pick(0, 3) != 0;
  options.outline = pick(0, 3) != 0;
  if (pick(0, 1)) options.outline_gap = std::array{0.5, 1.0, 2.5, 4.0}[static_cast<std::size_t>(pick(0, 3))];
  return options;
}

TEST(SceneTwin, RandomScenes) {
  for (unsigned seed = 0; seed < 1500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const std::vector<DenseGrid> grids = random_scene(seed % 50 == 0 ? 3 : seed % 3 == 0 ? 1 : 2, random);
    expect_like_twin(grids, random_direction(random), random_options(random));
  }
}

// Two voxels beside each other, in all ways, as two labels and as two solids at one place.
TEST(SceneTwin, PairsOfVoxels) {
  for (int first = 0; first < 8; ++first)
    for (int second = 0; second < 8; ++second) {
      SCOPED_TRACE(std::to_string(first) + " and " + std::to_string(second));
      std::vector<DenseGrid> grids(2, DenseGrid(1));
      grids[0].set(first & 1, first >> 1 & 1, first >> 2);
      grids[1].set(second & 1, second >> 1 & 1, second >> 2);
      for (const Eigen::Vector3d& d : {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, 2, 1),
                                       Eigen::Vector3d(-3, 1, 2), Eigen::Vector3d(1, 0, -1)})
        for (const double gap : {1.0, std::numeric_limits<double>::infinity()}) {
          SceneOptions options;
          options.hidden = options.outline = true;
          options.outline_gap = gap;
          expect_like_twin(grids, d, options);
        }
    }
}

}  // namespace
}  // namespace blackleaf
