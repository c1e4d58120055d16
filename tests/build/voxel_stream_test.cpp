// Slices one by one, against the whole volume at once: the same octree whatever comes when.
#include "blackleaf/voxel_stream.h"

#include <algorithm>
#include <limits>
#include <random>

#include "meshes.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using testing::error_of;
using Size = std::array<std::int64_t, 3>;

template <class T>
class VoxelStreams : public ::testing::Test {};
using Types = ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t, std::int32_t,
                               float, double>;
TYPED_TEST_SUITE(VoxelStreams, Types);

// Stretches of one value, so that bricks and blocks of one colour occur, and NaN where there is such a thing.
template <class T>
std::vector<T> random_values(const Size& size, std::mt19937& random) {
  const auto pick = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  std::vector<T> values = {T(0), T(1), T(2), T(41), T(42), T(43), std::numeric_limits<T>::max()};
  if constexpr (std::numeric_limits<T>::has_quiet_NaN) values.push_back(std::numeric_limits<T>::quiet_NaN());
  const std::size_t longest = pick(2) ? 3000 : 30;
  std::vector<T> result(static_cast<std::size_t>(size[0] * size[1] * size[2]));
  for (std::size_t i = 0; i < result.size();) {
    const T value = values[pick(values.size())];
    for (std::size_t length = 1 + pick(longest); length > 0 && i < result.size(); --length) result[i++] = value;
  }
  return result;
}

// Adds the volume, next(wanted, left) slices at a time.
template <class T, class Inside, class Next>
Octree streamed(const std::vector<T>& values, const Size& size, const Inside& inside, const VolumePlacement& placement,
                int threads, const Next& next) {
  VoxelStream<T> stream(size, inside, placement, {}, {threads, {}});
  const T* at = values.data();
  for (std::int64_t left = size[2]; left > 0;) {
    const std::int64_t wanted = stream.wanted();
    EXPECT_TRUE(wanted >= 1 && wanted <= left) << wanted << " of " << left;
    const std::int64_t slices = next(wanted, left);
    stream.add(at, slices);
    at += size[0] * size[1] * slices;
    left -= slices;
  }
  EXPECT_EQ(stream.wanted(), 0);
  return stream.finish();
}

TYPED_TEST(VoxelStreams, SameAsAtOnce) {
  using T = TypeParam;
  std::mt19937 random(31);
  const auto pick = [&](std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(random);
  };
  for (int i = 0; i < 60; ++i) {
    // Sizes that end anywhere in a brick and a block; universes of less than a block and of many.
    const bool small = i % 3 == 0;
    const Size size =
        small ? Size{pick(1, 40), pick(1, 40), pick(1, 40)} : Size{pick(1, 90), pick(1, 70), pick(1, 200)};
    VolumePlacement placement;
    if (pick(0, 2) > 0) {
      placement.depth = small ? 6 : static_cast<int>(pick(9, 20));
      for (auto& c : placement.corner) c = static_cast<std::int32_t>(pick(0, small ? 24 : 300));
    }
    SCOPED_TRACE(::testing::Message() << "case " << i << ": " << size[0] << " x " << size[1] << " x " << size[2]
                                      << " at " << placement.corner[0] << "," << placement.corner[1] << ","
                                      << placement.corner[2] << " depth " << placement.depth);
    const std::vector<T> values = random_values<T>(size, random);
    const ValueRange<T> range{T(1), T(42)};
    const Octree expected = octree_from_voxels<T>({values.data(), size}, range, placement, {}, {1, {}});
    const int threads = static_cast<int>(pick(1, 2));
    const auto as_wanted = [](std::int64_t wanted, std::int64_t) { return wanted; };
    const auto one = [](std::int64_t, std::int64_t) { return std::int64_t{1}; };
    const auto all = [](std::int64_t, std::int64_t left) { return left; };
    const auto any = [&](std::int64_t, std::int64_t left) { return pick(0, std::min<std::int64_t>(left, 9)); };
    const Octree octree = streamed(values, size, range, placement, threads, as_wanted);
    reference::expect_valid(octree);
    ASSERT_EQ(octree, expected);
    ASSERT_EQ(streamed(values, size, range, placement, threads, one), expected);
    ASSERT_EQ(streamed(values, size, range, placement, threads, all), expected);
    ASSERT_EQ(streamed(values, size, range, placement, threads, any), expected);
    const std::function<bool(T)> inside = range;
    ASSERT_EQ(streamed(values, size, inside, placement, threads, any), expected);
  }
}

TEST(VoxelStreamsOnce, LongRowsAndManyBlocks) {
  std::mt19937 random(8);
  for (const Size& size : {Size{4501, 5, 6}, {3, 1201, 70}, {2, 3, 1300}, {130, 257, 129}}) {
    SCOPED_TRACE(::testing::Message() << size[0] << " x " << size[1] << " x " << size[2]);
    const auto values = random_values<std::uint8_t>(size, random);
    const ValueRange<std::uint8_t> range{1, 42};
    for (const std::array<std::int32_t, 3>& corner : {std::array<std::int32_t, 3>{0, 0, 0}, {61, 2, 7}, {64, 127, 1}}) {
      const VolumePlacement placement{0, corner};
      const Octree expected = octree_from_voxels<std::uint8_t>({values.data(), size}, range, placement, {}, {1, {}});
      for (const int threads : {1, 2})
        for (const std::int64_t step : {1, 4, 7, 64, 100})
          EXPECT_EQ(streamed(values, size, range, placement, threads,
                             [&](std::int64_t, std::int64_t left) { return std::min(left, step); }),
                    expected)
              << step << " slices at a time";
    }
  }
}

