// OFF: all that its writers write is read, whole and in double precision; what contradicts itself is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <fmt/format.h>

#include "blackleaf/implicit.h"
#include "blackleaf/mesh_file.h"
#include "file/temporary_folder.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using test::expect_error;

const std::string kTetrahedron = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class OffFile : public testing::Test {
 protected:
  TriangleMesh read(std::string_view contents) {
    test::write_file(folder_ / "a.off", contents);
    return read_mesh(folder_ / "a.off");
  }
  void refuse(std::string_view contents, std::vector<std::string> pieces) {
    SCOPED_TRACE(contents.substr(0, 200));
    pieces.push_back("a.off: ");
    expect_error(ErrorCode::bad_input, pieces, [&] { read(contents); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(OffFile, HeadersOfAllKinds) {
  const TriangleMesh wanted = read(kTetrahedron);
  EXPECT_EQ(wanted.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}));
  EXPECT_EQ(wanted.vertices, (std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  for (const char* header :
       {"OFF 4 4 6\n", "OFF # by hand\n4 4 6\n", "OFF\n4 4\n", "OFF\n4\n4\n6\n", "OFF\r\n4 4 0\r\n", "COFF\n4 4 6\n",
        "NOFF\n4 4 6\n", "STCNOFF 4 4\n6\n", "4 4 6\n", "\n# a\n\nOFF\n#\n 4 4 6 \n"}) {
    SCOPED_TRACE(header);
    const TriangleMesh mesh = read(replaced(kTetrahedron, "OFF\n4 4 6\n", header));
    EXPECT_EQ(mesh.vertices, wanted.vertices);
    EXPECT_EQ(mesh.triangles, wanted.triangles);
  }
}

TEST_F(OffFile, CommentsColoursAndBlankLinesAnywhere) {
  const TriangleMesh wanted = read(kTetrahedron);
  std::string text = kTetrahedron;
  for (std::size_t at = 10; (at = text.find('\n', at)) != std::string::npos;) {
    const std::string more = at % 3 == 0 ? " 255 0 0 # red\n" : at % 3 == 1 ? "\n   \n# a comment\n" : "  \r\n\t\n";
    text.replace(at, 1, more);
    at += more.size();
  }
  const TriangleMesh mesh = read(text);
  EXPECT_EQ(mesh.vertices, wanted.vertices);
  EXPECT_EQ(mesh.triangles, wanted.triangles);
}

TEST_F(OffFile, DoublesBitForBit) {
  std::mt19937_64 random(61);
  std::string text = "OFF\n999 333 0\n";
  std::vector<Eigen::Vector3d> wanted;
  for (int i = 0; i < 999; ++i) {
    const auto number = [&] {
      return std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())),
                        static_cast<int>(random() % 120) - 90);
    };
    const Eigen::Vector3d v(number(), number(), number());
    wanted.push_back(v);
    text += fmt::format("{} {} {}\n", v[0], v[1], v[2]);
  }
  for (int i = 0; i < 333; ++i) text += fmt::format("3 {} {} {}\n", 3 * i, 3 * i + 1, 3 * i + 2);
  EXPECT_EQ(read(text).vertices, wanted);
  const TriangleMesh mesh = read("OFF\n3 1 0\n+1 -2. 1e-999\n.5 1E2 0\n0 0 1\n3 0 1 2\n");
  EXPECT_EQ(mesh.vertices, (std::vector<Eigen::Vector3d>{{1, -2, 0}, {0.5, 100, 0}, {0, 0, 1}}));
  EXPECT_EQ(read("4OFF\n3 1 0\n0 0 0 1\n2 0 0 2\n0 4 0 2\n3 0 1 2\n").vertices,
            (std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}));
}

// A prism over a polygon of any number of corners is closed, whatever the number.
TEST_F(OffFile, PolygonsOfManyCorners) {
  for (const int n : {3, 4, 9, 10, 12, 100, 20'000}) {
    SCOPED_TRACE(n);
    std::string text = fmt::format("OFF\n{} {} 0\n", 2 * n, n + 2), lower_face, upper_face;
    for (int z = 0; z < 2; ++z)
      for (int i = 0; i < n; ++i)
        text += fmt::format("{} {} {}\n", std::cos(6.283 * i / n), std::sin(6.283 * i / n), z);
    for (int i = 0; i < n; ++i) {
      lower_face += fmt::format(" {}", n - 1 - i);
      upper_face += fmt::format(" {}", n + i);
      text += fmt::format("4 {} {} {} {}\n", i, (i + 1) % n, n + (i + 1) % n, n + i);
    }
    text += fmt::format("{}{}\n{}{}\n", n, lower_face, n, upper_face);
    const TriangleMesh mesh = read(text);
    EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(4 * n - 4));
    const MeshReport report = check(mesh);
    EXPECT_TRUE(report.closed());
    EXPECT_EQ(report.misoriented_edges, 0u);
  }
}

TEST_F(OffFile, Refused) {
  refuse("OFF\n999999999 999999999 0\n", {"999999999 vertices", "cut off"});
  refuse("OFF\n4\n", {"no numbers"});
  refuse("OFF\n", {"no numbers"});
  refuse("OFF\n4 -1 0\n", {"'-1' where a number should be"});
  refuse("Dear sir or madam,\n", {"does not begin with OFF"});
  refuse("OFF BINARY\n", {"binary OFF"});
  refuse("nOFF\n3\n4 4 6\n", {"nOFF"});
  refuse(replaced(kTetrahedron, "4 4 6", "5 4 6"), {"4 faces but there are 3 faces", "cut off"});
  refuse(replaced(kTetrahedron, "4 4 6", "4 7 6"), {"7 faces but there are 4 faces", "cut off"});
  refuse(replaced(kTetrahedron, "4 4 6", "12 4 6"), {"there are 8 vertices"});
  refuse(replaced(kTetrahedron, "4 4 6", "0 0 0"), {"has no triangles"});
  refuse(replaced(kTetrahedron, "3 1 2 3", "3 1 2 77"), {"face 3 refers to vertex 77", "the last is 3"});
  refuse(replaced(kTetrahedron, "3 1 2 3", "3 1 2 99999999999999999999999"), {"face 3 refers to vertex"});
  refuse(replaced(kTetrahedron, "3 1 2 3", "3 1 2 -1"), {"face 3 refers to vertex -1, below 0"});
  refuse(replaced(kTetrahedron, "3 1 2 3", "9999999999 1 2 3"), {"face 3 tells of 9999999999 vertices but names 3"});
  refuse(replaced(kTetrahedron, "3 1 2 3", "three"), {"face 3 does not begin with"});
  refuse(replaced(kTetrahedron, "1 0 0", "nan 0 0"), {"vertex 1 is not finite"});
  refuse(replaced(kTetrahedron, "1 0 0", "0 -inf 0"), {"vertex 1 is not finite"});
  refuse(replaced(kTetrahedron, "1 0 0", "0 0 1e999"), {"vertex 1 is not finite"});
  refuse(replaced(kTetrahedron, "1 0 0", "1 0"), {"vertex 1 has 2 coordinates"});
  refuse(replaced(kTetrahedron, "1 0 0", "1,0,0"), {"vertex 1 has 0 coordinates"});
  refuse("4OFF\n3 1 0\n0 0 0 0\n2 0 0 2\n0 4 0 2\n3 0 1 2\n", {"vertex 0 is not finite"});
  refuse("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n1 2\n", {"has no triangles"});
  for (std::size_t length = 1; length < kTetrahedron.size() - 1; ++length) refuse(kTetrahedron.substr(0, length), {});
}

}  // namespace
}  // namespace blackleaf
