#include "blackleaf/label_voxels.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <random>

#include "blackleaf/error.h"
#include "reference/dense_labels.h"

namespace blackleaf {
namespace {

using reference::DenseLabels;

using Size = std::array<std::int64_t, 3>;

std::size_t voxels(const Size& size) { return static_cast<std::size_t>(size[0] * size[1] * size[2]); }

// Voxel by voxel: where the volume lies, label_of(value), elsewhere 0.
template <class T, class LabelOfValue>
DenseLabels twin(const VolumeView<T>& volume, int depth, const std::array<std::int32_t, 3>& corner,
                 LabelOfValue label_of) {
  DenseLabels grid(depth);
  for (int z = 0; z < volume.size[2]; ++z)
    for (int y = 0; y < volume.size[1]; ++y)
      for (int x = 0; x < volume.size[0]; ++x)
        grid.at(corner[0] + x, corner[1] + y, corner[2] + z) =
            label_of(volume.data[x + volume.size[0] * (y + volume.size[1] * z)]);
  return grid;
}

template <class T>
std::vector<std::uint32_t> palette() {
  if constexpr (sizeof(T) == 1) return {0, 1, 2, static_cast<std::uint32_t>(std::numeric_limits<T>::max())};
  if constexpr (sizeof(T) == 2) return {0, 1, 256, static_cast<std::uint32_t>(std::numeric_limits<T>::max())};
  if constexpr (std::is_same_v<T, std::int32_t>) return {0, 1, 65536, 2147483647u};
  if constexpr (std::is_same_v<T, float>) return {0, 1, 16777215, 4294967040u};  // whole floats
  return {0, 1, 65536, 4294967295u};
}

template <class T>
class LabelVoxels : public testing::Test {};
using Types = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t, std::int32_t,
                             std::uint64_t, std::int64_t, float, double>;
TYPED_TEST_SUITE(LabelVoxels, Types);

// Any size and placement, whole and in portions, on one thread and several.
TYPED_TEST(LabelVoxels, AreTheirDenseTwin) {
  using T = TypeParam;
  std::mt19937 random(31);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  for (int i = 0; i < 120; ++i) {
    SCOPED_TRACE(i);
    const int most = i % 10 == 0 ? 90 : i % 3 == 0 ? 2 : 21;
    const Size size = {pick(1, most), pick(1, i % 10 == 0 ? 30 : most), pick(1, most)};
    VolumePlacement placement;
    if (pick(0, 1))
      for (auto& c : placement.corner) c = pick(0, 12);
    const auto labels = reference::random_labels(size, palette<T>(), random);
    std::vector<T> values(labels.size());
    for (std::size_t k = 0; k < labels.size(); ++k) values[k] = static_cast<T>(labels[k]);
    const VolumeView<T> view{values.data(), size};
    const int least =
        depth_for({size[0] + placement.corner[0], size[1] + placement.corner[1], size[2] + placement.corner[2]});
    if (pick(0, 3) == 0) placement.depth = least + pick(0, 1);
    const int depth = placement.depth > 0 ? placement.depth : least;
    const Frame frame{{1, 2, 3}, Eigen::Matrix3d::Identity(), "mm"};
    const LabelMap map = label_map_from_voxels<T>(view, WholeNumbers{}, placement, frame, {pick(1, 3), {}});
    ASSERT_EQ(map.depth(), depth);
    EXPECT_TRUE(map.frame() == frame);
    const DenseLabels expected = twin(view, depth, placement.corner, [](T v) { return static_cast<std::uint32_t>(v); });
    ASSERT_EQ(map.runs(), expected.runs());

    LabelVolumeBuilder<T> builder(size, WholeNumbers{}, placement, frame, {pick(1, 3), {}});
    for (std::int64_t z = 0; z < size[2];) {
      const std::int64_t count = std::min<std::int64_t>(pick(0, 11), size[2] - z);
      builder.add(values.data() + size[0] * size[1] * z, count);
      z += count;
    }
    EXPECT_TRUE(builder.finish() == map);
  }
}

// Thresholds inside, between and beyond what the type holds; NaN and infinities.
TYPED_TEST(LabelVoxels, BandsCountThresholds) {
  using T = TypeParam;
  std::mt19937 random(32);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  std::vector<T> special = {T{0}, T{1}, std::numeric_limits<T>::min(), std::numeric_limits<T>::max(),
                            std::numeric_limits<T>::lowest()};
  if constexpr (std::is_floating_point_v<T>)
    for (const T value : {std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::infinity(),
                          -std::numeric_limits<T>::infinity(), T(0.1), T(-0.0), T(-1.5)})
      special.push_back(value);
  std::vector<double> places = {-1e300, -1e10, -32768, -128.5, -128,   -1,   -0.5, 0,     0.1,
                                0.5,    1,     3.5,    127,    127.5,  255,  300,  40000, 65535.5,
                                1e9,    4e9,   0x1p53, 0x1p63, 0x1p64, 1e39, 1e308};
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    const Size size = {pick(1, 70), pick(1, 9), pick(1, 9)};
    std::vector<T> values(voxels(size));
    for (T& value : values)
      value = pick(0, 2) ? special[static_cast<std::size_t>(pick(0, static_cast<int>(special.size()) - 1))]
                         : static_cast<T>(pick(0, 120));
    Bands bands;
    for (const double place : places)
      if (pick(0, 3) == 0) bands.thresholds.push_back(place);
    if (i % 8 == 0) {  // more than are counted one by one, more than a byte holds
      bands.thresholds.clear();
      for (int k = 0; k < (i % 16 == 0 ? 300 : 40); ++k) bands.thresholds.push_back(k / 3.0 - 5);
    }
    if (bands.thresholds.empty()) bands.thresholds = {0.25};
    const VolumeView<T> view{values.data(), size};
    const LabelMap map = label_map_from_voxels<T>(view, bands, {}, {}, {1 + i % 2, {}});
    const DenseLabels expected = twin(view, map.depth(), {}, [&](T value) {
      std::uint32_t count = 0;
      for (const double threshold : bands.thresholds) {
        if constexpr (std::is_integral_v<T>) {
          // Doubles and 64-bit numbers meet exactly in a long double.
          count += static_cast<long double>(value) >= static_cast<long double>(threshold) ? 1 : 0;
        } else {
          count += static_cast<double>(value) >= threshold ? 1 : 0;
        }
      }
      return count;
    });
    ASSERT_EQ(map.runs(), expected.runs());
  }
}

TYPED_TEST(LabelVoxels, AnyFunction) {
  using T = TypeParam;
  std::mt19937 random(33);
  std::vector<T> values(voxels({20, 11, 7}));
  for (T& value : values) value = static_cast<T>(random() % 5);
  if constexpr (std::is_floating_point_v<T>) values[17] = std::numeric_limits<T>::quiet_NaN();
  const VolumeView<T> view{values.data(), {20, 11, 7}};
  const LabelOf<T> label_of = [](T value) -> std::uint32_t {
    if (value != value) return 77;
    return value < T{2} ? 4294967295u : value < T{4} ? 0 : 1000000;
  };
  const LabelMap map = label_map_from_voxels<T>(view, label_of, {0, {3, 0, 1}}, {}, {2, {}});
  EXPECT_EQ(map.runs(), twin(view, map.depth(), {3, 0, 1}, label_of).runs());
}

std::string message_of(const std::function<void()>& action, ErrorCode code) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(code));
    return error.what();
  }
  return "nothing was thrown";
}

