// blackleaf build, with every kind of input and option.
#include "blackleaf/octree_file.h"
#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

using nlohmann::json;

class BuildCommand : public CliTest {
 protected:
  json info(const std::string& name) const { return done({"info", name, "--json"}).json(); }
};

TEST_F(BuildCommand, MeshByDefaultFillsThreeQuartersOfDepthEight) {
  make_stl("box.stl", {-1, 0, 5}, {1, 1, 6});
  const Result result = done({"build", "box.stl", "-o", "box.octree"});
  EXPECT_EQ(lines(result.out), 1u);
  EXPECT_NE(result.out.find("depth 8, 1,769,472 voxels"), std::string::npos) << result.out;
  const json facts = info("box.octree");
  EXPECT_EQ(facts["depth"], 8);
  // 192 x 96 x 96 in the middle of 256^3.
  EXPECT_EQ(facts["bounding_box"], json::parse("[[32,80,80],[224,176,176]]"));
  EXPECT_EQ(facts["volume"], 192 * 96 * 96);
  EXPECT_EQ(facts["surface_area"], 2 * (192 * 96 + 192 * 96 + 96 * 96));
  EXPECT_EQ(files(), (std::vector<std::string>{"box.octree", "box.stl"}));
}

TEST_F(BuildCommand, MeshByDepthAndFit) {
  make_stl("box.stl", {0, 0, 0}, {1, 1, 1});
  const json report = done({"build", "box.stl", "-o", "b.octree", "--depth", "4", "--fit", "0.5", "--json"}).json();
  EXPECT_EQ(report["depth"], 4);
  EXPECT_EQ(report["volume"], 8 * 8 * 8);
  EXPECT_EQ(report["output"], "b.octree");
  EXPECT_EQ(report["file_bytes"], std::filesystem::file_size(folder() / "b.octree"));
  EXPECT_EQ(info("b.octree")["bounding_box"], json::parse("[[4,4,4],[12,12,12]]"));
}

TEST_F(BuildCommand, MeshByVoxelSizeTakesTheSmallestUniverse) {
  make_stl("box.stl", {0, 0, 0}, {5, 3, 1});
  done({"build", "box.stl", "-o", "b.octree", "--voxel-size", "0.5"});
  const json facts = info("b.octree");
  EXPECT_EQ(facts["depth"], 4);
  EXPECT_EQ(facts["volume"], 10 * 6 * 2);
  EXPECT_EQ(facts["frame"]["axes"], json::parse("[[0.5,0,0],[0,0.5,0],[0,0,0.5]]"));
}

TEST_F(BuildCommand, TouchedRuleCountsEveryVoxelThatIsMet) {
  make_stl("box.stl", {0, 0, 0}, {1, 1, 1});
  // The cube is 4.8 voxels wide in the middle of 8: [1.6, 6.4].
  done({"build", "box.stl", "-o", "c.octree", "--depth", "3", "--fit", "0.6"});
  done({"build", "box.stl", "-o", "t.octree", "--depth", "3", "--fit", "0.6", "--rule", "touched"});
  EXPECT_EQ(info("c.octree")["bounding_box"], json::parse("[[2,2,2],[6,6,6]]"));
  EXPECT_EQ(info("t.octree")["bounding_box"], json::parse("[[1,1,1],[7,7,7]]"));
}

TEST_F(BuildCommand, LikePutsMeshesIntoOneUniverse) {
  make_stl("a.stl", {0, 0, 0}, {8, 8, 8});
  make_stl("b.stl", {8, 0, 0}, {9, 2, 3});
  done({"build", "a.stl", "-o", "a.octree", "--depth", "4", "--fit", "0.5"});
  done({"build", "b.stl", "-o", "b.octree", "--like", "a.octree"});
  const json a = info("a.octree"), b = info("b.octree");
  EXPECT_EQ(a["frame"], b["frame"]);
  EXPECT_EQ(a["bounding_box"], json::parse("[[4,4,4],[12,12,12]]"));
  EXPECT_EQ(b["bounding_box"], json::parse("[[12,4,4],[13,6,7]]"));
}

