#include "blackleaf/volume_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "blackleaf/implicit.h"
#include "blackleaf/measures.h"
#include "nrrd_text.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using test::expect_error;

Frame oblique_frame(bool mirrored) {
  Frame frame;
  frame.origin << -91.25, 126.5, -72.0625;
  Eigen::Matrix3d directions = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix() *
                               Eigen::Vector3d(-1, -1, 1).asDiagonal();
  if (mirrored) directions.col(1) *= -1;
  frame.axes = directions * Eigen::Vector3d(0.7, 0.9375, 2.5).asDiagonal();
  frame.unit = "mm";
  return frame;
}

Frame millimetres() {
  Frame frame;
  frame.unit = "mm";
  return frame;
}

TEST(VolumeFile, RoundTripsOfSolidsAndFrames) {
  const test::TemporaryFolder folder;
  std::mt19937 random(77);
  Frame negative = millimetres();
  negative.axes.diagonal() << -0.5, -0.75, 3;
  negative.origin << 100, 1e-3, -1e4;
  for (const char* name : {"a.nrrd", "a.mha", "a.nii", "a.nii.gz"})
    for (const Frame& frame : {millimetres(), negative, oblique_frame(false), oblique_frame(true)})
      for (int depth = 1; depth <= 5; ++depth) {
        SCOPED_TRACE(testing::Message() << name << " depth " << depth << " axis " << frame.axes.col(0).transpose());
        const Octree octree = reference::octree(reference::random_solid(depth, random)).with_frame(frame);
        write_volume(octree, folder / name);
        EXPECT_EQ(folder.names().size(), 1u);
        const Octree read = read_volume(folder / name);
        reference::expect_valid(read);
        EXPECT_TRUE(read == octree);
        // NIfTI keeps its geometry in 32-bit floats.
        const bool nifti = std::string(name).find(".nii") != std::string::npos;
        const double tolerance = nifti ? 1e-6 : 1e-9;
        EXPECT_EQ(read.frame().unit, "mm");
        EXPECT_LE((read.frame().axes - frame.axes).norm(), tolerance * frame.axes.norm());
        EXPECT_LE((read.frame().origin - frame.origin).norm(), tolerance * (frame.origin.norm() + frame.axes.norm()));
        std::filesystem::remove(folder / name);
      }
}

TEST(VolumeFile, CroppedVolumesLieInTheSamePlace) {
  const test::TemporaryFolder folder;
  std::mt19937 random(78);
  for (const char* name : {"a.nrrd", "a.mha", "a.nii.gz"})
    for (int i = 0; i < 40; ++i) {
      SCOPED_TRACE(testing::Message() << name << " " << i);
      const Octree octree =
          reference::octree(reference::random_solid(1 + i % 5, random)).with_frame(oblique_frame(i % 2));
      write_volume(octree, folder / name, true);
      const Octree read = read_volume(folder / name);
      const auto box = bounding_box(octree);
      const std::array<int, 3> corner = box ? box->min : std::array<int, 3>{};
      EXPECT_TRUE(read.frame().same_as(
          octree.frame().shifted({double(corner[0]), double(corner[1]), double(corner[2])}), 1e-4));
      EXPECT_EQ(volume(read), volume(octree));
      const int n = octree.side();
      for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
          for (int x = 0; x < n; ++x)
            ASSERT_EQ(read.contains(x - corner[0], y - corner[1], z - corner[2]), octree.contains(x, y, z));
    }
}

// The frame speaks of corners, files of centres; a volume placed elsewhere in the universe stays where it is in the
// world.
TEST(VolumeFile, CompressedNiftiBesideAnotherOfTheSameName) {
  // The NIfTI library, left to itself, takes a.nii's voxels for a.nii.gz's.
  const test::TemporaryFolder folder;
  const Octree one = ball(4, {8, 8, 8}, 5), other = box(4, {1, 2, 3}, {9, 8, 7});
  write_volume(one, folder / "a.nii");
  write_volume(other, folder / "a.nii.gz");
  EXPECT_TRUE(read_volume(folder / "a.nii") == one);
  EXPECT_TRUE(read_volume(folder / "a.nii.gz") == other);
}

