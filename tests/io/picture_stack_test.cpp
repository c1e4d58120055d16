// Stacks of PNG and TIFF pictures as volumes: compared with NRRD files of the same values.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "blackleaf/measures.h"
#include "blackleaf/volume_file.h"
#include "io/nrrd_text.h"
#include "io/slice_bytes.h"
#include "io/stack_files.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using test::expect_error;
using test::TiffPage;
using test::write_file;

template <class T>
std::vector<T> noise(std::size_t count, std::mt19937& random) {
  std::vector<T> values(count);
  for (T& v : values) v = static_cast<T>(random());
  return values;
}

template <class T>
std::string big_endian(const std::vector<T>& values) {
  std::string bytes;
  for (const T v : values) bytes += test::big(v);
  return bytes;
}

// The stack is the volume of these values, x fastest, in voxels of side 1.
template <class T>
void expect_same(const std::filesystem::path& stack, const std::string& type, const std::string& sizes,
                 const std::vector<T>& values, double low) {
  const test::TemporaryFolder folder;
  test::write_nrrd(folder / "a.nrrd", type, sizes, values);
  const Octree read = read_volume(stack, {.low = low});
  EXPECT_TRUE(read == read_volume(folder / "a.nrrd", {.low = low}));
  EXPECT_TRUE(read.frame() == Frame{});
  reference::expect_valid(read);
}

template <class T>
std::vector<T> part(const std::vector<T>& values, std::size_t slice, std::size_t count) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(slice * count);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

TEST(StackFiles, NaturalOrder) {
  std::vector<std::string> names = {"img10",
                                    "img9",
                                    "img1",
                                    "img01",
                                    "img2b",
                                    "img2",
                                    "img",
                                    "a10b2",
                                    "a10b10",
                                    "a2b30",
                                    "a",
                                    "0",
                                    "00",
                                    "1",
                                    "10",
                                    "9",
                                    "x1.5",
                                    "x1.10",
                                    "Z",
                                    "b-1",
                                    "b-10",
                                    "b-2",
                                    "99999999999999999999999999",
                                    "100000000000000000000000000"};
  std::mt19937 random(5);
  const auto before = [](const std::string& a, const std::string& b) { return detail::natural_less(a, b); };
  std::vector<std::string> sorted = names;
  std::sort(sorted.begin(), sorted.end(), before);
  for (int i = 0; i < 100; ++i) {
    std::shuffle(names.begin(), names.end(), random);
    std::sort(names.begin(), names.end(), before);
    ASSERT_EQ(names, sorted);
  }
  for (const auto& [a, b] :
       std::vector<std::pair<std::string, std::string>>{{"img2", "img10"},
                                                        {"img9", "img10"},
                                                        {"a2b30", "a10b2"},
                                                        {"img01", "img1"},
                                                        {"img1", "img2"},
                                                        {"a", "a1"},
                                                        {"x1.5", "x1.10"},
                                                        {"99999999999999999999999999", "100000000000000000000000000"},
                                                        {"Z", "a"}}) {
    EXPECT_TRUE(before(a, b)) << a << " " << b;
    EXPECT_FALSE(before(b, a)) << a << " " << b;
  }
  // Three at a time: an order that goes round would show.
  for (const auto& a : names)
    for (const auto& b : names)
      for (const auto& c : names)
        if (before(a, b) && before(b, c)) {
          ASSERT_TRUE(before(a, c)) << a << " " << b << " " << c;
        }
}