TEST_F(BuildCommand, VolumeByDefaultTakesValuesAboveZeroAtTheCorner) {
  std::vector<int> values(4 * 3 * 2, 0);
  values[0] = 1;                    // (0,0,0)
  values[3 + 4 * (2 + 3 * 1)] = 9;  // (3,2,1)
  make_nrrd("v.nrrd", {4, 3, 2}, values);
  done({"build", "v.nrrd", "-o", "v.octree"});
  const json facts = info("v.octree");
  EXPECT_EQ(facts["depth"], 2);
  EXPECT_EQ(facts["volume"], 2);
  EXPECT_EQ(facts["bounding_box"], json::parse("[[0,0,0],[4,3,2]]"));
  EXPECT_EQ(facts["metadata"]["source"], "v.nrrd");
  EXPECT_EQ(facts["metadata"]["command"], "build");
  EXPECT_EQ(facts["metadata"]["program"], "blackleaf");
  EXPECT_EQ(facts["metadata"]["version"], BLACKLEAF_VERSION_TEXT);
}

TEST_F(BuildCommand, VolumeByRangeAndLabel) {
  std::vector<int> values;
  for (int i = 0; i < 27; ++i) values.push_back(i);
  make_nrrd("v.nrrd", {3, 3, 3}, values);
  const auto volume = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words = {"build", "v.nrrd", "-o", "v.octree", "--json"};
    words.insert(words.end(), options.begin(), options.end());
    return done(words).json()["volume"].get<int>();
  };
  EXPECT_EQ(volume({}), 26);
  EXPECT_EQ(volume({"--range", "5:9"}), 5);
  EXPECT_EQ(volume({"--range", "20:"}), 7);
  EXPECT_EQ(volume({"--range", ":3"}), 4);
  EXPECT_EQ(volume({"--range", "-5:0"}), 1);
  EXPECT_EQ(volume({"--range=-5:0"}), 1);
  EXPECT_EQ(volume({"--label", "13"}), 1);
  EXPECT_EQ(volume({"--label", "0"}), 1);
  EXPECT_EQ(volume({"--label", "-1", "--quiet"}), 0);
}

TEST_F(BuildCommand, VolumeInADeeperUniverseCornerOrCentre) {
  make_nrrd("v.nrrd", {2, 2, 2}, std::vector<int>(8, 1));
  done({"build", "v.nrrd", "-o", "v.octree", "--depth", "4"});
  EXPECT_EQ(info("v.octree")["bounding_box"], json::parse("[[0,0,0],[2,2,2]]"));
  done({"build", "v.nrrd", "-o", "v.octree", "--depth", "4", "--centre"});
  EXPECT_EQ(info("v.octree")["depth"], 4);
  EXPECT_EQ(info("v.octree")["bounding_box"], json::parse("[[7,7,7],[9,9,9]]"));
}

TEST_F(BuildCommand, VolumeGeometryBecomesTheFrame) {
  const std::string geometry =
      "space: left-posterior-superior\nspace directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (10,20,30)\n";
  make_nrrd("v.nrrd", {2, 2, 2}, std::vector<int>(8, 1), geometry);
  done({"build", "v.nrrd", "-o", "v.octree"});
  const json frame = info("v.octree")["frame"];
  EXPECT_EQ(frame["origin"], json::parse("[9.0,18.5,28.0]"));  // the corner, half a voxel before the first centre
  EXPECT_EQ(frame["axes"], json::parse("[[2.0,0.0,0.0],[0.0,3.0,0.0],[0.0,0.0,4.0]]"));
  EXPECT_EQ(frame["unit"], "mm");
}

TEST_F(BuildCommand, LikeShiftsAVolumeByWholeVoxels) {
  const auto geometry = [](const std::string& origin) {
    return "space: left-posterior-superior\nspace directions: (2,0,0) (0,2,0) (0,0,2)\nspace origin: " + origin + "\n";
  };
  make_nrrd("a.nrrd", {8, 8, 8}, std::vector<int>(512, 1), geometry("(100,0,0)"));
  make_nrrd("b.nrrd", {2, 2, 2}, std::vector<int>(8, 1), geometry("(104,2,0)"));
  make_nrrd("c.nrrd", {2, 2, 2}, std::vector<int>(8, 1), geometry("(105,2,0)"));
  make_nrrd("d.nrrd", {2, 2, 2}, std::vector<int>(8, 1), geometry("(98,0,0)"));
  done({"build", "a.nrrd", "-o", "a.octree"});
  done({"build", "b.nrrd", "-o", "b.octree", "--like", "a.octree"});
  EXPECT_EQ(info("b.octree")["depth"], 3);
  EXPECT_EQ(info("b.octree")["bounding_box"], json::parse("[[2,1,0],[4,3,2]]"));
  EXPECT_EQ(info("b.octree")["frame"], info("a.octree")["frame"]);
  refused({"build", "c.nrrd", "-o", "c.octree", "--like", "a.octree"}, "shifted by whole voxels");
  refused({"build", "d.nrrd", "-o", "d.octree", "--like", "a.octree"}, "x");
}

