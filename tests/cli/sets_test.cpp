// combine of many and offset.
#include "blackleaf/implicit.h"
#include "blackleaf/octree_file.h"
#include "blackleaf/volume_file.h"
#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

using nlohmann::json;

class Sets : public CliTest {
 protected:
  json info(const std::string& name) const { return done({"info", name, "--json"}).json(); }
  int volume(const std::vector<std::string>& arguments) const {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {"-o", "o.octree", "--json"});
    return done(all).json()["volume"].get<int>();
  }
};

TEST_F(Sets, CombineTakesManyOperands) {
  make_box("a.octree", 4, {0, 0, 0}, {8, 4, 4});
  make_box("b.octree", 4, {2, 0, 0}, {10, 4, 4});
  make_box("c.octree", 4, {6, 0, 0}, {12, 4, 4});
  EXPECT_EQ(volume({"combine", "a.octree", "or", "b.octree", "c.octree"}), 12 * 16);
  EXPECT_EQ(volume({"combine", "a.octree", "and", "b.octree", "c.octree"}), 2 * 16);
  EXPECT_EQ(volume({"combine", "a.octree", "minus", "b.octree", "c.octree"}), 2 * 16);
  EXPECT_EQ(volume({"combine", "a.octree", "xor", "b.octree", "c.octree"}), (2 + 2 + 2) * 16);
  EXPECT_EQ(info("o.octree")["metadata"]["options"]["with"], json::parse(R"(["b.octree","c.octree"])"));
  make_box("d.octree", 5, {0, 0, 0}, {4, 4, 4});
  refused({"combine", "a.octree", "or", "b.octree", "d.octree", "-o", "e.octree"},
          "'a.octree' has depth 4 and 'd.octree' has depth 5; build both in one universe, with build --like, or place "
          "them by their frames with --align");
  refused({"combine", "a.octree", "or", "-", "-", "-o", "e.octree"}, "more than one octree is - for standard input");
}

TEST_F(Sets, CombineAlignsGrownUniverses) {
  make_box("a.octree", 3, {0, 2, 2}, {4, 6, 6});
  done({"offset", "a.octree", "1", "--grow", "-o", "fat.octree"});
  EXPECT_EQ(info("fat.octree")["depth"], 4);
  refused({"combine", "fat.octree", "minus", "a.octree", "-o", "e.octree"}, "has depth 4");
  EXPECT_EQ(volume({"combine", "fat.octree", "minus", "a.octree", "--align"}), 6 * 16);
  EXPECT_EQ(volume({"combine", "a.octree", "or", "fat.octree", "--align"}), 64 + 6 * 16);
  const json both = info("o.octree");
  EXPECT_EQ(both["depth"], 4);
  EXPECT_EQ(both["frame"], info("fat.octree")["frame"]);
  EXPECT_EQ(both["metadata"]["options"]["align"], true);
  Frame frame;
  frame.origin[0] = 0.5;
  save(box(3, {2, 0, 0}, {6, 4, 4}, frame), folder() / "half.octree");
  refused({"combine", "a.octree", "or", "half.octree", "--align", "-o", "e.octree"},
          "--align: the voxels of 'half.octree' do not lie on those of 'a.octree' in the world");
}

TEST_F(Sets, OffsetGrowsAndShrinks) {
  make_box("a.octree", 5, {10, 10, 10}, {14, 14, 14});
  EXPECT_EQ(volume({"offset", "a.octree", "1"}), 64 + 6 * 16);
  EXPECT_EQ(volume({"offset", "a.octree", "1.4142135623730951"}), 64 + 6 * 16 + 12 * 4);
  EXPECT_EQ(volume({"offset", "a.octree", "1.9"}), 64 + 6 * 16 + 12 * 4 + 8);
  EXPECT_EQ(volume({"offset", "a.octree", "-1"}), 8);
  EXPECT_EQ(volume({"offset", "a.octree", "-1.9", "--threads", "1"}), 8);
  EXPECT_EQ(volume({"offset", "a.octree", "1", "--open"}), 8 + 6 * 4);
  EXPECT_EQ(volume({"offset", "a.octree", "3", "--close"}), 64);
  EXPECT_EQ(info("o.octree")["metadata"]["options"], json::parse(R"({"radius":3.0,"operation":"close"})"));
}

TEST_F(Sets, OffsetLeavesTheUniverseOnlyWhenTold) {
  make_box("a.octree", 3, {0, 2, 2}, {4, 6, 6});
  refused({"offset", "a.octree", "2.9", "-o", "o.octree"},
          "the grown solid leaves the universe: 2 voxels below x = 0; grow it by less, clip");
  EXPECT_EQ(volume({"offset", "a.octree", "1", "--clip"}), 64 + 5 * 16);
  EXPECT_EQ(volume({"offset", "a.octree", "1", "--grow"}), 64 + 6 * 16);
  EXPECT_EQ(info("o.octree")["frame"]["origin"], json::parse("[-8.0,0.0,0.0]"));
  refused({"offset", "a.octree", "1e9", "--grow", "-o", "o.octree"}, "even when it is grown to depth 20");
}

TEST_F(Sets, OffsetRefusesAndWarns) {
  make_box("a.octree", 4, {2, 2, 2}, {6, 6, 6});
  refused({"offset", "a.octree", "much", "-o", "o.octree"}, "the radius R is 'much', which is not a finite number");
  refused({"offset", "a.octree", "nan", "-o", "o.octree"}, "not a finite number");
  refused({"offset", "a.octree", "-o", "o.octree"}, "R is required");
  refused({"offset", "a.octree", "-2", "--open", "-o", "o.octree"}, "give it without a sign");
  refused({"offset", "a.octree", "-2", "--clip", "-o", "o.octree"}, "--clip is for solids that grow");
  refused({"offset", "a.octree", "2", "--close", "--grow", "-o", "o.octree"}, "--grow is for solids that grow");
  refused({"offset", "a.octree", "2", "--close", "--open", "-o", "o.octree"}, "--open");
  refused({"offset", "a.octree", "2", "-o", "o.nrrd"}, "suffix .nrrd");
  const Result small = run({"offset", "a.octree", "0.5", "-o", "o.octree"});
  EXPECT_EQ(small.code, 0);
  EXPECT_NE(small.err.find("warning: a ball of radius 0.5 holds no voxel centre but its own"), std::string::npos);
  EXPECT_EQ(info("o.octree")["volume"], 64);
  const Result gone = run({"offset", "a.octree", "-5", "-o", "o.octree"});
  EXPECT_EQ(gone.code, 0);
  EXPECT_NE(gone.err.find("warning: no voxel is black"), std::string::npos);
}

TEST_F(Sets, OffsetReadsAndWritesStreamsAndLabels) {
  make_box("a.octree", 4, {4, 4, 4}, {8, 8, 8});
  const Result through = done({"offset", "-", "1", "-o", "-"}, read("a.octree"));
  write("b.octree", through.out);
  EXPECT_EQ(info("b.octree")["volume"], 64 + 6 * 16);
  make_nrrd("l.nrrd", {4, 4, 4}, [] {
    std::vector<int> values(64, 0);
    values[21] = 7;  // (1,1,1)
    values[42] = 9;
    return values;
  }());
  done({"build", "l.nrrd", "--labels", "-o", "l.octree"});
  EXPECT_EQ(volume({"offset", "l.octree", "1", "--label", "7"}), 7);
}

}  // namespace
}  // namespace blackleaf::test
