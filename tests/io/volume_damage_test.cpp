// Files that are not what they seem: refused in one clear line, at once, whatever they claim.
#include <gtest/gtest.h>

#include <random>

#include "blackleaf/implicit.h"
#include "blackleaf/volume_file.h"
#include "nrrd_text.h"

namespace blackleaf {
namespace {

using test::expect_error;

class VolumeDamage : public testing::Test {
 protected:
  void refuse(const std::string& name, std::string_view contents, std::vector<std::string> pieces,
              ErrorCode code = ErrorCode::bad_input) {
    SCOPED_TRACE(name);
    test::write_file(folder_ / name, contents);
    pieces.push_back(name);
    expect_error(code, pieces, [&] { read_volume(folder_ / name); });
  }
  const test::TemporaryFolder folder_;
};

TEST_F(VolumeDamage, NotAVolume) {
  for (const char* name : {"a.nrrd", "a.nii", "a.nii.gz", "a.mha", "a.mhd", "a.nhdr", "a.hdr"}) {
    refuse(name, "", {"is empty"});
    refuse(name, "Dear sir or madam,\n\nthis is a letter.\n", {});
    refuse(name, std::string(5000, '\0'), {});
    expect_error(ErrorCode::io, {"no such file"}, [&] { read_volume(folder_ / (std::string("none") + name)); });
  }
  std::filesystem::create_directory(folder_ / "dir.nrrd");
  expect_error(ErrorCode::io, {"dir.nrrd", "is a folder"}, [&] { read_volume(folder_ / "dir.nrrd"); });
  refuse("a.stl", "solid", {"no suffix of a volume"});
}

TEST_F(VolumeDamage, HeadersThatClaimTooMuch) {
  refuse("a.nrrd", test::nrrd_header("float", "10000 10000 10000", 3) + "\n1234",
         {"1000000000000 voxels", "there are 4"});
  refuse("b.nrrd", test::nrrd_header("uint8", "10000 10000 10000", 3, "", "gzip") + "\n1234", {"1000000000000 voxels"});
  refuse("c.nrrd", test::nrrd_header("uint8", "10000 10000 10000", 3, "", "ascii") + "\n1 2 3 4",
         {"1000000000000 voxels"});
  refuse("d.nrrd", test::nrrd_header("uint8", "9999999 10000 10000", 3) + "\n1234", {"too large"});
  refuse("e.nrrd", test::nrrd_header("uint8", "99999999999999999999 1 1", 3) + "\n1234", {});
  refuse("f.nrrd", test::nrrd_header("uint8", "0 10 10", 3) + "\n1234", {});
  refuse("g.nrrd", test::nrrd_header("uint8", "-5 10 10", 3) + "\n1234", {});
  refuse("h.nrrd", test::nrrd_header("block", "2 2 2", 3) + "block size: 3\n\n1234", {});
  const std::string meta = "ObjectType = Image\nNDims = 3\nDimSize = ";
  refuse("a.mha", meta + "10000 10000 10000\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n1234",
         {"1000000000000 voxels", "there are 4"});
  refuse("b.mha",
         meta + "10000 10000 10000\nCompressedData = True\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n1234",
         {"1000000000000 voxels"});
  refuse("c.mha", meta + "0 10 10\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n1234", {});
  refuse("d.mha", meta + "-2 10 10\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n1234", {});
  refuse("e.mha", "ObjectType = Image\nNDims = 0\nElementDataFile = LOCAL\n", {});
}

// Cut at every length that matters, raw files are refused, and never read beyond their end.
TEST_F(VolumeDamage, Truncated) {
  Frame frame;
  frame.unit = "mm";
  const Octree octree = ball(4, {8, 7.5, 8}, 6.3).with_frame(frame);
  for (const char* name : {"a.nrrd", "a.mha", "a.nii", "a.nii.gz"}) {
    write_volume(octree, folder_ / name);
    const std::string whole = test::read_text(folder_ / name);
    std::filesystem::remove(folder_ / name);
    const std::size_t step = 1 + whole.size() / 150;
    for (std::size_t length = 0; length < whole.size(); length += step) {
      SCOPED_TRACE(testing::Message() << length << " of " << whole.size());
      refuse(name, std::string_view(whole).substr(0, length), {});
    }
    refuse(name, std::string_view(whole).substr(0, whole.size() - 1), {});
  }
}

// Flips inside compressed data: refused, or, where nothing was hurt (a name or a date inside gzip), the same solid.
TEST_F(VolumeDamage, CompressedDataDamaged) {
  const Octree octree = ball(4, {8, 7.5, 8}, 6.3);
  std::mt19937 random(4);
  for (const char* name : {"a.nrrd", "a.mha", "a.nii.gz"}) {
    write_volume(octree, folder_ / name);
    const std::string whole = test::read_text(folder_ / name);
    int refused = 0;
    for (int i = 0; i < 200; ++i) {
      SCOPED_TRACE(testing::Message() << name << " " << i);
      std::string damaged = whole;
      // The compressed data are the last of the file; headers may change their meaning lawfully.
      const std::size_t at = whole.size() - 1 - random() % 60;
      damaged[at] = static_cast<char>(damaged[at] ^ static_cast<int>(1 + random() % 255));
      test::write_file(folder_ / name, damaged);
      try {
        EXPECT_TRUE(read_volume(folder_ / name) == octree);
      } catch (const Error& error) {
        ++refused;
        EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(ErrorCode::bad_input)) << error.what();
      }
    }
    EXPECT_GT(refused, 190);
  }
}

TEST_F(VolumeDamage, NothingButNaN) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  test::write_nrrd<float>(folder_ / "a.nrrd", "float", "2 2 2", std::vector<float>(8, nan));
  expect_error(ErrorCode::bad_input, {"a.nrrd", "every value is NaN"}, [&] { read_volume(folder_ / "a.nrrd"); });
  std::vector<float> values(8, nan);
  values[3] = -1;
  test::write_nrrd<float>(folder_ / "a.nrrd", "float", "2 2 2", values);
  EXPECT_TRUE(read_volume(folder_ / "a.nrrd").is_empty());
}

}  // namespace
}  // namespace blackleaf
