// Values in a range as bits, by every kernel, beside one value at a time.
#include "build/row_kernel.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "build/row_bits.h"
#include "reference/every_kernel.h"

namespace blackleaf {
namespace {

template <class T>
class RowKernel : public testing::Test {};

using Types =
    testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t, std::int32_t, float, double>;
TYPED_TEST_SUITE(RowKernel, Types);

// Where comparisons go wrong: the ends of the type, zeros, what is next to them, and what is no number.
template <class T>
std::vector<T> special_values() {
  using Limits = std::numeric_limits<T>;
  std::vector<T> values = {T(0), T(1), T(2), T(-1), T(-2), Limits::lowest(), Limits::max(), Limits::min(), T(100)};
  values.push_back(static_cast<T>(Limits::max() / 2));
  values.push_back(static_cast<T>(Limits::lowest() / 2));
  values.push_back(static_cast<T>(Limits::max() / 2 + 1));
  if constexpr (std::is_floating_point_v<T>) {
    for (const T value : {Limits::infinity(), Limits::quiet_NaN(), Limits::denorm_min(), Limits::epsilon(), T(1.5)}) {
      values.push_back(value);
      values.push_back(-value);
    }
    values.push_back(T(-0.0));
  }
  return values;
}

TYPED_TEST(RowKernel, LikeOneAtATime) {
  using T = TypeParam;
  std::mt19937_64 random(70000);
  const std::vector<T> special = special_values<T>();
  const auto pick = [&] { return special[random() % special.size()]; };
  const auto any = [&] {
    return random() % 3 == 0 ? pick() : static_cast<T>(static_cast<std::int64_t>(random() % 300) - 20);
  };
  reference::EveryKernel().run([&] {
    for (int round = 0; round < 3000; ++round) {
      const T low = any(), high = round % 4 == 0 ? low : any();
      const std::size_t count = random() % 300, offset = random() % 17;  // so that rows begin anywhere
      std::vector<T> values(offset + count);
      for (T& value : values) value = any();
      std::vector<std::uint64_t> words((count + 63) / 64 + 1, 0x1234'5678'9ABC'DEF0), expected = words;
      for (std::size_t i = 0; i < count; ++i) {
        const T value = values[offset + i];
        if (i % 64 == 0) expected[i / 64] = 0;
        expected[i / 64] |= std::uint64_t{low <= value && value <= high} << (i % 64);
      }
      detail::range_bits(values.data() + offset, count, low, high, words.data());
      ASSERT_EQ(words, expected) << "round " << round << ", " << count << " values from " << +low << " to " << +high;
    }
  });
}

// A row that begins and ends anywhere, and a predicate of any kind: bits stand where their voxels do.
TYPED_TEST(RowKernel, RowsStandWhereTheyBegin) {
  using T = TypeParam;
  std::mt19937_64 random(70001);
  for (int round = 0; round < 500; ++round) {
    const auto x0 = static_cast<std::int64_t>(random() % 200), x1 = x0 + 1 + static_cast<std::int64_t>(random() % 200);
    std::vector<T> values;
    for (std::int64_t x = x0; x < x1; ++x) values.push_back(static_cast<T>(random() % 5));
    const std::size_t count = static_cast<std::size_t>((x1 + 63) / 64 - x0 / 64);
    std::vector<std::uint64_t> expected(count, 0);
    for (std::int64_t x = x0; x < x1; ++x) {
      const T value = values[static_cast<std::size_t>(x - x0)];
      const std::uint64_t bit = std::uint64_t{T(2) <= value && value <= T(3)} << (x & 63);
      expected[static_cast<std::size_t>(x / 64 - x0 / 64)] |= bit;
    }
    std::vector<std::uint64_t> words(count, ~std::uint64_t{0}), others = words;
    detail::row_words(values.data(), x0, x1, detail::InRange<T>{T(2), T(3)}, words.data());
    ASSERT_EQ(words, expected) << x0 << " to " << x1;
    detail::row_words(
        values.data(), x0, x1, [](T value) { return T(2) <= value && value <= T(3); }, others.data());
    ASSERT_EQ(others, expected) << x0 << " to " << x1;
  }
}

}  // namespace
}  // namespace blackleaf
