// Inputs made to be misread: what blackleaf build must refuse in one line, and what it must warn of in one.
#include <cstdint>
#include <cstring>
#include <limits>

#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

using nlohmann::json;

class HostileInput : public CliTest {
 protected:
  void refused_build(const std::string& input, const std::string& part, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"build", input, "-o", "o.octree"});
    refused(more, part);
  }
  // A build that succeeds with one line on standard error.
  json warned(const std::string& input, const std::string& part, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"build", input, "-o", "o.octree", "--json"});
    SCOPED_TRACE(testing::PrintToString(more));
    const Result result = run(more);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(lines(result.err), 1u) << result.err;
    EXPECT_NE(result.err.find("blackleaf: warning: " + part), std::string::npos) << result.err;
    return result.code == 0 ? result.json() : json();
  }
  json frame(const std::string& input) const {
    done({"build", input, "-o", "o.octree"});
    return done({"info", "o.octree", "--json"}).json()["frame"];
  }

  template <class T>
  void make_raw(const std::string& name, const std::string& type, const std::string& size, const std::vector<T>& values,
                const std::string& more = {}) const {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    write(name, "NRRD0004\ntype: " + type + "\ndimension: 3\nsizes: " + size + "\nendian: little\nencoding: raw\n" +
                    more + "\n" + bytes);
  }
};

// Neighbours beyond 2^53 are one double: a bound that is not kept as it was typed is refused.
TEST_F(HostileInput, BoundsBeyondDoubles) {
  constexpr std::int64_t kBig = std::int64_t{1} << 53;
  make_raw<std::int64_t>("v.nrrd", "int64", "2 2 1", {kBig - 1, kBig, kBig + 1, kBig + 2});
  const auto count = [&](const std::string& range) {
    return done({"build", "v.nrrd", "-o", "v.octree", "--range", range, "--json"}).json()["volume"].get<int>();
  };
  EXPECT_EQ(count("9007199254740992:"), 3);
  EXPECT_EQ(count("9007199254740994:"), 1);
  EXPECT_EQ(count("9.007199254740994e15:"), 1);
  EXPECT_EQ(count("9007199254740994.000:"), 1);
  EXPECT_EQ(count("+90071992547409940e-1:"), 1);
  EXPECT_EQ(count("9007199254740991:9007199254740992"), 2);
  EXPECT_EQ(count("1:1e18"), 4);
  EXPECT_EQ(count("1:1e300"), 4);
  const std::string kept = "the nearest that is: 9007199254740992";
  for (const char* bound : {"9007199254740993", "9007199254740992.5", "9.007199254740993e15", "90071992547409930E-1",
                            "0.9007199254740993e+16"}) {
    refused_build("v.nrrd", kept, {"--range", std::string(bound) + ":"});
    refused_build("v.nrrd", "--range has " + std::string(bound), {"--range", "0:" + std::string(bound)});
    refused_build("v.nrrd", kept, {"--bands", "1," + std::string(bound)});
  }
  refused_build("v.nrrd", "the nearest that is: -9007199254740992", {"--range=-9007199254740993:"});
}

TEST_F(HostileInput, AnEmptySeriesIsNone) {
  make_nrrd("v.nrrd", {2, 2, 2}, std::vector<int>(8, 1));
  refused_build("v.nrrd", "--series is empty", {"--series", ""});
}

// Warnings wait until the command is done: an error stands alone.
TEST_F(HostileInput, ErrorsStandAlone) {
  std::filesystem::create_directory(folder() / "stack");
  make_nrrd("v.nrrd", {2, 2, 2}, std::vector<int>(8, 1));
  done({"build", "v.nrrd", "-o", "v.octree"});
  write("stack/readme.txt", "not a slice");
  write("cup.json", R"({"views": ["a.png"]})");
  done({"draw", "v.octree", "--view", "0,0,1", "-o", "stack/a.png"});
  const Result result = run({"build", "stack", "-o", "o.octree", "--range", "5:1"});
  EXPECT_EQ(lines(result.err), 1u) << result.err;
  refused_build("stack", "stack");  // a picture in colour, beside a file that is passed over
}