TEST(VoxelStreamsOnce, EveryValueIsReadOnce) {
  const Size size = {37, 21, 75};
  std::vector<std::int32_t> values(static_cast<std::size_t>(size[0] * size[1] * size[2]));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::int32_t>(i);
  for (const std::int64_t step : {1, 3, 4, 75}) {
    std::vector<int> reads(values.size(), 0);
    const std::function<bool(std::int32_t)> count = [&](std::int32_t value) {
      ++reads[static_cast<std::size_t>(value)];
      return value % 7 == 0;
    };
    streamed(values, size, count, {}, 1, [&](std::int64_t, std::int64_t left) { return std::min(left, step); });
    EXPECT_TRUE(std::all_of(reads.begin(), reads.end(), [](int n) { return n == 1; })) << step;
  }
}

// What is wanted fits the bricks and is bounded in bytes.
TEST(VoxelStreamsOnce, Wanted) {
  const ValueRange<float> range{1, 2};
  EXPECT_EQ(VoxelStream<float>({100, 100, 300}, range).wanted(), 64);
  EXPECT_EQ(VoxelStream<float>({100, 100, 300}, range).wanted(64), 64);
  EXPECT_EQ(VoxelStream<float>({100, 100, 300}, range).wanted(280), 20);
  EXPECT_EQ(VoxelStream<float>({100, 100, 300}, range).wanted(300), 0);
  EXPECT_EQ(VoxelStream<float>({100, 100, 300}, range, {0, {0, 0, 62}}).wanted(), 2);
  EXPECT_EQ(VoxelStream<float>({512, 512, 512}, range).wanted(), 4);
  EXPECT_EQ(VoxelStream<float>({4096, 4096, 512}, range).wanted(), 4);  // 64 MiB each
  EXPECT_EQ(VoxelStream<float>({4096, 4096, 512}, range, {0, {0, 0, 3}}).wanted(), 1);
  EXPECT_EQ(VoxelStream<float>({4097, 4096, 512}, range).wanted(), 1);
  EXPECT_EQ(VoxelStream<std::uint8_t>({1 << 16, 1 << 16, 4}, ValueRange<std::uint8_t>{1, 2}).wanted(), 1);
}

TEST(VoxelStreamsOnce, ProgressAndCancelling) {
  const Size size = {130, 130, 130};
  const std::vector<std::uint8_t> values(130 * 130 * 130, 1);
  const ValueRange<std::uint8_t> range{1, 1};
  for (const std::int64_t step : {1, 16}) {
    std::vector<double> seen;
    double last = 2;
    const auto run = [&] {
      VoxelStream<std::uint8_t> stream(size, range, {}, {}, {1, [&](double done) {
                                                               seen.push_back(done);
                                                               return done < last;
                                                             }});
      for (std::int64_t z = 0; z < size[2]; z += step) stream.add(values.data(), std::min(step, size[2] - z));
      return stream.finish();
    };
    EXPECT_EQ(run(), box(8, {0, 0, 0}, {130, 130, 130}));
    ASSERT_GT(seen.size(), 8u);
    EXPECT_GT(seen.front(), 0);
    EXPECT_DOUBLE_EQ(seen.back(), 1);
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    for (const double refused : {0.0, 0.5, 0.95}) {
      last = refused;
      EXPECT_EQ(error_of(ErrorCode::cancelled, run), "interrupted");
    }
  }
}

TEST(VoxelStreamsOnce, FrameAndErrors) {
  Frame frame;
  frame.origin = {1, 2, 3};
  frame.unit = "mm";
  const std::vector<std::uint8_t> values(3 * 5 * 2, 1);
  const ValueRange<std::uint8_t> range{1, 255};
  for (const int depth : {0, 7}) {
    VoxelStream<std::uint8_t> stream({3, 5, 2}, range, {depth, {}}, frame);
    VoxelStream<std::uint8_t> moved = std::move(stream);
    moved.add(values.data(), 2);
    const Octree octree = moved.finish();
    EXPECT_EQ(octree.frame(), frame);
    EXPECT_EQ(octree, box(depth == 0 ? 3 : 7, {0, 0, 0}, {3, 5, 2}));
  }
  EXPECT_EQ(error_of(ErrorCode::bad_input,
                     [&] {
                       VoxelStream<std::uint8_t>({4, 0, 4}, range);
                     }),
            "the volume of 4 x 0 x 4 voxels is empty; give a volume with at least one voxel along every axis");
  EXPECT_EQ(error_of(ErrorCode::bad_input,
                     [&] {
                       VoxelStream<std::uint8_t>({4, 4, 4}, range, {2, {0, 0, 1}});
                     }),
            "the volume reaches to (4, 4, 5) but a universe of depth 2 to 4; use depth 3 or leave it open");
}

}  // namespace
}  // namespace blackleaf
