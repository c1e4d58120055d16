// blackleaf draw of several solids: files, labels, steps of a path, hidden lines, outlines, hatching, cuts.
#include <cmath>
#include <map>

#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

using nlohmann::json;

class ScenePictures : public CliTest {
 protected:
  ScenePictures() {
    make_box("b.octree", 4, {4, 4, 4}, {10, 10, 10});
    make_box("c.octree", 4, {4, 4, 10}, {10, 10, 13});  // on top of it
  }

  // Layers of a picture in voxels by name, as their strokes.
  std::map<std::string, json> layers(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "draw");
    arguments.insert(arguments.end(), {"-o", "-", "--format", "json"});
    std::map<std::string, json> found;
    const json picture = json::parse(done(arguments).out);
    for (const json& layer : picture.at("layers")) found[layer["name"]] = layer["strokes"];
    return found;
  }
  static double length(const json& strokes) {
    double sum = 0;
    for (const json& s : strokes)
      sum += std::hypot(s[1][0].get<double>() - s[0][0].get<double>(), s[1][1].get<double>() - s[0][1].get<double>());
    return sum;
  }
};

TEST_F(ScenePictures, FilesHaveLayersAndPens) {
  const auto both = layers({"b.octree", "c.octree", "--view", "3,-4,2"});
  ASSERT_EQ(both.size(), 2u);
  // The edges of the face where they touch are edges of both, and the first file's. Of the lower cube the lower front
  // edges, three upright ones and those two; of the upper one its top and three upright ones.
  EXPECT_EQ(both.at("b.octree visible").size(), 7u);
  EXPECT_EQ(both.at("c.octree visible").size(), 7u);
  const std::string svg =
      done({"draw", "b.octree", "c.octree", "--view", "3,-4,2", "--pen", "red:0.7", "-o", "-", "--format", "svg"}).out;
  EXPECT_NE(svg.find("inkscape:label=\"b.octree visible\""), std::string::npos);
  EXPECT_NE(svg.find("stroke=\"#d55e00\" stroke-linecap=\"round\" stroke-linejoin=\"round\" stroke-width=\"0.7\""),
            std::string::npos);
  EXPECT_NE(svg.find("stroke=\"#0072b2\""), std::string::npos);
  EXPECT_NE(svg.find("b.octree, c.octree"), std::string::npos);
  refused({"draw", "b.octree", "c.octree", "--view", "1,2,3", "--pen", "red", "--pen", "red", "--pen", "red", "-o",
           "p.svg"},
          "--pen is given 3 times for 2 solids");
  refused({"draw", "b.octree", "--view", "1,2,3", "--pen", "3=red", "-o", "p.svg"}, "no solid has label 3");
  refused({"draw", "-", "-", "--view", "1,2,3", "-o", "p.svg"}, "more than one octree is -");
  for (const char* name : {"s.svg", "s.pdf", "s.png", "s.hpgl", "s.dxf", "s.json"})
    done({"draw", "b.octree", "c.octree", "--sheet", "--hidden", "dashed", "--outline-width", "0.5", "--hatch", "--cut",
          "x=7", "-o", name});
}

TEST_F(ScenePictures, HiddenLines) {
  // A cube has twelve edges, nine of them visible.
  const auto dashed = layers({"b.octree", "--view", "3,-4,2", "--hidden", "dashed"});
  EXPECT_EQ(dashed.at("visible").size(), 9u);
  EXPECT_EQ(dashed.at("hidden").size(), 3u);
  const auto only = layers({"b.octree", "--view", "3,-4,2", "--hidden", "only"});
  EXPECT_EQ(only, (std::map<std::string, json>{{"hidden", dashed.at("hidden")}}));
  const std::string svg =
      done({"draw", "b.octree", "--view", "3,-4,2", "--hidden", "dashed", "-o", "-", "--format", "svg"}).out;
  EXPECT_NE(svg.find("stroke-dasharray"), std::string::npos);
  refused({"draw", "b.octree", "--view", "1,2,3", "--hidden", "some", "-o", "p.svg"}, "use dashed, none or only");
  refused({"draw", "b.octree", "--view", "1,2,3", "--hidden", "only", "--hatch", "-o", "p.svg"}, "leaves nothing for");
}