TEST_F(HostileInput, SomeValuesAreNaN) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  make_raw<float>("v.nrrd", "float", "2 2 2", {1, nan, 1, 1, 1, nan, 1, 1});
  EXPECT_EQ(warned("v.nrrd", "v.nrrd: 2 of 8 values are NaN and taken as outside")["volume"], 6);
  EXPECT_EQ(warned("v.nrrd", "v.nrrd: 2 of 8 values are NaN and taken as label 0", {"--bands", "0.5"})["volume"], 6);
  make_raw<double>("v.nrrd", "double", "2 2 1", {1, 1, 1, nan});
  EXPECT_EQ(warned("v.nrrd", "v.nrrd: 1 of 4 values is NaN and taken as outside",
                   {"--range",
                    ":"
                    "9"})["volume"],
            3);
}

TEST_F(HostileInput, UnitsOfLength) {
  const std::vector<std::uint8_t> ones(8, 1);
  const std::string space = "space: left-posterior-superior\nspace directions: (2,0,0) (0,2,0) (0,0,2)\n";
  const auto expect = [&](const std::string& name, double side, double origin) {
    SCOPED_TRACE(name);
    const json found = frame(name);
    EXPECT_EQ(found["unit"], "mm");
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_DOUBLE_EQ(found["axes"][i][i].get<double>(), side);
      EXPECT_NEAR(found["origin"][i].get<double>(), origin, 1e-9);
    }
  };
  const std::string origin = "space origin: (11,11,11)\n";
  make_raw("mm.nrrd", "uint8", "2 2 2", ones, space + origin + "space units: \"mm\" \"mm\" \"mm\"\n");
  expect("mm.nrrd", 2, 10);
  make_raw("um.nrrd", "uint8", "2 2 2", ones, space + origin + "space units: \"um\" \"um\" \"um\"\n");
  expect("um.nrrd", 0.002, 0.010);
  make_raw("m.nrrd", "uint8", "2 2 2", ones, space + origin + "space units: \"m\" \"m\" \"m\"\n");
  expect("m.nrrd", 2000, 10000);
  make_raw("axes.nrrd", "uint8", "2 2 2", ones, "spacings: 2 2 2\nunits: \"cm\" \"cm\" \"cm\"\n");
  expect("axes.nrrd", 20, -10);
  const std::string meta =
      "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementSpacing = 2 2 2\nOffset = 11 11 11\n";
  const std::string rest = "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n" + std::string(8, '\1');
  write("a.mha", meta + "DistanceUnits = um\n" + rest);
  expect("a.mha", 0.002, 0.010);
  write("a.mha", meta + rest);
  expect("a.mha", 2, 10);
  // What is written is in millimetres, so nothing changes on the way out and in.
  done({"export", "o.octree", "-o", "b.nrrd"});
  expect("b.nrrd", 2, 10);
  make_raw("px.nrrd", "uint8", "2 2 2", ones, space + "space units: \"px\" \"px\" \"px\"\n");
  warned("px.nrrd", "px.nrrd: its unit of length 'px' is unknown and taken as mm");
  make_raw("none.nrrd", "uint8", "2 2 2", ones, space + origin + "space units: \"\" \"\" \"\"\n");
  expect("none.nrrd", 2, 10);
}

