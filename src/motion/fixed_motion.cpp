// FixedMotion: a motion on the grid of 2^-38 (include/blackleaf/motion.h has its bounds).
#include <cmath>

#include "blackleaf/error.h"
#include "exact_motion.h"

namespace blackleaf {
namespace {

__extension__ using Wide = __int128;
constexpr int kFractionBits = FixedMotion::kFractionBits;

// To nearest; the middle, and what is 2^-20 steps from it, away from zero. Requires: |value| <= 2^23.
std::int64_t fixed(const detail::DoubleDouble& value) {
  constexpr double kMiddle = 0.5 - 0x1p-20;
  const bool negative = value.high < 0;
  const detail::DoubleDouble steps = (negative ? -value : value).scaled(kFractionBits);
  const double high = std::floor(steps.high), low = std::floor(steps.low);
  const double fraction =
      (steps.high - high) + (steps.low - low);  // 0 to 2: one of the parts has at most rounding dust
  const double whole = std::floor(fraction);
  const std::int64_t result = static_cast<std::int64_t>(high) + static_cast<std::int64_t>(low) +
                              static_cast<std::int64_t>(whole) + (fraction - whole >= kMiddle ? 1 : 0);
  return negative ? -result : result;
}

// Rounds value / 2^bits to nearest, ties away from zero.
std::int64_t rounded_shift(Wide value, int bits) {
  const Wide half = Wide{1} << (bits - 1);
  return static_cast<std::int64_t>(value >= 0 ? (value + half) >> bits : -((-value + half) >> bits));
}

}  // namespace

FixedMotion::FixedMotion(const Motion& motion) {
  if (!(motion.translation().norm() <= kMaxTranslation))
    throw Error(ErrorCode::out_of_universe,
                "the translation of a motion is longer than 2^23 voxels, which takes every solid out of its universe",
                "move it less");
  const detail::ExactMotion exact = detail::ExactMotion::of(motion);
  for (std::size_t i = 0; i < 3; ++i) {
    forward_translation[i] = fixed(exact.translation[i]);
    for (std::size_t j = 0; j < 3; ++j) inverse_rotation[i][j] = fixed(exact.rotation[j][i]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    Wide sum = 0;
    for (std::size_t j = 0; j < 3; ++j) sum += Wide{inverse_rotation[i][j]} * forward_translation[j];
    inverse_translation[i] = rounded_shift(-sum, kFractionBits);
  }
}

FixedMotion FixedMotion::shifted(const std::array<std::int64_t, 3>& by) const {
  FixedMotion result = *this;
  for (std::size_t i = 0; i < 3; ++i) {
    result.forward_translation[i] += by[i] * (std::int64_t{1} << kFractionBits);
    for (std::size_t j = 0; j < 3; ++j) result.inverse_translation[i] -= inverse_rotation[i][j] * by[j];
  }
  return result;
}

bool FixedMotion::is_lattice_symmetry() const {
  constexpr std::int64_t kOne = std::int64_t{1} << kFractionBits;
  for (const auto& row : inverse_rotation)
    for (const std::int64_t entry : row)
      if (entry != 0 && entry != kOne && entry != -kOne) return false;
  for (const std::int64_t entry : inverse_translation)
    if (entry % kOne != 0) return false;
  return true;
}

}  // namespace blackleaf
