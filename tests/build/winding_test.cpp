// Meshes that do not bound a solid as they are: winding numbers, turning, both ways of telling inside from outside.
#include <algorithm>

#include "blackleaf/measures.h"
#include "build/winding.h"
#include "meshes.h"
#include "reference/mesh_reference.h"
#include "reference/winding_reference.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
using namespace testing;

// A part with vertices at no special places, so that no centre lies on it or on a plane of it.
TriangleMesh generic(TriangleMesh mesh, std::mt19937& random) {
  std::uniform_real_distribution<double> jitter(-0.01, 0.01);
  Eigen::Vector3d by(jitter(random), jitter(random), jitter(random));
  for (auto& v : mesh.vertices) v += by;
  return mesh;
}

void remove_some(TriangleMesh& mesh, double fraction, std::mt19937& random) {
  std::bernoulli_distribution remove(fraction);
  std::erase_if(mesh.triangles, [&](const auto&) { return remove(random); });
  if (mesh.triangles.empty()) mesh.triangles.push_back({0, 1, 2});
}

// Compares all voxels whose number is not too near 1/2; returns how many were compared.
int expect_equal(const Octree& octree, const TriangleMesh& mesh, int depth) {
  int compared = 0;
  for (int z = 0; z < 1 << depth; ++z)
    for (int y = 0; y < 1 << depth; ++y)
      for (int x = 0; x < 1 << depth; ++x) {
        const double w = reference::generalised_winding(mesh, {x + 0.5, y + 0.5, z + 0.5});
        if (std::abs(w - 0.5) < 1e-8) continue;
        ++compared;
        if (octree.contains(x, y, z) != (w > 0.5)) ADD_FAILURE() << x << ' ' << y << ' ' << z << ": " << w;
      }
  return compared;
}

// The solid of a mesh as it is oriented.
Octree as_oriented(const TriangleMesh& mesh, int depth) {
  return detail::winding_solid(detail::grid_mesh(mesh, universe(depth)), {}, {1, {}}).octree;
}

TEST(Winding, AnySetOfTrianglesEqualsTheTwin) {
  std::mt19937 random(20240707);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const int depth = i % 10 == 0 ? 5 : 3 + i % 2;
    const double side = 1 << depth;
    std::uniform_real_distribution<double> coordinate(0.1, side - 0.1);
    TriangleMesh mesh = generic(sphere(Eigen::Vector3d::Constant(side / 2), side * 0.4, pick(0, 3)), random);
    if (i % 3 == 1) append(mesh, generic(box_mesh({1.2, 1.3, 1.4}, {side / 2, side - 1.5, side / 2}), random), i % 2);
    if (i % 3 == 2) append(mesh, generic(sphere(Eigen::Vector3d::Constant(side / 2), side * 0.3, 2), random), i % 2);
    remove_some(mesh, std::array{0.02, 0.1, 0.3, 0.7}[static_cast<std::size_t>(i / 4 % 4)], random);
    if (i % 5 == 4)
      for (auto& t : mesh.triangles)
        if (pick(0, 9) == 0) std::swap(t[0], t[1]);
    if (i % 5 == 3)  // not joined to anything
      for (int k = 0; k < 10; ++k) {
        const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
        for (int v = 0; v < 3; ++v)
          mesh.vertices.emplace_back(coordinate(random), coordinate(random), coordinate(random));
        mesh.triangles.push_back({base, base + 1, base + 2});
      }
    const Octree octree = as_oriented(mesh, depth);
    reference::expect_valid(octree);
    compared += expect_equal(octree, mesh, depth);
  }
  EXPECT_GT(compared, 200000);
}