TEST(VolumeFile, FramesOfPlacedVolumes) {
  const test::TemporaryFolder folder;
  const std::string geometry =
      "space: left-posterior-superior\nspace directions: (2,0,0) (0.5,3,0) (0,0,-4)\nspace origin: (10,20,30)\n";
  test::write_file(folder / "a.nrrd",
                   test::nrrd_header("unsigned char", "3 2 1", 3, geometry) + "\n" + std::string("\0\1\0\1\0\0", 6));
  const Octree corner = read_volume(folder / "a.nrrd");
  EXPECT_EQ(corner.depth(), 2);
  EXPECT_EQ(volume(corner), 2u);
  EXPECT_TRUE(corner.contains(1, 0, 0) && corner.contains(0, 1, 0));
  Frame expected;
  expected.axes << 2, 0.5, 0, 0, 3, 0, 0, 0, -4;  // not orthogonal: NRRD can say so and it is kept
  expected.origin = Eigen::Vector3d(10, 20, 30) - expected.axes * Eigen::Vector3d(0.5, 0.5, 0.5);
  expected.unit = "mm";
  EXPECT_TRUE(corner.frame().same_as(expected, 1e-12));
  EXPECT_TRUE(corner.frame().to_world({0.5, 0.5, 0.5}).isApprox(Eigen::Vector3d(10, 20, 30), 1e-12));

  const Octree centre =
      read_volume(folder / "a.nrrd", {.low = {}, .high = {}, .label = {}, .depth = 4, .centre = true});
  EXPECT_EQ(centre.depth(), 4);
  EXPECT_TRUE(centre.contains(6 + 1, 7, 7) && centre.contains(6, 7 + 1, 7));  // (16 - (3,2,1)) / 2 rounded down
  EXPECT_TRUE(centre.frame().to_world({6.5, 7.5, 7.5}).isApprox(Eigen::Vector3d(10, 20, 30), 1e-12));

  write_volume(corner, folder / "b.nrrd");
  EXPECT_TRUE(read_volume(folder / "b.nrrd").frame().same_as(expected, 1e-9));
  for (const char* name : {"b.nii", "b.mha"})
    expect_error(ErrorCode::bad_argument, {name, "right angles", "write .nrrd"},
                 [&] { write_volume(corner, folder / name); });
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.nrrd", "b.nrrd"}));
}

template <class T>
class VolumeTypes : public testing::Test {};
using Types = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t, std::int32_t,
                             std::uint64_t, std::int64_t, float, double>;
TYPED_TEST_SUITE(VolumeTypes, Types);

template <class T>
std::string nrrd_type() {
  if constexpr (std::is_same_v<T, float>)
    return "float";
  else if constexpr (std::is_same_v<T, double>)
    return "double";
  else
    return std::string(std::is_signed_v<T> ? "int" : "uint") + std::to_string(8 * sizeof(T));
}

TYPED_TEST(VolumeTypes, RangesAndLabels) {
  using T = TypeParam;
  using Limits = std::numeric_limits<T>;
  const test::TemporaryFolder folder;
  std::vector<T> values = {T{0}, T{1}, T{2}, T{3}, T{100}, T{127}, Limits::max(), Limits::lowest()};
  if constexpr (std::is_floating_point_v<T>) {
    values[3] = Limits::quiet_NaN();
    values[4] = Limits::denorm_min();
    values[5] = Limits::infinity();
  }
  test::write_nrrd(folder / "a.nrrd", nrrd_type<T>(), "2 2 2", values);
  const auto expect_range = [&](std::optional<double> low, std::optional<double> high, std::optional<double> label) {
    SCOPED_TRACE(testing::Message() << low.value_or(-1) << " " << high.value_or(-1) << " " << label.value_or(-1));
    const Octree octree = read_volume(folder / "a.nrrd", {.low = low, .high = high, .label = label});
    ASSERT_EQ(octree.depth(), 1);
    for (int i = 0; i < 8; ++i) {
      // long double holds every value of every type and every bound exactly.
      const auto value = static_cast<long double>(values[static_cast<std::size_t>(i)]);
      bool inside = value > 0;
      if (low || high) inside = (!low || value >= *low) && (!high || value <= *high) && !std::isnan(value);
      if (label) inside = value == static_cast<long double>(*label);
      EXPECT_EQ(octree.contains(i & 1, i >> 1 & 1, i >> 2), inside) << "value " << value;
    }
  };
  expect_range({}, {}, {});
  const auto largest = static_cast<double>(Limits::max()), least = static_cast<double>(Limits::lowest());
  for (const double bound : {0.0, 0.5, 1.0, 2.5, -0.5, -1.0, 127.0, 255.0, 256.0, 1e-30, 1e30, -1e30, largest, least,
                             2 * largest, std::nextafter(largest, 0.0), HUGE_VAL, -HUGE_VAL}) {
    expect_range(bound, {}, {});
    expect_range({}, bound, {});
    // Doubles of this size stand for several 64-bit whole numbers.
    if (std::is_integral_v<T> && sizeof(T) == 8 && std::abs(bound) >= 0x1p53 && std::abs(bound) <= 0x1p64)
      expect_error(ErrorCode::bad_argument, {"a.nrrd", "label", "2^53"},
                   [&] { read_volume(folder / "a.nrrd", {.label = bound}); });
    else
      expect_range({}, {}, bound);
    for (const double other : {0.0, 2.0, 2.5, 0.1 + bound, largest})
      if (bound <= other) expect_range(bound, other, {});
  }
}

