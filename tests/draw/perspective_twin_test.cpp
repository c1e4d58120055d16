// draw() in perspective against its slow twin, over random solids and eyes of every kind.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "blackleaf/error.h"
#include "blackleaf/perspective.h"
#include "reference/dense_perspective.h"
#include "scenes.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
using reference::DensePerspective;

std::string show(const Eigen::Vector3d& p) {
  return std::to_string(p[0]) + "," + std::to_string(p[1]) + "," + std::to_string(p[2]);
}

bool touches(const DenseGrid& grid, const Eigen::Vector3d& eye) {
  for (int corner = 0; corner < 8; ++corner) {
    std::array<int, 3> voxel{};
    for (int i = 0; i < 3; ++i) {
      const double floor = std::floor(eye[i]);
      voxel[static_cast<std::size_t>(i)] = static_cast<int>(corner >> i & 1 && floor == eye[i] ? floor - 1 : floor);
    }
    if (grid.at(voxel[0], voxel[1], voxel[2])) return true;
  }
  return false;
}

// Draws with both, or expects a refusal; true iff drawn.
bool expect_like_twin(const std::vector<DenseGrid>& grids, const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                      double degrees, const SceneOptions& options) {
  SCOPED_TRACE("eye " + show(eye) + " target " + show(target) + " field of view " + std::to_string(degrees));
  const Perspective perspective(eye, target, degrees * std::numbers::pi / 180);
  const double tolerance = 1e-9 * (1 + perspective.distance());
  if (touches(reference::DenseScene::union_of(grids), eye)) {
    EXPECT_THROW(draw(scene_of(grids), perspective, options), Error);
    return false;
  }
  expect_same_layers(draw(scene_of(grids), perspective, options), DensePerspective::lines(grids, perspective, options),
                     tolerance);
  if (grids.size() == 1 && !options.hidden && !options.outline) {
    const LineDrawing drawing = draw(reference::octree(grids[0]), perspective);
    EXPECT_EQ(reference::difference(drawing.strokes, DensePerspective::strokes(grids[0], perspective), tolerance), "");
  }
  return true;
}

// One of the kinds of eye that differ in how edges, ways and picture lines fall together.
Eigen::Vector3d random_eye(int side, std::mt19937& random) {
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  const auto real = [&](double low, double high) {
    // On the grid of 2^-16, so that eyes are what they are called.
    return std::round(std::uniform_real_distribution<double>(low, high)(random) * 65536) / 65536;
  };
  Eigen::Vector3d eye(0, 0, 0);
  switch (pick(0, 6)) {
    case 0:  // anywhere around
      for (int i = 0; i < 3; ++i) eye[i] = real(-2 * side, 3 * side);
      break;
    case 1:  // a lattice point
      for (int i = 0; i < 3; ++i) eye[i] = pick(-side, 2 * side);
      break;
    case 2:  // on a lattice plane
      for (int i = 0; i < 3; ++i) eye[i] = real(-side, 2 * side);
      eye[pick(0, 2)] = pick(-1, side + 1);
      break;
    case 3:  // on a lattice line
      for (int i = 0; i < 3; ++i) eye[i] = pick(-1, side + 1);
      eye[pick(0, 2)] = real(-side, 2 * side);
      break;
    case 4:  // within the universe: between parts, in cavities
      for (int i = 0; i < 3; ++i) eye[i] = pick(0, 1) ? real(0, side) : pick(0, 2 * side) / 2.0;
      break;
    case 5:  // with many coincidences
      for (int i = 0; i < 3; ++i) eye[i] = pick(-4 * side, 6 * side) / 2.0;
      break;
    default:  // far away
      for (int i = 0; i < 3; ++i) eye[i] = pick(-1, 1) * pick(1, 1 << 23);
  }
  return eye;
}

Eigen::Vector3d random_target(const Eigen::Vector3d& eye, int side, std::mt19937& random) {
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  Eigen::Vector3d target = Eigen::Vector3d::Constant(side / 2.0);
  do {
    if (pick(0, 1)) target = {double(pick(0, side)), double(pick(0, side)), double(pick(0, side))};
    if (pick(0, 3) == 0) target = eye + Eigen::Vector3d(pick(-2, 2), pick(-2, 2), pick(-2, 2));
  } while (target == eye);
  return target;
}

TEST(PerspectiveTwin, AllSolidsOfDepthOne) {
  const std::array<Eigen::Vector3d, 7> eyes = {
      Eigen::Vector3d(5, -7, 4.25),   Eigen::Vector3d(4, 4, 4),   Eigen::Vector3d(1, 1, -2), Eigen::Vector3d(1, 5, 2),
      Eigen::Vector3d(0.5, 0.5, 0.5), Eigen::Vector3d(2.5, 1, 1), Eigen::Vector3d(0, -1, 2)};
  for (unsigned bits = 0; bits < 256; ++bits) {
    SCOPED_TRACE("solid " + std::to_string(bits));
    DenseGrid grid(1);
    for (int i = 0; i < 8; ++i) grid.set(i & 1, i >> 1 & 1, i >> 2, bits >> i & 1);
    expect_like_twin({grid}, eyes[bits % 7], {1, 1, 1}, 120, {});
  }
}

TEST(PerspectiveTwin, RandomSolids) {
  int drawn = 0;
  for (unsigned seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const DenseGrid grid = reference::random_solid(seed % 25 == 0 ? 3 : seed % 3 == 0 ? 1 : 2, random);
    const Eigen::Vector3d eye = random_eye(grid.side(), random);
    const Eigen::Vector3d target = random_target(eye, grid.side(), random);
    drawn += expect_like_twin({grid}, eye, target, std::array{20.0, 60.0, 120.0, 170.0}[random() % 4], {});
  }
  EXPECT_GT(drawn, 300);
}

// Few voxels far apart: much of the picture is decided far from where the way to the eye begins.
TEST(PerspectiveTwin, ScatteredVoxels) {
  int drawn = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 5000);
    DenseGrid grid(4);
    for (int i = 0; i < 12; ++i) {
      const auto at = [&] { return std::uniform_int_distribution<int>(0, 15)(random); };
      const int x = at(), y = at(), z = at();
      grid.set(x, y, z);
    }
    const Eigen::Vector3d eye = random_eye(16, random);
    drawn += expect_like_twin({grid}, eye, random_target(eye, 16, random), 120, {});
  }
  EXPECT_GT(drawn, 8);
}

TEST(PerspectiveTwin, RandomScenes) {
  int drawn = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 20000);
    const std::vector<DenseGrid> grids = random_scene(seed % 3 == 0 ? 1 : 2, random);
    SceneOptions options;
    options.hidden = random() % 4 != 0;
    options.outline = random() % 2 != 0;
    const int side = grids[0].side();
    const Eigen::Vector3d eye = random_eye(side, random);
    drawn += expect_like_twin(grids, eye, random_target(eye, side, random), random() % 2 ? 60 : 130, options);
  }
  EXPECT_GT(drawn, 200);
}

}  // namespace
}  // namespace blackleaf
