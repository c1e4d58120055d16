// DICOM series as volumes: compared with NRRD files of the same values and with geometry computed by hand.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "blackleaf/measures.h"
#include "blackleaf/volume_file.h"
#include "io/nrrd_text.h"
#include "io/slice_bytes.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using test::DicomBytes;
using test::expect_error;
using test::write_file;

std::vector<double> list(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

// A volume of 16-bit values and where it lies.
struct Scan {
  std::array<int, 3> size{5, 4, 6};
  std::vector<std::int16_t> stored;
  Eigen::Vector3d origin{-91.25, 126.5, -72.0625};
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
  Eigen::Vector3d spacing{0.7, 0.9375, 2.5};
  Eigen::Vector3d step{0, 0, 2.5};  // from slice to slice
  DicomBytes model;

  explicit Scan(std::mt19937& random, std::array<int, 3> shape = {5, 4, 6}) : size(shape) {
    std::uniform_int_distribution<int> value(-2048, 2047);
    stored.resize(static_cast<std::size_t>(size[0] * size[1] * size[2]));
    for (std::int16_t& v : stored) v = static_cast<std::int16_t>(value(random));
    model.stored = 12;
    model.high = 11;
    model.is_signed = 1;
  }
  std::size_t slice_values() const { return static_cast<std::size_t>(size[0] * size[1]); }
  std::vector<std::int16_t> slice(int z) const {
    const auto begin = stored.begin() + static_cast<std::ptrdiff_t>(slice_values()) * z;
    return {begin, begin + static_cast<std::ptrdiff_t>(slice_values())};
  }
  DicomBytes file(int z) const {
    DicomBytes result = model;
    result.columns = size[0];
    result.rows = size[1];
    result.position = list(origin + z * step);
    result.orientation = list(directions.col(0));
    for (const double d : list(directions.col(1))) result.orientation.push_back(d);
    result.spacing = {spacing[1], spacing[0]};
    result.pixels = test::raw_bytes(slice(z));
    return result;
  }
  // All slices, under names whose order says nothing.
  void write(const std::filesystem::path& folder, std::mt19937& random) const {
    std::filesystem::create_directories(folder);
    std::vector<int> order;
    for (int z = 0; z < size[2]; ++z) order.push_back(z);
    std::shuffle(order.begin(), order.end(), random);
    for (int z = 0; z < size[2]; ++z)
      write_file(folder / fmt::format("IM{}", order[static_cast<std::size_t>(z)]), file(z).bytes());
  }
  Frame frame() const {
    Frame result;
    result.unit = "mm";
    result.axes.col(0) = directions.col(0) * spacing[0];
    result.axes.col(1) = directions.col(1) * spacing[1];
    result.axes.col(2) = step;
    result.origin = origin - result.axes * Eigen::Vector3d::Constant(0.5);
    return result;
  }
  template <class T>
  void expect_same(const std::filesystem::path& dicom, const std::vector<T>& values, const std::string& type,
                   const VolumeOptions& options) const {
    const test::TemporaryFolder folder;
    test::write_nrrd(folder / "a.nrrd", type, fmt::format("{} {} {}", size[0], size[1], size[2]), values);
    const Octree expected = read_volume(folder / "a.nrrd", options), read = read_volume(dicom, options);
    EXPECT_TRUE(read == expected);
    reference::expect_valid(read);
    EXPECT_TRUE(read.frame().same_as(frame(), 1e-6)) << read.frame().origin.transpose() << "\n"
                                                     << read.frame().axes << "\ninstead of\n"
                                                     << frame().axes;
    EXPECT_EQ(read.frame().unit, "mm");
  }
  // `meaning` makes what is meant of what is stored.
  template <class T, class Meaning>
  void expect_same(const std::filesystem::path& dicom, const std::string& type, Meaning meaning,
                   const VolumeOptions& options) const {
    std::vector<T> values;
    for (const std::int16_t v : stored) values.push_back(meaning(v));
    expect_same(dicom, values, type, options);
  }
};

TEST(DicomStack, SeriesOfShuffledFilesAnyOrientation) {
  const test::TemporaryFolder folder;
  std::mt19937 random(31);
  std::uniform_real_distribution<double> part(-1, 1);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    Scan scan(random, {1 + i % 7, 1 + i % 5, 2 + i % 9});
    scan.directions =
        Eigen::AngleAxisd(3 * part(random), Eigen::Vector3d(part(random), part(random), part(random)).normalized())
            .toRotationMatrix();
    scan.origin << 200 * part(random), 200 * part(random), 200 * part(random);
    scan.step = scan.directions.col(2) * (0.5 + std::abs(part(random)));
    // Tilted gantries: slices lie askew.
    if (i % 3 == 0) scan.step += 0.3 * part(random) * scan.directions.col(1);
    const auto where = folder / std::to_string(i);
    scan.write(where, random);
    scan.expect_same<std::int16_t>(where, "int16", [](std::int16_t v) { return v; }, {.low = -100.0, .high = 900.0});
    scan.expect_same<std::int16_t>(where, "int16", [](std::int16_t v) { return v; }, {});
  }
}

