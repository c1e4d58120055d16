#include <limits>

#include "meshes.h"

namespace blackleaf {
namespace {

using namespace testing;

TEST(MeshCheck, SoundMeshes) {
  const MeshReport box = check(box_mesh({0, 0, 0}, {1, 2, 3}));
  EXPECT_EQ(box.triangles, 12u);
  EXPECT_EQ(box.components, 1u);
  EXPECT_TRUE(box.closed());
  EXPECT_EQ(box.degenerate_triangles + box.non_manifold_edges + box.misoriented_edges, 0u);
  const MeshReport ball = check(sphere({0, 0, 0}, 1, 3));  // every triangle has vertices of its own
  EXPECT_EQ(ball.triangles, 512u);
  EXPECT_EQ(ball.components, 1u);
  EXPECT_TRUE(ball.closed());
}

TEST(MeshCheck, OpenEdges) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  mesh.triangles.erase(mesh.triangles.begin());
  EXPECT_EQ(check(mesh).open_edges, 3u);
  EXPECT_EQ(check(mesh).misoriented_edges, 3u);
  EXPECT_FALSE(check(mesh).closed());
  mesh.triangles.resize(1);
  EXPECT_EQ(check(mesh).open_edges, 3u);
}

TEST(MeshCheck, Orientation) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  std::swap(mesh.triangles[5][1], mesh.triangles[5][2]);
  const MeshReport report = check(mesh);
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(report.misoriented_edges, 3u);
  EXPECT_EQ(check(reversed(box_mesh({0, 0, 0}, {1, 1, 1}))).misoriented_edges, 0u);
}

TEST(MeshCheck, NonManifoldEdgesAndComponents) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  append(mesh, box_mesh({1, 1, 0}, {2, 2, 1}));  // shares the edge x = y = 1
  append(mesh, box_mesh({5, 5, 5}, {6, 6, 6}));
  const MeshReport report = check(mesh);
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(report.non_manifold_edges, 1u);
  EXPECT_EQ(report.misoriented_edges, 0u);
  EXPECT_EQ(report.components, 2u);
}

TEST(MeshCheck, DoubledTriangles) {
  const TriangleMesh box = box_mesh({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(check(box).doubled_triangles, 0u);
  TriangleMesh mesh = box;
  mesh.triangles.push_back({box.triangles[4][1], box.triangles[4][2], box.triangles[4][0]});
  EXPECT_EQ(check(mesh).doubled_triangles, 1u);
  EXPECT_EQ(check(mesh).open_edges, 3u);
  EXPECT_EQ(check(mesh).doubled_edges, 3u);
  mesh.triangles.push_back({box.triangles[4][1], box.triangles[4][0], box.triangles[4][2]});  // turned over
  EXPECT_EQ(check(mesh).doubled_triangles, 2u);
  EXPECT_TRUE(check(mesh).closed());
  EXPECT_EQ(check(mesh).doubled_edges, 0u);
  mesh.triangles.erase(mesh.triangles.begin());  // a hole besides
  EXPECT_EQ(check(mesh).open_edges, 3u);
  EXPECT_EQ(check(mesh).doubled_edges, 0u);
}

TEST(MeshCheck, ZerosOfBothSignsAreOnePosition) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  TriangleMesh split;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (corner == 0) split.triangles.emplace_back();
      split.triangles.back()[corner] = static_cast<std::uint32_t>(split.vertices.size());
      Eigen::Vector3d v = mesh.vertices[mesh.triangles[i][corner]];
      for (int axis = 0; axis < 3; ++axis)
        if (v[axis] == 0 && i % 2) v[axis] = -0.0;
      split.vertices.push_back(v);
    }
  EXPECT_TRUE(check(split).closed());
  for (auto& v : split.vertices)
    if (v.x() == 0) {
      v.x() = 1e-300;  // the smallest crack is a crack
      break;
    }
  EXPECT_FALSE(check(split).closed());
}

TEST(MeshCheck, DegenerateTriangles) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  mesh.triangles.push_back({0, 0, 1});
  mesh.vertices.emplace_back(0, 0, 0);  // a second name of vertex 0
  mesh.triangles.push_back({0, 8, 1});
  EXPECT_EQ(check(mesh).degenerate_triangles, 2u);
  EXPECT_TRUE(check(mesh).closed());
  EXPECT_EQ(check(mesh).non_manifold_edges, 0u);

  // Exactly on a line or not by one unit in the last place: 0.1, 0.2, 0.3 in doubles are not.
  const auto degenerate = [](Eigen::Vector3d a, Eigen::Vector3d b, Eigen::Vector3d c) {
    TriangleMesh t;
    t.vertices = {a, b, c};
    t.triangles = {{0, 1, 2}};
    return check(t).degenerate_triangles == 1;
  };
  EXPECT_TRUE(degenerate({0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {0.3, 0.3, 0.3}));
  EXPECT_TRUE(degenerate({0.1, 0.3, 0.7}, {0.2, 0.6, 1.4}, {0.4, 1.2, 2.8}));
  EXPECT_FALSE(degenerate({0.1, 0.3, 0.7}, {0.2, 0.6, 1.4}, {0.4, 1.2, std::nextafter(2.8, 3)}));
  EXPECT_FALSE(degenerate({1e16, 1, 0}, {1e16, 2, 0}, {1e16 + 2, 3, 0}));
  EXPECT_TRUE(degenerate({1e16, 1, 0}, {1e16 + 2, 2, 0}, {1e16 + 4, 3, 0}));
}

