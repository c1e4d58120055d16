#include "blackleaf/voxels.h"

#include <limits>

#include "meshes.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
using testing::error_of;

template <class T>
class Voxels : public ::testing::Test {};
using Types = ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t, std::int32_t,
                               float, double>;
TYPED_TEST_SUITE(Voxels, Types);

// Values that matter to comparisons: limits, zero, neighbours of the range's ends, NaN and infinities.
template <class T>
std::vector<T> nasty() {
  using Limits = std::numeric_limits<T>;
  std::vector<T> values = {Limits::lowest(), Limits::max(), T(0), T(1), T(2), T(41), T(42), T(43), T(100), T(-1)};
  if constexpr (Limits::has_quiet_NaN)
    values.insert(values.end(), {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(), T(-0.0), Limits::min()});
  return values;
}

template <class T>
std::vector<T> random_values(std::size_t count, std::mt19937& random) {
  const std::vector<T> values = nasty<T>();
  const auto pick = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  std::vector<T> result(count);
  for (std::size_t i = 0; i < count;) {  // stretches of one value, so that bricks and blocks of one colour occur
    const T value = values[pick(values.size())];
    for (std::size_t length = pick(2) ? 1 : 1 + pick(300); length > 0 && i < count; --length) result[i++] = value;
  }
  return result;
}

template <class T>
void expect_the_values(const Octree& octree, const std::vector<T>& values, const std::array<std::int64_t, 3>& size,
                       const std::array<std::int32_t, 3>& corner, const ValueRange<T>& range) {
  std::uint64_t black = 0;
  bool equal = true;
  std::size_t next = 0;
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x, ++next) {
        black += range(values[next]);
        equal = equal && range(values[next]) == octree.contains(corner[0] + x, corner[1] + y, corner[2] + z);
      }
  EXPECT_TRUE(equal);
  EXPECT_EQ(volume(octree), black);
}

TYPED_TEST(Voxels, EveryRangeSizeAndCorner) {
  using T = TypeParam;
  std::mt19937 random(99);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const int depth = pick(1, 5), side = 1 << depth;
    VolumePlacement placement{depth, {}};
    VolumeView<T> view;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      placement.corner[axis] = pick(0, 2) ? pick(0, side - 1) : 0;
      view.size[axis] = pick(0, 2) ? pick(1, side - placement.corner[axis]) : side - placement.corner[axis];
    }
    const std::vector<T> values =
        random_values<T>(static_cast<std::size_t>(view.size[0] * view.size[1] * view.size[2]), random);
    view.data = values.data();
    const std::vector<T> ends = nasty<T>();
    const ValueRange<T> range{ends[static_cast<std::size_t>(pick(0, 9))], ends[static_cast<std::size_t>(pick(0, 9))]};
    DenseGrid expected(depth);
    std::size_t next = 0;
    for (int z = 0; z < view.size[2]; ++z)
      for (int y = 0; y < view.size[1]; ++y)
        for (int x = 0; x < view.size[0]; ++x, ++next)
          expected.set(placement.corner[0] + x, placement.corner[1] + y, placement.corner[2] + z,
                       values[next] >= range.low && values[next] <= range.high);
    const Octree octree = octree_from_voxels(view, range, placement);
    reference::expect_valid(octree);
    ASSERT_EQ(octree, reference::octree(expected));
    const std::function<bool(T)> inside = range;
    EXPECT_EQ(octree_from_voxels(view, inside, placement), octree);
  }
}

TYPED_TEST(Voxels, LargeUniversesAndThreads) {
  using T = TypeParam;
  std::mt19937 random(4);
  const std::array<std::int64_t, 3> size = {131, 66, 70};  // more than a block along every axis
  const std::vector<T> values = random_values<T>(static_cast<std::size_t>(size[0] * size[1] * size[2]), random);
  for (const int depth : {8, 9, 10, 20}) {
    SCOPED_TRACE(depth);
    const VolumePlacement placement{depth, {125, 190, depth == 20 ? (1 << 20) - 70 : 61}};
    const ValueRange<T> range{T(1), T(50)};
    const Octree octree = octree_from_voxels<T>({values.data(), size}, range, placement, {}, {1, {}});
    reference::expect_valid(octree);
    expect_the_values(octree, values, size, placement.corner, range);
    for (const int threads : {2, 5})
      EXPECT_EQ(octree_from_voxels<T>({values.data(), size}, range, placement, {}, {threads, {}}), octree);
  }
}

TYPED_TEST(Voxels, LongRowsAndThinVolumes) {
  using T = TypeParam;
  std::mt19937 random(7);
  for (const std::array<std::int64_t, 3>& size :
       {std::array<std::int64_t, 3>{4501, 5, 6}, {3, 1201, 2}, {2, 3, 1300}, {4096, 4, 4}, {1, 1, 700}, {700, 70, 1}}) {
    SCOPED_TRACE(std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]));
    const std::vector<T> values = random_values<T>(static_cast<std::size_t>(size[0] * size[1] * size[2]), random);
    const ValueRange<T> range{T(0), T(42)};
    for (const std::array<std::int32_t, 3>& corner : {std::array<std::int32_t, 3>{0, 0, 0}, {61, 2, 7}, {64, 127, 1}}) {
      const Octree octree = octree_from_voxels<T>({values.data(), size}, range, {0, corner}, {}, {1, {}});
      reference::expect_valid(octree);
      expect_the_values(octree, values, size, corner, range);
      EXPECT_EQ(octree_from_voxels<T>({values.data(), size}, range, {0, corner}, {}, {2, {}}), octree);
    }
  }
}

