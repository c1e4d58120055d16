// Files of many labels: build --labels and --bands, info, --label of every command that takes a solid.
#include <fmt/format.h>

#include "blackleaf/label_map.h"
#include "blackleaf/move.h"
#include "blackleaf/octree_file.h"
#include "blackleaf/runs_file.h"
#include "blackleaf/volume_file.h"
#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

using nlohmann::json;

class LabelsCommand : public CliTest {
 protected:
  // 4 x 4 x 4: label 3 at z = 0, label 200 at (1, 2, 3), else 0.
  LabelsCommand() {
    std::vector<int> values(64, 0);
    for (std::size_t i = 0; i < 16; ++i) values[i] = 3;
    values[1 + 4 * 2 + 16 * 3] = 200;
    make_nrrd("a.nrrd", {4, 4, 4}, values);
    done({"build", "a.nrrd", "-o", "a.octree", "--labels"});
  }

  json info(const std::string& name, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"info", name, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return done(arguments).json();
  }

  // A command that says once, on standard error, that it took all labels together.
  Result noted(const std::vector<std::string>& arguments) const {
    Result result = run(arguments);
    EXPECT_EQ(result.code, 0) << testing::PrintToString(arguments) << result.err;
    EXPECT_EQ(result.err,
              "blackleaf: note: 'a.octree' holds 2 labels; all but 0 taken as one solid; --label L takes one\n")
        << testing::PrintToString(arguments);
    return result;
  }
};

TEST_F(LabelsCommand, TranslateShiftsAllLabelsOrOne) {
  EXPECT_EQ(done({"translate", "a.octree", "0,0,4", "--grow", "-o", "t.octree"}).out.substr(0, 29),
            "t.octree: depth 3, 2 labels, ");
  EXPECT_EQ(info("t.octree")["labels"], json::parse(R"([{"label":3,"volume":16,"bounding_box":[[0,0,4],[4,4,5]]},
                            {"label":200,"volume":1,"bounding_box":[[1,2,7],[2,3,8]]}])"));
  done({"translate", "t.octree", "0,0,-4", "-o", "b.octree"});
  done({"translate", "a.octree", "0,0,-1", "--clip", "-o", "c.octree"});
  EXPECT_EQ(info("c.octree")["labels"], json::parse(R"([{"label":200,"volume":1,"bounding_box":[[1,2,2],[2,3,3]]}])"));
  refused({"translate", "a.octree", "0,0,-1", "-o", "d.octree"}, "1 voxel below z = 0");
  done({"translate", "a.octree", "0,0,-1", "--label", "200", "-o", "e.octree"});
  EXPECT_EQ(info("e.octree")["volume"], 1);
  EXPECT_FALSE(info("e.octree").contains("labels"));
  EXPECT_EQ(info("e.octree")["bounding_box"], json::parse("[[1,2,2],[2,3,3]]"));
  EXPECT_EQ(done({"translate", "a.octree", "0,0,0", "-o", "f.octree", "--json"}).json()["label_count"], 2);
}

TEST_F(LabelsCommand, BuildKeepsAllLabelsAndInfoListsThem) {
  const json facts = info("a.octree");
  EXPECT_EQ(facts["depth"], 2);
  EXPECT_EQ(facts["volume"], 17);
  EXPECT_EQ(facts["labels"], json::parse(R"([{"label":3,"volume":16,"bounding_box":[[0,0,0],[4,4,1]]},
                                            {"label":200,"volume":1,"bounding_box":[[1,2,3],[2,3,4]]}])"));
  EXPECT_EQ(facts["metadata"]["options"], json::parse(R"({"labels":true,"depth":2})"));
  const json one = info("a.octree", {"--label", "200"});
  EXPECT_EQ(one["volume"], 1);
  EXPECT_EQ(one["label"], 200);
  EXPECT_EQ(one["bounding_box"], json::parse("[[1,2,3],[2,3,4]]"));
  EXPECT_FALSE(one.contains("labels"));
  const std::string text = done({"info", "a.octree"}).out;
  EXPECT_NE(text.find("  labels          2 in "), std::string::npos) << text;
  EXPECT_NE(text.find("             3  16 voxels, (0, 0, 0) to (4, 4, 1)\n"), std::string::npos) << text;
  EXPECT_NE(text.find("           200  1 voxel, (1, 2, 3) to (2, 3, 4)\n"), std::string::npos) << text;
  const json report = done({"build", "a.nrrd", "-o", "b.octree", "--labels", "--json"}).json();
  EXPECT_EQ(report["label_count"], 2);
  EXPECT_EQ(report["volume"], 17);
  EXPECT_EQ(report["file_bytes"], std::filesystem::file_size(folder() / "b.octree"));
  EXPECT_EQ(read("a.octree"), read("b.octree"));
  EXPECT_EQ(done({"build", "a.nrrd", "-o", "-", "--labels"}).out, read("a.octree"));
  EXPECT_NE(done({"verify", "a.octree"}).out.find("ok, depth 2, 2 labels, 17 voxels"), std::string::npos);
}

