// blackleaf draw in perspective: --eye, --target, --fov.
#include <cmath>
#include <map>

#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

using nlohmann::json;

class EyePictures : public CliTest {
 protected:
  EyePictures() {
    make_box("b.octree", 4, {4, 4, 4}, {12, 12, 12});
    make_box("c.octree", 4, {4, 4, 12}, {12, 12, 14});  // on top of it
  }

  json drawn(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "draw");
    arguments.insert(arguments.end(), {"-o", "-", "--format", "json"});
    return json::parse(done(arguments).out);
  }
  std::map<std::string, std::size_t> layers(const std::vector<std::string>& arguments) const {
    std::map<std::string, std::size_t> counts;
    const json picture = drawn(arguments);
    for (const json& layer : picture.at("layers")) counts[layer["name"]] = layer["strokes"].size();
    return counts;
  }
};

TEST_F(EyePictures, FrontFaceInItsTrueSize) {
  const json picture = drawn({"b.octree", "--eye", "8,-8,8", "--target", "8,4,8"});
  EXPECT_EQ(picture["eye"], json({8, -8, 8}));
  EXPECT_EQ(picture["target"], json({8, 4, 8}));
  EXPECT_EQ(picture["view"], json({0, -1, 0}));
  ASSERT_EQ(picture["strokes"].size(), 4u);
  for (const json& stroke : picture["strokes"])
    for (const json& point : stroke)
      for (const json& coordinate : point) EXPECT_EQ(std::abs(coordinate.get<double>()), 4);
  // Without a target, the middle of the solid.
  EXPECT_EQ(drawn({"b.octree", "--eye", "8,-8,9"})["target"], json({8, 8, 8}));
}

TEST_F(EyePictures, HiddenLinesAndSeveralSolids) {
  EXPECT_EQ(layers({"b.octree", "--eye", "30,-40,20", "--hidden", "dashed", "--outline-width", "0.5"}),
            (std::map<std::string, std::size_t>{{"hidden", 3}, {"outline", 6}, {"visible", 3}}));
  const auto both = layers({"b.octree", "c.octree", "--eye", "30,-40,20"});
  EXPECT_EQ(both.at("b.octree visible"), 7u);
  EXPECT_EQ(both.at("c.octree visible"), 7u);
}

// A cut takes away what lies on the eye's side of the plane, and with it what the eye is in.
TEST_F(EyePictures, Cuts) {
  refused({"draw", "b.octree", "--eye", "8,5,8", "-o", "p.svg"}, "the eye is in or on the solid");
  EXPECT_EQ(layers({"b.octree", "--eye", "8,5,8", "--target", "8,8,8", "--cut", "y=7", "--fov", "150"}).at("visible"),
            4u);
  refused({"draw", "b.octree", "--eye", "8,-5,8", "--cut", "y=7,z=8", "-o", "p.svg"}, "--eye sees the plane edge-on");
}

TEST_F(EyePictures, PagesTellTheEye) {
  for (const char* name : {"s.svg", "s.pdf", "s.png", "s.hpgl", "s.dxf"})
    done({"draw", "b.octree", "--eye", "30,-40.5,20", "--hidden", "dashed", "-o", name});
  EXPECT_NE(read("s.svg").find("eye=\"30 -40.5 20\" target=\"8 8 8\""), std::string::npos);
  const json report = done({"draw", "b.octree", "--eye", "30,-40.5,20", "-o", "s.svg", "--json"}).json();
  EXPECT_EQ(report["eye"], json({30, -40.5, 20}));
  EXPECT_EQ(report["strokes"], 9);
}

TEST_F(EyePictures, Refuses) {
  const auto with_eye = [&](std::vector<std::string> more, const std::string& part) {
    more.insert(more.begin(), {"draw", "b.octree", "--eye", "30,-40,20", "-o", "p.svg"});
    refused(more, part);
  };
  with_eye({"--view", "1,2,3"}, "--eye and --view are two views");
  with_eye({"--sheet"}, "--eye and --sheet are two views");
  with_eye({"--hatch"}, "--hatch is for --view and --sheet");
  with_eye({"--cut", "x=5", "--hatch-spacing", "2mm"}, "--hatch-spacing is for --view");
  with_eye({"--outline-width", "1", "--outline-gap", "3"}, "--outline-gap is for --view");
  with_eye({"--fov", "175"}, "from 1 to 170 degrees");
  with_eye({"--fov", "0"}, "--fov");
  with_eye({"--target", "30,-40,20"}, "the same point");
  with_eye({"--target", "1,2"}, "--target");
  with_eye({"--target", "1,2,1e9"}, "16777216 voxels");
  refused({"draw", "b.octree", "--eye", "nan,0,0", "-o", "p.svg"}, "--eye");
  refused({"draw", "b.octree", "--eye", "x", "-o", "p.svg"}, "--eye");
  refused({"draw", "b.octree", "--view", "1,2,3", "--target", "1,2,3", "-o", "p.svg"}, "--target belongs to --eye");
  refused({"draw", "b.octree", "--view", "1,2,3", "--fov", "60", "-o", "p.svg"}, "--fov belongs to --eye");
  refused({"draw", "b.octree", "-o", "p.svg"}, "--eye, or --sheet");
}

}  // namespace
}  // namespace blackleaf::test