TEST_F(BuildCommand, RunsAreReadAsTheyArePrinted) {
  const std::string runs = "3 1\n10 0\n51 1\n";
  write("r.runs", runs);
  done({"build", "r.runs", "-o", "r.octree"});
  EXPECT_EQ(info("r.octree")["depth"], 2);
  EXPECT_EQ(info("r.octree")["volume"], 54);
  EXPECT_EQ(info("r.octree")["runs"], 3);
  EXPECT_EQ(done({"export", "r.octree", "-o", "-"}).out, runs);
  // White first, with colours and runs that merge.
  write("w.runs", "5 0\n3 7\n4 2\n52 0\n");
  done({"build", "w.runs", "-o", "w.octree"});
  EXPECT_EQ(done({"export", "w.octree", "-o", "-"}).out, "5 0\n7 1\n52 0\n");
}

TEST_F(BuildCommand, SameInputGivesTheSameBytesOnAnyNumberOfThreads) {
  make_stl("box.stl", {0, 0, 0}, {1, 0.7, 0.3});
  done({"build", "box.stl", "-o", "one.octree", "--depth", "6", "--threads", "1"});
  done({"build", "box.stl", "-o", "four.octree", "--depth", "6", "--threads", "4"});
  EXPECT_EQ(read("one.octree"), read("four.octree"));
}

