#include "io/value_range.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace blackleaf {
namespace {

using detail::range_between;

// Against comparison as long double, which holds every 64-bit integer and every double exactly.
template <class T>
void expect_right(double low, double high, T value) {
  const ValueRange<T> range = range_between<T>(low, high);
  const auto exact = static_cast<long double>(value);
  EXPECT_EQ(range(value), low <= exact && exact <= high)
      << value << " in " << low << " .. " << high << " became " << range.low << " .. " << range.high;
}

template <class T>
void all_pairs() {
  using Limits = std::numeric_limits<T>;
  const auto max = static_cast<double>(Limits::max()), min = static_cast<double>(Limits::lowest());
  std::vector<double> bounds = {0.0,
                                -0.0,
                                0.5,
                                -0.5,
                                1,
                                -1,
                                1.5,
                                2,
                                2.5,
                                127,
                                127.5,
                                128,
                                255,
                                255.5,
                                256,
                                max,
                                min,
                                2 * max,
                                2 * min,
                                1e300,
                                -1e300,
                                HUGE_VAL,
                                -HUGE_VAL,
                                1e-300,
                                -1e-300,
                                std::nextafter(max, 0),
                                std::nextafter(max, HUGE_VAL),
                                std::nextafter(min, 0),
                                std::nextafter(min, -HUGE_VAL),
                                0.1,
                                1.0 / 3};
  std::vector<T> values = {T{0},
                           T{1},
                           T{2},
                           T{3},
                           T{126},
                           T{127},
                           Limits::max(),
                           Limits::lowest(),
                           static_cast<T>(Limits::max() - 1),
                           static_cast<T>(Limits::lowest() + 1)};
  if constexpr (std::is_floating_point_v<T>) {
    for (const T v : {T(0.1), T(1) / T(3), Limits::infinity(), -Limits::infinity(), Limits::denorm_min(),
                      -Limits::denorm_min(), Limits::quiet_NaN()})
      values.push_back(v);
  }
  for (const double low : bounds)
    for (const double high : bounds)
      for (const T value : values) expect_right<T>(low, high, value);
}

TEST(ValueRange, EveryTypeAtItsLimits) {
  all_pairs<std::uint8_t>();
  all_pairs<std::int8_t>();
  all_pairs<std::uint16_t>();
  all_pairs<std::int16_t>();
  all_pairs<std::uint32_t>();
  all_pairs<std::int32_t>();
  all_pairs<std::uint64_t>();
  all_pairs<std::int64_t>();
  all_pairs<float>();
  all_pairs<double>();
}

TEST(ValueRange, RandomFloats) {
  std::mt19937_64 random(8);
  for (int i = 0; i < 100000; ++i) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (std::isnan(value)) continue;
    const double near = std::nextafter(static_cast<double>(value), random() % 2 ? HUGE_VAL : -HUGE_VAL);
    expect_right<float>(near, HUGE_VAL, value);
    expect_right<float>(-HUGE_VAL, near, value);
    expect_right<float>(static_cast<double>(value), static_cast<double>(value), value);
  }
}

}  // namespace
}  // namespace blackleaf