TEST_F(ScenePictures, Outlines) {
  const auto lines = layers({"b.octree", "--view", "3,-4,2", "--outline-width", "0.7"});
  EXPECT_EQ(lines.at("outline").size(), 6u);
  EXPECT_EQ(lines.at("visible").size(), 3u);
  const json picture = json::parse(
      done({"draw", "b.octree", "--view", "3,-4,2", "--outline-width", "0.7", "-o", "-", "--format", "json"}).out);
  EXPECT_EQ(picture["layers"][1]["name"], "outline");
  EXPECT_EQ(picture["layers"][1]["width"], 0.7);
  refused({"draw", "b.octree", "--view", "1,2,3", "--outline-width", "0", "-o", "p.svg"}, "--outline-width");
  refused({"draw", "b.octree", "--view", "1,2,3", "--outline-gap", "3", "-o", "p.svg"}, "belongs to --outline-width");
  refused({"draw", "b.octree", "--view", "1,2,3", "--outline-width", "1", "--outline-gap", "0", "-o", "p.svg"},
          "--outline-gap");
}

TEST_F(ScenePictures, HatchingAndCuts) {
  // From the front only faces across y are seen: 36 square voxels of them.
  const auto front = layers({"b.octree", "--view", "0,-1,0", "--hatch", "--hatch-spacing", "0.5voxels"});
  EXPECT_NEAR(length(front.at("hatch")) * 0.5 * 1.75, 36, 1.5);
  EXPECT_EQ(front.at("visible").size(), 4u);
  const auto cut = layers({"b.octree", "--view", "1,-1,1", "--cut", "x=7", "--hatch-spacing", "0.5voxels"});
  EXPECT_NEAR(length(cut.at("cut")) * 0.35, 36 / std::sqrt(3.0), 1.5);
  EXPECT_EQ(cut.at("visible").size(), 9u);
  EXPECT_EQ(cut.count("hatch"), 0u);
  // A quarter taken out leaves more edges than two halves taken away.
  const auto strokes = [&](std::vector<std::string> cuts) {
    cuts.insert(cuts.begin(), {"b.octree", "--view", "1,-1,1"});
    return layers(cuts).at("visible").size();
  };
  EXPECT_EQ(strokes({"--cut", "x=7", "--cut", "y=7"}), 9u);
  EXPECT_GT(strokes({"--cut", "x=7,y=7"}), 9u);
  for (const char* plane : {"", "x", "x=", "w=3", "x=1.5", "x=-1", "x=3,", "x=3,x=4", "x=3;y=4"})
    refused({"draw", "b.octree", "--view", "1,2,3", "--cut", plane, "-o", "p.svg"}, "--cut");
  refused({"draw", "b.octree", "--view", "0,-1,0", "--cut", "x=3", "-o", "p.svg"}, "edge-on");
  refused({"draw", "b.octree", "--view", "1,2,3", "--hatch-spacing", "1", "-o", "p.svg"},
          "belongs to --hatch or --cut");
  for (const char* spacing : {"", "0", "-1", "1cm", "mm", "1e-9", "nan"})
    refused({"draw", "b.octree", "--view", "1,2,3", "--hatch", "--hatch-spacing", spacing, "-o", "p.svg"}, "");
  refused({"draw", "b.octree", "--view", "1,2,3", "--hatch", "--hatch-spacing", "1mm", "-o", "p.json"}, "in voxels");
  // Nothing is left: an empty drawing and a warning.
  const Result empty = run({"draw", "b.octree", "--view", "1,2,3", "--cut", "x=0", "-o", "p.svg"});
  EXPECT_EQ(empty.code, 0);
  EXPECT_NE(empty.err.find("the picture is empty"), std::string::npos);
}

