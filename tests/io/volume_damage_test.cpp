// Files that are not what they seem: refused in one clear line, at once, whatever they claim.
#include <gtest/gtest.h>
#include <zlib.h>

#include <limits>
#include <random>

#include "blackleaf/implicit.h"
#include "blackleaf/measures.h"
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
  expect_error(ErrorCode::bad_input, {"dir.nrrd", "is an empty folder"}, [&] { read_volume(folder_ / "dir.nrrd"); });
  refuse("a.stl", "solid", {"no suffix of a volume"});
}

TEST_F(VolumeDamage, TextThatItsTypeCannotHold) {
  const auto nrrd = [](const std::string& type, const std::string& values) {
    return test::nrrd_header(type, "2 2 1", 3, "", "text") + "\n" + values;
  };
  refuse("a.nrrd", nrrd("uint8", "1 2 300 4\n"), {"value 3 is '300'"});
  refuse("b.nrrd", nrrd("uint8", "1 -2 3 4\n"), {"value 2 is '-2'"});
  refuse("c.nrrd", nrrd("int16", "1 2 3 32768"), {"value 4 is '32768'"});
  refuse("d.nrrd", nrrd("int8", "1.5 2 3 4"), {"value 1 is '1.5'"});
  refuse("e.nrrd", nrrd("uint8", "12345 6 7 "), {"12345"});
  refuse("f.nrrd", nrrd("uint8", "1 2      \n\n\n3\n"), {"4 voxels", "3 numbers"});
  refuse("g.nrrd", nrrd("float", "1 2 x 4"), {"value 3 is 'x'"});
  refuse("i.nrrd", nrrd("uint8", "1 2 3,4 5"), {"value 3 is '3,4'"});
  refuse("h.nrrd", nrrd("uint8", "1 2 3 " + std::string(100000, '4')), {"value 4"});
  test::write_file(folder_ / "good.nrrd", nrrd("uint8", "255 0\n 7 1\n"));
  EXPECT_EQ(read_volume(folder_ / "good.nrrd").depth(), 1);
  test::write_file(folder_ / "real.nrrd", nrrd("float", "1e-3 -2.5 nan 1e30\n"));
  EXPECT_EQ(read_volume(folder_ / "real.nrrd").depth(), 1);
  refuse("a.mha",
         "ObjectType = Image\nNDims = 3\nDimSize = 2 2 1\nBinaryData = False\nElementType = MET_UCHAR\n"
         "ElementDataFile = LOCAL\n1 2 256 4\n",
         {"value 3 is '256'"});
}

TEST_F(VolumeDamage, SpacingsThatAreNone) {
  for (const char* spacings : {"nan 1 1", "1 -1 1", "1 1 0", "1 inf 1", "1 x 1"})
    refuse("a.nrrd", test::nrrd_header("uint8", "2 2 1", 3, std::string("spacings: ") + spacings + "\n") + "\n1234",
           {"spacings"});
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
         meta +
             "10000 10000 10000\nCompressedData = True\nCompressedDataSize = 4\nElementType = "
             "MET_FLOAT\nElementDataFile = LOCAL\n1234",
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

std::string gzipped(const std::string& bytes) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, bytes.size()) + 32, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<unsigned>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<unsigned>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