TEST(PictureStack, PngOfEveryDepth) {
  const test::TemporaryFolder folder;
  std::mt19937 random(51);
  constexpr std::uint32_t kWidth = 13, kHeight = 5;
  constexpr std::size_t kSlice = kWidth * kHeight, kSlices = 12;  // more than nine: slice10 is the last but one
  for (const int bits : {1, 2, 4, 8, 16}) {
    SCOPED_TRACE(bits);
    std::vector<std::uint16_t> values = noise<std::uint16_t>(kSlice * kSlices, random);
    for (auto& v : values) v = static_cast<std::uint16_t>(v & ((1u << bits) - 1));
    const auto where = folder / std::to_string(bits);
    std::filesystem::create_directory(where);
    for (std::size_t z = 0; z < kSlices; ++z) {
      std::string rows;
      for (std::size_t y = 0; y < kHeight; ++y) {
        std::string row((kWidth * static_cast<std::size_t>(bits) + 7) / 8, '\0');
        for (std::size_t x = 0; x < kWidth; ++x) {
          const unsigned v = values[z * kSlice + y * kWidth + x];
          if (bits == 16) {
            row[2 * x] = static_cast<char>(v >> 8);
            row[2 * x + 1] = static_cast<char>(v);
          } else {
            const std::size_t bit = x * static_cast<std::size_t>(bits);
            row[bit / 8] =
                static_cast<char>(row[bit / 8] | static_cast<char>(v << (8 - static_cast<unsigned>(bits) - bit % 8)));
          }
        }
        rows += row;
      }
      write_file(where / fmt::format("slice{}.png", z), test::png_bytes(kWidth, kHeight, bits, rows));
    }
    expect_same(where, "uint16", "13 5 12", values, 1);
    expect_same(where, "uint16", "13 5 12", values, (1 << bits) / 2);
  }
  EXPECT_EQ(read_volume(folder / "8" / "slice3.png", {.low = 0.0}).depth(), 4);
}

TEST(PictureStack, TiffOfEveryType) {
  const test::TemporaryFolder folder;
  std::mt19937 random(52);
  constexpr std::uint32_t kWidth = 21, kHeight = 18;
  constexpr std::size_t kSlice = kWidth * kHeight, kSlices = 3;
  const auto check = [&]<class T>(T, const std::string& type, int format, double low) {
    std::vector<T> values = noise<T>(kSlice * kSlices, random);
    if constexpr (std::is_floating_point_v<T>) values[5] = std::numeric_limits<T>::quiet_NaN();
    for (int variant = 0; variant < 8; ++variant) {
      SCOPED_TRACE(testing::Message() << type << " " << variant);
      std::vector<TiffPage> pages;
      for (std::size_t z = 0; z < kSlices; ++z) {
        TiffPage page;
        page.width = kWidth;
        page.height = kHeight;
        page.bits = 8 * static_cast<int>(sizeof(T));
        page.format = format;
        page.tile = variant & 1 ? 16 : 0;
        page.deflate = (variant & 2) != 0;
        page.values = variant & 4 ? big_endian(part(values, z, kSlice)) : test::raw_bytes(part(values, z, kSlice));
        pages.push_back(page);
      }
      write_file(folder / "a.tif", test::tiff_bytes(pages, (variant & 4) != 0));
      expect_same(folder / "a.tif", type, "21 18 3", values, low);
    }
  };
  check(std::uint8_t{}, "uint8", 1, 100);
  check(std::int8_t{}, "int8", 2, -10);
  check(std::uint16_t{}, "uint16", 1, 40000);
  check(std::int16_t{}, "int16", 2, -1000);
  check(std::uint32_t{}, "uint32", 1, 3e9);
  check(std::int32_t{}, "int32", 2, -1e8);
  check(std::uint64_t{}, "uint64", 1, 2e9);
  check(float{}, "float", 3, 1e9);
  check(double{}, "double", 3, 1e9);
}

TEST(PictureStack, TiffOfFewBitsAndWhiteAsZero) {
  const test::TemporaryFolder folder;
  std::mt19937 random(53);
  for (const int bits : {1, 2, 4, 8, 16})
    for (const int meaning : {1, 0}) {
      SCOPED_TRACE(testing::Message() << bits << " " << meaning);
      constexpr std::size_t kWidth = 11, kHeight = 6;
      const unsigned most = (1u << bits) - 1;
      TiffPage page;
      page.width = kWidth;
      page.height = kHeight;
      page.bits = bits;
      page.meaning = meaning;
      std::vector<std::uint16_t> values;
      for (std::size_t y = 0; y < kHeight; ++y) {
        std::string row((kWidth * static_cast<std::size_t>(bits) + 7) / 8, '\0');
        for (std::size_t x = 0; x < kWidth; ++x) {
          const auto v = static_cast<unsigned>(random()) & most;
          values.push_back(static_cast<std::uint16_t>(meaning == 1 ? v : most - v));
          const std::size_t bit = x * static_cast<std::size_t>(bits);
          if (bits == 16)
            row.replace(2 * x, 2, test::little(static_cast<std::uint16_t>(v)));
          else
            row[bit / 8] =
                static_cast<char>(row[bit / 8] | static_cast<char>(v << (8 - static_cast<unsigned>(bits) - bit % 8)));
        }
        page.values += row;
      }
      write_file(folder / "a.tif", test::tiff_bytes({page}));
      expect_same(folder / "a.tif", "uint16", "11 6 1", values, 1);
      expect_same(folder / "a.tif", "uint16", "11 6 1", values, most);
    }
}

