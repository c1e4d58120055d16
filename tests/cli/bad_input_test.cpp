// What every command must refuse: one line, exit status 2, nothing left behind.
#include <sys/stat.h>
#include <unistd.h>

#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

class BadInput : public CliTest {
 protected:
  BadInput() { make_box("b.octree", 4, {3, 4, 5}, {6, 7, 8}); }

  // A command line for each command that reads `file`.
  static std::vector<std::vector<std::string>> readers(const std::string& file) {
    return {{"info", file},
            {"translate", file, "1,0,0", "-o", "o.octree"},
            {"move", file, "--translate", "1,0,0", "-o", "o.octree"},
            {"combine", file, "or", "b.octree", "-o", "o.octree"},
            {"combine", "b.octree", "or", file, "-o", "o.octree"},
            {"collide", "b.octree", file},
            {"draw", file, "--view", "1,2,3", "-o", "o.svg"},
            {"export", file, "-o", "o.nrrd"},
            {"build", "b.runs", "-o", "o.octree", "--like", file}};
  }
  // A command line for each command that writes `file`.
  static std::vector<std::vector<std::string>> writers(const std::string& file) {
    return {{"translate", "b.octree", "1,0,0", "-o", file + ".octree"},
            {"move", "b.octree", "--translate", "1,0,0", "-o", file + ".octree"},
            {"combine", "b.octree", "or", "b.octree", "-o", file + ".octree"},
            {"draw", "b.octree", "--view", "1,2,3", "-o", file + ".svg"},
            {"draw", "b.octree", "--view", "1,2,3", "-o", file + ".png"},
            {"export", "b.octree", "-o", file + ".nii.gz"},
            {"export", "b.octree", "-o", file + ".ply"},
            {"export", "b.octree", "-o", file + ".runs"},
            {"build", "b.runs", "-o", file + ".octree"}};
  }
};

TEST_F(BadInput, MissingFiles) {
  write("b.runs", "8 1\n");
  for (const auto& command : readers("none.octree")) refused(command, "no file 'none.octree'");
  for (const char* name : {"none.stl", "none.nrrd", "none.runs", "none", ""})
    refused({"build", name, "-o", "o.octree"}, std::string("no file '") + name + "'");
  refused({"move", "b.octree", "--matrix", "none.txt", "-o", "o.octree"}, "no file 'none.txt'");
}

TEST_F(BadInput, FoldersAsInput) {
  write("b.runs", "8 1\n");
  std::filesystem::create_directory(folder() / "folder");
  for (const auto& command : readers("folder")) refused(command, "'folder' is a folder");
  refused({"verify", "folder"}, "'folder' is a folder");
  refused({"build", "folder", "-o", "o.octree"}, "folder: is an empty folder");
  refused({"move", "b.octree", "--matrix", "folder", "-o", "o.octree"}, "'folder' is a folder");
}

TEST_F(BadInput, DamagedOctrees) {
  write("b.runs", "8 1\n");
  const std::string whole = read("b.octree");
  write("cut.octree", whole.substr(0, whole.size() - 3));
  for (const auto& command : readers("cut.octree")) refused(command, "cut.octree");
  std::string flipped = whole;
  flipped[flipped.size() - 5] = static_cast<char>(flipped[flipped.size() - 5] ^ 0x10);
  write("flipped.octree", flipped);
  for (const auto& command : readers("flipped.octree")) refused(command, "flipped.octree");
  write("text.octree", "not an octree\n");
  for (const auto& command : readers("text.octree")) refused(command, "text.octree");
  write("empty.octree", "");
  for (const auto& command : readers("empty.octree")) refused(command, "empty.octree");
}

