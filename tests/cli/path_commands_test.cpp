// sweep and animate, as a user runs them.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "blackleaf/curve.h"
#include "blackleaf/implicit.h"
#include "blackleaf/label_map.h"
#include "blackleaf/measures.h"
#include "blackleaf/octree_file.h"
#include "blackleaf/sweep.h"
#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

using PathCommands = CliTest;

const char* const kSlide = R"({"poses": [{"time": 0}, {"time": 2, "translation": [10, 0, 4]}]})";
const char* const kTurn =
    R"({"about": [16, 16, 16], "poses": [{"time": 0}, {"time": 1, "rotation": [0.7071, 0, 0, 0.7071]}]})";

TEST_F(PathCommands, SweepIsThatOfTheLibrary) {
  make_box("o.octree", 5, {6, 7, 6}, {12, 12, 13});
  write("turn.json", kTurn);
  const nlohmann::json report = done({"sweep", "o.octree", "--path", "turn.json", "-o", "s.octree", "--json"}).json();
  const Path path(
      {{0, {0, 0, 0}, Eigen::Quaterniond::Identity()}, {1, {0, 0, 0}, Eigen::Quaterniond(0.7071, 0, 0, 0.7071)}},
      {16, 16, 16});
  const Octree source = box(5, {6, 7, 6}, {12, 12, 13});
  const Octree expected = sweep(source, path);
  EXPECT_TRUE(load(folder() / "s.octree").octree == expected);
  EXPECT_EQ(report["volume"], volume(expected));
  EXPECT_EQ(report["motions"], motions_along(source, path).size());
  // Standard input carries either of the two.
  EXPECT_EQ(done({"sweep", "o.octree", "--path", "-", "-o", "t.octree", "--quiet"}, kTurn).out, "");
  EXPECT_TRUE(load(folder() / "t.octree").octree == expected);
  done({"sweep", "-", "--path", "turn.json", "-o", "u.octree"}, read("o.octree"));
  EXPECT_TRUE(load(folder() / "u.octree").octree == expected);
  // Finer steps look more often.
  EXPECT_GT(
      done({"sweep", "o.octree", "--path", "turn.json", "-o", "f.octree", "--json", "--step", "0.1"}).json()["motions"],
      9 * (report["motions"].get<int>() - 2));
}

TEST_F(PathCommands, SweepLeavesTheUniverseAsTold) {
  make_box("o.octree", 5, {4, 5, 6}, {12, 12, 13});
  write("far.json", R"({"poses": [{"time": 0}, {"time": 1, "translation": [25.5, 0, 0]}]})");
  refused({"sweep", "o.octree", "--path", "far.json", "-o", "s.octree"}, "5.5 voxels beyond x = 32");
  done({"sweep", "o.octree", "--path", "far.json", "-o", "clipped.octree", "--clip"});
  EXPECT_TRUE(load(folder() / "clipped.octree").octree == box(5, {4, 5, 6}, {32, 12, 13}));
  done({"sweep", "o.octree", "--path", "far.json", "-o", "grown.octree", "--grow"});
  const Octree grown = load(folder() / "grown.octree").octree;
  EXPECT_EQ(grown.depth(), 6);
  EXPECT_EQ(bounding_box(grown), (Box{{4, 5, 6}, {38, 12, 13}}));
}

TEST_F(PathCommands, SweepRefusesInOneLine) {
  make_box("o.octree", 5, {4, 5, 6}, {12, 12, 13});
  write("slide.json", kSlide);
  write("bad.json", R"({"poses": [{"time": 0, "rotation": [1, 1, 1, 1]}], "about": [0, 0, 0]})");
  refused({"sweep", "o.octree", "-o", "s.octree"}, "--path is required");
  refused({"sweep", "o.octree", "--path", "none.json", "-o", "s.octree"}, "there is no file 'none.json'");
  refused({"sweep", "o.octree", "--path", "bad.json", "-o", "s.octree"}, "bad.json: poses[0].rotation has length 2.0");
  refused({"sweep", "o.octree", "--path", "o.octree", "-o", "s.octree"}, "o.octree: is not JSON: line 1");
  refused({"sweep", "o.octree", "--path", "slide.json", "-o", "s.octree", "--step", "0"}, "--step is '0'");
  refused({"sweep", "o.octree", "--path", "slide.json", "-o", "s.octree", "--step", "0.000001"},
          "more than 1048576 steps");
  refused({"sweep", "-", "--path", "-", "-o", "s.octree"}, "both - for standard input");
  refused({"sweep", "o.octree", "--path", "slide.json", "-o", "s.octree", "--label", "3"},
          "holds one solid without labels");
}