TEST(PictureStack, FoldersOfTiffFilesAndReducedCopies) {
  const test::TemporaryFolder folder;
  std::mt19937 random(54);
  const auto values = noise<std::uint8_t>(std::size_t{6} * 5 * 11, random);
  std::filesystem::create_directory(folder / "f");
  for (std::size_t z = 0; z < 11; ++z) {
    TiffPage page, small;
    page.width = 6;
    page.height = 5;
    page.values = test::raw_bytes(part(values, z, 30));
    small.kind = 1;
    small.values = "x";
    write_file(folder / "f" / fmt::format("s{}.tiff", z + 3), test::tiff_bytes({page, small}));
  }
  std::vector<std::string> warnings;
  VolumeOptions options{.low = 100.0};
  options.warn = [&](const std::string& line) { warnings.push_back(line); };
  expect_same(folder / "f", "uint8", "6 5 11", values, 100);
  read_volume(folder / "f", options);
  EXPECT_TRUE(warnings.empty());
  std::filesystem::remove(folder / "f" / "s7.tiff");
  read_volume(folder / "f", options);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("not numbered evenly: s8.tiff follows s6.tiff"), std::string::npos) << warnings[0];
  std::filesystem::rename(folder / "f" / "s13.tiff", folder / "f" / "s13_mask.tiff");
  read_volume(folder / "f", options);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[1].find("no single pattern"), std::string::npos) << warnings[1];
}

// Pages that cannot be reached are an error, not the end of the volume.
TEST(PictureStack, TiffChainsThatBreakOff) {
  const test::TemporaryFolder folder;
  for (const bool big_endian : {false, true}) {
    TiffPage page;
    page.values = "a";
    const std::string two = test::tiff_bytes({page, page}, big_endian);
    const std::string whole = test::tiff_bytes({page, page, page}, big_endian);
    // The third page is its value, padded, and then its directory, which starts with a count of two bytes.
    for (std::size_t size = two.size() + 2; size < whole.size(); ++size) {
      SCOPED_TRACE(size);
      write_file(folder / "a.tif", whole.substr(0, size));
      expect_error(ErrorCode::bad_input, {"a.tif: is "}, [&] { read_volume(folder / "a.tif"); });
    }
    for (const std::uint32_t place : {0xfffffff0u, static_cast<std::uint32_t>(whole.size()), 8u}) {
      SCOPED_TRACE(place);
      std::string bytes = whole;
      bytes.replace(two.size() - 4, 4, big_endian ? test::big(place) : test::little(place));
      write_file(folder / "a.tif", bytes);
      expect_error(ErrorCode::bad_input, {"a.tif: is damaged behind page 2"}, [&] { read_volume(folder / "a.tif"); });
    }
    write_file(folder / "a.tif", whole);
    EXPECT_EQ(volume(read_volume(folder / "a.tif", {.low = 1.0})), 3u);
  }
}

