// The commands that make one octree of another, or tell about one.
#include "blackleaf/implicit.h"
#include "blackleaf/octree_file.h"
#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

using nlohmann::json;

class Commands : public CliTest {
 protected:
  json info(const std::string& name) const { return done({"info", name, "--json"}).json(); }
  json bounds(const std::string& name) const { return info(name)["bounding_box"]; }
};

TEST_F(Commands, VersionAndHelp) {
  EXPECT_EQ(done({"--version"}).out, "blackleaf " BLACKLEAF_VERSION_TEXT "\n");
  const std::string help = done({"--help"}).out;
  std::size_t last = 0;
  for (const char* name :
       {"build", "info", "translate", "move", "combine", "offset", "collide", "draw", "export", "curve", "verify"}) {
    const std::size_t at = help.find(std::string("\n  ") + name + " ");
    ASSERT_NE(at, std::string::npos) << name;
    EXPECT_GT(at, last) << name;
    last = at;
    const std::string own = done({name, "--help"}).out;
    EXPECT_NE(own.find(std::string("Usage: blackleaf ") + name), std::string::npos) << own;
    EXPECT_NE(own.find(std::string("Example:\n  blackleaf ") + name), std::string::npos) << own;
    EXPECT_NE(own.find("--threads"), std::string::npos);
  }
  const Result alone = run({});
  EXPECT_EQ(alone.code, 2);
  EXPECT_EQ(alone.err, help);
}

TEST_F(Commands, InfoHasExactlyThePromisedKeys) {
  make_box("b.octree", 3, {0, 0, 0}, {4, 4, 4});
  const json facts = info("b.octree");
  std::vector<std::string> keys;
  for (const auto& [key, value] : facts.items()) keys.push_back(key);
  EXPECT_EQ(keys, (std::vector<std::string>{"black_leaves", "black_leaves_by_level", "bounding_box", "centroid",
                                            "depth", "file_bytes", "frame", "internal_nodes", "memory_bytes",
                                            "metadata", "runs", "surface_area", "volume", "white_leaves"}));
  EXPECT_EQ(facts["depth"], 3);
  EXPECT_EQ(facts["black_leaves"], 1);
  EXPECT_EQ(facts["white_leaves"], 7);
  EXPECT_EQ(facts["internal_nodes"], 1);
  EXPECT_EQ(facts["black_leaves_by_level"], json::parse("[0,0,1,0]"));
  EXPECT_EQ(facts["volume"], 64);
  EXPECT_EQ(facts["surface_area"], 96);
  EXPECT_EQ(facts["bounding_box"], json::parse("[[0,0,0],[4,4,4]]"));
  EXPECT_EQ(facts["centroid"], json::parse("[2.0,2.0,2.0]"));
  EXPECT_EQ(facts["runs"], 2);
  EXPECT_EQ(facts["file_bytes"], std::filesystem::file_size(folder() / "b.octree"));
  EXPECT_EQ(facts["frame"], json::parse(R"({"origin":[0.0,0.0,0.0],"axes":[[1.0,0.0,0.0],[0.0,1.0,0.0],[0.0,0.0,1.0]],
                                           "unit":"voxel"})"));
  EXPECT_EQ(facts["metadata"], json::object());
}

TEST_F(Commands, InfoOfNothingAndOfAxesAsColumns) {
  Frame frame;
  frame.axes << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  save(Octree(5, Colour::white, frame), folder() / "empty.octree", R"({"note":"nothing"})");
  const json facts = info("empty.octree");
  EXPECT_EQ(facts["bounding_box"], nullptr);
  EXPECT_EQ(facts["centroid"], nullptr);
  EXPECT_EQ(facts["volume"], 0);
  EXPECT_EQ(facts["frame"]["axes"], json::parse("[[1.0,4.0,7.0],[2.0,5.0,8.0],[3.0,6.0,10.0]]"));
  EXPECT_EQ(facts["metadata"]["note"], "nothing");
  const std::string text = done({"info", "empty.octree"}).out;
  EXPECT_NE(text.find("volume          0 voxels"), std::string::npos) << text;
}