TEST(VoxelsOnce, ProgressAndCancelling) {
  const std::vector<std::uint8_t> values(130 * 130 * 130, 1);
  const VolumeView<std::uint8_t> view{values.data(), {130, 130, 130}};
  const ValueRange<std::uint8_t> range{1, 1};
  for (const int threads : {1, 2}) {
    std::vector<double> seen;
    const Work watched{threads, [&](double done) {
                         seen.push_back(done);
                         return true;
                       }};
    octree_from_voxels(view, range, {}, {}, watched);
    ASSERT_GT(seen.size(), 2u);
    EXPECT_GT(*std::min_element(seen.begin(), seen.end()), 0);
    EXPECT_DOUBLE_EQ(*std::max_element(seen.begin(), seen.end()), 1);
    if (threads == 1) {
      EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    }
    for (const double last : {0.0, 0.5, 0.95})
      EXPECT_EQ(error_of(ErrorCode::cancelled,
                         [&] {
                           octree_from_voxels(view, range, {}, {}, {threads, [&](double done) { return done < last; }});
                         }),
                "interrupted");
  }
}

TEST(VoxelsOnce, EveryValueIsReadOnce) {
  for (const int side : {2, 5, 37, 70}) {
    std::vector<std::int32_t> values(static_cast<std::size_t>(side * side * side));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::int32_t>(i);
    std::vector<int> reads(values.size(), 0);
    const std::function<bool(std::int32_t)> count = [&](std::int32_t value) {
      ++reads[static_cast<std::size_t>(value)];
      return value % 7 == 0;
    };
    octree_from_voxels<std::int32_t>({values.data(), {side, side, side}}, count, {}, {}, {1, {}});
    EXPECT_TRUE(std::all_of(reads.begin(), reads.end(), [](int n) { return n == 1; })) << side;
  }
}

TEST(VoxelsOnce, FrameAndDepth) {
  const std::vector<std::uint8_t> values(3 * 5 * 2, 1);
  Frame frame;
  frame.origin = {1, 2, 3};
  frame.unit = "mm";
  const Octree octree =
      octree_from_voxels<std::uint8_t>({values.data(), {3, 5, 2}}, ValueRange<std::uint8_t>{1, 255}, {}, frame);
  EXPECT_EQ(octree.frame(), frame);
  EXPECT_EQ(octree, box(3, {0, 0, 0}, {3, 5, 2}));
  EXPECT_EQ(
      octree_from_voxels<std::uint8_t>({values.data(), {3, 5, 2}}, ValueRange<std::uint8_t>{1, 255}, {0, {0, 4, 0}}),
      box(4, {0, 4, 0}, {3, 9, 2}));
  EXPECT_EQ(depth_for({1, 1, 1}), 1);
  EXPECT_EQ(depth_for({2, 1, 2}), 1);
  EXPECT_EQ(depth_for({2, 3, 2}), 2);
  EXPECT_EQ(depth_for({1 << 20, 3, 2}), 20);
}

TEST(VoxelsOnce, Errors) {
  const std::vector<std::uint8_t> values(64, 1);
  const auto message = [&](std::array<std::int64_t, 3> size, VolumePlacement placement, ErrorCode code) {
    return error_of(code, [&] {
      octree_from_voxels<std::uint8_t>({values.data(), size}, ValueRange<std::uint8_t>{1, 255}, placement);
    });
  };
  EXPECT_EQ(message({4, 0, 4}, {}, ErrorCode::bad_input),
            "the volume of 4 x 0 x 4 voxels is empty; give a volume with at least one voxel along every axis");
  EXPECT_EQ(
      message({4, 4, 4}, {0, {0, -1, 0}}, ErrorCode::bad_input),
      "a volume of 4 x 4 x 4 voxels at (0, -1, 0) does not fit any universe; place it at coordinates of 0 or more, "
      "with no side over 2^20 voxels");
  EXPECT_EQ(message({4, 4, 4}, {21, {}}, ErrorCode::bad_argument),
            "depth 21 is out of range; use 1 to 20, or 0 for the smallest that holds the volume");
  EXPECT_EQ(message({4, 4, 4}, {2, {0, 0, 1}}, ErrorCode::bad_input),
            "the volume reaches to (4, 4, 5) but a universe of depth 2 to 4; use depth 3 or leave it open");
  EXPECT_EQ(
      message({4, 4, 4}, {0, {0, 0, 1 << 20}}, ErrorCode::bad_input),
      "a volume that reaches to (4, 4, 1048580) voxels does not fit any universe; no side may be over 2^20 voxels");
}

}  // namespace
}  // namespace blackleaf