TEST(PictureStack, VoxelSizes) {
  const test::TemporaryFolder folder;
  const auto frame_of = [&](const std::string& description, double resolution, const VolumeOptions& options = {}) {
    TiffPage page;
    page.values = "a";
    page.description = description;
    page.pixels_a_unit = resolution;
    TiffPage second = page;
    second.description.clear();
    write_file(folder / "a.tif", test::tiff_bytes({page, second}));
    return read_volume(folder / "a.tif", options).frame();
  };
  const auto expect = [&](const Frame& frame, double x, double z) {
    EXPECT_EQ(frame.unit, "mm");
    EXPECT_TRUE(frame.axes.diagonal().isApprox(Eigen::Vector3d(x, x, z), 1e-6)) << frame.axes.diagonal().transpose();
    EXPECT_TRUE(frame.origin.isZero(1e-12));
  };
  expect(frame_of("ImageJ=1.53t\nimages=2\nslices=2\nunit=micron\nspacing=2.5\nloop=false\n", 4), 0.00025, 0.0025);
  expect(frame_of("ImageJ=1.53t\nimages=2\nslices=2\nunit=\\u00B5m\nspacing=-2\n", 4), 0.00025, 0.002);
  expect(
      frame_of(
          "<?xml?><OME><Image><Pixels SizeC=\"1\" SizeT=\"1\" SizeZ=\"2\" PhysicalSizeX=\"0.5\" PhysicalSizeY=\"0.5\" "
          "PhysicalSizeZ=\"2\" PhysicalSizeZUnit=\"mm\"/></Image></OME>",
          0),
      0.0005, 2);
  for (const Frame& frame : {frame_of("", 300), frame_of("ImageJ=1.53t\nimages=2\nunit=pixel\nspacing=2\n", 1),
                             frame_of("ImageJ=1.53t\nimages=2\nunit=mm\n", 1),
                             frame_of("ImageJ=1.53t\nimages=2\nunit=mm\nspacing=nan\n", 1)})
    EXPECT_TRUE(frame == Frame{});
  expect(frame_of("ImageJ=1.53t\nimages=2\nunit=mm\nspacing=9\n", 1, {.spacing = std::array<double, 3>{2, 2, 3}}), 2,
         3);
  expect_error(ErrorCode::bad_input, {"a.tif: has several channels"},
               [&] { frame_of("ImageJ=1.53t\nimages=2\nchannels=2\n", 1); });
  expect_error(ErrorCode::bad_input, {"several times"},
               [&] { frame_of("ImageJ=1.53t\nimages=4\nslices=2\nframes=2\n", 1); });
  expect_error(ErrorCode::bad_input, {"tells of 9 pictures but has 2"},
               [&] { frame_of("ImageJ=1.53t\nimages=9\n", 1); });
  const auto ome = [](const std::string& more) {
    return "<?xml?><OME><Image><Pixels SizeC=\"1\" SizeT=\"1\" SizeZ=\"5\">" + more + "</Pixels></Image></OME>";
  };
  const std::string a = "<TiffData><UUID FileName=\"a.tif\"/></TiffData>";
  for (const std::string& more : {std::string(), a, a + a})
    expect_error(ErrorCode::bad_input, {"a.tif: tells of 5 slices but has 2 pages"}, [&] { frame_of(ome(more), 1); });
  EXPECT_TRUE(frame_of(ome(a + a + "<TiffData><UUID FileName=\"b.tif\"/></TiffData>"), 1) == Frame{});
  for (const double side : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), HUGE_VAL})
    expect_error(ErrorCode::bad_argument, {"makes no sense"}, [&] {
      frame_of("", 1, {.spacing = std::array<double, 3>{1, side, 1}});
    });
}