TEST(DicomStack, RescaledValues) {
  const test::TemporaryFolder folder;
  std::mt19937 random(32);
  Scan scan(random);
  scan.model.slope = "1";
  scan.model.intercept = "-1024";
  scan.write(folder / "hounsfield", random);
  scan.expect_same<std::int16_t>(folder / "hounsfield", "int16",
                                 [](std::int16_t v) { return static_cast<std::int16_t>(v - 1024); },
                                 {.low = -1500.0, .high = -300.0});
  scan.model.slope = "0.125";
  scan.model.intercept = "-0.5";
  scan.write(folder / "fractions", random);
  for (const VolumeOptions& options :
       {VolumeOptions{.low = -0.5, .high = 17.625}, VolumeOptions{.label = 0.125 * scan.stored[7] - 0.5}})
    scan.expect_same<double>(
        folder / "fractions", "double", [](std::int16_t v) { return 0.125 * v - 0.5; }, options);
  scan.model.slope = "100000";
  scan.model.intercept = "7";
  scan.write(folder / "large", random);
  scan.expect_same<std::int32_t>(folder / "large", "int32", [](std::int16_t v) { return 100000 * v + 7; },
                                 {.low = 3e6, .high = 1e8});
  // Each slice its own meaning, as in PET.
  std::vector<double> meant;
  for (int z = 0; z < scan.size[2]; ++z) {
    DicomBytes file = scan.file(z);
    file.slope = fmt::format("{}", 0.25 * (z + 1));
    file.intercept = "0";
    std::filesystem::create_directories(folder / "pet");
    write_file(folder / "pet" / std::to_string(z), file.bytes());
    for (const std::int16_t v : scan.slice(z)) meant.push_back(0.25 * (z + 1) * v);
  }
  scan.expect_same(folder / "pet", meant, "double", {.low = 100.0});
}

// Deflated files, also such as unpack to much more than they are.
TEST(DicomStack, Deflated) {
  const test::TemporaryFolder folder;
  std::mt19937 random(34);
  for (const std::array<int, 3> size : {std::array{5, 4, 6}, std::array{5, 4, 1}, std::array{300, 200, 1}}) {
    SCOPED_TRACE(size[0]);
    for (const bool blank : {false, true}) {
      Scan scan(random, size);
      if (blank) std::fill(scan.stored.begin() + 1, scan.stored.end(), std::int16_t{0});
      scan.stored[0] = 7;
      scan.model.syntax = "1.2.840.10008.1.2.1.99";
      scan.model.deflated = true;
      const auto where = folder / fmt::format("{} {} {}", size[0], size[2], blank);
      scan.step = {0, 0, size[2] == 1 ? 1.0 : 2.5};
      scan.write(where, random);
      scan.expect_same<std::int16_t>(where, "int16", [](std::int16_t v) { return v; }, {});
    }
  }
}

