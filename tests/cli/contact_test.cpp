// blackleaf collide: exit status, numbers and both modes.
#include <cmath>

#include "blackleaf/implicit.h"
#include "blackleaf/octree_file.h"
#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

using nlohmann::json;

class Collide : public CliTest {
 protected:
  // The answer as JSON, after checking that the exit status says the same.
  json ask(const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"collide", "a.octree", "b.octree", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = run(words);
    const json answer = result.json();
    EXPECT_EQ(result.code, answer["interferes"] ? 1 : 0);
    return answer;
  }
  // The same where the exit status tells of many answers.
  json ask_any(const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"collide", "a.octree", "b.octree", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = run(words);
    EXPECT_EQ(result.code, result.json()["interfering"].get<int>() > 0 ? 1 : 0);
    return result.json();
  }
  Collide() {
    make_box("a.octree", 5, {0, 0, 0}, {8, 8, 8});
    make_box("b.octree", 5, {12, 11, 8}, {16, 15, 12});
  }
};

TEST_F(Collide, ApartTouchingAndInterfering) {
  EXPECT_EQ(ask({}), json::parse(R"({"interferes":false,"overlap_volume":0,"distance":5.0,"mode":"voxelised"})"));
  EXPECT_EQ(ask({"--translate", "-4,-3,0"})["distance"], 0.0);
  EXPECT_EQ(ask({"--translate", "-4,-3,0"})["interferes"], false);
  EXPECT_EQ(ask({"--translate", "-6,-5,-1"}),
            json::parse(R"({"interferes":true,"overlap_volume":4,"distance":0.0,"mode":"voxelised"})"));
}

TEST_F(Collide, InWords) {
  const Result apart = run({"collide", "a.octree", "b.octree"});
  EXPECT_EQ(apart.code, 0);
  EXPECT_NE(apart.out.find("they do not interfere: 5 voxels apart, from (8, 8, 8)"), std::string::npos) << apart.out;
  const Result hit = run({"collide", "a.octree", "b.octree", "--translate", "-6,-5,-1"});
  EXPECT_EQ(hit.code, 1);
  EXPECT_EQ(hit.out, "they interfere: the overlap is 4 voxels\n");
  EXPECT_EQ(hit.err, "");
  const Result quiet = run({"collide", "a.octree", "b.octree", "--translate", "-6,-5,-1", "--quiet"});
  EXPECT_EQ(quiet.code, 1);
  EXPECT_EQ(quiet.out, "");
}

TEST_F(Collide, ExactAndVoxelisedMayDiffer) {
  // B turned by 45 degrees about its own axis reaches 2 sqrt 2 = 2.83 from it. With the axis at x = 8 + 2.7 the tilted
  // corner is 0.13 inside A, but no voxel centre is.
  const std::vector<std::string> motion = {"--rotate", "0,0,1:45", "--about", "centroid", "--translate", "-3.3,-8,-4"};
  std::vector<std::string> exact = motion;
  exact.emplace_back("--exact");
  EXPECT_EQ(ask(exact), json::parse(R"({"interferes":true,"overlap_volume":null,"distance":0.0,"mode":"exact"})"));
  EXPECT_EQ(ask(motion)["interferes"], false);
  exact[5] = "-3.1,-8,-4";  // the corner stays 0.07 outside
  const json apart = ask(exact);
  EXPECT_EQ(apart["interferes"], false);
  EXPECT_NEAR(apart["distance"], 14 - 3.1 - 2 * std::sqrt(2.0) - 8, 1e-9);
}

