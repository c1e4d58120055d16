// blackleaf build from point clouds.
#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

using nlohmann::json;

class PointsCommand : public CliTest {
 protected:
  json info(const std::string& name) const { return done({"info", name, "--json"}).json(); }
};

const char* const kFour = "0 0 0\n10 5 2.5\n10 5 2.5\n3 3 0\n";

TEST_F(PointsCommand, AreFittedAsMeshesAre) {
  write("p.xyz", kFour);
  const json report = done({"build", "p.xyz", "-o", "p.octree", "--json"}).json();
  EXPECT_EQ(report["depth"], 8);
  EXPECT_EQ(report["volume"], 3);
  const json facts = info("p.octree");
  // Ten units are 192 of 256 voxels.
  EXPECT_EQ(facts["bounding_box"], json::parse("[[32,80,104],[225,177,153]]"));
  EXPECT_EQ(facts["metadata"]["options"], json::parse(R"({"fit":0.75,"depth":8,"min_points":1})"));
  done({"build", "p.xyz", "-o", "q.octree", "--depth", "4", "--fit", "1"});
  EXPECT_EQ(info("q.octree")["bounding_box"], json::parse("[[0,4,6],[16,13,11]]"));
}

TEST_F(PointsCommand, VoxelSizesShareOneLattice) {
  write("a.xyz", kFour);
  write("b.xyz", "100.1 0.1 -7.3\n");
  done({"build", "a.xyz", "-o", "a.octree", "--voxel-size", "0.5"});
  done({"build", "b.xyz", "-o", "b.octree", "--voxel-size", "0.5"});
  const json a = info("a.octree"), b = info("b.octree");
  EXPECT_EQ(a["depth"], 5);
  EXPECT_EQ(b["depth"], 1);
  EXPECT_EQ(a["frame"]["origin"], json::parse("[-2.5,-5.0,-6.5]"));
  EXPECT_EQ(b["frame"]["origin"], json::parse("[100.0,0.0,-7.5]"));
}

TEST_F(PointsCommand, FewPointsAreNoise) {
  write("p.xyz", kFour);
  done({"build", "p.xyz", "-o", "p.octree", "--voxel-size", "1", "--min-points", "2"});
  EXPECT_EQ(info("p.octree")["volume"], 1);
  const Result none = run({"build", "p.xyz", "-o", "n.octree", "--voxel-size", "1", "--min-points", "3"});
  EXPECT_EQ(none.code, 0);
  EXPECT_NE(none.err.find("no voxel is black"), std::string::npos);
}

TEST_F(PointsCommand, LikeAndClip) {
  make_box("u.octree", 3, {0, 0, 0}, {1, 1, 1});
  write("p.xyz", kFour);
  refused({"build", "p.xyz", "-o", "p.octree", "--like", "u.octree"},
          "2 of 4 points lie outside the universe, the first at (10");
  const Result clipped = run({"build", "p.xyz", "-o", "p.octree", "--like", "u.octree", "--clip"});
  EXPECT_EQ(clipped.code, 0) << clipped.err;
  EXPECT_NE(clipped.err.find("2 of 4 points lie outside the universe and were clipped"), std::string::npos);
  EXPECT_EQ(info("p.octree")["volume"], 2);
  EXPECT_EQ(info("p.octree")["frame"], info("u.octree")["frame"]);
}

TEST_F(PointsCommand, PointsThatAreNotFiniteAreDroppedWithAWarning) {
  write("p.pcd",
        "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA ascii\n"
        "1 2 3\nnan nan nan\n4 5 6\n");
  const Result result = run({"build", "p.pcd", "-o", "p.octree", "--voxel-size", "1"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.err.find("1 of 3 points have a coordinate that is not a number"), std::string::npos) << result.err;
  EXPECT_EQ(info("p.octree")["volume"], 2);
}

TEST_F(PointsCommand, PlyWithFacesIsAMeshUnlessPointsAreWanted) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string vertices = "0 0 0\n4 0 0\n0 4 0\n0 0 4\n";
  write("cloud.ply", head + "end_header\n" + vertices);
  write("solid.ply", head + "element face 4\nproperty list uchar int vertex_indices\nend_header\n" + vertices +
                         "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  done({"build", "cloud.ply", "-o", "cloud.octree", "--voxel-size", "1"});
  done({"build", "solid.ply", "-o", "solid.octree", "--voxel-size", "1"});
  done({"build", "solid.ply", "-o", "dots.octree", "--voxel-size", "1", "--points"});
  EXPECT_EQ(info("cloud.octree")["volume"], 4);
  EXPECT_EQ(info("dots.octree")["volume"], 4);
  EXPECT_GT(info("solid.octree")["volume"], 6);
  EXPECT_EQ(info("dots.octree")["metadata"]["options"]["points"], true);
  make_stl("box.stl", {0, 0, 0}, {1, 2, 3});
  done({"build", "box.stl", "-o", "corners.octree", "--voxel-size", "0.5", "--points"});
  EXPECT_EQ(info("corners.octree")["volume"], 8);
}

TEST_F(PointsCommand, BadInputIsRefused) {
  write("p.xyz", kFour);
  write("bad.xyz", "1 2 3\n4 5\n");
  write("one.xyz", "1 2 3\n");
  write("far.xyz", "1 2 3\n1e300 0 0\n");
  make_nrrd("v.nrrd", {1, 1, 1}, {1});
  make_stl("box.stl", {0, 0, 0}, {1, 2, 3});
  refused({"build", "bad.xyz", "-o", "x.octree"}, "bad.xyz: line 2");
  refused({"build", "one.xyz", "-o", "x.octree"}, "one.xyz: all points lie at one place; give the voxels' size");
  refused({"build", "far.xyz", "-o", "x.octree", "--voxel-size", "1"}, "far.xyz: the points span 2^50 voxels or more");
  refused({"build", "p.xyz", "-o", "x.octree", "--voxel-size", "1e-7"}, "p.xyz: the points span");
  refused({"build", "p.xyz", "-o", "x.octree", "--min-points", "0"}, "--min-points");
  refused({"build", "p.xyz", "-o", "x.octree", "--rule", "touched"}, "--rule does not apply to 'p.xyz'");
  refused({"build", "p.xyz", "-o", "x.octree", "--label", "1"}, "--label does not apply");
  refused({"build", "v.nrrd", "-o", "x.octree", "--points"}, "--points does not apply to 'v.nrrd'");
  refused({"build", "box.stl", "-o", "x.octree", "--min-points", "2"}, "--min-points does not apply to 'box.stl'");
  refused({"build", "box.stl", "-o", "x.octree", "--clip"}, "--clip does not apply");
}

}  // namespace
}  // namespace blackleaf::test