// Walls, rims and caps pass through centres, which count as moved by (e, e^2, e^3).
TEST(Winding, OpenBoxesThroughCentres) {
  std::mt19937 random(77);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const Eigen::Vector3d low(pick(0, 2) + 0.5, pick(0, 2) + 0.5, pick(0, 2) + 0.5);
    TriangleMesh mesh = box_mesh(low, low + Eigen::Vector3d(pick(1, 4), pick(1, 4), pick(1, 4)));
    const auto side = static_cast<std::ptrdiff_t>(pick(0, 5));
    mesh.triangles.erase(mesh.triangles.begin() + 2 * side, mesh.triangles.begin() + 2 * side + 1 + i % 2);
    const Octree octree = as_oriented(mesh, 3);
    reference::expect_valid(octree);
    for (int z = 0; z < 8; ++z)
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
          const double w = reference::generalised_winding(mesh, {x + 0.5 + 1e-3, y + 0.5 + 1e-6, z + 0.5 + 1e-9});
          if (std::abs(w - 0.5) < 1e-2) continue;
          ++compared;
          EXPECT_EQ(octree.contains(x, y, z), w > 0.5) << x << ' ' << y << ' ' << z << ": " << w;
        }
  }
  EXPECT_GT(compared, 28000);
}

TEST(Winding, ShellsInShells) {
  std::mt19937 random(5);
  const Eigen::Vector3d centre(16.13, 16.27, 15.91);
  std::array<TriangleMesh, 3> shells;
  std::array<Octree, 3> balls;
  for (std::size_t i = 0; i < 3; ++i) {
    shells[i] = sphere(centre, 15.0 - 4.5 * static_cast<double>(i), 3);
    balls[i] = octree_from_mesh(shells[i], universe(5));
  }
  const std::uint64_t alternating = volume(balls[0]) - volume(balls[1]) + volume(balls[2]);
  for (int facing = 0; facing < 8; ++facing)
    for (const bool mixed : {false, true}) {
      SCOPED_TRACE("facing " + std::to_string(facing) + (mixed ? ", some triangles turned" : ""));
      TriangleMesh mesh;
      for (std::size_t i = 0; i < 3; ++i) append(mesh, shells[i], facing >> i & 1);
      if (mixed)
        for (auto& t : mesh.triangles)
          if (std::bernoulli_distribution(0.2)(random)) std::swap(t[0], t[1]);
      EXPECT_EQ(volume(solid_from_mesh(mesh, universe(5), {MeshRule::centre, Inside::parity}).octree), alternating);
      const MeshSolid solid = solid_from_mesh(mesh, universe(5));
      if (mixed) {  // mended shells are cavities where the larger ones wind about them
        EXPECT_EQ(volume(solid.octree), alternating);
        EXPECT_GT(solid.turned_triangles, 200u);
      } else if (facing == 0 || facing == 7) {  // they wind up to three times
        EXPECT_EQ(solid.octree, balls[0]);
        EXPECT_TRUE(solid.overlaps);
      } else if (facing == 2 || facing == 5) {
        EXPECT_EQ(volume(solid.octree), alternating);
        EXPECT_EQ(solid.inside, Inside::parity);
      }
    }
}

TEST(Winding, TheBunnyWithHoles) {
  const TriangleMesh bunny = read_stl(BLACKLEAF_DATA "/bunny.stl");
  const MeshPlacement placement = place_by_fraction(bunny, 7, 0.75);
  TriangleMesh open = bunny;
  std::mt19937 random(1);
  remove_some(open, 0.05, random);
  const MeshSolid solid = solid_from_mesh(open, placement, {}, {1, {}});
  EXPECT_EQ(solid.inside, Inside::winding);
  EXPECT_GT(solid.holes, 100u);
  EXPECT_EQ(solid.octree, solid_from_mesh(open, placement, {}, {2, {}}).octree);
  EXPECT_ANY_THROW(solid_from_mesh(open, placement, {MeshRule::centre, Inside::parity}));
  const Octree whole = octree_from_mesh(bunny, placement);
  const Octree touched = solid_from_mesh(open, placement, {MeshRule::touched, Inside::automatic}).octree;
  std::uint64_t differ = 0;
  reference::dense(solid.octree).for_each([&](int x, int y, int z, bool black) {
    differ += black != whole.contains(x, y, z);
    EXPECT_TRUE(!black || touched.contains(x, y, z));
  });
  EXPECT_GT(differ, 0u);
  EXPECT_LT(differ, volume(whole) / 1000);
}

}  // namespace
}  // namespace blackleaf
