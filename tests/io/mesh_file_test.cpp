#include "blackleaf/mesh_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <random>

#include "blackleaf/implicit.h"
#include "file/temporary_folder.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using test::expect_error;
using Corners = std::array<std::array<double, 3>, 3>;

// Triangles by the positions of their corners: what a mesh means, whatever the numbering.
std::vector<Corners> corners(const TriangleMesh& mesh) {
  std::vector<Corners> result;
  for (const auto& triangle : mesh.triangles) {
    Corners c;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i) c[k][i] = mesh.vertices[triangle[k]][static_cast<int>(i)];
    result.push_back(c);
  }
  return result;
}

TEST(MeshFile, BoundariesOfSolidsRoundTrip) {
  const test::TemporaryFolder folder;
  std::mt19937 random(31);
  for (const char* name : {"a.stl", "a.obj", "a.ply", "a.STL"})
    for (int i = 0; i < 12; ++i) {
      SCOPED_TRACE(testing::Message() << name << " " << i);
      const Octree octree = reference::octree(reference::random_solid(1 + i % 4, random));
      if (octree.is_empty()) continue;
      const TriangleMesh mesh = boundary_mesh(octree);
      write_mesh(mesh, folder / name);
      const TriangleMesh read = read_mesh(folder / name);
      EXPECT_EQ(corners(read), corners(mesh));
      EXPECT_TRUE(check(read).closed());
      std::filesystem::remove(folder / name);
      EXPECT_TRUE(folder.names().empty());
    }
}

// Positions are those of the file, bit for bit, as far as its numbers are floats.
TEST(MeshFile, PositionsAreKeptBitForBit) {
  const test::TemporaryFolder folder;
  std::mt19937 random(32);
  TriangleMesh mesh;
  for (unsigned i = 0; i < 3000; ++i) {
    const auto number = [&] {
      const auto value =
          std::ldexp(static_cast<float>(static_cast<int>(random())) / 3, -static_cast<int>(random() % 60));
      return static_cast<double>(value);
    };
    mesh.vertices.push_back({number(), number(), number()});
    if (i % 3 == 2) mesh.triangles.push_back({i - 2, i - 1, i});
  }
  for (const char* name : {"a.stl", "a.ply"}) {
    write_mesh(mesh, folder / name);
    EXPECT_EQ(corners(read_mesh(folder / name)), corners(mesh)) << name;
  }
  write_mesh(mesh, folder / "a.obj");  // the text holds the number; assimp's own reading of it may be an ulp off
  const auto read = corners(read_mesh(folder / "a.obj")), wanted = corners(mesh);
  ASSERT_EQ(read.size(), wanted.size());
  for (std::size_t t = 0; t < read.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_LE(std::abs(read[t][k][i] - wanted[t][k][i]), 1e-6 * std::abs(wanted[t][k][i]));
}

TEST(MeshFile, ObjAndPlyHoldDoubles) {
  const test::TemporaryFolder folder;
  TriangleMesh mesh;
  mesh.vertices = {{1.0 / 3, -0.1, 1e-9}, {12345678.901234567, 0, 1}, {0, 1e17, 2}};
  mesh.triangles = {{0, 1, 2}};
  write_mesh(mesh, folder / "a.obj");
  std::istringstream text(test::read_text(folder / "a.obj"));
  std::string word;
  std::getline(text, word);
  for (const auto& vertex : mesh.vertices) {
    text >> word;
    EXPECT_EQ(word, "v");
    for (int i = 0; i < 3; ++i) {
      text >> word;
      EXPECT_EQ(std::strtod(word.c_str(), nullptr), vertex[i]);
    }
  }
  write_mesh(mesh, folder / "a.ply");
  const std::string ply = test::read_text(folder / "a.ply");
  const std::size_t at = ply.find("end_header\n") + 11;
  ASSERT_EQ(ply.size(), at + 9 * 8 + 13);
  for (std::size_t i = 0; i < 9; ++i) {
    double value = 0;
    std::memcpy(&value, ply.data() + at + 8 * i, 8);
    EXPECT_EQ(value, mesh.vertices[i / 3][static_cast<int>(i % 3)]);
  }
}

TEST(MeshFile, StlAsItsDefinitionHasIt) {
  const test::TemporaryFolder folder;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 5}, {2, 0, 5}, {0, 3, 5}};
  mesh.triangles = {{0, 1, 2}};
  write_mesh(mesh, folder / "a.stl");
  const std::string stl = test::read_text(folder / "a.stl");
  ASSERT_EQ(stl.size(), 84u + 50u);
  EXPECT_FALSE(stl.starts_with("solid"));
  std::array<float, 12> numbers;
  std::memcpy(numbers.data(), stl.data() + 84, sizeof numbers);
  EXPECT_EQ(numbers, (std::array<float, 12>{0, 0, 1, 0, 0, 5, 2, 0, 5, 0, 3, 5}));
}

