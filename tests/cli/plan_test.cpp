// blackleaf plan, as a user runs it.
#include <chrono>
#include <csignal>

#include "blackleaf/implicit.h"
#include "blackleaf/octree_file.h"
#include "blackleaf/path_file.h"
#include "blackleaf/plan.h"
#include "blackleaf/resample.h"
#include "blackleaf/set_operations.h"
#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

using nlohmann::json;

class PlanCommand : public CliTest {
 protected:
  PlanCommand() {
    save(wall_, folder() / "wall.octree");
    make_box("board.octree", 5, {3, 15, 8}, {9, 17, 24});
  }

  std::vector<std::string> command(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"plan",  "--environment", "wall.octree", "--object", "board.octree", "--start",
                                      "0,0,0", "--goal",        "20,0,0",      "-o",       "way.json"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  // A wall with a slot that the board passes lying down only.
  const Octree wall_ = subtract(box(5, {15, 0, 0}, {17, 32, 32}), box(5, {15, 6, 13}, {17, 26, 18}));
};

TEST_F(PlanCommand, WritesThePathOfTheLibrary) {
  const Result told = done(command());
  const PathFile file = read_path(folder() / "way.json");
  const Octree board = box(5, {3, 15, 8}, {9, 17, 24});
  const Plan expected = plan(wall_, board, {}, {0, {20, 0, 0}, Eigen::Quaterniond::Identity()});
  ASSERT_EQ(file.path.poses().size(), expected.path->poses().size());
  for (std::size_t i = 0; i < file.path.poses().size(); ++i) {
    EXPECT_TRUE(file.path.poses()[i].translation == expected.path->poses()[i].translation);
    EXPECT_EQ(file.notes.clearance[i], expected.clearance[i]);
  }
  EXPECT_EQ(file.notes.length, expected.length);
  EXPECT_EQ(file.notes.planner, "rrt-connect");
  EXPECT_EQ(file.notes.verified, true);
  EXPECT_GT(*file.notes.seconds, 0);
  EXPECT_TRUE(path_is_clear(wall_, board, file.path));
  EXPECT_TRUE(told.out.starts_with("way.json: " + std::to_string(file.path.poses().size()) + " poses, ")) << told.out;
  EXPECT_TRUE(told.out.ends_with(" voxels clear at its poses, verified\n")) << told.out;
  // The other commands take it.
  done({"sweep", "board.octree", "--path", "way.json", "-o", "swept.octree"});
  EXPECT_TRUE(intersect(load(folder() / "swept.octree").octree, wall_).is_empty());
}

TEST_F(PlanCommand, ReportsAsJson) {
  const json report = done(command({"--json", "--seed", "3", "--planner", "kpiece", "--speed", "2.5"})).json();
  EXPECT_EQ(report["output"], "way.json");
  EXPECT_EQ(report["found"], true);
  EXPECT_EQ(report["verified"], true);
  EXPECT_EQ(report["planner"], "kpiece");
  EXPECT_EQ(report["seed"], 3);
  EXPECT_GT(report["clearance"], 0);
  EXPECT_NEAR(report["duration"].get<double>(), report["length"].get<double>() / 2.5, 1e-6);
  const json file = json::parse(read("way.json"));
  EXPECT_EQ(file["poses"].size(), report["poses"]);
  EXPECT_EQ(file["poses"][0]["time"], 0);
  EXPECT_EQ(file["verified"], true);
  // The same again but for the time it took.
  json first = file,
       again = json::parse(done(command({"--seed", "3", "--planner", "kpiece", "--speed", "2.5"})).out.empty()
                               ? "{}"
                               : read("way.json"));
  first.erase("seconds");
  again.erase("seconds");
  EXPECT_EQ(first, again);
  // On standard output the path itself.
  std::vector<std::string> words = command({"--quiet"});
  words[10] = "-";
  EXPECT_EQ(json::parse(done(words).out)["planner"], "rrt-connect");
}

TEST_F(PlanCommand, SaysHowNearItCame) {
  save(box(5, {15, 0, 0}, {17, 32, 32}), folder() / "wall.octree");
  const auto before = files();
  const Result none = run(command({"--time-limit", "0.3"}));
  EXPECT_EQ(none.code, 1);
  EXPECT_EQ(none.err, "");
  EXPECT_TRUE(none.out.starts_with("no path for 'board.octree' was found within 0.3 s; the nearest way ends "))
      << none.out;
  const Result report = run(command({"--time-limit", "0.3", "--json"}));
  EXPECT_EQ(report.code, 1);
  EXPECT_EQ(report.json()["found"], false);
  EXPECT_GT(report.json()["missing"], 1);
  EXPECT_FALSE(report.json()["nearest"].empty());
  EXPECT_EQ(files(), before) << "nothing that could be taken for a path";
}

TEST_F(PlanCommand, SeveralObjectsGiveWay) {
  make_box("a.octree", 5, {1, 4, 4}, {5, 8, 8});
  make_box("b.octree", 5, {26, 4, 4}, {30, 8, 8});
  save(Octree(5), folder() / "room.octree");
  const std::vector<std::string> both = {"plan",    "--environment", "room.octree", "--object", "a.octree",
                                         "--start", "0,0,0",         "--goal",      "25,0,0",   "-o",
                                         "a.json",  "--object",      "b.octree",    "--start",  "0,0,0",
                                         "--goal",  "-25,0,0",       "-o",          "b.json",   "--json"};
  const json report = done(both).json();
  EXPECT_EQ(report["paths"].size(), 2u);
  const std::vector<Mover> movers{{box(5, {1, 4, 4}, {5, 8, 8}), read_path(folder() / "a.json").path}};
  const Path b = read_path(folder() / "b.json").path;
  EXPECT_TRUE(path_is_clear(Octree(5), box(5, {26, 4, 4}, {30, 8, 8}), b, 0, movers));
  // The same with the first one's file.
  const json alone = done({"plan", "--environment", "room.octree", "--object", "b.octree", "--start", "0,0,0", "--goal",
                           "-25,0,0", "-o", "c.json", "--moving", "a.octree", "--along", "a.json", "--json"})
                         .json();
  EXPECT_EQ(alone["length"], report["paths"][1]["length"]);
  std::vector<std::string> fewer = both;
  fewer.resize(17);
  fewer.push_back("--json");
  refused(fewer, "there are 2 --objects but 1 -o");
}

TEST_F(PlanCommand, PlacesSolidsByTheirFrames) {
  // The board in a universe of its own, whose corner lies at (2, 14, 7) of the wall's.
  Frame frame;
  frame.origin = {2, 14, 7};
  save(box(5, {1, 1, 1}, {7, 3, 17}, frame), folder() / "own.octree");
  std::vector<std::string> words = command();
  done(words);
  words[4] = "own.octree";
  words[10] = "own.json";
  done(words);
  const Path by_board = read_path(folder() / "way.json").path, by_own = read_path(folder() / "own.json").path;
  ASSERT_EQ(by_board.poses().size(), by_own.poses().size());
  EXPECT_LT((by_board.about() - by_own.about() - frame.origin).norm(), 1e-9);
  // Voxels of half the size.
  frame.axes *= 0.5;
  save(box(6, {2, 2, 2}, {14, 6, 34}, frame), folder() / "fine.octree");
  words[4] = "fine.octree";
  words[10] = "fine.json";
  refused(words, "'wall.octree' has voxels of 1 voxel and 'fine.octree' of 0.5 voxel");
  words.insert(words.end(), {"--resample", "coarse.octree"});
  done(words);
  EXPECT_TRUE(load(folder() / "coarse.octree").octree == load(folder() / "board.octree").octree);
  EXPECT_EQ(read_path(folder() / "fine.json").path.poses().size(), by_board.poses().size());
  frame = {};
  frame.origin = {0.5, 0, 0};
  save(box(5, {1, 1, 1}, {7, 3, 17}, frame), folder() / "between.octree");
  words = command();
  words[4] = "between.octree";
  refused(words, "do not lie on each other");
  frame.origin = {100, 0, 0};
  save(box(5, {1, 1, 1}, {7, 3, 17}, frame), folder() / "away.octree");
  words[4] = "away.octree";
  refused(words, "'away.octree' does not lie in the universe of 'wall.octree'");
}

TEST_F(PlanCommand, Refuses) {
  const auto with = [&](std::size_t at, const std::string& text) {
    std::vector<std::string> words = command();
    words[at] = text;
    return words;
  };
  refused(with(6, "10,0,0"), "at the start the object interferes with the environment: ");
  refused(with(8, "30,0,0"), "at the goal the object is outside the universe: 7 voxels beyond x = 32");
  refused(with(8, "20,0"), "--goal is '20,0', which is no pose; write x,y,z or x,y,z@x,y,z:degrees");
  refused(with(6, "0,0,0@0,0,1"), "--start is '0,0,0@0,0,1', which is no pose");
  refused(with(10, "way.octree"), "'way.octree' would be a path, which is JSON");
  refused(with(10, "none/way.json"), "there is no folder 'none'");
  refused(with(4, "none.octree"), "there is no file 'none.octree'");
  refused(command({"--planner", "a-star"}), "--planner is 'a-star', which is no planner");
  refused(command({"--time-limit", "0"}), "--time-limit is '0'");
  refused(command({"--seed", "-1"}), "--seed is '-1'");
  refused(command({"--object", "board.octree"}), "there are 2 --objects but 1 --start");
  refused(command({"--moving", "board.octree", "--along", "none.json"}), "there is no file 'none.json'");
  refused(command({"--moving", "board.octree", "--along", "board.octree"}), "is not JSON");
  refused({"plan", "--environment", "wall.octree"}, "required");
  make_box("deep.octree", 6, {0, 0, 40}, {4, 4, 44});
  refused(with(4, "deep.octree"), "'deep.octree' does not lie in the universe of 'wall.octree'");
}

}  // namespace
}  // namespace blackleaf::test
