// Label maps from volume files and back; real atlases against a dense reading by zlib alone.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <random>

#include "blackleaf/label_map.h"
#include "blackleaf/volume_file.h"
#include "io/nrrd_text.h"
#include "reference/dense_labels.h"

namespace blackleaf {
namespace {

using reference::DenseLabels;
using test::expect_error;

LabelMap random_map(int depth, std::vector<std::uint32_t> palette, std::mt19937& random, Frame frame) {
  const std::int64_t side = std::int64_t{1} << depth;
  DenseLabels grid(depth);
  grid.labels = reference::random_labels({side, side, side}, palette, random);
  return LabelMap(grid.runs(), depth, std::move(frame));
}

Frame frame() {
  Frame frame;
  frame.origin << 3, -4, 5.5;
  frame.axes.diagonal() << -0.5, 0.75, 3;
  frame.unit = "mm";
  return frame;
}

TEST(LabelVolume, RoundTrips) {
  const test::TemporaryFolder folder;
  std::mt19937 random(41);
  const std::vector<std::vector<std::uint32_t>> palettes = {{0, 1, 255}, {0, 7, 256, 65535}, {0, 65536, 4294967295u}};
  for (const char* name : {"a.nrrd", "a.mha", "a.nii", "a.nii.gz"})
    for (std::size_t i = 0; i < 12; ++i) {
      SCOPED_TRACE(testing::Message() << name << " " << i);
      const LabelMap map = random_map(1 + static_cast<int>(i) / 3, palettes[i % 3], random, frame());
      write_volume(map, folder / name);
      const LabelMap read = read_label_volume(folder / name);
      EXPECT_TRUE(read == map);
      EXPECT_TRUE(read.frame().same_as(map.frame(), 1e-5));
    }
}

TEST(LabelVolume, CroppedVolumesKeepTheirPlace) {
  const test::TemporaryFolder folder;
  std::mt19937 random(42);
  for (int i = 0; i < 30; ++i) {
    SCOPED_TRACE(i);
    const LabelMap map = random_map(2 + i % 3, {0, 0, 0, 5, 9}, random, frame());
    write_volume(map, folder / "a.nrrd", true);
    const LabelMap read = read_label_volume(folder / "a.nrrd");
    const auto box = bounding_box(octree_from_labels(map));
    const std::array<int, 3> corner = box ? box->min : std::array<int, 3>{};
    EXPECT_TRUE(
        read.frame().same_as(map.frame().shifted({double(corner[0]), double(corner[1]), double(corner[2])}), 1e-5));
    for (int z = 0; z < map.side(); ++z)
      for (int y = 0; y < map.side(); ++y)
        for (int x = 0; x < map.side(); ++x)
          ASSERT_EQ(read.label(x - corner[0], y - corner[1], z - corner[2]), map.label(x, y, z));
  }
}

TEST(LabelVolume, TheSmallestTypeThatHoldsAllLabels) {
  const test::TemporaryFolder folder;
  const auto type_of = [&](std::uint32_t label) {
    const std::vector<blackleaf::Run> runs = {{3, 0}, {5, label}};
    write_volume(LabelMap(runs, 1), folder / "a.nrrd");
    const std::string text = test::read_text(folder / "a.nrrd");
    const std::size_t at = text.find("type: ") + 6;
    return text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_TRUE(type_of(255) == "uint8" || type_of(255) == "unsigned char") << type_of(255);
  EXPECT_TRUE(type_of(256) == "uint16" || type_of(256) == "unsigned short") << type_of(256);
  EXPECT_TRUE(type_of(65536) == "uint32" || type_of(65536) == "unsigned int") << type_of(65536);
}

TEST(LabelVolume, PlacementAndBands) {
  const test::TemporaryFolder folder;
  std::vector<float> values(5 * 3 * 9);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i) - 20.5f;
  values[4] = std::numeric_limits<float>::quiet_NaN();
  test::write_nrrd(folder / "a.nrrd", "float", "5 3 9", values);
  LabelVolumeOptions options;
  options.bands = Bands{{-10, 0.5, 40}};
  options.depth = 5;
  options.centre = true;
  const LabelMap map = read_label_volume(folder / "a.nrrd", options);
  ASSERT_EQ(map.depth(), 5);
  DenseLabels expected(5);
  for (int z = 0; z < 9; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 5; ++x) {
        const float v = values[static_cast<std::size_t>(x + 5 * (y + 3 * z))];
        expected.at((32 - 5) / 2 + x, (32 - 3) / 2 + y, (32 - 9) / 2 + z) =
            static_cast<std::uint32_t>((v >= -10) + (v >= 0.5f) + (v >= 40));
      }
  EXPECT_EQ(map.runs(), expected.runs());
}

TEST(LabelVolume, SaysWhatIsNoLabelAndWhere) {
  const test::TemporaryFolder folder;
  std::vector<std::int16_t> values(4 * 4 * 4, 2);
  values[4 * 4 * 2 + 4 * 3 + 1] = -5;
  test::write_nrrd(folder / "a.nrrd", "short", "4 4 4", values);
  expect_error(ErrorCode::bad_input, {"a.nrrd: ", "the value -5 of voxel (1, 3, 2) is no label", "--bands"},
               [&] { read_label_volume(folder / "a.nrrd"); });
  test::write_nrrd(folder / "b.nrrd", "float", "2 2 2", std::vector<float>(8, std::nanf("")));
  expect_error(ErrorCode::bad_input, {"b.nrrd: ", "nan"}, [&] { read_label_volume(folder / "b.nrrd"); });
  LabelVolumeOptions bands;
  bands.bands = Bands{{1}};
  expect_error(ErrorCode::bad_input, {"b.nrrd: every value is NaN"},
               [&] { read_label_volume(folder / "b.nrrd", bands); });
  bands.bands = Bands{{2, 1}};
  expect_error(ErrorCode::bad_argument, {"do not increase"}, [&] { read_label_volume(folder / "b.nrrd", bands); });
  LabelVolumeOptions small;
  small.depth = 1;
  expect_error(ErrorCode::bad_input, {"a.nrrd: ", "do not fit"}, [&] { read_label_volume(folder / "a.nrrd", small); });
  small.depth = 21;
  expect_error(ErrorCode::bad_argument, {"depth 21"}, [&] { read_label_volume(folder / "a.nrrd", small); });
  expect_error(ErrorCode::bad_argument, {"volumes are not written as '.stl'"},
               [&] { write_volume(LabelMap(2), folder / "a.stl"); });
}

// Debian's mricron-data. Read here by zlib and a few fields of the header, nothing of ours.
struct Atlas {
  std::array<std::int64_t, 3> size{};
  std::vector<std::int32_t> values;
};

std::string atlas_path(const std::string& name) { return "/usr/share/mricron/templates/" + name + ".nii.gz"; }

Atlas read_atlas(const std::string& name) {
  const gzFile file = gzopen(atlas_path(name).c_str(), "rb");
  std::array<char, 352> header{};
  Atlas atlas;
  EXPECT_EQ(gzread(file, header.data(), 352), 352);
  std::array<std::int16_t, 16> fields{};
  std::memcpy(fields.data(), &header[40], 32);
  float offset = 0;
  std::memcpy(&offset, &header[108], 4);
  for (std::size_t i = 0; i < 3; ++i) atlas.size[i] = fields[i + 1];
  const std::int16_t type = fields[15];  // 2: uint8, 4: int16
  gzseek(file, static_cast<z_off_t>(offset), SEEK_SET);
  std::vector<char> bytes(static_cast<std::size_t>(atlas.size[0] * atlas.size[1] * atlas.size[2]) *
                          (type == 2 ? 1 : 2));
  EXPECT_EQ(gzread(file, bytes.data(), static_cast<unsigned>(bytes.size())), static_cast<int>(bytes.size()));
  gzclose(file);
  for (std::size_t i = 0; i < bytes.size(); i += type == 2 ? 1 : 2) {
    std::int16_t value = static_cast<unsigned char>(bytes[i]);
    if (type != 2) std::memcpy(&value, &bytes[i], 2);
    atlas.values.push_back(value);
  }
  return atlas;
}

class Atlases : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(atlas_path("aal"))) GTEST_SKIP() << "Debian's mricron-data is not installed";
  }
};

