#include <algorithm>

#include "meshes.h"
#include "reference/mesh_reference.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
using namespace testing;

// The octree, or nothing when the surface is found to pass through itself.
std::optional<Octree> build(const TriangleMesh& mesh, const MeshPlacement& placement, const Work& work = {}) {
  try {
    return octree_from_mesh(mesh, placement, MeshRule::centre, work);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    EXPECT_NE(std::string(error.what()).find("passes through itself"), std::string::npos) << error.what();
    return std::nullopt;
  }
}

TEST(MeshOctree, CubeIsExact) {
  const Octree octree = octree_from_mesh(box_mesh({1, 1, 1}, {7, 7, 7}), universe(3));
  EXPECT_EQ(octree, box(3, {1, 1, 1}, {7, 7, 7}));
  EXPECT_EQ(volume(octree), 216u);
}

TEST(MeshOctree, EqualsTheTwin) {
  std::mt19937 random(20240101);
  int accepted = 0, refused = 0;
  for (int i = 0; i < 1500; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const int depth = i % 5 == 0 ? 4 : 3;
    const TriangleMesh mesh = random_mesh(depth, random);
    ASSERT_TRUE(check(mesh).closed());
    const std::optional<DenseGrid> expected = reference::centre_rule(mesh, depth);
    const std::optional<Octree> octree = build(mesh, universe(depth));
    ASSERT_EQ(octree.has_value(), expected.has_value());
    if (!octree) {
      ++refused;
      continue;
    }
    ++accepted;
    reference::expect_valid(*octree);
    ASSERT_EQ(*octree, reference::octree(*expected));
    EXPECT_EQ(octree_from_mesh(reversed(mesh), universe(depth)), *octree);
  }
  EXPECT_GT(accepted, 1000);
  RecordProperty("refused", refused);
}

TEST(MeshOctree, EveryDepthFromOne) {
  const TriangleMesh ball = sphere({0.5, 0.5, 0.5}, 0.45, 1);
  for (int depth = 1; depth <= 5; ++depth) {
    SCOPED_TRACE(depth);
    const TriangleMesh mesh = moved(ball, Eigen::Matrix3d::Identity() * (1 << depth), Eigen::Vector3d::Zero());
    EXPECT_EQ(octree_from_mesh(mesh, universe(depth)), reference::octree(reference::centre_rule(mesh, depth).value()));
  }
  for (int depth = 1; depth <= 20; ++depth) {
    SCOPED_TRACE(depth);
    const double side = std::ldexp(1.0, depth);
    if (depth <= 9) {  // the cost follows the surface
      EXPECT_TRUE(octree_from_mesh(box_mesh({0, 0, 0}, {side, side, side}), universe(depth)).root().is_black());
    }
    // A small box far out in a large universe.
    const double at = side * 0.5 - 1;
    const Octree small = octree_from_mesh(box_mesh({at, at, at}, {at + 2, at + 2, at + 2}), universe(depth));
    EXPECT_EQ(volume(small), 8u);
    EXPECT_EQ(small.contains(static_cast<int>(at), static_cast<int>(at) + 1, static_cast<int>(at)), true);
    reference::expect_valid(small);
  }
}

TEST(MeshOctree, SmallSolidsInTheLargestUniverse) {
  std::mt19937 random(7);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const int x = std::uniform_int_distribution<int>(0, (1 << 20) - 8)(random), y = i % 2 ? (1 << 20) - 8 : 3,
              z = 4 * i;
    const TriangleMesh mesh = moved(sphere({4, 4, 4}, 3.9, 1), Eigen::Matrix3d::Identity(), Eigen::Vector3d(x, y, z));
    const Octree octree = octree_from_mesh(mesh, universe(20));
    const auto triangles = reference::integer_triangles(mesh, 20);
    std::uint64_t black = 0;
    for (int dz = 0; dz < 8; ++dz)
      for (int dy = 0; dy < 8; ++dy)
        for (int dx = 0; dx < 8; ++dx) {
          const bool expected = reference::winding(triangles, 20, x + dx, y + dy, z + dz) != 0;
          black += expected;
          EXPECT_EQ(octree.contains(x + dx, y + dy, z + dz), expected);
        }
    EXPECT_EQ(volume(octree), black);
  }
}

TEST(MeshOctree, SharedFacesNeitherOverlapNorGape) {
  for (const double face : {3.0, 3.5, 4.0, 4.25, 4.5}) {
    SCOPED_TRACE(face);
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d middle_high(7, 7, 7), middle_low(1, 1, 1);
      middle_high[axis] = middle_low[axis] = face;
      const Octree a = octree_from_mesh(box_mesh({1, 1, 1}, middle_high), universe(3));
      const Octree b = octree_from_mesh(box_mesh(middle_low, {7, 7, 7}), universe(3));
      DenseGrid both(3);
      both.for_each([&](int x, int y, int z, bool) {
        EXPECT_FALSE(a.contains(x, y, z) && b.contains(x, y, z));
        both.set(x, y, z, a.contains(x, y, z) || b.contains(x, y, z));
      });
      EXPECT_EQ(reference::octree(both), box(3, {1, 1, 1}, {7, 7, 7}));
    }
  }
}