TEST_F(PathCommands, SweepAndAnimateKeepLabels) {
  const Octree one = box(4, {2, 2, 2}, {5, 5, 5}), two = box(4, {5, 2, 2}, {7, 4, 4});
  LabelMapBuilder builder(4);
  for (std::uint64_t i = 0; i < 4096; ++i) {
    const auto at = curve::voxel(4, i);
    builder.add(1, one.contains(at.x, at.y, at.z) ? 3u : two.contains(at.x, at.y, at.z) ? 8u : 0u);
  }
  const LabelMap map = builder.finish();
  save(map, folder() / "l.octree");
  write("slide.json", kSlide);
  const Path path({{0, {0, 0, 0}, Eigen::Quaterniond::Identity()}, {2, {10, 0, 4}, Eigen::Quaterniond::Identity()}});
  const Result told = done({"sweep", "l.octree", "--path", "slide.json", "-o", "s.octree", "--clip"});
  EXPECT_NE(told.out.find("2 labels"), std::string::npos) << told.out;
  EXPECT_EQ(load(folder() / "s.octree").labels, sweep(map, path, 1, Leaving::clip));
  // One label as a solid.
  done({"sweep", "l.octree", "--path", "slide.json", "-o", "t.octree", "--label", "3"});
  EXPECT_FALSE(load(folder() / "t.octree").labels);
  EXPECT_TRUE(load(folder() / "t.octree").octree == sweep(one, path));
  refused({"sweep", "l.octree", "--path", "slide.json", "-o", "u.octree"}, "1 voxel beyond x = 16");
  refused({"sweep", "l.octree", "--path", "slide.json", "-o", "u.octree", "--label", "4"}, "it has 2 labels: 3, 8");
  // Frames of octrees have all labels too; grown, in one universe.
  done({"animate", "l.octree", "--path", "slide.json", "-o", "f%d.octree", "--frames", "3", "--clip"});
  EXPECT_EQ(load(folder() / "f2.octree").labels, move(map, path.motion_at(1)));
  EXPECT_EQ(load(folder() / "f3.octree").labels, move(map, path.motion_at(2), Leaving::clip));
  done({"animate", "l.octree", "--path", "slide.json", "-o", "g%d.octree", "--frames", "3", "--grow"});
  const LabelMap first = load(folder() / "g1.octree").labels.value(),
                 last = load(folder() / "g3.octree").labels.value();
  EXPECT_EQ(first.depth(), 5);
  EXPECT_EQ(last, translate(first, {10, 0, 4}));
  refused({"animate", "l.octree", "--path", "slide.json", "-o", "h%d.octree", "--frames", "3"},
          "1 voxel beyond x = 16");
  done({"animate", "l.octree", "--path", "slide.json", "-o", "o%d.octree", "--frames", "1", "--label", "8"});
  EXPECT_TRUE(load(folder() / "o1.octree").octree == two);
}

TEST_F(PathCommands, AnimateWritesOctreesAlongThePath) {
  make_box("o.octree", 5, {4, 5, 6}, {12, 12, 13});
  write("slide.json", kSlide);
  const Result told = done({"animate", "o.octree", "--path", "slide.json", "-o", "f%03d.octree", "--frames", "6"});
  EXPECT_EQ(told.out, "f001.octree to f006.octree: 6 frames\n");
  for (int i = 0; i < 6; ++i) {
    const std::string name = "f00" + std::to_string(i + 1) + ".octree";
    const OctreeFile file = load(folder() / name);
    EXPECT_TRUE(file.octree == move(box(5, {4, 5, 6}, {12, 12, 13}),
                                    Motion::translation(Eigen::Vector3d(10, 0, 4) * (i * 2 / 5.0 / 2))))
        << name;
    EXPECT_EQ(nlohmann::json::parse(file.metadata)["options"]["frame"], i + 1);
    EXPECT_EQ(nlohmann::json::parse(file.metadata)["options"]["time"], 2.0 * i / 5);
  }
  EXPECT_EQ(files().size(), 8u);
}

TEST_F(PathCommands, AnimateTakesFramesASecond) {
  make_box("o.octree", 4, {2, 2, 2}, {4, 4, 4});
  write("slide.json", R"({"poses": [{"time": 1}, {"time": 3, "translation": [10, 0, 4]}]})");
  const nlohmann::json report =
      done({"animate", "o.octree", "--path", "slide.json", "-o", "f%d.octree", "--fps", "2.5", "--json"}).json();
  EXPECT_EQ(report["frames"], 6);  // at 1, 1.4, ... 3
  EXPECT_EQ(report["first"], "f1.octree");
  EXPECT_EQ(report["last"], "f6.octree");
  EXPECT_EQ(report["from"], 1);
  EXPECT_EQ(report["to"], 3);
  EXPECT_TRUE(load(folder() / "f6.octree").octree == box(4, {12, 2, 6}, {14, 4, 8}));
  // One pose is one frame, and so is one frame.
  write("rest.json", R"({"poses": [{"time": 1}]})");
  EXPECT_EQ(done({"animate", "o.octree", "--path", "rest.json", "-o", "r%d.octree", "--fps", "25"}).out,
            "r1.octree: one frame\n");
}

