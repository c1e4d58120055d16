// draw(scene) against its slow twin, over random scenes and directions of every kind.
#include <gtest/gtest.h>

#include <random>

#include "blackleaf/scene.h"
#include "directions.h"
#include "reference/dense_scene.h"
#include "scenes.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
using reference::DenseScene;

void expect_like_twin(const std::vector<DenseGrid>& grids, const Eigen::Vector3d& direction,
                      const SceneOptions& options) {
  SCOPED_TRACE("view " + show(direction) + " gap " + std::to_string(options.outline_gap));
  const View view(direction);
  expect_same_layers(draw(scene_of(grids), view, options), DenseScene::lines(grids, view.direction(), options));
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