TEST(MeshOctree, TetrahedraFillTheirCube) {
  // Six tetrahedra of a cube whose corners lie on voxel centres: each voxel belongs to exactly one.
  const Eigen::Vector3d low(0.5, 0.5, 0.5);
  std::array<int, 3> axes = {0, 1, 2};
  DenseGrid all(3);
  do {
    std::array<Eigen::Vector3d, 4> p = {low, low, low, low};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = i; j < 3; ++j) p[j + 1][axes[i]] += 6;
    const Octree part = octree_from_mesh(tetrahedron(p), universe(3));
    all.for_each([&](int x, int y, int z, bool black) {
      if (!part.contains(x, y, z)) return;
      EXPECT_FALSE(black);
      all.set(x, y, z);
    });
  } while (std::next_permutation(axes.begin(), axes.end()));
  EXPECT_EQ(reference::octree(all), octree_from_mesh(box_mesh(low, low.array() + 6), universe(3)));
  EXPECT_EQ(volume(reference::octree(all)), 216u);
}

TEST(MeshOctree, WholeVoxelsCommuteWithBuilding) {
  std::mt19937 random(11);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const TriangleMesh mesh = random_mesh(3, random);
    const std::array<int, 3> by = {i % 8, i / 8 % 8, i * 5 % 9};
    const TriangleMesh shifted = moved(mesh, Eigen::Matrix3d::Identity(), Eigen::Vector3d(by[0], by[1], by[2]));
    const std::optional<Octree> a = build(mesh, universe(4)), b = build(shifted, universe(4));
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    DenseGrid expected(4);
    expected.for_each(
        [&](int x, int y, int z, bool) { expected.set(x, y, z, a->contains(x - by[0], y - by[1], z - by[2])); });
    EXPECT_EQ(*b, reference::octree(expected));
  }
}

TEST(MeshOctree, FramesOfAnyKind) {
  // The same universe through oblique frames of either hand: the mesh is mapped out and comes back to the grid.
  Frame frame;
  frame.origin = {10, -20, 3};
  frame.axes << 0, 0.5, 0.25, 2, 0, 0, 0, 0.125, 1;
  const TriangleMesh mesh = sphere({8, 8, 8}, 7, 2);
  ASSERT_LT(frame.axes.determinant(), 0);
  for (const double hand : {1.0, -1.0}) {
    Frame f = frame;
    f.axes.col(0) *= hand;
    TriangleMesh world = mesh;
    for (auto& v : world.vertices) v = f.to_world(v);
    const Octree octree = octree_from_mesh(world, {4, f});
    EXPECT_EQ(octree, octree_from_mesh(mesh, universe(4)));
    EXPECT_EQ(octree.frame(), f);
  }
}

TEST(MeshOctree, Bunny) {
  const TriangleMesh bunny = read_stl(BLACKLEAF_DATA "/bunny.stl");
  const MeshReport report = check(bunny);
  EXPECT_EQ(report.triangles, 3674u);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.open_edges + report.non_manifold_edges + report.misoriented_edges + report.degenerate_triangles, 0u);

  const MeshPlacement coarse = place_by_fraction(bunny, 5, 0.6);
  TriangleMesh in_voxels = bunny;
  for (auto& v : in_voxels.vertices) v = (v - coarse.frame.origin) / coarse.frame.axes(0, 0);
  EXPECT_EQ(octree_from_mesh(bunny, coarse), reference::octree(reference::centre_rule(in_voxels, 5).value()));

  const MeshPlacement placement = place_by_fraction(bunny, 8, 0.6);
  const Octree octree = octree_from_mesh(bunny, placement, MeshRule::centre, {1, {}});
  EXPECT_EQ(volume(octree), 723898u);
  reference::expect_valid(octree);
  const Octree touched = octree_from_mesh(bunny, placement, MeshRule::touched, {1, {}});
  reference::expect_valid(touched);
  for (const int threads : {0, 2, 5}) {
    EXPECT_EQ(octree_from_mesh(bunny, placement, MeshRule::centre, {threads, {}}), octree);
    EXPECT_EQ(octree_from_mesh(bunny, placement, MeshRule::touched, {threads, {}}), touched);
  }
}

TEST(MeshOctree, TouchedEqualsTheTwin) {
  std::mt19937 random(5);
  int compared = 0;
  for (int i = 0; i < 120; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const TriangleMesh mesh = snapped(random_mesh(3, random), i % 2 ? 2 : 64);
    const std::optional<Octree> centre = build(mesh, universe(3));
    if (!centre) continue;
    ++compared;
    const Octree touched = octree_from_mesh(mesh, universe(3), MeshRule::touched);
    reference::expect_valid(touched);
    ASSERT_EQ(touched, reference::octree(reference::touched_rule(mesh, 3)));
    reference::dense(*centre).for_each(
        [&](int x, int y, int z, bool black) { EXPECT_TRUE(!black || touched.contains(x, y, z)); });
  }
  EXPECT_GT(compared, 80);
}