// What is above the stored bits is no part of the values.
TEST(DicomStack, TypesAndBitsOfValues) {
  const test::TemporaryFolder folder;
  std::mt19937 random(33);
  Scan scan(random);
  int count = 0;
  const auto check = [&](DicomBytes model, const std::string& type, auto meaning, double low) {
    SCOPED_TRACE(type);
    scan.model = model;
    const auto where = folder / std::to_string(count++);
    scan.write(where, random);
    using T = decltype(meaning(std::int16_t{}));
    scan.expect_same<T>(where, type, meaning, {.low = low});
  };
  DicomBytes model;
  check(
      model, "uint16", [](std::int16_t v) { return static_cast<std::uint16_t>(v); }, 1000);
  model.is_signed = 1;
  check(
      model, "int16", [](std::int16_t v) { return v; }, -5);
  model = {};
  model.stored = 10;
  model.high = 9;
  check(
      model, "uint16", [](std::int16_t v) { return static_cast<std::uint16_t>(v & 1023); }, 300);
  model.is_signed = 1;
  check(
      model, "int16", [](std::int16_t v) { return static_cast<std::int16_t>(static_cast<std::int16_t>(v << 6) >> 6); },
      -100);
  // A byte a value.
  for (int i = 0; i < 2; ++i) {
    scan.model = {};
    scan.model.allocated = scan.model.stored = 8;
    scan.model.high = 7;
    scan.model.is_signed = i;
    const auto where = folder / fmt::format("bytes{}", i);
    std::filesystem::create_directories(where);
    std::vector<std::int8_t> values;
    for (int z = 0; z < scan.size[2]; ++z) {
      DicomBytes file = scan.file(z);
      std::vector<std::int8_t> bytes;
      for (const std::int16_t v : scan.slice(z)) bytes.push_back(static_cast<std::int8_t>(v));
      file.pixels = test::raw_bytes(bytes);
      write_file(where / fmt::format("{}.dcm", z), file.bytes());
      values.insert(values.end(), bytes.begin(), bytes.end());
    }
    scan.expect_same(where, values, i == 0 ? "uint8" : "int8", {.low = 17.0});
  }
}

TEST(DicomStack, SeveralSeries) {
  const test::TemporaryFolder folder;
  std::mt19937 random(34);
  Scan one(random), two(random, {3, 3, 4});
  two.model.series = "1.2.3.5";
  two.model.description = "other";
  two.model.is_signed = 0;
  for (int z = 0; z < 6; ++z) write_file(folder / fmt::format("a{}", z), one.file(z).bytes());
  for (int z = 0; z < 4; ++z) write_file(folder / fmt::format("b{}", z), two.file(z).bytes());
  expect_error(ErrorCode::bad_input,
               {"2 DICOM series", "1.2.3.4 ('test', 6 slices)", "1.2.3.5 ('other', 4 slices)", "--series"},
               [&] { read_volume(folder.path()); });
}

TEST(DicomStack, ChosenSeries) {
  const test::TemporaryFolder folder;
  std::mt19937 random(35);
  Scan one(random), two(random, {3, 3, 4});
  two.model.series = "1.2.3.5";
  for (int z = 0; z < 6; ++z) write_file(folder / fmt::format("a{}", z), one.file(z).bytes());
  for (int z = 0; z < 4; ++z) write_file(folder / fmt::format("b{}", z), two.file(z).bytes());
  for (const char* uid : {"1.2.3.5", "5", ".3.5"}) {
    const Octree read = read_volume(folder.path(), {.low = -5000.0, .series = uid});
    EXPECT_EQ(volume(read), 36u);
  }
  EXPECT_EQ(volume(read_volume(folder.path(), {.low = -5000.0, .series = "4"})), 120u);
  expect_error(ErrorCode::bad_argument, {"no series has the UID 7", "1.2.3.4"},
               [&] { read_volume(folder.path(), {.series = "7"}); });
  expect_error(ErrorCode::bad_argument, {"spacing", "tell their own"}, [&] {
    read_volume(folder.path(), {.series = "4", .spacing = std::array<double, 3>{1, 1, 1}});
  });
}