TEST(PictureStack, WhatIsNoStack) {
  const auto refuse = [&](const std::vector<std::pair<std::string, std::string>>& files,
                          const std::vector<std::string>& pieces, const VolumeOptions& options = {},
                          ErrorCode code = ErrorCode::bad_input) {
    SCOPED_TRACE(pieces[0]);
    const test::TemporaryFolder folder;
    for (const auto& [name, content] : files) {
      if (content == "folder")
        std::filesystem::create_directory(folder / name);
      else
        write_file(folder / name, content);
    }
    expect_error(code, pieces, [&] { read_volume(folder.path(), options); });
  };
  const std::string png = test::png_bytes(2, 2, 8, "abcd"), wide = test::png_bytes(4, 1, 8, "abcd");
  const std::string deep = test::png_bytes(2, 2, 16, "abcdefgh");
  TiffPage page;
  page.values = "a";
  const std::string tiff = test::tiff_bytes({page});
  refuse({}, {"empty folder"});
  refuse({{"a.txt", "text"}, {"b.jpg", "\xff\xd8"}}, {"holds no slices", "2 files are neither"});
  refuse({{"sub", "folder"}}, {"holds no slices itself, but 1 folder"});
  refuse({{"a.png", png}, {"a.tif", tiff}}, {"both PNG and TIFF", "a.png", "a.tif"});
  refuse({{"1.png", png}, {"2.png", wide}}, {"differ in size", "1.png has 2 x 2", "2.png has 4 x 1"});
  refuse({{"1.png", png}, {"2.png", deep}}, {"differ in the type", "1.png", "2.png"});
  refuse({{"1.png", png}, {"2.png", "text"}}, {"2.png: is not a PNG file"});
  refuse({{"1.png", "text"}}, {"1.png: is not a PNG file"});
  refuse({{"1.png", png}}, {"series"}, {.series = "1.2"}, ErrorCode::bad_argument);
  refuse({{"1.png", test::png_bytes(1, 1, 8, "abc", 2)}}, {"is in colours", "save it as gray"});
  refuse({{"1.png", test::png_bytes(1, 1, 8, "ab", 4)}}, {"alpha"});
  refuse({{"1.png", test::png_bytes(1, 1, 8, "a", 3)}}, {"palette"});
  refuse({{"1.png", png.substr(0, png.size() - 20)}}, {"1.png: is damaged"});
  std::string huge = png;
  huge.replace(16, 8, test::big(std::uint32_t{1} << 20) + test::big(std::uint32_t{1} << 20));
  refuse({{"1.png", huge}}, {"1048576 x 1048576", "can hold"});
  refuse({{"1.tif", tiff.substr(0, tiff.size() - 30)}}, {"1.tif"});
  refuse({{"1.tif", test::tiff_bytes({page, page})}, {"2.tif", tiff}}, {"1.tif of its 2 files has 2 pages"});
  TiffPage other = page;
  other.samples = 3;
  other.meaning = 2;
  other.values = "abc";
  refuse({{"1.tif", test::tiff_bytes({other})}}, {"is in colours"});
  other = page;
  other.meaning = 3;
  refuse({{"1.tif", test::tiff_bytes({other})}}, {"palette"});
  other = page;
  other.width = other.height = 1 << 19;
  refuse({{"1.tif", test::tiff_bytes({other})}}, {"524288 x 524288", "can hold"});
  other = page;
  other.bits = 16;
  other.format = 3;
  other.values = "ab";
  refuse({{"1.tif", test::tiff_bytes({other})}}, {"floating-point values of 16 bits"});
  other = page;
  other.width = 2;
  other.values = "ab";
  refuse({{"1.tif", test::tiff_bytes({page, other})}}, {"differ in size", "page 1 of 1.tif", "page 2 of 1.tif"});
  // The last entry, the format of the values, becomes the orientation.
  std::string mirrored = tiff;
  mirrored.replace(mirrored.size() - 16, 12,
                   test::little(std::uint16_t{274}) + test::little(std::uint16_t{3}) + test::little(std::uint32_t{1}) +
                       test::little(std::uint32_t{4}));
  refuse({{"1.tif", mirrored}}, {"1.tif: is to be shown turned or mirrored", "orientation is 4"});
  const test::TemporaryFolder folder;
  test::write_nrrd<std::uint8_t>(folder / "a.nrrd", "uint8", "1 1 1", {1});
  expect_error(ErrorCode::bad_argument, {"a.nrrd", "spacing"}, [&] {
    read_volume(folder / "a.nrrd", {.spacing = std::array<double, 3>{1, 1, 1}});
  });
  write_file(folder / "a.tif", "text");
  expect_error(ErrorCode::bad_input, {"a.tif", "neither DICOM nor TIFF nor PNG"},
               [&] { read_volume(folder / "a.tif"); });
}

TEST(PictureStack, MutatedFiles) {
  const test::TemporaryFolder folder;
  std::mt19937 random(55);
  TiffPage page;
  page.width = page.height = 20;
  page.values = test::raw_bytes(noise<std::uint8_t>(400, random));
  TiffPage tiled = page;
  tiled.tile = 16;
  tiled.deflate = true;
  const std::vector<std::string> files = {test::png_bytes(20, 20, 8, page.values), test::tiff_bytes({page, tiled})};
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    const bool png = i % 3 == 0;
    std::string bytes = files[png ? 0 : 1];
    // TIFF's directories matter more than its values.
    const std::size_t from = png ? 8 : bytes.size() - 420;
    if (i % 5 == 0) bytes.resize(from + random() % (bytes.size() - from));
    for (std::size_t k = 0; k < 1 + random() % 4 && bytes.size() > from; ++k)
      bytes[from + random() % (bytes.size() - from)] = static_cast<char>(random() % 3 == 0 ? 255 : random());
    const auto name = folder / (png ? "a.png" : "a.tif");
    write_file(name, bytes);
    try {
      reference::expect_valid(read_volume(name));
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace blackleaf
