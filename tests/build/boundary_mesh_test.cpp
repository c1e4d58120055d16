#include <map>

#include "meshes.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
using namespace testing;

// Unit squares between black and white as (corner, axis), +1 where outward is along +axis, -1 against it.
using Squares = std::map<std::array<int, 4>, int>;

Squares squares_of(const DenseGrid& grid) {
  Squares squares;
  const int n = grid.side();
  for (int axis = 0; axis < 3; ++axis)
    for (int z = 0; z <= n; ++z)
      for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x) {
          const int before = grid.at(x - (axis == 0), y - (axis == 1), z - (axis == 2)), here = grid.at(x, y, z);
          if (before != here) squares[{x, y, z, axis}] = before - here;
        }
  return squares;
}

TEST(BoundaryMesh, SquaresOutwardAndWatertight) {
  std::mt19937 random(42);
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const DenseGrid grid = reference::random_solid(1 + i % 4, random);
    const Octree octree = reference::octree(grid);
    const TriangleMesh mesh = boundary_mesh(octree);
    Squares squares;
    ASSERT_EQ(mesh.triangles.size() % 2, 0u);
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 2) {
      Eigen::AlignedBox3d box;
      std::array<Eigen::Vector3d, 2> normals;
      for (std::size_t half = 0; half < 2; ++half) {
        const auto& c = mesh.triangles[t + half];
        for (const std::uint32_t corner : c) box.extend(mesh.vertices[corner]);
        normals[half] = (mesh.vertices[c[1]] - mesh.vertices[c[0]]).cross(mesh.vertices[c[2]] - mesh.vertices[c[0]]);
      }
      EXPECT_EQ(normals[0], normals[1]);
      EXPECT_EQ(normals[0].norm(), 1);
      int axis = 0;
      normals[0].cwiseAbs().maxCoeff(&axis);
      EXPECT_EQ(box.sizes(), Eigen::Vector3d::Ones() - Eigen::Vector3d::Unit(axis));
      const bool added = squares
                             .insert({{static_cast<int>(box.min().x()), static_cast<int>(box.min().y()),
                                       static_cast<int>(box.min().z()), axis},
                                      static_cast<int>(normals[0][axis])})
                             .second;
      EXPECT_TRUE(added);
    }
    ASSERT_EQ(squares, squares_of(grid));
    if (squares.empty()) continue;
    const MeshReport report = check(mesh);
    EXPECT_TRUE(report.closed());
    EXPECT_EQ(report.misoriented_edges, 0u);
    EXPECT_EQ(report.degenerate_triangles, 0u);
    std::map<std::array<double, 3>, int> positions;
    for (const auto& v : mesh.vertices) EXPECT_EQ(++positions[(std::array<double, 3>{v.x(), v.y(), v.z()})], 1);
  }
}

double volume_inside(const TriangleMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles) six += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  return six / 6;
}

TEST(BoundaryMesh, WorldCoordinatesAndHandedness) {
  Frame frame;
  frame.origin = {1, 2, 3};
  frame.axes = Eigen::Vector3d(2, 0.5, 4).asDiagonal();
  frame.unit = "mm";
  for (const double hand : {1.0, -1.0}) {
    Frame f = frame;
    f.axes.col(1) *= hand;
    const Octree octree = box(5, {3, 4, 5}, {20, 9, 17}, f);
    const TriangleMesh mesh = boundary_mesh(octree);
    EXPECT_EQ(mesh.unit, "mm");
    EXPECT_EQ(mesh.triangles.size(), 4u * (17 * 5 + 5 * 12 + 12 * 17));
    EXPECT_NEAR(volume_inside(mesh), 17 * 5 * 12 * 4.0, 1e-9);  // positive: outward in the world
    EXPECT_EQ(octree_from_mesh(mesh, {5, f}), octree);
  }
}

TEST(BoundaryMesh, EmptyAndFull) {
  EXPECT_TRUE(boundary_mesh(Octree(5)).triangles.empty());
  for (int depth = 1; depth <= 6; ++depth) {
    const TriangleMesh mesh = boundary_mesh(Octree(depth, Colour::black));
    EXPECT_EQ(mesh.triangles.size(), std::size_t{12} << (2 * depth));
    EXPECT_EQ(volume_inside(mesh), std::ldexp(1.0, 3 * depth));
  }
}

}  // namespace
}  // namespace blackleaf