TEST_F(HostileInput, MoreDataThanToldOf) {
  const std::string nrrd = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: ";
  write("a.nrrd", nrrd + "ascii\n\n1 1 1 1 1 1 1 1 \n\t\n");
  done({"build", "a.nrrd", "-o", "a.octree"});
  write("b.nrrd", nrrd + "ascii\n\n1 1 1 1 1 1 1 1 9\n");
  refused_build("b.nrrd", "b.nrrd: its header tells of 8 voxels, but there are more numbers: '9'");
  write("h.nrrd", nrrd + "hex\n\n01010101\n01010101 \n");
  done({"build", "h.nrrd", "-o", "h.octree"});
  write("i.nrrd", nrrd + "hex\n\n01010101\n0101010101\n");
  refused_build("i.nrrd", "i.nrrd: its header tells of values of 16 hexadecimal digits, but there are more");
  write("j.nrrd", nrrd + "hex\n\n010101010101010g1\n");
  refused_build("j.nrrd", "j.nrrd: its values have 'g' after 15 hexadecimal digits");
  write("k.mha",
        "ObjectType = Image\nNDims = 3\nBinaryData = False\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
        "ElementDataFile = LOCAL\n1 1 1 1 1 1 1 1 7");
  refused_build("k.mha", "there are more numbers: '7'");

  const std::string off = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  write("a.off", off + "\n# the end\n");
  done({"build", "a.off", "-o", "a.octree"});
  write("b.off", off + "3 0 1 2\n");
  refused_build("b.off", "b.off: has more data behind the last face that its header tells of: '3 0 1 2'");
  write("c.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 -1 2\n");
  refused_build("c.off", "c.off: face 0 refers to vertex -1, below 0");

  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 "
      "0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  write("a.ply", ply + " \n");
  done({"build", "a.ply", "-o", "a.octree"});
  write("b.ply", ply + "3 0 1 2\n");
  refused_build("b.ply", "b.ply: has more data behind the last element that its header tells of: '3 0 1 2'");
  refused_build("b.ply", "b.ply: has more data behind", {"--points"});
  write("p.ply",
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
        "z\nend_header\n0 0 0\n1 0 0\n2 0 0\n");
  refused_build("p.ply", "p.ply: has more data behind the last element that its header tells of: '2 0 0'");

  const auto pcd = [](std::size_t bytes) {
    return "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE U U U\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA binary\n" +
           std::string(12, '\1') + std::string(bytes - 12, '\2');
  };
  write("a.pcd", pcd(24 + 11));
  done({"build", "a.pcd", "-o", "a.octree"});
  write("b.pcd", pcd(36));
  refused_build("b.pcd", "b.pcd: its header tells of 2 points but there are 12 bytes behind them");
}

TEST_F(HostileInput, SilhouetteLists) {
  write("a.json", R"({"depth": 3, "views": ["a.png"], "depth": 4})");
  refused_build("a.json", R"(a.json: has "depth" twice in one object)");
  write("a.json", R"({"views": [{"image": "a.png"}, {"image": "a.png", "view": "top", "image": "b.png"}]})");
  refused_build("a.json", R"(a.json: has "image" twice in one object)");
  write("a.json", R"({"views": [{"image": "a.png", "pixel_size": 1e300}]})");
  refused_build("a.json", "pixel_size is 1e+300; give the side of a pixel in voxels, from 2^-30 to 2^30");
}

TEST_F(HostileInput, ClipMeansNothingWithoutLike) {
  write("a.xyz", "0 0 0\n1 1 1\n");
  refused_build("a.xyz", "--clip is given without --like", {"--clip"});
}

TEST_F(HostileInput, VoxelsFarTooSmall) {
  make_stl("s.stl", {0, 0, 0}, {3, 1, 1});
  for (const char* size : {"1e-9", "1e-300", "2.86e-6"})
    refused_build("s.stl", "a universe of depth 20 has 1048576; use voxels of side 2.862e-06 or more",
                  {"--voxel-size", size});
  refused_build("s.stl", "use voxels of side 0.1875 or more, or a greater depth",
                {"--voxel-size", "0.1", "--depth", "4"});
  done({"build", "s.stl", "-o", "o.octree", "--voxel-size", "0.1875", "--depth", "4"});
  // The universe is deep enough, and no machine holds such a surface.
  refused_build("s.stl", "its surface is 1.7e+12 voxels large, which takes more than", {"--voxel-size", "2.862e-6"});
  write("a.xyz", "0 0 0\n3 1 1\n");
  for (const char* size : {"1e-9", "1e-300", "2.86e-6"})
    refused_build("a.xyz", "use voxels of side 2.862e-06 or more", {"--voxel-size", size});
  refused_build("a.xyz", "use voxels of side 0.2143 or more or a greater depth",
                {"--voxel-size", "0.1", "--depth", "4"});
  done({"build", "a.xyz", "-o", "o.octree", "--voxel-size", "0.2143", "--depth", "4"});
  done({"build", "a.xyz", "-o", "o.octree", "--voxel-size", "2.862e-6"});
}