TEST(DicomStack, SeriesThatAreNoVolume) {
  std::mt19937 random(36);
  const auto refuse = [&](auto&& change, const std::vector<std::string>& pieces,
                          ErrorCode code = ErrorCode::bad_input) {
    SCOPED_TRACE(pieces[0]);
    const test::TemporaryFolder folder;
    Scan scan(random);
    std::vector<DicomBytes> files;
    for (int z = 0; z < scan.size[2]; ++z) files.push_back(scan.file(z));
    change(files);
    for (std::size_t i = 0; i < files.size(); ++i) write_file(folder / fmt::format("IM{}", i), files[i].bytes());
    expect_error(code, pieces, [&] { read_volume(folder.path()); });
  };
  using Files = std::vector<DicomBytes>;
  refuse([](Files& f) { f.erase(f.begin() + 3); },
         {"1 slice is missing between IM2 and IM3", "5 mm apart instead of 2.5"});
  refuse([](Files& f) { f.erase(f.begin() + 2, f.begin() + 4); }, {"2 slices are missing between IM1 and IM2"});
  refuse([](Files& f) { f.push_back(f[2]); }, {"IM2 and IM6 lie in the same place"});
  refuse([](Files& f) { f[5].position[2] += 1; }, {"lie unevenly", "3.5 mm between IM4 and IM5", "2.5 mm elsewhere"});
  refuse([](Files& f) { f[3].position[1] += 1; }, {"do not lie in a row", "IM3 is 1 mm aside"});
  refuse([](Files& f) { f[3].orientation = {0, 1, 0, 1, 0, 0}; }, {"turned against each other", "IM3"});
  refuse([](Files& f) { f[3].spacing = {1, 1}; }, {"voxels of different sizes", "IM3"});
  refuse([](Files& f) { f[3].position.clear(); }, {"IM0 tells where it lies and IM3 does not"});
  refuse(
      [](Files& f) {
        f[3].rows = 2;
        f[3].columns = 10;
      },
      {"differ in size", "5 x 4", "IM3 has 10 x 2"});
  refuse(
      [](Files& f) {
        for (DicomBytes& file : f) file.position.clear();
      },
      {"cannot be ordered"});
  refuse([](Files& f) { f[4].slope = "nan"; }, {"IM4", "slope", "no finite number"});
  refuse(
      [](Files& f) {
        for (DicomBytes& file : f) file.orientation = {1, 0, 0, 0.6, 0.8, 0};
      },
      {"right angles"});
  refuse(
      [](Files& f) {
        for (DicomBytes& file : f) file.orientation = {0, 0, 0, 0, 0, 0};
      },
      {"length 0"});
  refuse([](Files& f) { f[1].position[0] = 1e30; }, {"IM1 lies beyond all bounds"});
  refuse([](Files& f) { f[1].meaning = "PALETTE COLOR"; }, {"IM1 is in colours"});
  refuse([](Files& f) { f[1].pixels.resize(20); }, {"IM1"});
  refuse(
      [](Files& f) {
        f[1].rows = 60000;
        f[1].columns = 60000;
      },
      {"IM1", "60000 x 60000", "can hold"});
  refuse([](Files& f) { f[1].frames = 2000000000; }, {"IM1", "can hold"});
}

