// blackleaf collide: exit status, numbers and both modes.
#include <cmath>

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
  EXPECT_EQ(ask(exact), json::parse(R"({"interferes":true,"overlap_volume":null,"distance":null,"mode":"exact"})"));
  EXPECT_EQ(ask(motion)["interferes"], false);
  exact[5] = "-3.1,-8,-4";  // the corner stays 0.07 outside
  EXPECT_EQ(ask(exact)["interferes"], false);
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

TEST_F(Collide, Refusals) {
  make_box("deep.octree", 6, {0, 0, 0}, {8, 8, 8});
  refused({"collide", "a.octree", "deep.octree"}, "'a.octree' has depth 5 and 'deep.octree' has depth 6");
  refused({"collide", "a.octree"}, "B is required");
  refused({"collide", "-", "-"}, "standard input");
  refused({"collide", "a.octree", "none.octree"}, "none.octree");
}

}  // namespace
}  // namespace blackleaf::test