// What stands behind the values may be padding; a slice more than the header tells is a header that is wrong.
TEST_F(VolumeDamage, MoreOrFewerValuesThanTold) {
  const std::string values = [] {
    std::mt19937 random(12);
    std::string bytes(20 * 10 * 6, '\0');
    for (char& c : bytes) c = static_cast<char>(random() % 2);
    return bytes;
  }();
  const std::string raw = test::nrrd_header("uint8", "20 10 6", 3) + "\n";
  const std::string gzip = test::nrrd_header("uint8", "20 10 6", 3, "", "gzip") + "\n";
  test::write_file(folder_ / "z.nrrd", raw + values);
  const Octree octree = read_volume(folder_ / "z.nrrd");
  EXPECT_FALSE(octree.is_empty());
  const auto same = [&](const std::string& contents) {
    test::write_file(folder_ / "z.nrrd", contents);
    EXPECT_TRUE(read_volume(folder_ / "z.nrrd") == octree);
  };
  same(gzip + gzipped(values));
  same(raw + values + std::string(199, 'x'));
  same(gzip + gzipped(values + std::string(199, 'x')));
  same(gzip + gzipped(values) + "and so on, no gzip");
  same(gzip + gzipped(values) + std::string(5000, '\0'));
  // Two members, cut anywhere.
  for (const std::size_t cut : {std::size_t{0}, std::size_t{1}, std::size_t{700}, values.size()})
    same(gzip + gzipped(values.substr(0, cut)) + gzipped(values.substr(cut)));
  same(gzip + gzipped(values) + gzipped("a second member"));

  refuse("z.nrrd", raw + values + std::string(200, 'x'), {"tells of 6 slices, but there are values for more"});
  refuse("z.nrrd", gzip + gzipped(values + std::string(200, 'x')), {"6 slices, but there are values for more"});
  refuse("z.nrrd", gzip + gzipped(values) + gzipped(values), {"6 slices, but there are values for more"});
  refuse("z.nrrd", gzip + gzipped(values.substr(1)), {"1199 bytes, fewer than its header tells of"});
  refuse("z.nrrd", gzip + gzipped(values.substr(1)) + "garbage", {"damaged after 1199 bytes"});
  refuse("z.nrrd", gzip + "no gzip at all", {"damaged after 0 bytes"});
  const std::string packed = gzipped(values);
  for (std::size_t length = 2; length < packed.size(); ++length)  // its last eight bytes are checksums
    refuse("z.nrrd", gzip + packed.substr(0, length), {"compressed values"});
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

// One NIfTI file of 2 x 2 x 2 voxels of one byte, all black, with millimetre voxels and no word on its orientation.
std::string nifti() {
  std::string bytes(352, '\0');
  const auto put = [&]<class T>(std::size_t at, T value) { std::memcpy(bytes.data() + at, &value, sizeof value); };
  put(0, std::int32_t{348});
  for (std::size_t i = 0; i < 8; ++i) put(40 + 2 * i, static_cast<std::int16_t>(i == 0 ? 3 : i < 4 ? 2 : 1));
  put(70, std::int16_t{2});
  put(72, std::int16_t{8});
  for (std::size_t i = 0; i < 8; ++i) put(76 + 4 * i, 1.0F);
  put(108, 352.0F);
  bytes.replace(344, 3, "n+1");
  return bytes + std::string(8, '\1');
}

template <class T>
std::string with(std::string bytes, std::size_t at, const std::vector<T>& values) {
  return bytes.replace(at, values.size() * sizeof(T), test::raw_bytes(values));
}

TEST_F(VolumeDamage, NiftiHeaders) {
  using Shorts = std::vector<std::int16_t>;
  using Floats = std::vector<float>;
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  test::write_file(folder_ / "z.nii", nifti());
  EXPECT_EQ(volume(read_volume(folder_ / "z.nii")), 8u);
  testing::internal::CaptureStderr();
  refuse("z.nii", with(nifti(), 40, Shorts{3, 0, 2, 2}), {"z.nii: has no voxels (0 x 2 x 2)"});
  refuse("z.nii", with(nifti(), 40, Shorts{3, -2, 2, 2}), {"z.nii: has no voxels (-2 x 2 x 2)"});
  for (const int dimensions : {9, 0, -1, 300})
    refuse("z.nii", with(nifti(), 40, Shorts{static_cast<std::int16_t>(dimensions)}),
           {"tells of " + std::to_string(dimensions) + " dimensions"});
  refuse("z.nii", with(nifti(), 70, Shorts{0}), {"unknown type"});
  refuse("z.nii", with(nifti(), 0, Shorts{540}), {"NIfTI-2"});
  for (const float offset : {0.0F, 300.0F, -5.0F, 348.0F, 352.5F, 353.0F, 1e30F, kNaN, kInfinity})
    for (const bool cut : {false, true})
      refuse("z.nii", with(nifti(), 108, Floats{offset}).substr(0, cut ? 352 : 360), {});
  for (const float size : {0.0F, kNaN, kInfinity}) {
    refuse("z.nii", with(nifti(), 80, Floats{size}), {"along dimension 1 (pixdim)"});
    refuse("z.nii", with(nifti(), 88, Floats{size}), {"along dimension 3 (pixdim)"});
  }
  for (const float bad : {kNaN, kInfinity, -3e38F}) {
    const std::string q = with(nifti(), 252, Shorts{1}), s = with(nifti(), 254, Shorts{1});
    for (std::size_t i = 0; i < 6; ++i) refuse("z.nii", with(q, 256 + 4 * i, Floats{bad}), {"qform"});
    for (std::size_t i = 0; i < 12; ++i) refuse("z.nii", with(s, 280 + 4 * i, Floats{bad}), {"sform"});
    refuse("z.nii", with(s, 280, Floats(12, bad)), {"sform"});
  }
  const std::string sform = with(nifti(), 254, Shorts{1});
  refuse("z.nii", with(sform, 280, Floats{1, .5F, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}), {"axes are not orthogonal", ".nrrd"});
  refuse("z.nii", with(sform, 280, Floats(12, 0.0F)), {"axes do not span space"});
  refuse("z.nii", with(sform, 280, Floats{1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0}), {"axes"});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(VolumeDamage, MetaImageHeaders) {
  const auto meta = [](const std::string& more, const std::string& dimensions = "3",
                       const std::string& type = "MET_UCHAR") {
    return "ObjectType = Image\nNDims = " + dimensions + "\nBinaryData = True\n" + more +
           "DimSize = 2 2 2\nElementType = " + type + "\nElementDataFile = LOCAL\n";
  };
  const std::string values(8, '\1');
  test::write_file(folder_ / "z.mha", meta("") + values);
  EXPECT_EQ(volume(read_volume(folder_ / "z.mha")), 8u);
  for (const char* dimensions : {"-1", "0", "11", "300", "", "three", "99999999999"})
    refuse("z.mha", meta("", dimensions) + values, {"dimensions"});
  refuse("z.mha", "ObjectType: Image\nNDims: -1\nElementDataFile: LOCAL\n", {"dimensions"});
  refuse("z.mha", meta("", "3", "MET_FOO") + values, {"unknown type ('MET_FOO')"});
  refuse("z.mha", meta("", "3", "MET_STRING") + values, {"unknown type"});
  for (const char* key : {"ElementSpacing", "Offset", "TransformMatrix"})
    for (const char* word : {"nan", "inf", "1e999", "x"})
      refuse("z.mha", meta(std::string(key) + " = " + word + " 1 1\n") + values, {key, word});
  refuse("z.mha", meta("ElementSpacing = 0 1 1\n") + values, {"axes do not span space"});
  refuse("z.mha", meta("TransformMatrix = 1 0 0 1 0 0 0 0 1\n") + values, {});
}

// Compressed values of a length that the header does not tell, or tells wrong, are refused every time.
TEST_F(VolumeDamage, MetaImageCompressedLength) {
  std::vector<std::int16_t> values(64);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::int16_t>(i * 7919 % 200);
  const std::string raw = test::raw_bytes(values);
  uLongf length = compressBound(raw.size());
  std::string packed(length, '\0');
  ASSERT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(raw.data()),
                     raw.size()),
            Z_OK);
  packed.resize(length);
  const auto meta = [&](const std::string& told) {
    return "ObjectType = Image\nNDims = 3\nBinaryData = True\nCompressedData = True\n" + told +
           "DimSize = 4 4 4\nElementType = MET_SHORT\nElementDataFile = LOCAL\n" + packed;
  };
  const auto size = [](std::int64_t told) { return "CompressedDataSize = " + std::to_string(told) + "\n"; };
  const auto exact = static_cast<std::int64_t>(length);
  test::write_file(folder_ / "z.mha", meta(size(exact)));
  EXPECT_EQ(volume(read_volume(folder_ / "z.mha")), 63u);
  refuse("z.mha", meta(""), {"no CompressedDataSize"});
  refuse("z.mha", meta(size(0)), {"no CompressedDataSize"});
  for (const std::int64_t told : {exact - 1, exact / 2, std::int64_t{1}, exact + 1, std::int64_t{-1},
                                  std::int64_t{99999999999999}, std::numeric_limits<std::int64_t>::min()})
    refuse("z.mha", meta(size(told)), {});
  refuse("z.mha", meta("CompressedDataSize = many\n"), {"'many'"});
  refuse("z.mha", meta("HeaderSize = 7\n" + size(exact)), {});
  refuse("z.mha", meta("HeaderSize = -1\n" + size(exact)), {"HeaderSize"});
}