class HostileMeshes : public HostileInput {
 protected:
  static std::string off(const std::string& vertices, const std::vector<std::string>& faces) {
    std::string text =
        "OFF\n" + std::to_string(lines(vertices)) + " " + std::to_string(faces.size()) + " 0\n" + vertices;
    for (const std::string& face : faces) text += "3 " + face + "\n";
    return text;
  }
  static constexpr const char* kCorners = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
};

TEST_F(HostileMeshes, DoubledTriangles) {
  write("m.off", off(kCorners, {"0 2 1", "0 1 3", "1 2 3", "2 0 3", "1 2 3"}));
  warned("m.off", "m.off: 1 doubled triangle, 3 non-manifold edges, 1 component; ");
  refused_build("m.off", "m.off: the mesh has 1 triangle that it has before; remove the doubles",
                {"--inside", "parity"});
  write("m.off", off(kCorners, {"0 2 1", "0 1 3", "1 2 3", "1 2 3"}));
  warned("m.off", "m.off: 1 doubled triangle, 3 open edges");
  write("m.off", off(kCorners, {"0 2 1", "0 1 3", "1 2 3", "2 0 3", "0 2 1", "0 1 3", "1 2 3", "2 0 3"}));
  warned("m.off", "m.off: 4 doubled triangles, surfaces that overlap");
}

TEST_F(HostileMeshes, EmptyOctreesOfSolids) {
  const std::string two = std::string(kCorners) + "1000 0 0\n1001 0 0\n1000 1 0\n1000 0 1\n";
  const std::vector<std::string> faces = {"0 2 1", "0 1 3", "1 2 3", "2 0 3", "4 6 5", "4 5 7", "5 6 7", "6 4 7"};
  write("m.off", off(two, faces));
  refused_build("m.off", "m.off: no voxel's centre is inside any of its 2 parts: the mesh is 192 x 0.1918 x 0.1918");
  const std::string far = std::string(kCorners) + "1000 500 700\n1001 500 700\n1000 501 700\n1000 500 701\n";
  write("m.off", off(far, faces));
  refused_build("m.off", "and its parts are thinner than one or far apart; use smaller voxels");
  write("m.off", off("0 0 0\n1 1 1\n0 0 0.0001\n1 1 0.9999\n", {"0 2 1", "0 1 3", "1 2 3", "2 0 3"}));
  refused_build("m.off", "no voxel's centre is inside it: the mesh is 192 x 192 x 192 voxels, but thinner than one");
}

TEST_F(HostileMeshes, NothingButTrianglesWithoutArea) {
  write("m.off", off("0 0 0\n1 1 1\n2 2 2\n", {"0 1 2", "2 1 0"}));
  refused_build("m.off", "m.off: none of its 2 triangles has an area");
  refused_build("m.off", "m.off: none of its 2 triangles has an area", {"--rule", "touched"});
  write("m.off", off("0 0 0\n1 1 1\n2 2 2\n", {"0 1 1"}));
  refused_build("m.off", "m.off: its one triangle has no area");
  refused_build("m.off", "m.off: its one triangle has no area", {"--rule", "touched"});
  write("m.stl", std::string(84, '\0'));
  refused_build("m.stl", "m.stl: has no triangles; give a surface");
}

}  // namespace
}  // namespace blackleaf::test