TEST_F(BadInput, NumbersThatAreNone) {
  for (const char* vector : {"nan,0,0", "0,inf,0", "1,2", "1,2,3,4", "1 2 3", "1,,3", "", ",,", "1,2,3x", "-nan,0,0"}) {
    refused({"move", "b.octree", "--translate", vector, "-o", "o.octree"}, "--translate");
    refused({"move", "b.octree", "--rotate", std::string(vector) + ":90", "-o", "o.octree"}, "--rotate");
    refused({"translate", "b.octree", std::string("0") + vector, "-o", "o.octree"}, "displacement");
    refused({"collide", "b.octree", "b.octree", "--about", vector}, "--about");
  }
  for (const char* rotation : {"0,0,1", "0,0,1:", "0,0,1:nan", "0,0,0:90", "0,0,1:90:1", ":90", "0,0,1:ninety"})
    refused({"move", "b.octree", "--rotate", rotation, "-o", "o.octree"}, "--rotate");
  refused({"translate", "b.octree", "1.5,0,0", "-o", "o.octree"}, "displacement is '1.5,0,0'");
  refused({"translate", "b.octree", "99999999999999999999,0,0", "-o", "o.octree"}, "displacement");
  refused({"translate", "b.octree", "-nan,0,0", "-o", "o.octree"}, "-nan,0,0");
  refused({"move", "b.octree", "--about", "middle", "-o", "o.octree"}, "--about is 'middle'");
}