// The first bad value in the order of the data is named, whatever the threads and portions.
template <class T>
void expect_named(T bad, const std::string& text) {
  SCOPED_TRACE(text);
  const Size size = {37, 18, 70};
  std::vector<T> values(voxels(size), T{1});
  const auto at = [&](int x, int y, int z) { return static_cast<std::size_t>(x + 37 * (y + 18 * z)); };
  for (const auto& [x, y, z] : {std::array{36, 17, 69}, {5, 4, 33}, {4, 5, 33}, {0, 0, 34}}) {
    values[at(x, y, z)] = bad;
    const bool last = z == 69;
    const std::string place = last ? "(36, 17, 69)" : "(5, 4, 33)";
    for (const int threads : {1, 2})
      EXPECT_EQ(
          message_of(
              [&] {
                label_map_from_voxels<T>({values.data(), size}, WholeNumbers{}, {0, {1, 2, 3}}, {}, {threads, {}});
              },
              ErrorCode::bad_input),
          "the value " + text + " of voxel " + place +
              " is no label, which is a whole number from 0 to 4294967295; make labels of ranges of values with "
              "bands (--bands)");
    LabelVolumeBuilder<T> builder(size);
    EXPECT_NE(message_of(
                  [&] {
                    for (int k = 0; k < 70; k += 7) builder.add(&values[at(0, 0, k)], 7);
                  },
                  ErrorCode::bad_input)
                  .find(place),
              std::string::npos);
  }
}