// Only tags that are absent mean that a file does not tell where it lies.
TEST(DicomStack, GeometryThatMakesNoSense) {
  std::mt19937 random(43);
  const Scan scan(random, {5, 4, 3});
  const auto element = [](std::uint16_t group, std::uint16_t number, const std::string& value) {
    return test::element(group, number, "DS", value);
  };
  const auto check = [&](std::uint16_t group, std::uint16_t number, const std::string& sound, const std::string& bad,
                         const std::string& name) {
    SCOPED_TRACE(bad);
    const test::TemporaryFolder folder;
    for (int z = 0; z < 3; ++z) {
      DicomBytes file = scan.file(z);
      file.thickness = file.between = 2.5;
      std::string bytes = file.bytes();
      const std::string old = element(group, number, sound.empty() ? test::decimals(file.position) : sound);
      const std::size_t at = bytes.find(old);
      ASSERT_NE(at, std::string::npos);
      bytes.replace(at, old.size(), element(group, number, bad));
      write_file(folder / fmt::format("IM{}", z), bytes);
    }
    expect_error(ErrorCode::bad_input, {"IM0: its " + name, fmt::format("({:04x},{:04x})", group, number), bad},
                 [&] { read_volume(folder.path()); });
  };
  for (const char* bad : {"0\\1", "-1\\1", "1\\0", "nan\\1", "inf\\1", "1", "a\\b"})
    check(0x28, 0x30, "0.9375\\0.7", bad, "Pixel Spacing");
  for (const char* bad : {"nan\\0\\0", "a\\b\\c", "1\\2"}) check(0x20, 0x32, "", bad, "Image Position");
  check(0x20, 0x37, "1\\0\\0\\0\\1\\0", "1\\0\\0\\0\\1", "Image Orientation");
  check(0x18, 0x88, "2.5", "nan", "Spacing Between Slices");
  check(0x18, 0x50, "2.5", "wide", "Slice Thickness");
}

TEST(DicomStack, LostNumberOfFrames) {
  const test::TemporaryFolder folder;
  std::mt19937 random(44);
  const Scan scan(random, {5, 4, 3});
  DicomBytes file = scan.file(0);
  for (const std::size_t frames : {2u, 3u}) {
    file.pixels = test::raw_bytes(scan.stored).substr(0, frames * 40);
    write_file(folder / "a.dcm", file.bytes());
    expect_error(
        ErrorCode::bad_input,
        {"a.dcm: its header tells of 5 x 4 x 1 voxels", fmt::format("values of {} bytes", frames * 40), "Frames"},
        [&] { read_volume(folder / "a.dcm"); });
  }
  // One byte is padded to two.
  file.columns = file.rows = 1;
  file.allocated = file.stored = 8;
  file.high = 7;
  file.pixels = "a";
  write_file(folder / "a.dcm", file.bytes());
  EXPECT_EQ(volume(read_volume(folder / "a.dcm", {.low = 1.0})), 1u);
}

TEST(DicomStack, OneSliceOrWithoutPlaces) {
  const test::TemporaryFolder folder;
  std::mt19937 random(37);
  Scan scan(random, {5, 4, 1});
  DicomBytes file = scan.file(0);
  file.thickness = 2.5;
  write_file(folder / "noname", file.bytes());
  EXPECT_FALSE(is_volume_name(folder / "noname"));
  EXPECT_TRUE(is_volume(folder / "noname"));
  scan.expect_same<std::int16_t>(folder / "noname", "int16", [](std::int16_t v) { return v; }, {.low = 0.0});
  file.thickness = 0;
  write_file(folder / "noname", file.bytes());
  scan.step = {0, 0, 1};
  scan.expect_same<std::int16_t>(folder / "noname", "int16", [](std::int16_t v) { return v; }, {.low = 0.0});

  // Ordered by number when nothing else is told.
  Scan more(random, {3, 3, 5});
  std::filesystem::create_directory(folder / "f");
  for (int z = 0; z < 5; ++z) {
    DicomBytes each = more.file(z);
    each.position.clear();
    each.number = z + 7;
    write_file(folder / "f" / fmt::format("{}", 9 - z), each.bytes());
  }
  const Octree plain = read_volume(folder / "f", {.low = 0.0});
  EXPECT_TRUE(plain.frame() == Frame{});
  test::write_nrrd(folder / "a.nrrd", "int16", "3 3 5", more.stored);
  EXPECT_TRUE(plain == read_volume(folder / "a.nrrd", {.low = 0.0}));
  const Octree sized = read_volume(folder / "f", {.spacing = std::array<double, 3>{2, 3, 4}});
  EXPECT_EQ(sized.frame().unit, "mm");
  EXPECT_TRUE(sized.frame().origin.isZero());
  EXPECT_TRUE(sized.frame().axes.diagonal().isApprox(Eigen::Vector3d(2, 3, 4)));
}

