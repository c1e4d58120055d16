// blackleaf build on folders of slices.
#include "cli/run_command.h"
#include "io/slice_bytes.h"

namespace blackleaf::test {
namespace {

class Stacks : public CliTest {
 protected:
  void make_folder(const std::string& name) const { std::filesystem::create_directory(folder() / name); }
  // One slice of 2 x 2 voxels in a series.
  void make_dicom(const std::string& name, const std::string& series, double z, const std::string& values) const {
    DicomBytes file;
    file.series = series;
    file.rows = file.columns = 2;
    file.allocated = file.stored = 8;
    file.high = 7;
    file.position = {10, 20, z};
    file.spacing = {0.5, 0.25};
    file.pixels = values;
    write(name, file.bytes());
  }
};

TEST_F(Stacks, DicomFolderWithTheFrameInInfo) {
  make_folder("ct");
  make_dicom("ct/b", "1.2", 3, "abcd");
  make_dicom("ct/a", "1.2", 5, "efgh");
  EXPECT_NE(done({"build", "ct", "-o", "o.octree", "--range", "100:"}).out.find("depth 1, 5 voxels"),
            std::string::npos);
  const auto info = done({"info", "o.octree", "--json"}).json();
  EXPECT_EQ(info["frame"]["unit"], "mm");
  EXPECT_EQ(info["frame"]["origin"], nlohmann::json::parse("[9.875,19.75,2]"));
  EXPECT_EQ(info["frame"]["axes"], nlohmann::json::parse("[[0.25,0,0],[0,0.5,0],[0,0,2]]"));
  EXPECT_EQ(info["metadata"]["source"], "ct");
  // With a slash at the end it is the same folder.
  done({"build", "ct/", "-o", "p.octree", "--range", "100:"});
  EXPECT_EQ(read("o.octree").size(), read("p.octree").size());
}

TEST_F(Stacks, SeriesAreListedAndChosen) {
  make_folder("ct");
  make_dicom("ct/a", "1.2", 3, "abcd");
  make_dicom("ct/b", "1.3", 3, "efgh");
  write("ct/notes.txt", "hello");
  refused({"build", "ct", "-o", "o.octree"}, "ct: holds 2 DICOM series: 1.2 ('test', 1 slice), 1.3 ('test', 1 slice)");
  const Result result = run({"build", "ct", "-o", "o.octree", "--series", "1.3"});
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.err.find("warning: ct: 1 file is no slice and passed over: notes.txt"), std::string::npos)
      << result.err;
  EXPECT_EQ(lines(result.err), 1u);
  refused({"build", "ct", "-o", "p.octree", "--series", "7"}, "no series has the UID 7");
}

TEST_F(Stacks, PicturesWithSpacing) {
  make_folder("p");
  write("p/s9.png", png_bytes(2, 2, 8, std::string("\1\0\0\0", 4)));
  write("p/s10.png", png_bytes(2, 2, 8, std::string("\0\0\0\1", 4)));
  done({"build", "p", "-o", "o.octree"});
  auto info = done({"info", "o.octree", "--json"}).json();
  EXPECT_EQ(info["frame"]["unit"], "voxel");
  EXPECT_EQ(info["volume"], 2);
  EXPECT_EQ(info["centroid"], nlohmann::json::parse("[1,1,1]"));
  done({"build", "p", "-o", "o.octree", "--spacing", "0.5,0.5,2"});
  info = done({"info", "o.octree", "--json"}).json();
  EXPECT_EQ(info["frame"]["unit"], "mm");
  EXPECT_EQ(info["frame"]["axes"], nlohmann::json::parse("[[0.5,0,0],[0,0.5,0],[0,0,2]]"));
  EXPECT_EQ(info["metadata"]["options"]["spacing"], nlohmann::json::parse("[0.5,0.5,2]"));
  for (const char* spacing : {"0,1,1", "1,1", "a,b,c", "1,-1,1"})
    refused({"build", "p", "-o", "q.octree", "--spacing", spacing}, "spacing");
  done({"build", "p/s9.png", "-o", "o.octree"});
}

TEST_F(Stacks, OptionsThatDoNotApply) {
  make_stl("s.stl", {0, 0, 0}, {1, 1, 1});
  make_nrrd("v.nrrd", {1, 1, 1}, {1});
  write("r.runs", "8 1\n");
  for (const char* input : {"s.stl", "r.runs"}) {
    refused({"build", input, "-o", "o.octree", "--spacing", "1,1,1"}, "--spacing does not apply");
    refused({"build", input, "-o", "o.octree", "--series", "1"}, "--series does not apply");
  }
  refused({"build", "v.nrrd", "-o", "o.octree", "--spacing", "1,1,1"}, "v.nrrd: a spacing is given");
  make_folder("empty");
  refused({"build", "empty", "-o", "o.octree"}, "empty: is an empty folder; name a folder with the slices");
  make_folder("ct");
  make_dicom("ct/a", "1.2", 3, "abcd");
  refused({"build", "ct", "-o", "o.octree", "--fit", "0.5"}, "--fit does not apply");
  refused({"build", "ct", "-o", "o.octree", "--spacing", "1,1,1"},
          "ct: a spacing is given, but the files tell their own");
}

}  // namespace
}  // namespace blackleaf::test