TEST_F(LabelsCommand, EveryLabelOpensAsItsOwnOctree) {
  done({"build", "a.nrrd", "-o", "three.octree", "--label", "3"});
  const Octree three = load(folder() / "three.octree").octree;
  done({"translate", "a.octree", "0,0,2", "--label", "3", "-o", "t.octree"});
  EXPECT_EQ(info("t.octree")["bounding_box"], json::parse("[[0,0,2],[4,4,3]]"));
  EXPECT_EQ(info("t.octree")["metadata"]["options"]["label"], 3);
  done({"move", "a.octree", "--translate", "0,0,1", "--label", "3", "-o", "m.octree"});
  EXPECT_EQ(info("m.octree")["bounding_box"], json::parse("[[0,0,1],[4,4,2]]"));
  done({"draw", "a.octree", "--view", "1,2,3", "--label", "3", "-o", "a.svg"});
  done({"draw", "three.octree", "--view", "1,2,3", "-o", "three.svg"});
  const auto lines = [&](const char* name) { return read(name).substr(read(name).find("<g ")); };  // less their sources
  EXPECT_EQ(lines("a.svg"), lines("three.svg"));
  done({"export", "a.octree", "--label", "3", "-o", "a.runs"});
  EXPECT_TRUE(read_runs(folder() / "a.runs") == three);
  done({"export", "a.octree", "--label", "200", "-o", "a.ply"});
  EXPECT_EQ(done({"export", "a.octree", "--label", "200", "-o", "b.ply", "--json"}).json()["triangles"], 12);
  EXPECT_EQ(run({"collide", "a.octree", "three.octree", "--label-a", "3"}).code, 1);
  EXPECT_EQ(run({"collide", "a.octree", "three.octree", "--label-a", "200"}).code, 0);
  EXPECT_EQ(run({"collide", "a.octree", "a.octree", "--label-a", "200", "--label-b", "200"}).code, 1);
  done({"combine", "a.octree", "or", "a.octree", "--label-a", "3", "--label-b", "200", "-o", "u.octree"});
  EXPECT_EQ(info("u.octree")["volume"], 17);
  EXPECT_EQ(info("u.octree")["metadata"]["options"]["label_b"], 200);
}

TEST_F(LabelsCommand, WithoutALabelAllButZeroAreOneSolid) {
  noted({"export", "a.octree", "-o", "a.stl"});
  EXPECT_EQ(done({"translate", "a.octree", "0,0,0", "-o", "q.octree", "--quiet"}).out, "");
}

TEST_F(LabelsCommand, MoveMovesAllLabels) {
  const LabelMap map = *load(folder() / "a.octree").labels;
  const json report = done({"move", "a.octree", "--rotate", "0,0,1:90", "--about", "centre", "--translate", "0.25,0,0",
                            "--clip", "--stats", "--json", "-o", "m.octree"})
                          .json();
  const Motion turn = Motion::translation({0.25, 0, 0}) * Motion::rotation_degrees({0, 0, 1}, 90).about({2, 2, 2});
  EXPECT_TRUE(*load(folder() / "m.octree").labels == move(map, turn, Leaving::clip));
  EXPECT_EQ(report["label_count"], 2);
  EXPECT_EQ(report["volume"], 17);
  EXPECT_EQ(report["stats"]["source"]["volume"], 17);
  EXPECT_EQ(info("m.octree")["labels"][1]["bounding_box"], json::parse("[[1,1,3],[2,2,4]]"));
  const std::string text = done({"move", "a.octree", "--translate", "0,0,0", "--stats", "-o", "m.octree"}).out;
  EXPECT_NE(text.find("I/V"), std::string::npos) << text;
  EXPECT_NE(text.find("m.octree: depth 2, 2 labels, 17 voxels"), std::string::npos) << text;
  EXPECT_TRUE(*load(folder() / "m.octree").labels == map);
  refused({"move", "a.octree", "--translate", "0.25,0,0", "-o", "o.octree"}, "0.25 voxels beyond x = 4");
}