TEST(MeshPlacement, ByFraction) {
  const TriangleMesh mesh = box_mesh({10, 20, 30}, {14, 21, 32});
  const MeshPlacement placement = place_by_fraction(mesh, 4, 0.5);
  EXPECT_EQ(placement.depth, 4);
  EXPECT_EQ(placement.frame.axes, Eigen::Matrix3d::Identity() * 0.5);
  EXPECT_EQ(placement.frame.origin, Eigen::Vector3d(8, 16.5, 27));
  EXPECT_EQ(placement.frame.unit, "unit");
  // A mesh that fills its universe, whatever the rounding.
  for (const double scale : {1.0, 0.1, 1.0 / 3, 1e6 / 7})
    for (const double shift : {0.0, 0.1, 1234.567}) {
      TriangleMesh full = box_mesh({0, 0, 0}, {1, 1, 1});
      for (auto& v : full.vertices) v = v * scale + Eigen::Vector3d::Constant(shift * scale);
      EXPECT_TRUE(octree_from_mesh(full, place_by_fraction(full, 5, 1)).root().is_black()) << scale << " " << shift;
    }
}

TEST(MeshPlacement, ByVoxelSize) {
  const TriangleMesh mesh = box_mesh({10, 20, 30}, {16.4, 21, 32});
  EXPECT_EQ(place_by_voxel_size(mesh, 0.1).depth, 6);
  EXPECT_EQ(place_by_voxel_size(mesh, 0.099).depth, 7);
  EXPECT_EQ(place_by_voxel_size(mesh, 100).depth, 1);
  const MeshPlacement placement = place_by_voxel_size(mesh, 0.1, 8);
  EXPECT_EQ(placement.depth, 8);
  EXPECT_EQ(placement.frame.axes, Eigen::Matrix3d::Identity() * 0.1);
  EXPECT_LT((placement.frame.to_world(Eigen::Vector3d::Constant(128)) - mesh.bounding_box().center()).norm(), 1e-12);
  EXPECT_EQ(volume(octree_from_mesh(mesh, placement)), 64u * 10 * 20);
}

TEST(MeshPlacement, StrayVerticesDoNotCount) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  mesh.vertices.emplace_back(1e9, 1e9, std::nan(""));
  EXPECT_EQ(mesh.bounding_box().sizes(), Eigen::Vector3d(1, 1, 1));
  EXPECT_TRUE(octree_from_mesh(mesh, place_by_fraction(mesh, 3, 1)).root().is_black());
}

TEST(MeshPlacement, Errors) {
  const TriangleMesh mesh = box_mesh({0, 0, 0}, {4, 1, 1});
  const auto argument = [](const auto& call) { return error_of(ErrorCode::bad_argument, call); };
  EXPECT_EQ(argument([&] { place_by_fraction(mesh, 0, 0.5); }), "depth 0 is out of range; use 1 to 20");
  EXPECT_EQ(argument([&] { place_by_fraction(mesh, 8, 0); }), "fraction 0 is out of range; use more than 0, at most 1");
  EXPECT_EQ(argument([&] { place_by_fraction(mesh, 8, 1.5); }),
            "fraction 1.5 is out of range; use more than 0, at most 1");
  EXPECT_EQ(argument([&] { place_by_fraction(mesh, 8, std::nan("")); }),
            "fraction nan is out of range; use more than 0, at most 1");
  EXPECT_EQ(argument([&] { place_by_fraction(mesh, 1, 1e-310); }),
            "fraction 1e-310 makes voxels too large for floating point; use a larger fraction");
  EXPECT_EQ(argument([&] { place_by_voxel_size(mesh, -1); }),
            "voxel size -1 is out of range; use a finite size above 0");
  EXPECT_EQ(argument([&] { place_by_voxel_size(mesh, 1, 21); }),
            "depth 21 is out of range; use 1 to 20, or 0 for the smallest that holds the mesh");
  EXPECT_EQ(
      error_of(ErrorCode::out_of_universe, [&] { place_by_voxel_size(mesh, 0.25, 3); }),
      "the mesh is 16 voxels long but a universe of depth 3 has 8; use voxels of side 0.5 or more, or a greater depth");
  EXPECT_EQ(
      error_of(ErrorCode::out_of_universe, [&] { place_by_voxel_size(mesh, 1e-9); }),
      "the mesh is 4e+09 voxels long but a universe of depth 20 has 1048576; use voxels of side 3.815e-06 or more");
  TriangleMesh point = mesh;
  for (auto& v : point.vertices) v = {1, 2, 3};
  EXPECT_EQ(error_of(ErrorCode::bad_input, [&] { place_by_fraction(point, 8, 0.5); }),
            "the mesh has no extent; its vertices must not all lie at one point");
  TriangleMesh huge = mesh;
  huge.vertices[1].x() = 1.7e308;
  huge.vertices[0].x() = -1.7e308;
  EXPECT_EQ(error_of(ErrorCode::bad_input, [&] { place_by_fraction(huge, 8, 0.5); }),
            "the mesh is too large for floating point; scale it down");
}

}  // namespace
}  // namespace blackleaf