TEST(LabelVoxels, WhatIsNoLabelIsNamed) {
  expect_named<std::int8_t>(-1, "-1");
  expect_named<std::int16_t>(-32768, "-32768");
  expect_named<std::int32_t>(-7, "-7");
  expect_named<std::int64_t>(-7, "-7");
  expect_named<std::int64_t>(4294967296, "4294967296");
  expect_named<std::uint64_t>(18446744073709551615u, "18446744073709551615");
  expect_named<float>(0.1f, "0.1");
  expect_named<float>(-2, "-2");
  expect_named<float>(4294967296.0f, "4294967296");
  expect_named<float>(std::numeric_limits<float>::quiet_NaN(), "nan");
  expect_named<double>(4294967295.5, "4294967295.5");
  expect_named<double>(std::numeric_limits<double>::infinity(), "inf");
}

TEST(LabelVoxels, RefusesWhatDoesNotFitAndBadBands) {
  const std::uint8_t value = 1;
  const auto refused = [&](const Size& size, const Labelling<std::uint8_t>& labelling, const VolumePlacement& placement,
                           ErrorCode code, const std::string& part) {
    const std::string message = message_of(
        [&] {
          label_map_from_voxels<std::uint8_t>({&value, size}, labelling, placement);
        },
        code);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  refused({0, 1, 1}, WholeNumbers{}, {}, ErrorCode::bad_input, "is empty");
  refused({5, 1, 1}, WholeNumbers{}, {2, {}}, ErrorCode::bad_input, "use depth 3");
  refused({1, 1, 1}, WholeNumbers{}, {2, {-1, 0, 0}}, ErrorCode::bad_input, "does not fit");
  refused({1, 1, 1}, WholeNumbers{}, {21, {}}, ErrorCode::bad_argument, "depth 21");
  refused({1, 1, 1}, Bands{}, {}, ErrorCode::bad_argument, "no thresholds");
  refused({1, 1, 1}, Bands{{1, 1}}, {}, ErrorCode::bad_argument, "1 comes after 1");
  refused({1, 1, 1}, Bands{{3, 2.5}}, {}, ErrorCode::bad_argument, "2.5 comes after 3");
  refused({1, 1, 1}, Bands{{std::nan("")}}, {}, ErrorCode::bad_argument, "not finite");
  refused({1, 1, 1}, Bands{std::vector<double>(70000, 1)}, {}, ErrorCode::bad_argument, "too many");
}

TEST(LabelVoxels, ProgressGrowsAndCancels) {
  const Size size = {40, 50, 150};
  std::vector<std::uint8_t> values(voxels(size), 3);
  double last = 0;
  const Work work{1, [&](double done) {
                    EXPECT_GE(done, last);
                    EXPECT_LE(done, 1.0);
                    last = done;
                    return true;
                  }};
  label_map_from_voxels<std::uint8_t>({values.data(), size}, WholeNumbers{}, {}, {}, work);
  EXPECT_NEAR(last, 1.0, 1e-9);
  EXPECT_NE(message_of(
                [&] {
                  label_map_from_voxels<std::uint8_t>({values.data(), size}, WholeNumbers{}, {}, {},
                                                      {1, [](double) { return false; }});
                },
                ErrorCode::cancelled)
                .find("interrupted"),
            std::string::npos);
}

// Large enough for several slabs and blocks along every axis.
TEST(LabelVoxels, ManyBlocks) {
  const Size size = {150, 131, 140};
  std::vector<std::uint16_t> values(voxels(size));
  for (std::int64_t z = 0; z < size[2]; ++z)
    for (std::int64_t y = 0; y < size[1]; ++y)
      for (std::int64_t x = 0; x < size[0]; ++x)
        values[static_cast<std::size_t>(x + size[0] * (y + size[1] * z))] =
            static_cast<std::uint16_t>((x * x + y * y + z * z) / 3000 % 5 * 300);
  const VolumeView<std::uint16_t> view{values.data(), size};
  const LabelMap map = label_map_from_voxels<std::uint16_t>(view, WholeNumbers{}, {0, {30, 62, 64}}, {}, {2, {}});
  EXPECT_EQ(map.depth(), 8);
  EXPECT_EQ(map.runs(), twin(view, 8, {30, 62, 64}, [](std::uint16_t v) { return std::uint32_t{v}; }).runs());
}

}  // namespace
}  // namespace blackleaf