TEST_F(PathCommands, AnimatedPicturesShareOneFrame) {
  make_box("o.octree", 5, {4, 5, 6}, {12, 12, 13});
  write("slide.json", kSlide);
  done({"animate", "o.octree", "--path", "slide.json", "-o", "f%04d.svg", "--frames", "3", "--view", "3,-4,2"});
  const auto head = [&](const std::string& name, const std::string& key) {
    const std::string text = read(name);
    const std::size_t at = text.find(key + "=\"");
    return text.substr(at, text.find('"', at + key.size() + 2) - at);
  };
  for (const char* key : {"width", "height", "viewBox", "millimetres-per-voxel"}) {
    EXPECT_EQ(head("f0001.svg", key), head("f0002.svg", key));
    EXPECT_EQ(head("f0001.svg", key), head("f0003.svg", key));
  }
  EXPECT_NE(read("f0001.svg"), read("f0002.svg"));
  // A picture of one frame alone is drawn larger: it need not leave room for the way.
  done({"draw", "o.octree", "--view", "3,-4,2", "-o", "alone.svg"});
  EXPECT_NE(head("alone.svg", "millimetres-per-voxel"), head("f0001.svg", "millimetres-per-voxel"));
  // The first and the last frame reach the margins on opposite sides: nothing is cut off and no room is left over.
  for (const char* kind : {"png", "pdf", "json"})
    done({"animate", "o.octree", "--path", "slide.json", "-o", std::string("p%d.") + kind, "--frames", "2", "--view",
          "3,-4,2"});
  EXPECT_EQ(read("p1.png").substr(16, 8), read("p2.png").substr(16, 8)) << "width and height in pixels";
}

TEST_F(PathCommands, AnimateRefusesBeforeItWrites) {
  make_box("o.octree", 5, {4, 5, 6}, {12, 12, 13});
  write("slide.json", kSlide);
  write("far.json", R"({"poses": [{"time": 0}, {"time": 1, "translation": [0, -25.5, 0]}]})");
  const auto with = [](const std::string& output, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"animate", "o.octree", "--path", "slide.json", "-o", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  refused(with("f.octree", {"--frames", "3"}),
          "-o is 'f.octree', which does not say once where the frame's number goes");
  refused(with("f%d%d.octree", {"--frames", "3"}), "does not say once");
  refused(with("f%s.octree", {"--frames", "3"}), "does not say once");
  refused(with("f%999d.octree", {"--frames", "3"}), "does not say once");
  refused(with("f%", {"--frames", "3"}), "does not say once");
  refused(with("f%d.bmp", {"--frames", "3"}), "unknown suffix '.bmp'");
  refused(with("f%d.octree", {}), "neither --frames nor --fps is given");
  refused(with("f%d.octree", {"--frames", "0"}), "--frames is '0'");
  refused(with("f%d.octree", {"--fps", "-1"}), "--fps is '-1'");
  refused(with("f%d.octree", {"--fps", "1e9"}), "are more than 100000");
  refused(with("f%d.octree", {"--frames", "3", "--fps", "2"}), "--frames excludes --fps");
  refused(with("f%d.octree", {"--frames", "3", "--view", "1,0,0"}), "--view does not apply to octrees");
  refused(with("f%d.octree", {"--frames", "3", "--size", "A4"}), "--size does not apply to an octree");
  refused(with("f%d.svg", {"--frames", "3"}), "pictures need --view");
  refused(with("f%d.svg", {"--frames", "3", "--view", "0,0,0"}), "--view is zero");
  refused(with("f%d.svg", {"--frames", "3", "--view", "1,0,0", "--size", "5x5"}), "which the margins of 10 mm fill");
  refused(with("nowhere/f%d.svg", {"--frames", "3", "--view", "1,0,0"}), "there is no folder 'nowhere'");
  refused({"animate", "o.octree", "--path", "far.json", "-o", "f%d.octree", "--frames", "3"},
          "20.5 voxels below y = 0");
  done({"animate", "o.octree", "--path", "far.json", "-o", "f%d.octree", "--frames", "2", "--clip"});
  EXPECT_TRUE(load(folder() / "f2.octree").octree.is_empty());
  // Grown, all frames have one universe.
  done({"animate", "o.octree", "--path", "far.json", "-o", "g%d.octree", "--frames", "2", "--grow"});
  const Octree first = load(folder() / "g1.octree").octree, second = load(folder() / "g2.octree").octree;
  EXPECT_EQ(first.depth(), 6);
  EXPECT_EQ(second.depth(), 6);
  EXPECT_EQ(first.frame(), second.frame());
  EXPECT_TRUE(first == box(6, {4, 5 + 32, 6}, {12, 12 + 32, 13}));
  EXPECT_EQ(first.frame().origin, Eigen::Vector3d(0, -32, 0));
}

TEST_F(PathCommands, PercentSignsMayBeInFrameNames) {
  make_box("o.octree", 3, {0, 0, 0}, {4, 4, 4});
  done({"animate", "o.octree", "--path", "-", "-o", "50%%of%d.octree", "--frames", "1"}, R"({"poses": [{"time": 0}]})");
  EXPECT_EQ(files(), (std::vector<std::string>{"50%of1.octree", "o.octree"}));
}

}  // namespace
}  // namespace blackleaf::test