TEST_F(LabelsCommand, VolumesAndRunsCarryLabels) {
  const LabelMap map = *load(folder() / "a.octree").labels;
  for (const char* name : {"b.nrrd", "b.nii.gz", "b.mha"}) {
    SCOPED_TRACE(name);
    done({"export", "a.octree", "-o", name});
    EXPECT_TRUE(read_label_volume(folder() / name) == map);
  }
  EXPECT_NE(done({"export", "a.octree", "-o", "b.runs"}).out.find("labelled runs"), std::string::npos);
  EXPECT_TRUE(read_label_runs(folder() / "b.runs") == map);
  EXPECT_EQ(done({"export", "a.octree", "-o", "-"}).out, read("b.runs"));
  done({"build", "b.runs", "-o", "b.octree", "--labels", "--like", "a.octree"});
  const OctreeFile again = load(folder() / "b.octree");
  EXPECT_TRUE(*again.labels == map);
  EXPECT_TRUE(again.octree.frame() == map.frame());
  done({"build", "b.runs", "-o", "one.octree", "--label", "200"});
  EXPECT_EQ(info("one.octree")["volume"], 1);
  done({"build", "b.runs", "-o", "all.octree"});
  EXPECT_EQ(info("all.octree")["volume"], 17);
  EXPECT_FALSE(info("all.octree").contains("labels"));
}

TEST_F(LabelsCommand, Bands) {
  done({"build", "a.nrrd", "-o", "b.octree", "--bands", "-1,3,199.5"});
  const json facts = info("b.octree");
  EXPECT_EQ(facts["metadata"]["options"], json::parse(R"({"bands":[-1.0,3.0,199.5],"depth":2})"));
  ASSERT_EQ(facts["labels"].size(), 3u);
  EXPECT_EQ(facts["labels"][0]["volume"], 47);
  EXPECT_EQ(facts["labels"][1]["volume"], 16);
  EXPECT_EQ(facts["labels"][2]["volume"], 1);
}

TEST_F(LabelsCommand, Like) {
  done({"build", "a.nrrd", "-o", "b.octree", "--labels", "--like", "a.octree"});
  EXPECT_TRUE(*load(folder() / "b.octree").labels == *load(folder() / "a.octree").labels);
  make_box("far.octree", 2, {0, 0, 0}, {1, 1, 1});
  refused({"build", "a.nrrd", "-o", "c.octree", "--labels", "--like", "far.octree"},
          "its voxels are not those of the universe");
  make_box("big.octree", 3, {0, 0, 0}, {1, 1, 1});
  done({"export", "a.octree", "-o", "a.runs"});
  refused({"build", "a.runs", "-o", "c.octree", "--labels", "--like", "big.octree"},
          "fits only universes of its own depth");
}

// Labels in another universe: shifted by whole voxels, and what reaches beyond it is background.
TEST_F(LabelsCommand, LikeShiftsByWholeVoxels) {
  const auto geometry = [](const std::string& origin) {
    return "space: left-posterior-superior\nspace directions: (2,0,0) (0,2,0) (0,0,2)\nspace origin: " + origin + "\n";
  };
  make_nrrd("u.nrrd", {4, 4, 4}, std::vector<int>(64, 1), geometry("(100,0,0)"));
  done({"build", "u.nrrd", "-o", "u.octree"});
  const auto labels = [&](const std::string& name) { return done({"info", name, "--json"}).json()["labels"]; };
  make_nrrd("in.nrrd", {2, 2, 2}, {5, 5, 5, 5, 5, 5, 5, 9}, geometry("(104,2,0)"));
  done({"build", "in.nrrd", "-o", "in.octree", "--labels", "--like", "u.octree"});
  EXPECT_EQ(labels("in.octree"), json::parse(R"([{"label":5,"volume":7,"bounding_box":[[2,1,0],[4,3,2]]},
                                                 {"label":9,"volume":1,"bounding_box":[[3,2,1],[4,3,2]]}])"));
  EXPECT_EQ(done({"info", "in.octree", "--json"}).json()["frame"],
            done({"info", "u.octree", "--json"}).json()["frame"]);
  make_nrrd("half.nrrd", {2, 2, 2}, {5, 5, 5, 5, 5, 5, 5, 9}, geometry("(105,2,0)"));
  refused({"build", "half.nrrd", "-o", "o.octree", "--labels", "--like", "u.octree"},
          "half.nrrd: its voxels are not those of the universe that it is to lie in, shifted by whole voxels");
  // 8 x 8 x 8 around the universe, which begins at (3,2,1) of it.
  std::vector<int> values(512, 0);
  const auto at = [&](int x, int y, int z) -> int& { return values[static_cast<std::size_t>(x + 8 * (y + 8 * z))]; };
  at(3, 2, 1) = 7;
  at(6, 5, 4) = 8;
  make_nrrd("around.nrrd", {8, 8, 8}, values, geometry("(94,-4,-2)"));
  done({"build", "around.nrrd", "-o", "around.octree", "--labels", "--like", "u.octree"});
  EXPECT_EQ(labels("around.octree"), json::parse(R"([{"label":7,"volume":1,"bounding_box":[[0,0,0],[1,1,1]]},
                                                     {"label":8,"volume":1,"bounding_box":[[3,3,3],[4,4,4]]}])"));
  done({"build", "around.nrrd", "-o", "bands.octree", "--bands", "1,8", "--like", "u.octree"});
  EXPECT_EQ(labels("bands.octree").size(), 2u);
  for (const std::array<int, 3> outside : {std::array{2, 2, 1}, std::array{3, 1, 1}, std::array{3, 2, 0},
                                           std::array{7, 2, 1}, std::array{6, 6, 4}, std::array{0, 0, 7}}) {
    std::vector<int> more = values;
    more[static_cast<std::size_t>(outside[0] + 8 * (outside[1] + 8 * outside[2]))] = 3;
    make_nrrd("more.nrrd", {8, 8, 8}, more, geometry("(94,-4,-2)"));
    const std::string voxel = fmt::format("more.nrrd: voxel ({},{},{}) has value 3 and lies outside the universe",
                                          outside[0], outside[1], outside[2]);
    refused({"build", "more.nrrd", "-o", "o.octree", "--labels", "--like", "u.octree"}, voxel);
    refused({"build", "more.nrrd", "-o", "o.octree", "--bands", "3", "--like", "u.octree"}, voxel);
    done({"build", "more.nrrd", "-o", "o.octree", "--bands", "4", "--like", "u.octree"});
  }
  make_nrrd("far.nrrd", {2, 2, 2}, std::vector<int>(8, 0), geometry("(300,0,0)"));
  refused({"build", "far.nrrd", "-o", "o.octree", "--labels", "--like", "u.octree"}, "far.nrrd: lies outside");
}