// Every voxel, in the order of the curve.
void expect_atlas(const LabelMap& map, const Atlas& atlas, const std::function<std::uint32_t(std::int32_t)>& label_of) {
  std::uint64_t wrong = 0, seen = 0;
  std::map<std::uint32_t, std::uint64_t> volumes;
  for_each_label_cube(map, [&](const Cube& c, std::uint32_t label) {
    for (std::int64_t z = c.z; z < c.z + c.side(); ++z)
      for (std::int64_t y = c.y; y < c.y + c.side(); ++y)
        for (std::int64_t x = c.x; x < c.x + c.side(); ++x) {
          const bool outside = x >= atlas.size[0] || y >= atlas.size[1] || z >= atlas.size[2];
          const std::uint32_t expected =
              outside ? 0
                      : label_of(atlas.values[static_cast<std::size_t>(x + atlas.size[0] * (y + atlas.size[1] * z))]);
          wrong += label != expected;
          ++seen;
          if (expected != 0) ++volumes[expected];
        }
  });
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(seen, std::uint64_t{1} << (3 * map.depth()));
  const auto facts = label_facts(map);
  ASSERT_EQ(facts.size(), volumes.size());
  for (const LabelFacts& known : facts) EXPECT_EQ(known.volume, volumes[known.label]) << known.label;
}

TEST_F(Atlases, AalVoxelForVoxel) {
  const LabelMap map = read_label_volume(atlas_path("aal"));
  EXPECT_EQ(map.depth(), 8);
  expect_atlas(map, read_atlas("aal"), [](std::int32_t v) { return static_cast<std::uint32_t>(v); });
  EXPECT_EQ(label_facts(map).size(), 116u);  // automated anatomical labelling has so many regions
}

TEST_F(Atlases, IniaVoxelForVoxel) {
  const LabelMap map = read_label_volume(atlas_path("inia19-NeuroMaps"));
  expect_atlas(map, read_atlas("inia19-NeuroMaps"), [](std::int32_t v) { return static_cast<std::uint32_t>(v); });
}

TEST_F(Atlases, Ch2InBands) {
  LabelVolumeOptions options;
  options.bands = Bands{{40, 80.5, 120}};
  expect_atlas(read_label_volume(atlas_path("ch2"), options), read_atlas("ch2"),
               [](std::int32_t v) { return static_cast<std::uint32_t>((v >= 40) + (v >= 81) + (v >= 120)); });
}

}  // namespace
}  // namespace blackleaf