TEST(MeshOctree, TouchingFromOutsideCounts) {
  EXPECT_EQ(octree_from_mesh(box_mesh({2, 2, 2}, {4, 4, 4}), universe(3), MeshRule::touched),
            box(3, {1, 1, 1}, {5, 5, 5}));
  EXPECT_EQ(octree_from_mesh(box_mesh({0.25, 0.25, 0.25}, {0.5, 0.5, 0.5}), universe(1), MeshRule::touched),
            box(1, {0, 0, 0}, {1, 1, 1}));
  EXPECT_TRUE(octree_from_mesh(box_mesh({0, 0, 0}, {2, 2, 2}), universe(1), MeshRule::touched).root().is_black());
}

TEST(MeshOctree, RoundTripThroughTheBoundary) {
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const int depth = 1 + i % 4;
    const Octree octree = reference::octree(reference::random_solid(depth, random));
    if (octree.is_empty()) continue;
    EXPECT_EQ(octree_from_mesh(boundary_mesh(octree), universe(depth)), octree);
  }
}

TEST(MeshOctree, Errors) {
  const auto message = [](const TriangleMesh& mesh, ErrorCode code = ErrorCode::bad_input, int depth = 3) {
    return error_of(code, [&] { octree_from_mesh(mesh, universe(depth)); });
  };
  EXPECT_EQ(message({}), "the mesh has no triangles; give a closed surface of triangles");
  TriangleMesh open = box_mesh({1, 1, 1}, {7, 7, 7});
  open.triangles.pop_back();
  EXPECT_EQ(message(open), "the mesh is not closed: it has 3 open edges; close its holes first");
  TriangleMesh turned = box_mesh({1, 1, 1}, {7, 7, 7});
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_EQ(message(turned),
            "the mesh is oriented inconsistently: 3 edges are passed unequally often in both directions; turn its "
            "triangles so that all face outward");
  TriangleMesh overlapping = box_mesh({1, 1, 1}, {5, 5, 5});
  append(overlapping, box_mesh({4, 4, 4}, {7, 7, 7}));
  EXPECT_EQ(
      message(overlapping),
      "the mesh passes through itself or is oriented inconsistently in 1 of 24 columns of voxels, first near (4.5, "
      "4.5, 4.5); unite its overlapping parts and turn all its triangles outward");
  TriangleMesh mixed = box_mesh({1, 1, 1}, {3, 3, 3});
  append(mixed, box_mesh({4, 4, 4}, {7, 7, 7}), true);
  EXPECT_EQ(
      message(mixed),
      "the mesh passes through itself or is oriented inconsistently in 4 of 13 columns of voxels, first near (1.5, "
      "1.5, 1.5); unite its overlapping parts and turn all its triangles outward");
  EXPECT_EQ(
      message(box_mesh({1, 1, 1}, {7, 7, 9}), ErrorCode::out_of_universe),
      "the mesh reaches from (1, 1, 1) to (7, 7, 9) voxels, but the universe only from 0 to 8; place it inside, or "
      "use a universe that holds it");
  EXPECT_EQ(message(box_mesh({1, 1, 1}, {7, 7, 9}), ErrorCode::bad_argument, 21),
            "depth 21 is out of range; use 1 to 20");
  TriangleMesh endless = box_mesh({1, 1, 1}, {7, 7, 7});
  endless.vertices[3].y() = std::nan("");
  EXPECT_EQ(message(endless), "vertex 3 is not finite; mend its coordinates or remove its triangles");
  TriangleMesh wild = box_mesh({1, 1, 1}, {7, 7, 7});
  wild.triangles[4][2] = 8;
  EXPECT_EQ(
      message(wild),
      "triangle 4 refers to vertex 8, but the mesh has 8 vertices; mend the triangle's indices (they count from 0)");
  MeshPlacement flat = universe(3);
  flat.frame.axes.col(1) = flat.frame.axes.col(0);
  EXPECT_EQ(error_of(ErrorCode::bad_argument,
                     [&] {
                       octree_from_mesh(box_mesh({1, 1, 1}, {2, 2, 2}), flat);
                     }),
            "the frame's axes do not span space; give three independent axes");
}

TEST(MeshOctree, CanBeInterrupted) {
  const TriangleMesh mesh = sphere({128, 128, 128}, 100, 3);
  for (const int threads : {1, 2}) {
    double last = 0;
    const Octree whole = octree_from_mesh(mesh, universe(8), MeshRule::touched, {threads, [&](double done) {
                                                                                   EXPECT_GE(done, 0);
                                                                                   EXPECT_LE(done, 1);
                                                                                   last = std::max(last, done);
                                                                                   return true;
                                                                                 }});
    EXPECT_EQ(last, 1);
    EXPECT_EQ(
        error_of(
            ErrorCode::cancelled,
            [&] {
              octree_from_mesh(mesh, universe(8), MeshRule::touched, {threads, [](double done) { return done < 0.7; }});
            }),
        "interrupted");
  }
}

}  // namespace
}  // namespace blackleaf