TEST_F(VolumeDamage, NrrdHeaders) {
  const auto nrrd = [](const std::string& more, const std::string& sizes = "2 2 2") {
    return test::nrrd_header("uint8", sizes, 3, more) + "\n" + std::string(8, '\1');
  };
  const auto axes = [](const std::string& directions, const std::string& origin = "(0,0,0)") {
    return "space: left-posterior-superior\nspace directions: " + directions + "\nspace origin: " + origin + "\n";
  };
  refuse("z.nrrd", nrrd("", "0 2 2"), {"z.nrrd: has no voxels (0 x 2 x 2)"});
  refuse("z.nrrd", nrrd("", "2 -5 2"), {"z.nrrd: has no voxels (2 x -5 x 2)"});
  refuse("z.nrrd", nrrd(axes("(1,0,0) (1,0,0) (0,0,1)")), {"axes do not span space"});
  refuse("z.nrrd", nrrd(axes("(1,0,0) (0,1,0) (1,1,0)")), {"axes do not span space"});
  refuse("z.nrrd", nrrd(axes("(0,0,0) (0,1,0) (0,0,1)")), {"z.nrrd: "});
  refuse("z.nrrd", nrrd(axes("(nan,0,0) (0,1,0) (0,0,1)")), {"space directions has numbers that are not finite"});
  refuse("z.nrrd", nrrd(axes("(1,0,0) (0,1,0) (0,0,1)", "(0,Inf,0)")), {"space origin has numbers"});
  refuse("z.nrrd", nrrd("data file: /dev/zero\n"), {"its data file is not an ordinary file"});
  refuse("z.nrrd", nrrd("data file: nothere.raw\n"), {"its data file cannot be read", "nothere.raw"});
  test::write_file(folder_ / "z.nrrd", nrrd(axes("(1,0,0) (0.5,1,0) (0,0,1)")));
  EXPECT_EQ(volume(read_volume(folder_ / "z.nrrd")), 8u);
}