TEST_F(LabelsCommand, Refusals) {
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"info", "a.octree"},
                                             {"translate", "a.octree", "0,0,0", "-o", "o.octree"},
                                             {"move", "a.octree", "--translate", "0,0,0", "-o", "o.octree"},
                                             {"draw", "a.octree", "--view", "1,2,3", "-o", "o.svg"},
                                             {"export", "a.octree", "-o", "o.stl"},
                                             {"export", "a.octree", "-o", "o.nrrd"}}) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--label", "4"});
    refused(arguments, "'a.octree' has no label 4; it has 2 labels: 3, 200");
    arguments.back() = "-1";
    refused(arguments, "--label is '-1'");
  }
  refused({"collide", "a.octree", "a.octree", "--label-a", "3", "--label-b", "4"},
          "has no label 4; it has 2 labels: 3, 200");
  make_box("box.octree", 2, {0, 0, 0}, {1, 1, 1});
  refused({"info", "box.octree", "--label", "1"}, "'box.octree' holds one solid without labels");
  refused({"draw", "box.octree", "--label", "1", "--view", "1,2,3", "-o", "o.svg"}, "holds one solid without labels");
  make_stl("box.stl", {0, 0, 0}, {1, 1, 1});
  refused({"build", "box.stl", "-o", "o.octree", "--labels"}, "--labels does not apply to 'box.stl'");
  refused({"build", "a.nrrd", "-o", "o.octree", "--labels", "--bands", "1"}, "--labels");
  refused({"build", "a.nrrd", "-o", "o.octree", "--labels", "--label", "1"}, "--label");
  refused({"build", "a.nrrd", "-o", "o.octree", "--bands", "1", "--range", "1:"}, "--range");
  refused({"build", "a.nrrd", "-o", "o.octree", "--bands", "1,,2"}, "--bands is '1,,2'");
  refused({"build", "a.nrrd", "-o", "o.octree", "--bands", "2,1"}, "the thresholds do not increase: 1 comes after 2");
  refused({"build", "a.nrrd", "-o", "o.octree", "--labels", "--fit", "0.5"}, "--fit does not apply");
  write("b.runs", "8 2\n");
  refused({"build", "b.runs", "-o", "o.octree", "--bands", "1"}, "--bands does not apply");
  write("b.runs", "3 2\nx 1\n");
  refused({"build", "b.runs", "-o", "o.octree", "--labels"}, "line 2 is not");
  write("signed.nrrd",
        "NRRD0004\ntype: int8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n\x01\x01\x01\x01\x01\x01\xff\x01");
  refused({"build", "signed.nrrd", "-o", "o.octree", "--labels"}, "the value -1 of voxel (0, 1, 1) is no label");
}

TEST_F(LabelsCommand, NothingButBackgroundIsWarnedOf) {
  make_nrrd("zero.nrrd", {2, 2, 2}, std::vector<int>(8, 0));
  const Result result = run({"build", "zero.nrrd", "-o", "z.octree", "--labels"});
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.err.find("warning: no voxel has a label but 0"), std::string::npos) << result.err;
  refused({"info", "z.octree", "--label", "1"}, "'z.octree' has no label 1, nor any but 0");
}

}  // namespace
}  // namespace blackleaf::test