TEST(MeshFile, PolygonsPartsAndNodes) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "quads.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  EXPECT_EQ(read_mesh(folder / "quads.off").triangles.size(), 2u);
  test::write_file(
      folder / "parts.obj",
      "o one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no two\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf 4 5 6\no line\nl 1 4\n");
  EXPECT_EQ(read_mesh(folder / "parts.obj").triangles.size(), 2u);
  // One triangle, twice in the scene: where it is, and turned and shifted by nested nodes.
  std::string buffer;
  for (const float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f}) {
    const auto bytes = std::bit_cast<std::array<char, 4>>(v);
    buffer.append(bytes.begin(), bytes.end());
  }
  test::write_file(folder / "scene.bin", buffer);
  test::write_file(folder / "scene.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"mesh": 0}, {"translation": [10, 0, 0], "children": [2]}, {"mesh": 0, "scale": [2, 2, 2], "rotation": [0, 0, 1, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 2, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "scene.bin", "byteLength": 36}]})");
  const auto scene = corners(read_mesh(folder / "scene.gltf"));
  ASSERT_EQ(scene.size(), 2u);
  EXPECT_EQ(scene[0], (Corners{{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}}));
  const Corners moved{{{10, 0, 0}, {8, 0, 0}, {10, -4, 0}}};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(scene[1][k][i], moved[k][i], 1e-6);
}

TEST(MeshFile, TheBunny) {
  const std::filesystem::path path = std::filesystem::path(BLACKLEAF_DATA) / "bunny.stl";
  const TriangleMesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.triangles.size(), 3674u);
  const MeshReport report = check(mesh);
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(report.misoriented_edges, 0u);
}

TEST(MeshFile, WhatCannotBeRead) {
  const test::TemporaryFolder folder;
  const auto refuse = [&](const std::string& name, std::string_view contents, std::vector<std::string> pieces) {
    SCOPED_TRACE(name);
    test::write_file(folder / name, contents);
    pieces.push_back(name);
    expect_error(ErrorCode::bad_input, pieces, [&] { read_mesh(folder / name); });
  };
  for (const char* name : {"a.stl", "a.obj", "a.ply", "a.off", "a.gltf", "a.glb", "a.3mf"}) {
    refuse(name, "", {"is empty"});
    refuse(name, "Dear sir or madam,\n\nthis is a letter.\n", {});
    refuse(name, std::string(1000, '\xFF'), {});
    expect_error(ErrorCode::io, {"no such file"}, [&] { read_mesh(folder / (std::string("none") + name)); });
  }
  refuse("a.unknown", "hello", {"cannot be read as a mesh"});
  refuse("points.obj", "v 0 0 0\nv 1 0 0\np 1\nl 1 2\n", {});
  refuse(
      "nan.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n",
      {"not finite"});
  expect_error(ErrorCode::io, {"is a folder"}, [&] { read_mesh(folder.path()); });
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 5}, {2, 0, 5}, {0, 3, 5}};
  mesh.triangles = {{0, 1, 2}};
  write_mesh(mesh, folder / "whole.stl");
  const std::string whole = test::read_text(folder / "whole.stl");
  for (const unsigned length : {1u, 79u, 80u, 83u, 84u, 100u, 133u}) refuse("cut.stl", whole.substr(0, length), {});
}

TEST(MeshFile, WhatCannotBeWritten) {
  const test::TemporaryFolder folder;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 5}, {1e39, 0, 5}, {0, 3, 5}};
  mesh.triangles = {{0, 1, 2}};
  expect_error(ErrorCode::bad_argument, {"a.stl", "vertex 1", "write .ply"},
               [&] { write_mesh(mesh, folder / "a.stl"); });
  expect_error(ErrorCode::bad_argument, {"a.gltf", "use .stl, .obj or .ply"},
               [&] { write_mesh(mesh, folder / "a.gltf"); });
  mesh.vertices[1][0] = NAN;
  expect_error(ErrorCode::bad_argument, {"a.obj", "vertex 1"}, [&] { write_mesh(mesh, folder / "a.obj"); });
  mesh.triangles[0][2] = 3;
  mesh.vertices[1][0] = 1;
  expect_error(ErrorCode::bad_argument, {"a.ply", "vertex 3 of 3"}, [&] { write_mesh(mesh, folder / "a.ply"); });
  mesh.triangles[0][2] = 2;
  expect_error(ErrorCode::io, {"a.ply: cannot be written"}, [&] { write_mesh(mesh, folder / "no" / "a.ply"); });
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace blackleaf