TEST_F(Commands, TranslateTakesNegativeDisplacements) {
  make_box("b.octree", 4, {3, 4, 5}, {6, 7, 8});
  done({"translate", "b.octree", "-3,2,-5", "-o", "t.octree"});
  EXPECT_EQ(bounds("t.octree"), json::parse("[[0,6,0],[3,9,3]]"));
  done({"translate", "b.octree", "-4,0,0", "--clip", "-o", "t.octree"});
  EXPECT_EQ(bounds("t.octree"), json::parse("[[0,4,5],[2,7,8]]"));
  done({"translate", "b.octree", "-4,0,0", "--grow", "-o", "t.octree"});
  EXPECT_EQ(info("t.octree")["depth"], 5);
  EXPECT_EQ(info("t.octree")["volume"], 27);
  // World coordinates are kept: the box still begins at x = -1 there.
  const json grown = info("t.octree");
  EXPECT_EQ(grown["frame"]["origin"][0].get<double>() + grown["bounding_box"][0][0].get<double>(), -1);
}

TEST_F(Commands, OutputMayReplaceInput) {
  make_box("b.octree", 4, {3, 4, 5}, {6, 7, 8});
  done({"translate", "b.octree", "1,1,1", "-o", "b.octree"});
  EXPECT_EQ(bounds("b.octree"), json::parse("[[4,5,6],[7,8,9]]"));
  EXPECT_EQ(files(), std::vector<std::string>{"b.octree"});
}

TEST_F(Commands, MoveByQuarterTurnsIsExact) {
  make_box("b.octree", 10, {100, 200, 300}, {110, 220, 330});
  // (x,y) -> (-y,x), then +1024 in x.
  done({"move", "b.octree", "--rotate", "0,0,1:90", "--translate", "1024,0,0", "-o", "m.octree"});
  EXPECT_EQ(bounds("m.octree"), json::parse("[[804,100,300],[824,110,330]]"));
  EXPECT_EQ(info("m.octree")["volume"], 10 * 20 * 30);
  done({"move", "b.octree", "--rotate", "0,0,1:-270", "--about", "centre", "-o", "c.octree"});
  EXPECT_EQ(bounds("c.octree"), json::parse("[[804,100,300],[824,110,330]]"));
  done({"move", "b.octree", "--rotate", "0,0,2:90", "--about", "512,512,0", "-o", "p.octree"});
  EXPECT_EQ(bounds("p.octree"), json::parse("[[804,100,300],[824,110,330]]"));
  // About its own centroid (105, 210, 315) a box of sides 10, 20, 30 trades the first two.
  done({"move", "b.octree", "--rotate", "0,0,1:90", "--about", "centroid", "-o", "o.octree"});
  EXPECT_EQ(bounds("o.octree"), json::parse("[[95,205,300],[115,215,330]]"));
}

TEST_F(Commands, RotationsApplyInOrderAndTranslationsMayBeNegative) {
  make_box("b.octree", 4, {1, 2, 3}, {2, 4, 6});
  // About the centre of 16: z by 90: (x,y) -> (16-y, x); then x by 90: (y,z) -> (16-z, y).
  done({"move", "b.octree", "--rotate", "0,0,1:90", "--rotate", "1,0,0:90", "--about", "centre", "--translate",
        "-2,0,-1", "-o", "m.octree"});
  EXPECT_EQ(bounds("m.octree"), json::parse("[[10,10,0],[12,13,1]]"));
  // Three thirds of a turn, written as one option each, are the identity.
  done({"move", "b.octree", "--rotate", "1,1,1:120", "--rotate", "1,1,1:120", "--rotate=1,1,1:120", "-o", "i.octree"});
  EXPECT_EQ(bounds("i.octree"), bounds("b.octree"));
}

TEST_F(Commands, MoveReflects) {
  make_box("b.octree", 4, {1, 2, 3}, {2, 4, 6});
  done({"move", "b.octree", "--reflect", "x", "-o", "m.octree"});  // about the centre
  EXPECT_EQ(bounds("m.octree"), json::parse("[[14,2,3],[15,4,6]]"));
  EXPECT_EQ(info("m.octree")["frame"], info("b.octree")["frame"]);
  EXPECT_EQ(info("m.octree")["metadata"]["options"]["reflect"], "x");
  done({"move", "b.octree", "--reflect", "y,z", "--about", "2.5,3,4.5", "-o", "m.octree"});
  EXPECT_EQ(bounds("m.octree"), bounds("b.octree"));
  done({"move", "b.octree", "--reflect", "y", "--about", "0,3.5,0", "-o", "m.octree"});
  EXPECT_EQ(bounds("m.octree"), json::parse("[[1,3,3],[2,5,6]]"));
  // First the reflection, (15,2,3) to (14,4,6), then the quarter turn about the centre, then the translation.
  done({"move", "b.octree", "--rotate", "0,0,1:90", "--reflect", "x", "--about", "centre", "--translate", "0,0,2", "-o",
        "m.octree"});
  EXPECT_EQ(bounds("m.octree"), json::parse("[[12,14,5],[14,15,8]]"));
  refused({"move", "b.octree", "--reflect", "x", "--about", "corner", "-o", "n.octree"}, "2 voxels below x = 0");
  for (const std::string axes : {"", "q", "x,", "x,x", "xy", "x;y", "z,y,x,z"})
    refused({"move", "b.octree", "--reflect", axes, "-o", "n.octree"}, "names no axes");
}