// Hatching has its distance on the page.
TEST_F(ScenePictures, HatchingInMillimetres) {
  const auto hatch_length = [&](const std::string& spacing) {
    const json page = json::parse(
        done({"draw", "b.octree", "--sheet", "--hatch", "--hatch-spacing", spacing, "-o", "-", "--format", "json"})
            .out);
    for (const json& layer : page["layers"])
      if (layer["name"] == "hatch") return length(layer["strokes"]);
    return 0.0;
  };
  EXPECT_NEAR(hatch_length("0.5") / hatch_length("1mm"), 2, 0.1);
}

TEST_F(ScenePictures, EveryLabelHasAPen) {
  make_nrrd("a.nrrd", {4, 1, 1}, {3, 3, 200, 200});
  done({"build", "a.nrrd", "--labels", "-o", "a.octree"});
  const auto lines = layers({"a.octree", "--view", "0,-1,0"});
  // Two rectangles of 2 x 1 that share an edge, which is the first label's.
  EXPECT_NEAR(length(lines.at("label 3 visible")), 6, 1e-12);
  EXPECT_NEAR(length(lines.at("label 200 visible")), 5, 1e-12);
  const std::string svg = done({"draw", "a.octree", "--view", "0,-1,0", "--pen", "black", "--pen", "200=#123456", "-o",
                                "-", "--format", "svg"})
                              .out;
  EXPECT_NE(svg.find("#123456"), std::string::npos);
  const json one =
      json::parse(done({"draw", "a.octree", "--view", "0,-1,0", "--label", "200", "-o", "-", "--format", "json"}).out);
  EXPECT_EQ(one["strokes"].size(), 4u);
}

TEST_F(ScenePictures, UniversesThatDiffer) {
  make_box("deep.octree", 5, {4, 4, 4}, {10, 10, 10});
  refused({"draw", "b.octree", "deep.octree", "--view", "1,2,3", "-o", "p.svg"},
          "'b.octree' has depth 4 and 'deep.octree' has depth 5");
  const Result aligned = done({"draw", "b.octree", "deep.octree", "--view", "1,2,3", "--align", "-o", "p.svg"});
  EXPECT_NE(aligned.out.find("9 strokes"), std::string::npos) << aligned.out;  // one in the other's place
  make_nrrd("far.nrrd", {16, 16, 16}, std::vector<int>(4096, 1),
            "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (5,0,0)\n");
  done({"build", "far.nrrd", "-o", "far.octree"});
  refused({"draw", "far.octree", "b.octree", "--view", "1,2,3", "-o", "p.svg"},
          "'far.octree' and 'b.octree' have different frames");
}

TEST_F(ScenePictures, StepsAlongAPath) {
  write("way.json", R"({"poses": [{"time": 0, "translation": [0, 0, 0]}, {"time": 1, "translation": [0, 0, 3]}]})");
  const auto two = layers({"b.octree", "--path", "way.json", "--steps", "2", "--view", "0,-1,0"});
  ASSERT_EQ(two.size(), 2u);
  EXPECT_NEAR(length(two.at("b.octree step 1 visible")), 24, 1e-12);
  EXPECT_NEAR(length(two.at("b.octree step 2 visible")), 24 - 6, 1e-12);  // but for what is the first one's
  make_box("d.octree", 4, {11, 1, 1}, {14, 3, 3});
  const auto beside = layers({"b.octree", "d.octree", "--path", "way.json", "--steps", "3", "--view", "1,-1,1"});
  EXPECT_EQ(beside.size(), 4u);
  EXPECT_EQ(beside.at("d.octree visible").size(), 9u);
  refused({"draw", "b.octree", "--path", "way.json", "--steps", "0", "--view", "1,2,3", "-o", "p.svg"}, "--steps");
  refused({"draw", "b.octree", "--steps", "2", "--view", "1,2,3", "-o", "p.svg"}, "--steps belongs to --path");
  write("far.json", R"({"poses": [{"time": 0, "translation": [0, 0, 0]}, {"time": 1, "translation": [0, 0, 30]}]})");
  refused({"draw", "b.octree", "--path", "far.json", "--view", "1,2,3", "-o", "p.svg"}, "--grow");
  done({"draw", "b.octree", "c.octree", "--path", "far.json", "--grow", "--view", "1,2,3", "-o", "p.svg"});
}

}  // namespace
}  // namespace blackleaf::test