TEST_F(Collide, PartsOutsideTheUniverseAreMentioned) {
  const Result result = run({"collide", "a.octree", "b.octree", "--translate", "18,0,0", "--json"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(lines(result.err), 1u);
  EXPECT_NE(result.err.find("warning: parts of the moved 'b.octree' are outside the universe"), std::string::npos);
  // Two layers of B are left at x = 30.
  EXPECT_EQ(result.json()["distance"].get<double>(), std::sqrt(22.0 * 22 + 3 * 3));
  // Nothing is left.
  const Result gone = run({"collide", "a.octree", "b.octree", "--translate", "100,0,0", "--json", "--quiet"});
  EXPECT_EQ(gone.code, 0);
  EXPECT_EQ(gone.err, "");
  EXPECT_EQ(gone.json()["distance"], nullptr);
  // Tilted cubes may be anywhere.
  EXPECT_EQ(ask({"--translate", "100,0,0", "--exact"})["interferes"], false);
}

TEST_F(Collide, AtManyPoses) {
  write("poses.txt", "# one a line\n0,0,0\n-6,-5,-1   # inside\n\n -4,-3,0\n-3.3,-8,-4@0,0,1:45\n");
  const json voxelised = ask_any({"--poses", "poses.txt"});
  EXPECT_EQ(voxelised, json::parse(R"({"poses":4,"interfering":1,"interferes":[false,true,false,false],
                                        "mode":"voxelised"})"));
  EXPECT_EQ(ask_any({"--poses", "poses.txt", "--exact"})["interferes"], json::parse("[false,true,false,true]"));
  const Result text = run({"collide", "a.octree", "b.octree", "--poses", "poses.txt", "--exact"});
  EXPECT_EQ(text.code, 1);
  EXPECT_EQ(text.out, "they interfere at 2 of 4 poses: 2, 4\n");
  // A path is as good; standard input too.
  const std::string path =
      R"({"poses": [{"time": 0}, {"time": 1, "translation": [-6, -5, -1]}, {"time": 2, "translation": [9, 0, 0]}]})";
  const Result piped = run({"collide", "a.octree", "b.octree", "--poses", "-", "--threads", "2"}, path);
  EXPECT_EQ(piped.out, "they interfere at 1 of 3 poses: 2\n");
  write("none.txt", "# nothing\n");
  refused({"collide", "a.octree", "b.octree", "--poses", "none.txt"}, "'none.txt' has no poses");
  write("bad.txt", "1,2,3\n1,2\n");
  refused({"collide", "a.octree", "b.octree", "--poses", "bad.txt"}, "line 2 of 'bad.txt'");
  write("bad.txt", "1,2,3@0,0,1\n");
  refused({"collide", "a.octree", "b.octree", "--poses", "bad.txt"}, "line 1 of 'bad.txt'");
  refused({"collide", "a.octree", "b.octree", "--poses", "poses.txt", "--translate", "1,0,0"}, "--poses");
  refused({"collide", "a.octree", "b.octree", "--poses", "no.txt"}, "no.txt");
}

TEST_F(Collide, WritesWhatTheyShare) {
  const json report = ask({"--translate", "-6,-5,-1", "-o", "common.octree"});
  EXPECT_EQ(report["volume"], 4);
  EXPECT_EQ(report["overlap_volume"], 4);
  EXPECT_TRUE(load(folder() / "common.octree").octree == box(5, {6, 6, 7}, {8, 8, 8}));
  const Result text = run({"collide", "a.octree", "b.octree", "--translate", "-6,-5,-1", "-o", "common.octree"});
  EXPECT_EQ(text.out.find("they interfere: the overlap is 4 voxels\ncommon.octree: depth 5, 4 voxels"), 0u) << text.out;
  const Result apart = run({"collide", "a.octree", "b.octree", "-o", "none.octree"});
  EXPECT_EQ(apart.code, 0);
  EXPECT_TRUE(load(folder() / "none.octree").octree.is_empty());
  refused({"collide", "a.octree", "b.octree", "--exact", "-o", "x.octree"}, "--exact");
}

TEST_F(Collide, FramesThatDoNotMatch) {
  Frame fine;
  fine.axes *= 0.5;
  save(box(6, {24, 22, 16}, {32, 30, 24}, fine), folder() / "fine.octree");
  refused({"collide", "a.octree", "fine.octree"},
          "the voxels of 'a.octree' measure 1 voxel and those of 'fine.octree' 0.5 voxel");
  EXPECT_EQ(run({"collide", "a.octree", "fine.octree", "--resample", "--json"}).json()["distance"], 5.0);
  EXPECT_EQ(run({"collide", "a.octree", "fine.octree", "--resample", "--exact", "--translate", "-6,-5,-1"}).code, 1);
  save(box(6, {24, 22, 16}, {32, 30, 24}, Frame{{20, 0, 0}, fine.axes, fine.unit}), folder() / "out.octree");
  EXPECT_NE(run({"collide", "a.octree", "out.octree", "--resample"}).err.find("parts of 'out.octree' are outside"),
            std::string::npos);
  EXPECT_EQ(run({"collide", "a.octree", "fine.octree", "--resample"}).err, "");
  Frame aside;
  aside.origin = {-2, 0, 0};
  save(box(4, {12, 11, 8}, {16, 15, 12}, aside), folder() / "aside.octree");
  refused({"collide", "a.octree", "aside.octree"}, "--align");
  EXPECT_EQ(run({"collide", "a.octree", "aside.octree", "--align", "--json"}).json()["distance"],
            std::sqrt(2.0 * 2 + 3 * 3));
  aside.origin = {-2.25, 0, 0};
  save(box(4, {12, 11, 8}, {16, 15, 12}, aside), folder() / "aside.octree");
  refused({"collide", "a.octree", "aside.octree", "--align"}, "do not lie on those");
  refused({"collide", "a.octree", "fine.octree", "--resample", "--align"}, "excludes");
}

using RayCommand = CliTest;

TEST_F(RayCommand, HitsAndMisses) {
  make_box("a.octree", 5, {2, 3, 4}, {8, 8, 8});
  const Result hit = run({"ray", "a.octree", "--from", "-2,5,5.5", "--direction", "2,0,0"});
  EXPECT_EQ(hit.code, 0);
  EXPECT_EQ(hit.out, "it hits at (2, 5, 5.5) at 2, face -x\n");
  EXPECT_EQ(run({"ray", "a.octree", "--from", "-2,5,5.5", "--direction", "2,0,0", "--json"}).json(),
            json::parse(R"({"hit":true,"time":2.0,"point":[2.0,5.0,5.5],"face":"-x"})"));
  EXPECT_EQ(run({"ray", "a.octree", "--from", "5,5,5", "--direction", "0,0,1", "--all", "--json"}).json(),
            json::parse(R"({"hit":true,"stretches":[{"enter":{"time":0.0,"point":[5.0,5.0,5.0],"face":null},
                            "leave":{"time":3.0,"point":[5.0,5.0,8.0],"face":"+z"}}]})"));
  const Result miss = run({"ray", "a.octree", "--from", "-2,5,5.5", "--direction", "-2,0,0"});
  EXPECT_EQ(miss.code, 1);
  EXPECT_EQ(miss.out, "it misses\n");
  refused({"ray", "a.octree", "--from", "1,2", "--direction", "1,0,0"}, "--from");
  refused({"ray", "a.octree", "--from", "1,2,3", "--direction", "0,0,0"}, "direction");
  refused({"ray", "a.octree", "--direction", "1,0,0"}, "--from");
}