TEST_F(BadInput, MatricesThatAreNotRigid) {
  const auto matrix = [&](const std::string& text, const std::string& part) {
    write("m.txt", text);
    refused({"move", "b.octree", "--matrix", "m.txt", "-o", "o.octree"}, part);
    refused({"collide", "b.octree", "b.octree", "--matrix", "m.txt"}, part);
  };
  matrix("1 0.5 0 0\n0 0.866025403784438647 0 0\n0 0 1 0\n0 0 0 1\n", "shears");
  matrix("2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n", "scales");
  matrix("1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n",
         "it is a reflection along z: its determinant is -1; that is another operation: --reflect z");
  matrix("1 0 0 4\n0 1 0 0\n0 0 1 0\n0 0 0.5 1\n", "the last row of a motion's matrix is 0 0 0.5 1, not 0 0 0 1");
  matrix("1 0 0 0\n0 1 0 0\n0 0 1 0\n5 6 7 1\n", "matrix 'm.txt' is written column by column; write it row by row");
  matrix("1 0 0 0\n0 1 0 0\n0 0 1 0\n", "12 numbers");
  matrix("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1 7\n", "more than 16 numbers");
  matrix("1 0 0 nan\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "entry 4");
  matrix("one two\n", "entry 1");
  matrix("", "0 numbers");
}

TEST_F(BadInput, UsageIsExplained) {
  refused({"frobnicate"}, "unknown command 'frobnicate'");
  refused({"--frobnicate"}, "unknown option --frobnicate");
  refused({"info", "b.octree", "--frobnicate"}, "unknown option --frobnicate, in blackleaf info");
  refused({"info", "b.octree", "c.octree"}, "unexpected argument 'c.octree'");
  refused({"info"}, "FILE is required");
  refused({"move", "b.octree", "--clip", "--grow", "-o", "o.octree"}, "--clip");
  refused({"translate", "b.octree", "1,0,0", "--clip", "--grow", "-o", "o.octree"}, "--clip");
  write("m.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  refused({"move", "b.octree", "--matrix", "m.txt", "--rotate", "0,0,1:90", "-o", "o.octree"}, "--matrix");
  refused({"move", "b.octree", "--matrix", "m.txt", "--translate", "0,0,1", "-o", "o.octree"}, "--matrix");
  refused({"move", "b.octree", "--translate"}, "--translate");
  refused({"info", "b.octree", "--json=maybe"}, "--json");
  refused({"draw", "b.octree", "--view", "1,0,0", "--view", "0,1,0", "-o", "o.svg"}, "--view");
  // Commands that do not report have no --json to ignore, and later commands are not there yet.
  refused({"teleport"}, "unknown command");
}

TEST_F(BadInput, MissingOutput) {
  refused({"build", "b.stl"}, "--output is required");
  refused({"translate", "b.octree", "1,0,0"}, "--output is required");
  refused({"move", "b.octree"}, "--output is required");
  refused({"combine", "b.octree", "or", "b.octree"}, "--output is required");
  refused({"draw", "b.octree", "--view", "1,2,3"}, "--output is required");
  refused({"export", "b.octree"}, "--output is required");
}

TEST_F(BadInput, OutputsThatCannotBe) {
  write("b.runs", "8 1\n");
  for (const auto& command : writers("no/such/folder/o")) refused(command, "no folder 'no/such/folder'");
  for (const auto& command : writers("b.octree/o")) refused(command, "no folder 'b.octree'");
  std::filesystem::create_directory(folder() / "f");
  for (const char* suffix : {".octree", ".svg", ".png", ".nii.gz", ".ply", ".runs"})
    std::filesystem::create_directory(folder() / ("f" + std::string(suffix)));
  for (const auto& command : writers("f")) refused(command, "it is a folder");
  refused({"move", "b.octree", "-o", "o.stl"}, "its suffix .stl says otherwise");
  refused({"build", "b.runs", "-o", ""}, "name is empty");
  refused({"move", "b.octree", "-o", "-", "--json"}, "--json");
  if (geteuid() == 0) return;  // root may write anywhere
  std::filesystem::create_directory(folder() / "closed");
  std::filesystem::permissions(folder() / "closed",
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  for (const auto& command : writers("closed/o")) refused(command, "may not be written to");
}

TEST_F(BadInput, PipesAreNotBuiltFrom) {
  for (const char* name : {"pipe", "pipe.stl", "pipe.nrrd", "pipe.nii.gz", "pipe.runs"}) {
    // Nobody writes to it: whoever opened it would wait for ever.
    ASSERT_EQ(mkfifo((folder() / name).c_str(), 0600), 0);
    refused({"build", name, "-o", "o.octree"}, "' is a device or a pipe");
  }
  refused({"build", "/dev/null", "-o", "o.octree"}, "'/dev/null' is a device or a pipe");
  refused({"build", "-", "-o", "o.octree"}, "standard input cannot be built from; name a file");
}

TEST_F(BadInput, NamedPipesAreNotWaitedFor) {
  write("b.runs", "8 1\n");
  ASSERT_EQ(mkfifo((folder() / "pipe").c_str(), 0600), 0);
  for (const auto& command : readers("pipe")) refused(command, "'pipe' is a named pipe");
  refused({"verify", "pipe"}, "'pipe' is a named pipe");
}

TEST_F(BadInput, Meshes) {
  const auto off = [&](const std::string& vertices, const std::string& faces, const std::string& part,
                       std::vector<std::string> more = {}) {
    write("m.off", "OFF\n3 2 0\n" + vertices + faces);
    more.insert(more.begin(), {"build", "m.off", "-o", "o.octree"});
    refused(more, part);
  };
  const std::string flat = "0 0 0\n1 0 0\n0 1 0\n", both = "3 0 1 2\n3 0 2 1\n";
  off(flat, "2 0 1\n1 2\n", "m.off: has no triangles");
  off(flat, "3 0 1 2\n3 0 2 3\n", "face 1 refers to vertex 3, and the last is 2");
  off("0 0 0\nnan 0 0\n0 1 0\n", both, "vertex 1 is not finite");
  off("0 0 0\n0 inf 0\n0 1 0\n", both, "vertex 1 is not finite");
  off("0 0 0\n0 0 1e999\n0 1 0\n", both, "vertex 1 is not finite");
  off("5 5 5\n5 5 5\n5 5 5\n", both, "blackleaf: m.off: ");
  off("0 0 0\n1e9 0 0\n0 1 0\n", both, "blackleaf: m.off: ", {"--voxel-size", "0.001", "--depth", "8"});
  off("0 0 0\n1e300 0 0\n0 1e300 0\n", both, "blackleaf: m.off: ", {"--voxel-size", "1"});
  write("m.off", "OFF\n4000000000 4000000000 0\n0 0 0\n");
  refused({"build", "m.off", "-o", "o.octree"}, "but there are 34 bytes; the file was cut off");
  write("m.obj", "v 0 0 0\nv 1 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
  refused({"build", "m.obj", "-o", "o.octree"}, "m.obj: vertex 2 has 2 coordinates");
}

TEST_F(BadInput, OptionsGivenTwice) {
  make_stl("s.stl", {0, 0, 0}, {1, 1, 1});
  refused({"build", "s.stl", "--depth", "2", "--depth", "3", "-o", "o.octree"}, "--depth is given twice");
  refused({"build", "s.stl", "--depth", "2", "-o", "o.octree", "-o", "p.octree"}, "--output is given twice");
  refused({"draw", "b.octree", "--view", "1,0,0", "--view", "0,1,0", "--view", "0,0,1", "-o", "o.svg"},
          "--view is given 3 times");
}

TEST_F(BadInput, MessagesNameWhatToMend) {
  make_stl("s.stl", {0, 0, 0}, {1, 1, 1});
  make_stl("open.stl", {0, 0, 0}, {1, 1, 1}, true);
  refused({"build", "open.stl", "--inside", "parity", "-o", "o.octree"}, "blackleaf: open.stl: ");
  refused({"build", "s.stl", "--voxel-size", "0.01", "--depth", "4", "-o", "o.octree"}, "blackleaf: s.stl: ");
  refused({"build", "s.stl", "--fit", "1e-300", "-o", "o.octree"}, "--fit is 1e-300, which is less than any voxel");
  refused({"draw", "b.octree", "--view", "1,2,3", "--size", "10x10", "-o", "o.svg"},
          "make both sides longer than 20 mm");
  write("empty.runs", "");
  refused({"build", "empty.runs", "-o", "o.octree"}, "empty.runs: is empty");
  if (std::filesystem::is_directory("/proc"))
    refused({"translate", "b.octree", "1,0,0", "-o", "/proc/x"}, "choose another folder");
}

TEST_F(BadInput, ResultsThatSurpriseWarn) {
  const auto warned = [&](const std::vector<std::string>& arguments, const std::string& part) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    const Result result = run(arguments);
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(lines(result.err), 1u) << result.err;
    EXPECT_NE(result.err.find("warning: " + part), std::string::npos) << result.err;
    std::vector<std::string> quiet = arguments;
    quiet.emplace_back("--quiet");
    done(quiet);
  };
  make_nrrd("v.nrrd", {2, 2, 2}, std::vector<int>(8, 0));
  warned({"build", "v.nrrd", "-o", "o.octree"}, "no voxel is black");
  warned({"translate", "b.octree", "100,0,0", "--clip", "-o", "o.octree"}, "no voxel is black");
  warned({"move", "b.octree", "--translate", "100,0,0", "--clip", "-o", "o.octree"}, "no voxel is black");
  warned({"move", "b.octree", "--about", "centre", "-o", "o.octree"}, "no motion is given");
}

TEST_F(BadInput, FarDisplacementsAreNotCutShort) {
  for (const char* by : {"99999999999,0,0", "9223372036854775807,0,0"})
    for (const char* leaving : {"", "--grow"}) {
      std::vector<std::string> command = {"translate", "b.octree", by, "-o", "o.octree"};
      if (*leaving != 0) command.emplace_back(leaving);
      refused(command, "it is moved by more than 4194304 voxels along +x");
    }
  refused({"translate", "b.octree", "0,-9223372036854775808,5000000", "-o", "o.octree"},
          "more than 4194304 voxels along -y, more than 4194304 voxels along +z");
}

TEST_F(BadInput, WhatIsNoFileHasNoSize) {
  EXPECT_EQ(done({"translate", "b.octree", "1,0,0", "-o", "/dev/null"}).out.find("byte"), std::string::npos);
  EXPECT_TRUE(done({"translate", "b.octree", "1,0,0", "-o", "/dev/null", "--json"}).json()["file_bytes"].is_null());
}

TEST_F(BadInput, NamesWithLineBreaksStillMakeOneLine) { refused({"info", "two\nlines"}, "two lines"); }

}  // namespace
}  // namespace blackleaf::test