TEST_F(BuildCommand, QuietSaysNothingAndTimingsComeLast) {
  make_stl("box.stl", {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(done({"build", "box.stl", "-o", "b.octree", "--depth", "4", "--quiet"}).out, "");
  const Result result = run({"build", "box.stl", "-o", "b.octree", "--depth", "4", "--timings", "--threads", "3"});
  EXPECT_EQ(result.code, 0);
  ASSERT_EQ(lines(result.err), 1u);
  const json times = json::parse(result.err);
  for (const char* stage : {"read", "build", "write", "total"}) EXPECT_GE(times[stage].get<double>(), 0) << stage;
  EXPECT_EQ(times["threads"], 3);
  EXPECT_GT(times["peak_memory"].get<std::uint64_t>(), 100000u);
}

TEST_F(BuildCommand, OptionsOfOtherInputsAreRefused) {
  make_stl("box.stl", {0, 0, 0}, {1, 1, 1});
  make_nrrd("v.nrrd", {2, 2, 2}, std::vector<int>(8, 1));
  write("r.runs", "8 1\n");
  make_box("u.octree", 3, {0, 0, 0}, {1, 1, 1});
  refused({"build", "box.stl", "-o", "b.octree", "--range", "1:2"}, "--range does not apply to 'box.stl'");
  refused({"build", "box.stl", "-o", "b.octree", "--label", "1"}, "--label does not apply to 'box.stl'");
  refused({"build", "box.stl", "-o", "b.octree", "--centre"}, "--centre does not apply to 'box.stl'");
  refused({"build", "v.nrrd", "-o", "b.octree", "--fit", "1"}, "--fit does not apply to 'v.nrrd'");
  refused({"build", "v.nrrd", "-o", "b.octree", "--voxel-size", "1"}, "--voxel-size does not apply to 'v.nrrd'");
  refused({"build", "v.nrrd", "-o", "b.octree", "--rule", "centre"}, "--rule does not apply to 'v.nrrd'");
  refused({"build", "r.runs", "-o", "b.octree", "--depth", "1"}, "--depth does not apply to 'r.runs'");
  refused({"build", "r.runs", "-o", "b.octree", "--like", "u.octree"}, "depth");
  refused({"build", "u.octree", "-o", "b.octree"}, "is an octree already");
  refused({"build", "box.stl", "-o", "b.octree", "--fit", "0.5", "--voxel-size", "1"}, "--fit");
  refused({"build", "v.nrrd", "-o", "b.octree", "--range", "1:2", "--label", "1"}, "--label");
  refused({"build", "box.stl", "-o", "b.octree", "--like", "u.octree", "--depth", "3"}, "--depth");
}

TEST_F(BuildCommand, OptionsOutOfRangeAreRefused) {
  make_stl("box.stl", {0, 0, 0}, {1, 1, 1});
  make_nrrd("v.nrrd", {2, 2, 2}, std::vector<int>(8, 1));
  for (const char* depth : {"0", "21", "-1", "8.5", "eight", "", "99999999999999999999"})
    refused({"build", "box.stl", "-o", "b.octree", "--depth", depth}, "--depth");
  for (const char* fit : {"0", "-0.5", "1.01", "nan", "inf", "x"})
    refused({"build", "box.stl", "-o", "b.octree", "--fit", fit}, "--fit");
  for (const char* size : {"0", "-1", "nan"})
    refused({"build", "box.stl", "-o", "b.octree", "--voxel-size", size}, "--voxel-size");
  refused({"build", "box.stl", "-o", "b.octree", "--voxel-size", "0.01", "--depth", "4"}, "universe");
  refused({"build", "box.stl", "-o", "b.octree", "--rule", "maybe"}, "--rule");
  for (const char* range : {":", "2:1", "1", "a:b", "1:2:3", "nan:", "5:inf"})
    refused({"build", "v.nrrd", "-o", "b.octree", "--range", range}, "--range");
  for (const char* threads : {"0", "1025", "-2", "two"})
    refused({"build", "box.stl", "-o", "b.octree", "--threads", threads}, "--threads");
  refused({"build", "v.nrrd", "-o", "b.octree", "--label", "nan"}, "--label");
}

TEST_F(BuildCommand, OpenMeshesAreBuiltWithAWarning) {
  make_stl("open.stl", {0, 0, 0}, {1, 1, 1}, true);
  const auto result = run({"build", "open.stl", "-o", "b.octree", "--depth", "4"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(lines(result.err), 1u);
  EXPECT_NE(result.err.find("open.stl: 3 open edges, 1 component; inside is where the winding number is above 1/2"),
            std::string::npos)
      << result.err;
}

TEST_F(BuildCommand, BadMeshesAreRefused) {
  make_stl("open.stl", {0, 0, 0}, {1, 1, 1}, true);
  refused({"build", "open.stl", "--inside", "parity", "-o", "b.octree"}, "not closed: it has 3 open edges");
  refused({"build", "open.stl", "--inside", "maybe", "-o", "b.octree"}, "automatic, parity or winding");
  make_stl("flat.stl", {0, 0, 0}, {0, 0, 0});
  refused({"build", "flat.stl", "-o", "b.octree"}, "");
  write("text.stl", "this is not a mesh\n");
  refused({"build", "text.stl", "-o", "b.octree"}, "text.stl");
  write("empty.obj", "");
  refused({"build", "empty.obj", "-o", "b.octree"}, "empty.obj");
  write("notes.doc", "hello\n");
  refused({"build", "notes.doc", "-o", "b.octree"}, "notes.doc");
  refused({"build", "notes.doc", "-o", "b.octree"},
          "a volume (NRRD, NIfTI, MetaImage, DICOM, TIFF, PNG) or a run stream (.runs)");
}

TEST_F(BuildCommand, BadVolumesAreRefused) {
  write("text.nrrd", "this is not a volume\n");
  refused({"build", "text.nrrd", "-o", "b.octree"}, "text.nrrd");
  make_nrrd("zero.nrrd", {0, 3, 3}, {});
  refused({"build", "zero.nrrd", "-o", "b.octree"}, "zero.nrrd");
  make_nrrd("short.nrrd", {8, 8, 8}, {1, 2, 3});
  refused({"build", "short.nrrd", "-o", "b.octree"}, "short.nrrd");
  make_nrrd("big.nrrd", {5, 5, 5}, std::vector<int>(125, 1));
  refused({"build", "big.nrrd", "-o", "b.octree", "--depth", "2"}, "big.nrrd");
  write("text.nii", "this is not a volume\n");
  refused({"build", "text.nii", "-o", "b.octree"}, "text.nii");
  write("bad.runs", "3 1\n");
  refused({"build", "bad.runs", "-o", "b.octree"}, "bad.runs");
}

}  // namespace
}  // namespace blackleaf::test