TEST(VolumeFile, OptionsThatContradictThemselves) {
  const test::TemporaryFolder folder;
  test::write_nrrd<std::uint8_t>(folder / "a.nrrd", "uint8", "9 1 1", {1, 2, 3, 4, 5, 6, 7, 8, 9});
  const auto refuse = [&](const VolumeOptions& options, const std::vector<std::string>& pieces,
                          ErrorCode code = ErrorCode::bad_argument) {
    expect_error(code, pieces, [&] { read_volume(folder / "a.nrrd", options); });
  };
  refuse({.low = 3.0, .high = 2.0}, {"from 3 to 2", "smaller value first"});
  refuse({.low = 3.0, .high = {}, .label = 1.0}, {"range", "label"});
  refuse({.low = std::nan("")}, {"not a number"});
  refuse({.low = {}, .high = {}, .label = std::nan("")}, {"not a number"});
  refuse({.low = {}, .high = {}, .label = {}, .depth = 21}, {"depth 21"});
  refuse({.low = {}, .high = {}, .label = {}, .depth = -1}, {"depth -1"});
  refuse({.low = {}, .high = {}, .label = {}, .depth = 3}, {"a.nrrd", "9 x 1 x 1", "depth 3", "use depth 4"},
         ErrorCode::bad_input);
  EXPECT_EQ(volume(read_volume(folder / "a.nrrd", {.low = 2.25, .high = 2.75})), 0u);
}

TEST(VolumeFile, DimensionsOtherThanThree) {
  const test::TemporaryFolder folder;
  const std::string no_space;
  test::write_file(folder / "2.nrrd",
                   test::nrrd_header("uint8", "3 2", 2, no_space) + "\n" + std::string("\1\0\0\0\0\1", 6));
  const Octree slice = read_volume(folder / "2.nrrd");
  EXPECT_EQ(slice.depth(), 2);
  EXPECT_EQ(volume(slice), 2u);
  EXPECT_TRUE(slice.contains(0, 0, 0) && slice.contains(2, 1, 0));
  test::write_file(folder / "4.nrrd",
                   test::nrrd_header("uint8", "3 2 1 1", 4, no_space) + "\n" + std::string("\1\0\0\0\0\1", 6));
  EXPECT_TRUE(read_volume(folder / "4.nrrd") == slice);
  test::write_file(folder / "5.nrrd",
                   test::nrrd_header("uint8", "3 1 1 2", 4, no_space) + "\n" + std::string("\1\0\0\0\0\1", 6));
  expect_error(ErrorCode::bad_input, {"5.nrrd", "4 dimensions", "3 x 1 x 1 x 2"},
               [&] { read_volume(folder / "5.nrrd"); });
  test::write_file(folder / "rgb.nrrd",
                   test::nrrd_header("uint8", "3 2 1 1", 4,
                                     "space: left-posterior-superior\n"
                                     "space directions: none (1,0,0) (0,1,0) (0,0,1)\n"
                                     "kinds: RGB-color domain domain domain\nspace origin: (0,0,0)\n") +
                       "\n" + std::string("\1\0\0\0\0\1", 6));
  expect_error(ErrorCode::bad_input, {"rgb.nrrd", "3 values a voxel"}, [&] { read_volume(folder / "rgb.nrrd"); });
}

TEST(VolumeFile, DetachedHeadersAndEncodings) {
  const test::TemporaryFolder folder;
  const std::vector<std::int16_t> values = {-5, 0, 7, 300, -32768, 32767, 0, 1};
  const Octree expected = [&] {
    test::write_nrrd(folder / "whole.nrrd", "int16", "2 2 2", values);
    return read_volume(folder / "whole.nrrd");
  }();
  EXPECT_EQ(volume(expected), 4u);
  std::filesystem::create_directory(folder / "sub");
  test::write_file(folder / "sub" / "data.raw", test::raw_bytes(values));
  test::write_file(folder / "a.nhdr", test::nrrd_header("int16", "2 2 2", 3) + "data file: sub/data.raw\n");
  EXPECT_TRUE(read_volume(folder / "a.nhdr") == expected);
  test::write_file(
      folder / "a.mhd",
      "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_SHORT\nElementDataFile = sub/data.raw\n");
  EXPECT_TRUE(read_volume(folder / "a.mhd") == expected);
  test::write_file(folder / "text.nrrd",
                   test::nrrd_header("int16", "2 2 2", 3, "", "text") + "\n-5 0 7 300\n-32768 32767 0 1\n");
  EXPECT_TRUE(read_volume(folder / "text.nrrd") == expected);
  test::write_file(folder / "gone.nhdr", test::nrrd_header("int16", "2 2 2", 3) + "data file: gone.raw\n");
  EXPECT_THROW(read_volume(folder / "gone.nhdr"), Error);
  test::write_file(
      folder / "gone.mhd",
      "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_SHORT\nElementDataFile = gone.raw\n");
  expect_error(ErrorCode::bad_input, {"gone.mhd: its data file", "gone.raw: no such file"},
               [&] { read_volume(folder / "gone.mhd"); });
}

