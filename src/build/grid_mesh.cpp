#include "grid_mesh.h"

#include <cmath>
#include <cstdio>
#include <string>

#include "blackleaf/error.h"
#include "to_universe.h"

namespace blackleaf::detail {
namespace {

std::string text(const Eigen::Vector3d& p) {
  std::array<char, 96> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "(%.6g, %.6g, %.6g)", p.x(), p.y(), p.z());
  return buffer.data();
}

}  // namespace

GridMesh grid_mesh(const TriangleMesh& mesh, const MeshPlacement& placement) {
  if (placement.depth < 1 || placement.depth > kMaxDepth)
    throw Error(ErrorCode::bad_argument, "depth " + std::to_string(placement.depth) + " is out of range",
                "use 1 to 20");
  require_sound(mesh);
  GridMesh grid;
  grid.depth = placement.depth;
  const double side = std::ldexp(1.0, grid.depth);
  const ToUniverse to_universe(placement.frame);

  std::vector<std::uint8_t> used(mesh.vertices.size(), 0);
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) used[corner] = 1;
  grid.vertices.resize(mesh.vertices.size());
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!used[i]) continue;
    const Eigen::Vector3d p = to_universe(mesh.vertices[i]);
    box.extend(p);
    for (int axis = 0; axis < 3; ++axis)
      grid.vertices[i][static_cast<std::size_t>(axis)] =
          std::llround(std::ldexp(std::fmin(std::fmax(p[axis], 0.0), side), grid.fraction_bits()));
  }
  if (!(box.min().minCoeff() >= -kWallTolerance) || !(box.max().maxCoeff() <= side + kWallTolerance))
    throw Error(ErrorCode::out_of_universe,
                "the mesh reaches from " + text(box.min()) + " to " + text(box.max()) +
                    " voxels, but the universe only from 0 to " + std::to_string(std::int64_t{1} << grid.depth),
                "place it inside, or use a universe that holds it");

  std::vector<std::array<std::uint64_t, 3>> keys(grid.vertices.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) keys[i][axis] = static_cast<std::uint64_t>(grid.vertices[i][axis]);
  const std::vector<std::uint32_t> first = first_equal(keys);
  grid.triangles.reserve(mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    const Triangle t = {first[triangle[0]], first[triangle[1]], first[triangle[2]]};
    if (!collapsed(t)) grid.triangles.push_back(t);
  }
  return grid;
}

MeshReport GridMesh::report(bool components) const {
  MeshReport result = report_of(triangles, vertices.size(), components);
  result.triangles = triangles.size();
  return result;
}

void require_closed(const MeshReport& report, bool oriented) {
  if (report.open_edges > 0 && report.doubled_edges == report.open_edges)
    throw Error(ErrorCode::bad_input,
                "the mesh has " + std::to_string(report.doubled_triangles) +
                    (report.doubled_triangles == 1 ? " triangle" : " triangles") + " that it has before",
                "remove the doubles");
  if (report.open_edges > 0)
    throw Error(ErrorCode::bad_input,
                "the mesh is not closed: it has " + std::to_string(report.open_edges) +
                    (report.open_edges == 1 ? " open edge" : " open edges"),
                "close its holes first");
  if (oriented && report.misoriented_edges > 0)
    throw Error(ErrorCode::bad_input,
                "the mesh is oriented inconsistently: " + std::to_string(report.misoriented_edges) +
                    (report.misoriented_edges == 1 ? " edge is" : " edges are") +
                    " passed unequally often in both directions",
                "turn its triangles so that all face outward");
}

}  // namespace blackleaf::detail