TEST_F(VolumeDamage, NrrdOddities) {
  const auto read = [&](const std::string& more, const std::string& values = std::string(8, '\1')) {
    test::write_file(folder_ / "z.nrrd", test::nrrd_header("uint8", "2 2 2", 3, more) + "\n" + values);
    return volume(read_volume(folder_ / "z.nrrd"));
  };
  EXPECT_EQ(read("sizes:=my sizes\nspacings:=measured by Ann\nspace origin:=nan\n"), 8u);
  test::write_file(folder_ / "my file.raw", std::string(8, '\1'));
  EXPECT_EQ(read("data file: my file.raw\n", ""), 8u);
  test::write_file(folder_ / "my file.raw", std::string(7, '\1'));
  refuse("z.nrrd", test::nrrd_header("uint8", "2 2 2", 3, "data file: my file.raw\n") + "\n", {"there are 7"});
  refuse("z.nrrd", test::nrrd_header("uint8", "2 2 2", 3, "", "bzip2") + "\n", {"bzip2", "save it raw or with gzip"});
}

TEST_F(VolumeDamage, NrrdOfSeveralFiles) {
  const auto part = [&](int i, std::size_t bytes) {
    test::write_file(folder_ / ("s0" + std::to_string(i) + ".raw"), std::string(bytes, '\1'));
  };
  const std::string list = "s01.raw\ns02.raw\n";
  const auto listed = [](const std::string& sizes) {
    const std::string header = test::nrrd_header("uint8", sizes, 3, "");
    return header + "data file: LIST\n";
  };
  const auto pattern = [](const std::string& sizes) {
    return test::nrrd_header("uint8", sizes, 3, "data file: s%02d.raw 1 2 1\n") + "\n";
  };
  part(1, 4);
  refuse("z.nhdr", listed("2 2 2") + list, {"s02.raw"});
  refuse("z.nhdr", pattern("2 2 2"), {"s02.raw"});
  part(2, 3);
  refuse("z.nhdr", listed("2 2 2") + list, {"need at least 8 bytes, but there are 7"});
  refuse("z.nhdr", pattern("2 2 2"), {"need at least 8 bytes, but there are 7"});
  part(2, 4);
  part(1, 5);
  for (const std::string& contents : {listed("2 2 2") + list, pattern("2 2 2")}) {
    test::write_file(folder_ / "z.nhdr", contents);
    EXPECT_EQ(volume(read_volume(folder_ / "z.nhdr")), 8u);
  }
  part(1, 3);
  part(2, 5);
  refuse("z.nhdr", listed("2 2 2") + list, {});
  refuse("z.nhdr", pattern("2 2 2"), {});
  refuse("z.nhdr", pattern("100000 100000 2"), {"20000000000 voxels"});
  refuse("z.nhdr", test::nrrd_header("uint8", "100000 100000 2", 3, "", "text") + "data file: LIST\n" + list,
         {"save it as one file"});
}

