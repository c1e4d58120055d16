// Closed meshes for tests, in universe coordinates.
#pragma once

#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "blackleaf/error.h"
#include "blackleaf/mesh.h"
#include "reference/dense_grid.h"

namespace blackleaf::testing {

inline void append(TriangleMesh& mesh, const TriangleMesh& part, bool reversed = false) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (auto t : part.triangles) {
    if (reversed) std::swap(t[1], t[2]);
    mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
}

inline TriangleMesh reversed(const TriangleMesh& mesh) {
  TriangleMesh result;
  append(result, mesh, true);
  return result;
}

inline TriangleMesh box_mesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
  constexpr std::uint32_t kSquares[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                            {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& s : kSquares) {
    mesh.triangles.push_back({s[0], s[1], s[2]});
    mesh.triangles.push_back({s[0], s[2], s[3]});
  }
  return mesh;
}

/// Outward if the vertices are positively oriented.
inline TriangleMesh tetrahedron(const std::array<Eigen::Vector3d, 4>& p) {
  TriangleMesh mesh;
  mesh.vertices.assign(p.begin(), p.end());
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

/// An octahedron divided `times` times and blown up to a ball.
inline TriangleMesh sphere(const Eigen::Vector3d& centre, double radius, int times) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double s : {-1.0, 1.0}) mesh.vertices.push_back(s * Eigen::Vector3d::Unit(axis));
  for (std::uint32_t octant = 0; octant < 8; ++octant) {
    std::array<std::uint32_t, 3> t = {octant & 1, 2 + (octant >> 1 & 1), 4 + (octant >> 2)};
    if (((octant & 1) + (octant >> 1 & 1) + (octant >> 2)) % 2 == 0) std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  }
  for (; times > 0; --times) {  // every triangle brings its own midpoints: welding has something to do
    TriangleMesh finer;
    for (const auto& t : mesh.triangles) {
      std::array<Eigen::Vector3d, 6> p;
      for (std::size_t i = 0; i < 3; ++i) {
        p[i] = mesh.vertices[t[i]];
        p[3 + i] = (mesh.vertices[t[i]] + mesh.vertices[t[(i + 1) % 3]]).normalized();
      }
      const auto base = static_cast<std::uint32_t>(finer.vertices.size());
      finer.vertices.insert(finer.vertices.end(), p.begin(), p.end());
      for (const auto& s : {std::array<std::uint32_t, 3>{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}})
        finer.triangles.push_back({base + s[0], base + s[1], base + s[2]});
    }
    mesh = finer;
  }
  for (auto& v : mesh.vertices) v = centre + radius * v;
  return mesh;
}

/// Coordinates rounded to multiples of 1/steps.
inline TriangleMesh snapped(TriangleMesh mesh, double steps) {
  for (auto& v : mesh.vertices) v = (v * steps).array().round() / steps;
  return mesh;
}

inline TriangleMesh moved(TriangleMesh mesh, const Eigen::Matrix3d& matrix, const Eigen::Vector3d& by) {
  for (auto& v : mesh.vertices) v = matrix * v + by;
  return mesh;
}

inline MeshPlacement universe(int depth) { return {depth, {}}; }

/// A random closed mesh in the universe of the given depth (3 or 4): boxes, tetrahedra, balls, rotated voxel solids,
/// cavities; often with vertices, edges and faces exactly on voxel centres. Some pass through themselves.
inline TriangleMesh random_mesh(int depth, std::mt19937& random) {
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  const double side = 1 << depth;
  const double steps = std::array{1.0, 2.0, 2.0, 4.0, 64.0}[static_cast<std::size_t>(pick(0, 4))];
  const auto coordinate = [&] { return pick(0, static_cast<int>(side * steps)) / steps; };
  const auto point = [&] { return Eigen::Vector3d(coordinate(), coordinate(), coordinate()); };
  const auto box = [&] {
    const Eigen::Vector3d a = point(), b = point();
    const Eigen::Vector3d low = a.cwiseMin(b), high = (low.array() + 1 / steps).max(a.cwiseMax(b).array());
    return box_mesh(low.cwiseMin(side - 1 / steps), high.cwiseMin(side));
  };
  TriangleMesh mesh;
  switch (pick(0, 5)) {
    case 0:
      mesh = box();
      break;
    case 1:
      do {
        const std::array<Eigen::Vector3d, 4> p = {point(), point(), point(), point()};
        mesh = tetrahedron(p);
        const double volume = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
        if (std::abs(volume) >= 1) break;
      } while (true);
      break;
    case 2:
      mesh = snapped(sphere(Eigen::Vector3d::Constant(side / 2), side * pick(4, 8) / 16, pick(1, 2)), steps);
      break;
    case 3: {  // two boxes side by side, or one in the other
      mesh = box();
      const Eigen::AlignedBox3d outer = mesh.bounding_box();
      if (pick(0, 1) && outer.sizes().minCoeff() > 2 / steps) {
        append(mesh, box_mesh(outer.min().array() + 1 / steps, outer.max().array() - 1 / steps), true);
      } else if (outer.max().x() < side) {
        append(mesh, box_mesh({outer.max().x(), outer.min().y(), outer.min().z()}, {side, outer.max().y(), side}));
      }
      break;
    }
    default: {  // voxel solids, turned by (2,3,6)/7 or not at all
      reference::DenseGrid grid(2);
      do grid = reference::random_solid(2, random);
      while (reference::octree(grid).is_empty());
      mesh = boundary_mesh(reference::octree(grid));
      Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
      if (pick(0, 2)) turn << 2, 3, 6, 3, -6, 2, 6, 2, -3;
      if (pick(0, 1)) turn.row(pick(0, 2)) *= -1;
      const double scale = side / 4 * pick(1, 4) / 8 / (turn(0, 0) == 1 || turn(0, 0) == -1 ? 1.0 : 7.0);
      mesh = moved(mesh, turn * scale, Eigen::Vector3d::Zero());
      const Eigen::AlignedBox3d all = mesh.bounding_box();
      mesh = moved(mesh, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Constant(side / 2) - all.center());
    }
  }
  return pick(0, 3) ? mesh : reversed(mesh);
}

inline TriangleMesh read_stl(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  TriangleMesh mesh;
  for (std::size_t at = 84; at + 50 <= bytes.size(); at += 50)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      std::array<float, 3> p{};
      std::memcpy(p.data(), bytes.data() + at + 12 * (corner + 1), sizeof p);
      if (corner == 0) mesh.triangles.emplace_back();
      mesh.triangles.back()[corner] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.emplace_back(p[0], p[1], p[2]);
    }
  return mesh;
}

/// The message of the Error that a call throws, "" if none; its code must be as expected.
template <class Call>
std::string error_of(ErrorCode code, const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  return "";
}

}  // namespace blackleaf::testing