TEST_F(Commands, MoveByMatrix) {
  make_box("b.octree", 4, {1, 2, 3}, {2, 4, 6});
  write("m.txt", "0 -1 0 16\n1 0 0 0\n0 0 1 0\n0 0 0 1\n");
  done({"move", "b.octree", "--matrix", "m.txt", "-o", "m.octree"});
  EXPECT_EQ(bounds("m.octree"), json::parse("[[12,1,3],[14,2,6]]"));
  write("m.json", "[[0,-1,0,0],[1,0,0,0],[0,0,1,0],[0,0,0,1]]");
  done({"move", "b.octree", "--matrix", "m.json", "--about", "centre", "-o", "m.octree"});
  EXPECT_EQ(bounds("m.octree"), json::parse("[[12,1,3],[14,2,6]]"));
}

TEST_F(Commands, MoveStatsAreTheRowOfTable2) {
  make_box("b.octree", 5, {0, 0, 0}, {16, 16, 16});
  const json report = done({"move", "b.octree", "--translate", "1,0,0", "--stats", "--json", "-o", "m.octree"}).json();
  EXPECT_EQ(report["stats"]["source"]["black_leaves"], 1);
  EXPECT_EQ(report["stats"]["source"]["internal_nodes"], 1);
  EXPECT_EQ(report["stats"]["target"]["volume"], 4096);
  const json moved = info("m.octree");
  EXPECT_EQ(report["stats"]["target"]["black_leaves"], moved["black_leaves"]);
  EXPECT_EQ(report["stats"]["target"]["internal_nodes"], moved["internal_nodes"]);
  EXPECT_EQ(report["stats"]["target"]["peak_internal_nodes"], moved["internal_nodes"]);
  EXPECT_EQ(report["stats"]["target"]["internal_nodes_per_voxel"].get<double>(),
            moved["internal_nodes"].get<double>() / 4096);
  const std::string text = done({"move", "b.octree", "--translate", "0,0,0", "--stats", "-o", "m.octree"}).out;
  EXPECT_NE(text.find("I/V"), std::string::npos);
  EXPECT_EQ(lines(text), 4u);
}

TEST_F(Commands, LeavingTheUniverseSaysByHowMuchAndWhere) {
  make_box("b.octree", 4, {3, 4, 5}, {6, 7, 8});
  refused({"translate", "b.octree", "-5,0,0", "-o", "t.octree"}, "2 voxels below x = 0");
  refused({"translate", "b.octree", "0,12,0", "-o", "t.octree"}, "y = 16");
  refused({"move", "b.octree", "--translate", "0,0,10", "-o", "t.octree"}, "z = 16");
  refused({"move", "b.octree", "--translate", "1e300,0,0", "-o", "t.octree"}, "");
  done({"move", "b.octree", "--translate", "0,0,10", "--clip", "-o", "t.octree"});
  EXPECT_EQ(info("t.octree")["volume"], 9);
}

TEST_F(Commands, CombineKnowsFourOperations) {
  make_box("a.octree", 4, {0, 0, 0}, {4, 4, 4});
  make_box("b.octree", 4, {2, 0, 0}, {6, 4, 4});
  const auto volume = [&](const std::string& operation) {
    return done({"combine", "a.octree", operation, "b.octree", "-o", "c.octree", "--json"}).json()["volume"].get<int>();
  };
  EXPECT_EQ(volume("and"), 32);
  EXPECT_EQ(volume("or"), 96);
  EXPECT_EQ(volume("minus"), 32);
  EXPECT_EQ(volume("xor"), 64);
  EXPECT_EQ(info("c.octree")["metadata"]["options"]["with"], "b.octree");
}