TEST_F(VolumeDamage, MetaImageOfSeveralFiles) {
  const auto meta = [](const std::string& data, const std::string& size = "2 2 3") {
    return "ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = " + size +
           "\nElementType = MET_SHORT\nElementDataFile = " + data;
  };
  const auto part = [&](int i, std::size_t bytes) {
    test::write_file(folder_ / ("s" + std::to_string(i) + ".raw"), std::string(bytes, '\1'));
  };
  const auto fine = [&](const std::string& data) {
    SCOPED_TRACE(data);
    test::write_file(folder_ / "z.mhd", meta(data));
    EXPECT_EQ(volume(read_volume(folder_ / "z.mhd")), 12u);
  };
  const std::string list = "s1.raw\ns2.raw\ns3.raw\n";
  part(1, 8);
  part(2, 8);
  refuse("z.mhd", meta("LIST\n" + list), {"its data file cannot be read", "s3.raw"});
  refuse("z.mhd", meta("s%d.raw 1 3 1\n"), {"its data file cannot be read", "s3.raw"});
  part(3, 7);
  refuse("z.mhd", meta("LIST\n" + list), {"'s3.raw' has 7 bytes, but a slice needs 8"});
  refuse("z.mhd", meta("s%d.raw\n"), {"'s3.raw' has 7 bytes, but a slice needs 8"});
  part(3, 8);
  for (const std::string& data : {"LIST\n" + list, "LIST 2D\n" + list, "LIST 2\n" + list + "\n"}) fine(data);
  for (const char* data : {"s%d.raw\n", "s%01d.raw 1\n", "s%d.raw 1 3 1\n"}) fine(data);
  refuse("z.mhd", meta("LIST\n" + list.substr(0, 14)), {"tells of 3 slices, but names 2 files"});
  refuse("z.mhd", meta("LIST\n" + list.substr(0, 20)), {"no end", "new line"});
  refuse("z.mha", meta("LIST\n"), {"tells of 3 slices, but names 0 files"});
  refuse("z.mhd", meta("s%d.raw 1 2 1\n"), {"tells of 3 slices, but names 2 files"});
  for (const char* data : {"s%d.raw 1 3\n", "s%d.raw 1 3 0\n", "s%d.raw 3 1 1\n", "s%s.raw 1 3 1\n", "%d%n 1 3 1\n",
                           "s%d%d.raw\n", "LIST 7 8\n", "LIST x\n"})
    refuse("z.mhd", meta(data), {"z.mhd: "});
  refuse("z.mhd", meta("LIST\n" + list, "100000 100000 100000"), {"100000 slices"});
  refuse("z.mhd", meta("LIST\n" + list, "100000 100000 3"), {"a slice needs 20000000000"});
  refuse("z.mhd", "CompressedData = True\n" + meta("LIST\n" + list), {"save it as one file"});
  refuse("z.mhd", meta("LOCAL\n", "2 2"), {"3 dimensions (NDims), but has 2 sizes (DimSize)"});
}

TEST_F(VolumeDamage, LabelsBeyondDoubles) {
  constexpr std::uint64_t kLargest = std::numeric_limits<std::uint64_t>::max();
  test::write_nrrd<std::uint64_t>(folder_ / "z.nrrd", "uint64", "2 2 2",
                                  {kLargest, kLargest - 1, (1ULL << 53) - 1, 1ULL << 53, (1ULL << 53) + 1, 0, 1, 2});
  const auto read = [&](double label) { return volume(read_volume(folder_ / "z.nrrd", {.label = label})); };
  EXPECT_EQ(read(0x1p53 - 1), 1u);
  EXPECT_EQ(read(2), 1u);
  for (const double label : {0x1p53, 18446744073709551615.0, -0x1p60})
    expect_error(ErrorCode::bad_argument, {"z.nrrd", "label", "2^53"}, [&] { read(label); });
  test::write_nrrd<float>(folder_ / "y.nrrd", "float", "2 1 1", {0x1p60F, 1});
  EXPECT_EQ(volume(read_volume(folder_ / "y.nrrd", {.label = 0x1p60})), 1u);
}

}  // namespace
}  // namespace blackleaf