TEST(DicomStack, FramesOfOneFile) {
  const test::TemporaryFolder folder;
  std::mt19937 random(38);
  Scan scan(random);
  const auto same = [](std::int16_t v) { return v; };
  DicomBytes file = scan.file(0);
  file.frames = scan.size[2];
  file.pixels = test::raw_bytes(scan.stored);
  // Told how far apart, or by radiotherapy's offsets.
  file.between = 2.5;
  write_file(folder / "between.dcm", file.bytes());
  scan.expect_same<std::int16_t>(folder / "between.dcm", "int16", same, {.low = 0.0});
  file.between = 0;
  file.doses = test::element(0x3004, 0x0c, "DS", test::decimals({0, 2.5, 5, 7.5, 10, 12.5}));
  write_file(folder / "offsets.dcm", file.bytes());
  scan.expect_same<std::int16_t>(folder / "offsets.dcm", "int16", same, {.low = 0.0});
  for (const char* bad : {"0\\2.5\\nan\\7.5\\10\\12.5", "0\\2.5\\5\\7.5\\x\\12.5", "0\\2.5\\5"}) {
    file.doses = test::element(0x3004, 0x0c, "DS", bad);
    write_file(folder / "bad.dcm", file.bytes());
    expect_error(ErrorCode::bad_input, {"bad.dcm: its Grid Frame Offset Vector (3004,000c)", "6 numbers"},
                 [&] { read_volume(folder / "bad.dcm"); });
  }
  file.doses.clear();
  write_file(folder / "nowhere.dcm", file.bytes());
  EXPECT_EQ(read_volume(folder / "nowhere.dcm").frame().unit, "voxel");
  // Functional groups; the frames lie in another order than they are stored in, and each has its own meaning.
  std::vector<int> order = {3, 0, 5, 1, 4, 2};
  file.sop_class = "1.2.840.10008.5.1.4.1.1.2.1";
  file.position.clear();
  const auto sequence = [](std::uint16_t group, std::uint16_t number, const std::string& content) {
    return test::element(group, number, "SQ", content);
  };
  const std::string shared = sequence(0x20, 0x9116, test::item(test::element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0"))) +
                             sequence(0x28, 0x9110, test::item(test::element(0x28, 0x30, "DS", "0.9375\\0.7")));
  std::string per_frame;
  file.pixels.clear();
  for (const int z : order) {
    per_frame += test::item(
        sequence(0x20, 0x9113,
                 test::item(test::element(0x20, 0x32, "DS", test::decimals(list(scan.origin + z * scan.step))))) +
        sequence(0x28, 0x9145,
                 test::item(test::element(0x28, 0x1052, "DS", fmt::format("{}", 10 * z)) +
                            test::element(0x28, 0x1053, "DS", "2"))));
    file.pixels += test::raw_bytes(scan.slice(z));
  }
  file.groups = sequence(0x5200, 0x9229, test::item(shared)) + sequence(0x5200, 0x9230, per_frame);
  write_file(folder / "enhanced.dcm", file.bytes());
  std::vector<std::int16_t> meant;
  for (std::size_t i = 0; i < scan.stored.size(); ++i)
    meant.push_back(static_cast<std::int16_t>(2 * scan.stored[i] + 10 * static_cast<int>(i / scan.slice_values())));
  scan.expect_same(folder / "enhanced.dcm", meant, "int16", {.low = 30.0});
}

// RLE Lossless, packed by hand as runs of literal bytes: one segment for the high bytes, one for the low ones.
std::string rle(const std::vector<std::int16_t>& values) {
  const auto segment = [&](int shift) {
    std::string bytes;
    for (const std::int16_t v : values) {
      bytes += '\0';  // one literal follows
      bytes += static_cast<char>(static_cast<std::uint16_t>(v) >> shift & 255);
    }
    return bytes;
  };
  const std::string high = segment(8), low = segment(0);
  std::string header = test::little(std::uint32_t{2}) + test::little(std::uint32_t{64}) +
                       test::little(static_cast<std::uint32_t>(64 + high.size()));
  header.resize(64, '\0');
  return header + high + low;
}

TEST(DicomStack, CompressedSlicesAndFrames) {
  const test::TemporaryFolder folder;
  std::mt19937 random(39);
  Scan scan(random);
  scan.model.syntax = "1.2.840.10008.1.2.5";
  scan.model.encapsulated = true;
  std::filesystem::create_directory(folder / "f");
  std::string all;
  for (int z = 0; z < scan.size[2]; ++z) {
    DicomBytes file = scan.file(z);
    file.pixels = test::item("") + test::item(rle(scan.slice(z)));
    write_file(folder / "f" / fmt::format("{}.dcm", z), file.bytes());
    all += test::item(rle(scan.slice(z)));
  }
  const auto same = [](std::int16_t v) { return v; };
  scan.expect_same<std::int16_t>(folder / "f", "int16", same, {.low = 0.0});
  DicomBytes file = scan.file(0);
  file.frames = scan.size[2];
  file.between = 2.5;
  file.pixels = test::item("") + all;
  write_file(folder / "frames.dcm", file.bytes());
  scan.expect_same<std::int16_t>(folder / "frames.dcm", "int16", same, {.low = 0.0});
  file.frames = 0;
  write_file(folder / "lost.dcm", file.bytes());
  expect_error(ErrorCode::bad_input, {"lost.dcm", "values are"}, [&] { read_volume(folder / "lost.dcm"); });
}

TEST(DicomStack, OtherFilesArePassedOver) {
  const test::TemporaryFolder folder;
  std::mt19937 random(40);
  Scan scan(random);
  scan.write(folder.path(), random);
  write_file(folder / ".hidden", "nothing");
  write_file(folder / "notes.txt", "nothing");
  write_file(folder / "empty", "");
  std::filesystem::create_directory(folder / "sub");
  DicomBytes report = scan.file(0);  // without rows and columns it is no image
  std::string bytes = report.bytes();
  const std::size_t image = bytes.find(test::element(0x28, 0x02, "US", test::little(std::uint16_t{1})));
  ASSERT_NE(image, std::string::npos);
  write_file(folder / "report.dcm", bytes.substr(0, image));
  std::vector<std::string> warnings;
  VolumeOptions options{.low = 0.0};
  options.warn = [&](const std::string& line) { warnings.push_back(line); };
  scan.expect_same<std::int16_t>(folder.path(), "int16", [](std::int16_t v) { return v; }, {.low = 0.0});
  read_volume(folder.path(), options);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("3 files are no slices and passed over"), std::string::npos) << warnings[0];
  write_file(folder / "bad.dcm", "not DICOM at all");
  expect_error(ErrorCode::bad_input, {"bad.dcm", "not a DICOM file"}, [&] { read_volume(folder.path()); });
}

TEST(DicomStack, ManyTinySlices) {
  const test::TemporaryFolder folder;
  std::mt19937 random(41);
  const Scan scan(random, {1, 1, 600});
  scan.write(folder.path(), random);
  scan.expect_same<std::int16_t>(folder.path(), "int16", [](std::int16_t v) { return v; }, {.low = 0.0});
}

// Whatever is wrong with a file, it ends in an octree or one clear line.
TEST(DicomStack, MutatedFiles) {
  const test::TemporaryFolder folder;
  std::mt19937 random(42);
  Scan scan(random, {5, 4, 2});
  const std::string whole = scan.file(0).bytes();
  const std::size_t from = whole.find("DICM") + 4;
  std::filesystem::create_directory(folder / "f");
  write_file(folder / "f" / "b", scan.file(1).bytes());
  int refused = 0;
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE(i);
    std::string bytes = whole;
    if (i % 5 == 0) bytes.resize(from + 1 + random() % (bytes.size() - from - 1));
    for (std::size_t k = 0; k < 1 + random() % 4; ++k)
      bytes[from + random() % (bytes.size() - from)] = static_cast<char>(random() % 3 == 0 ? 255 : random());
    write_file(folder / "f" / "a", bytes);
    try {
      reference::expect_valid(read_volume(folder / "f"));
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(refused, 25);
}

}  // namespace
}  // namespace blackleaf