// NIfTI may say that values are slope * stored + intercept: then the result is meant.
TEST(VolumeFile, NiftiWithScaledValues) {
  const test::TemporaryFolder folder;
  write_volume(box(2, {1, 0, 2}, {3, 1, 4}).with_frame(millimetres()), folder / "a.nii");
  std::string bytes = test::read_text(folder / "a.nii");
  const float slope = 0.5f, intercept = 0.25f;
  std::memcpy(bytes.data() + 112, &slope, 4);
  std::memcpy(bytes.data() + 116, &intercept, 4);
  test::write_file(folder / "a.nii", bytes);
  const gzFile packed = gzopen((folder / "b.nii.gz").c_str(), "wb");
  gzwrite(packed, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(packed);
  for (const char* name : {"a.nii", "b.nii.gz"}) {
    EXPECT_EQ(volume(read_volume(folder / name)), 64u);
    EXPECT_EQ(volume(read_volume(folder / name, {.low = 0.5, .high = 1.0})), 4u);
    EXPECT_EQ(volume(read_volume(folder / name, {.label = 0.75})), 4u);
    EXPECT_EQ(volume(read_volume(folder / name, {.label = 0.25})), 60u);
  }
}

TEST(VolumeFile, NamesOfVolumes) {
  for (const char* name : {"a.nrrd", "A.NRRD", "a.nhdr", "a.nii", "a.b.nii.gz", "a.Nii.Gz", "a.mha", "a.mhd", "a.hdr",
                           "a.img", "a.img.gz"})
    EXPECT_TRUE(is_volume_name(name)) << name;
  for (const char* name :
       {"", "nrrd", ".gz", "a.gz", "a.stl", "a.octree", "a.nrrd.gz", "a.nii.bz2", "a.tar.gz", "a.nrrd/b"})
    EXPECT_FALSE(is_volume_name(name)) << name;
}

TEST(VolumeFile, WhatCannotBeWritten) {
  const test::TemporaryFolder folder;
  const Octree octree = box(4, {1, 2, 3}, {5, 6, 7});
  for (const char* name : {"a.stl", "a", "a.mhd", "a.nhdr", "a.nrrd.gz", "a.hdr"})
    expect_error(ErrorCode::bad_argument, {name, "use .nrrd, .nii, .nii.gz or .mha"},
                 [&] { write_volume(octree, folder / name); });
  expect_error(ErrorCode::bad_argument, {"a.nrrd", "1048576", "2^33", "crop"}, [&] {
    write_volume(box(20, {1, 2, 3}, {5, 6, 7}), folder / "a.nrrd");
  });
  expect_error(ErrorCode::io, {"a.nrrd: cannot be written"}, [&] { write_volume(octree, folder / "no" / "a.nrrd"); });
  Frame flat = millimetres();
  flat.axes(2, 2) = 0;
  expect_error(ErrorCode::bad_argument, {"axis without length"},
               [&] { write_volume(octree.with_frame(flat), folder / "a.nrrd"); });
  EXPECT_TRUE(folder.names().empty());
  // A small solid in a large universe is written from its bounding box.
  write_volume(box(20, {1 << 19, 5, 77}, {(1 << 19) + 4, 9, 80}), folder / "a.nrrd", true);
  EXPECT_EQ(volume(read_volume(folder / "a.nrrd")), 48u);
  // A side of more than 32767 voxels is beyond NIfTI.
  const Octree rod = box(16, {0, 0, 0}, {40000, 1, 1});
  expect_error(ErrorCode::bad_argument, {"a.nii", "32767", "write .nrrd"},
               [&] { write_volume(rod, folder / "a.nii", true); });
  write_volume(rod, folder / "a.mha", true);
  EXPECT_EQ(volume(read_volume(folder / "a.mha")), 40000u);
}

}  // namespace
}  // namespace blackleaf