TEST_F(Commands, CombineWarnsOfDifferentFramesAndRefusesDifferentDepths) {
  make_box("a.octree", 4, {0, 0, 0}, {4, 4, 4});
  Frame frame;
  frame.origin[0] = 7;
  save(box(4, {2, 0, 0}, {6, 4, 4}, frame), folder() / "b.octree");
  const Result result = run({"combine", "b.octree", "or", "a.octree", "-o", "c.octree"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(lines(result.err), 1u);
  EXPECT_NE(result.err.find("warning: 'b.octree' and 'a.octree' have different frames"), std::string::npos);
  EXPECT_EQ(info("c.octree")["frame"], info("b.octree")["frame"]);
  make_box("d.octree", 5, {0, 0, 0}, {4, 4, 4});
  refused({"combine", "a.octree", "or", "d.octree", "-o", "e.octree"},
          "'a.octree' has depth 4 and 'd.octree' has depth 5");
  refused({"combine", "a.octree", "plus", "b.octree", "-o", "e.octree"}, "'plus'");
}

TEST_F(Commands, CurveBothWays) {
  EXPECT_EQ(done({"curve", "--order", "2", "30"}).out, "0 1 3\n");
  EXPECT_EQ(done({"curve", "--order", "2", "--inverse", "0,1,3"}).out, "30\n");
  EXPECT_EQ(done({"curve", "30", "0", "--order", "2"}).out, "0 1 3\n0 0 0\n");
  EXPECT_EQ(done({"curve", "--order", "20", "--inverse", "1048575,1048575,0", "--json"}).json()["points"][0]["voxel"],
            json::parse("[1048575,1048575,0]"));
  EXPECT_EQ(done({"curve", "--order", "2", "--json", "30"}).json(),
            json::parse(R"({"order":2,"points":[{"number":30,"voxel":[0,1,3]}]})"));
  EXPECT_EQ(done({"curve", "--order", "2", "-"}, "30\n0\n").out, "0 1 3\n0 0 0\n");
  std::vector<std::string> words = {"curve", "--order", "1", "--inverse"};
  for (const char* number : {"0", "1", "2", "3", "4", "5", "6", "7"}) {
    std::string voxel = done({"curve", "--order", "1", number}).out;
    for (char& c : voxel) c = c == ' ' ? ',' : c;
    words.push_back(voxel.substr(0, 5));
  }
  EXPECT_EQ(done(words).out, "0\n1\n2\n3\n4\n5\n6\n7\n");
}

TEST_F(Commands, CurveRefusesWhatIsOutside) {
  refused({"curve", "--order", "2", "64"}, "node number is '64'");
  refused({"curve", "--order", "2", "-1"}, "node number is '-1'");
  refused({"curve", "--order", "2", "1.5"}, "node number is '1.5'");
  refused({"curve", "--order", "2", "--inverse", "0,4,0"}, "voxel 0,4,0 is outside");
  refused({"curve", "--order", "2", "--inverse", "-1,0,0"}, "voxel -1,0,0 is outside");
  refused({"curve", "--order", "2", "--inverse", "1,2"}, "voxel is '1,2'");
  refused({"curve", "--order", "0", "1"}, "--order");
  refused({"curve", "--order", "21", "1"}, "--order");
  refused({"curve", "1"}, "--order");
  refused({"curve", "--order", "2"}, "ITEM");
}

TEST_F(Commands, VerifyTellsWholeFromDamaged) {
  make_box("b.octree", 6, {3, 4, 5}, {46, 37, 58});
  EXPECT_EQ(done({"verify", "b.octree", "--json"}).json(),
            json::parse(R"({"file":"b.octree","ok":true,"problem":null})"));
  EXPECT_NE(done({"verify", "b.octree"}).out.find("b.octree: ok, depth 6"), std::string::npos);
  const std::string whole = read("b.octree");
  // Bytes all over the file, one at a time, upside down: never "ok". The first four decide what the file is.
  for (std::size_t at = 0; at < whole.size(); at += at < 16 ? 1 : 13) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(~damaged[at]);
    write("d.octree", damaged);
    const Result result = run({"verify", "d.octree", "--json"});
    EXPECT_EQ(result.code, at < 4 ? 2 : 1) << "byte " << at;
    if (at < 4) continue;
    EXPECT_EQ(result.json()["ok"], false);
    EXPECT_NE(result.json()["problem"].get<std::string>().find("d.octree"), std::string::npos);
  }
  write("d.octree", whole.substr(0, whole.size() / 2));
  const Result result = run({"verify", "d.octree"});
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.out.find("damaged: d.octree"), std::string::npos) << result.out;
  EXPECT_EQ(run({"verify", "d.octree", "--quiet"}).out, "");
  refused({"verify", "none.octree"}, "none.octree");
  write("text.octree", "hello, this is a text\n");
  refused({"verify", "text.octree"}, "text.octree");
  write("empty.octree", "");
  refused({"verify", "empty.octree"}, "empty.octree");
}

}  // namespace
}  // namespace blackleaf::test
