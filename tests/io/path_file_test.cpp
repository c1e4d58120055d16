#include "blackleaf/path_file.h"

#include <gtest/gtest.h>

#include "blackleaf/error.h"
#include "file/temporary_folder.h"
#include "reference/paths.h"

namespace blackleaf {
namespace {

TEST(PathFile, ComesBackAsItWas) {
  std::mt19937 random(70);
  const test::TemporaryFolder folder;
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const Path path = reference::random_path(6, random);
    PathNotes notes;
    if (trial % 2) {
      notes.clearance.assign(path.poses().size(), 1.25);
      notes.length = 17.5;
      notes.planner = "a \"planner\"\n";
      notes.seconds = 0.1;
      notes.verified = trial % 4 == 1;
    }
    write_path(path, folder / "path.json", notes);
    const PathFile back = read_path(folder / "path.json");
    EXPECT_EQ(back.path.about(), path.about());
    ASSERT_EQ(back.path.poses().size(), path.poses().size());
    for (std::size_t i = 0; i < path.poses().size(); ++i) {
      const Pose &a = path.poses()[i], &b = back.path.poses()[i];
      EXPECT_EQ(a.time, b.time);
      EXPECT_EQ(a.translation, b.translation);
      EXPECT_LT((a.rotation.coeffs() - b.rotation.coeffs()).norm(), 1e-15);  // normalised once more
    }
    EXPECT_EQ(back.notes.clearance, notes.clearance);
    EXPECT_EQ(back.notes.length, notes.length);
    EXPECT_EQ(back.notes.planner, notes.planner);
    EXPECT_EQ(back.notes.seconds, notes.seconds);
    EXPECT_EQ(back.notes.verified, notes.verified);
  }
}

TEST(PathFile, PosesMayBeShort) {
  const PathFile file =
      path_from_json(R"({"author": "me", "poses": [{"time": 1}, {"time": 2, "translation": [1, 2, 3]}]})", "short");
  EXPECT_EQ(file.path.poses().size(), 2u);
  EXPECT_EQ(file.path.poses()[1].translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(file.path.poses()[1].rotation.w(), 1);
  EXPECT_EQ(file.path.about(), Eigen::Vector3d::Zero());
}

TEST(PathFile, RefusesInOneLineWhatIsNoPath) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "p.json: is not JSON: line 1"},
      {"{\n\"poses\": [}", "p.json: is not JSON: line 2"},
      {"[]", "p.json: the file is no table"},
      {"{}", "p.json: poses is missing"},
      {R"({"poses": []})", "p.json: poses is no list"},
      {R"({"poses": {"time": 0}})", "p.json: poses is no list"},
      {R"({"poses": [7]})", "p.json: poses[0] is 7"},
      {R"({"poses": [{}]})", "p.json: poses[0].time is missing"},
      {R"({"poses": [{"time": "now"}]})", "p.json: poses[0].time is \"now\""},
      {R"({"poses": [{"time": 0}, {"time": 1, "translation": [1, 2]}]})", "p.json: poses[1].translation is [1,2]"},
      {R"({"poses": [{"time": 0, "translation": [1, 2, "3"]}]})", "p.json: poses[0].translation"},
      {R"({"poses": [{"time": 0, "rotation": [1, 0, 0]}]})", "p.json: poses[0].rotation is [1,0,0]"},
      {R"({"about": [0, 0, 0], "poses": [{"time": 0, "rotation": [1, 1, 0, 0]}]})",
       "p.json: poses[0].rotation has length"},
      {R"({"poses": [{"time": 0, "rotation": [0, 1, 0, 0]}]})", "p.json: about is missing, though poses turn"},
      {R"({"about": "centre", "poses": [{"time": 0}]})", "p.json: about is \"centre\""},
      {R"({"poses": [{"time": 0, "rotatoin": [0, 1, 0, 0]}]})", "p.json: poses[0].rotatoin is unknown; use time"},
      {R"({"poses": [{"time": 3}, {"time": 3}]})", "p.json: poses[1].time is not after"},
      {R"({"poses": [{"time": 1e999}]})", "p.json: has a number beyond floating point"},
      {R"({"poses": [{"time": 1e99}]})", "p.json: poses[0].time is out of range"},
      {R"({"poses": [{"time": 0, "clearance": 1}, {"time": 1}]})", "p.json: poses have a clearance here and there"},
      {R"({"length": [], "poses": [{"time": 0}]})", "p.json: length is []"},
      {R"({"planner": 3, "poses": [{"time": 0}]})", "p.json: planner is 3"},
      {R"({"verified": 1, "poses": [{"time": 0}]})", "p.json: verified is 1"},
      {"{\"poses\": " + std::string(100, '[') + std::string(100, ']') + "}", "p.json: is nested too deeply"},
  };
  for (const auto& [text, part] : cases) {
    SCOPED_TRACE(text);
    try {
      path_from_json(text, "p.json");
      ADD_FAILURE() << "taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_THROW(read_path("/nowhere/path.json"), Error);
}

}  // namespace
}  // namespace blackleaf