TEST_F(Collide, Refusals) {
  make_box("deep.octree", 6, {0, 0, 0}, {8, 8, 8});
  refused({"collide", "a.octree", "deep.octree"}, "'a.octree' has depth 5 and 'deep.octree' has depth 6");
  refused({"collide", "a.octree"}, "B is required");
  refused({"collide", "-", "-"}, "standard input");
  refused({"collide", "a.octree", "none.octree"}, "none.octree");
}

TEST_F(Collide, AlongAPath) {
  // B, 12 to 16 along x, goes to A, which ends at x = 8: 4 voxels in 4 of 10 seconds.
  write("hit.json",
        R"({"poses": [{"time": 0, "translation": [0, -8, -4]}, {"time": 10, "translation": [-10, -8, -4]}]})");
  write("miss.json",
        R"({"poses": [{"time": 0, "translation": [0, -8, -4]}, {"time": 10, "translation": [-3, -8, -4]}]})");
  const Result hit = run({"collide", "a.octree", "b.octree", "--path", "hit.json", "--json"});
  EXPECT_EQ(hit.code, 1);
  const json contact = hit.json()["first_contact"];
  EXPECT_EQ(hit.json()["clear"], false);
  EXPECT_LE(contact["time"].get<double>(), 4);
  EXPECT_GE(contact["time"].get<double>(), 4 - 0.0011);
  EXPECT_LE(contact["distance"].get<double>(), 0.001);
  EXPECT_NEAR(contact["place"][0].get<double>(), 8, 0.001);
  EXPECT_NEAR(contact["pose"]["translation"][0].get<double>(), -4, 0.002);
  EXPECT_EQ(contact["pose"]["rotation"], json::parse("[1.0,0.0,0.0,0.0]"));
  EXPECT_NE(run({"collide", "a.octree", "b.octree", "--path", "hit.json"}).out.find("first contact at time "),
            std::string::npos);
  const Result clear = run({"collide", "a.octree", "b.octree", "--path", "miss.json", "--json"});
  EXPECT_EQ(clear.code, 0);
  EXPECT_EQ(clear.json()["clear"], true);
  EXPECT_NEAR(clear.json()["clearance"]["at_least"].get<double>(), 1, 0.011);
  EXPECT_NE(run({"collide", "a.octree", "b.octree", "--path", "miss.json"}).out.find("the way is clear: at least"),
            std::string::npos);
  EXPECT_EQ(run({"collide", "a.octree", "b.octree", "--path", "miss.json", "--clearance", "0.9"}).code, 0);
  EXPECT_EQ(run({"collide", "a.octree", "b.octree", "--path", "miss.json", "--clearance", "1.1", "--quiet"}).code, 1);
  EXPECT_EQ(run({"collide", "a.octree", "b.octree", "--path", "hit.json", "--clearance", "-6.5"}).code, 0);
  refused({"collide", "a.octree", "b.octree", "--path", "hit.json", "--exact"}, "--path");
  refused({"collide", "a.octree", "b.octree", "--path", "hit.json", "--translate", "1,0,0"}, "--path");
  refused({"collide", "a.octree", "b.octree", "--clearance", "1"}, "--path");
  refused({"collide", "a.octree", "b.octree", "--path", "hit.json", "--tolerance", "0"}, "--tolerance");
  refused({"collide", "a.octree", "b.octree", "--path", "hit.json", "--tolerance", "1e-13"}, "too small");
  refused({"collide", "a.octree", "b.octree", "--path", "none.json"}, "none.json");
  refused({"collide", "-", "b.octree", "--path", "-"}, "standard input");
}

}  // namespace
}  // namespace blackleaf::test
