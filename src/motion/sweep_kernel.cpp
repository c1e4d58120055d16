#include "sweep_kernel.h"

#include "octree/brick.h"
#include "octree/simd_kernels.h"

// Highway compiles what follows once for every instruction set, and chooses when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "motion/sweep_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace blackleaf::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The voxels; `unclear` is set if one of them is.
std::uint64_t covered_lanes(const CutCentres& centres, const std::uint32_t* rows, bool& unclear) {
  const hn::CappedTag<std::uint32_t, 16> d;
  const hn::Rebind<std::int32_t, decltype(d)> index;
  using Lanes = hn::Vec<decltype(d)>;
  const std::size_t lanes = hn::Lanes(d);
  const auto one = hn::Set(d, 1), fraction = hn::Set(d, (1u << kSweepFraction) - 1);
  // The bits of a lane's number in a brick are x0 y0 z0 x1 y1 z1; what lies above the lanes is added as a whole.
  const auto number = hn::Iota(d, 0);
  const auto bit = [&](std::uint32_t i) { return hn::And(hn::Shr(number, hn::Set(d, i)), one); };
  const auto x = hn::Add(bit(0), hn::ShiftLeft<1>(bit(3))), y = bit(1), z = bit(2);
  const auto start = [&](std::size_t axis) -> Lanes {
    const auto& step = centres.step;
    return hn::Add(hn::Add(hn::Set(d, centres.first[axis]), hn::Mul(x, hn::Set(d, step[0][axis]))),
                   hn::Add(hn::Mul(y, hn::Set(d, step[1][axis])), hn::Mul(z, hn::Set(d, step[2][axis]))));
  };
  const Lanes x_start = start(0), y_start = start(1), z_start = start(2);
  const auto margin = hn::Set(d, kUnclear);
  auto least = fraction;
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < 64; i += lanes) {
    const auto place = static_cast<unsigned>(i);
    const std::uint32_t u = brick_x(place), v = brick_y(place), w = brick_z(place);
    const auto offset = [&](std::size_t axis) {
      return hn::Set(d, u * centres.step[0][axis] + v * centres.step[1][axis] + w * centres.step[2][axis]);
    };
    const auto px = hn::Add(x_start, offset(0)), py = hn::Add(y_start, offset(1)), pz = hn::Add(z_start, offset(2));
    least = hn::Min(least,
                    hn::Min(hn::And(hn::Add(px, margin), fraction),
                            hn::Min(hn::And(hn::Add(py, margin), fraction), hn::And(hn::Add(pz, margin), fraction))));
    const auto row = hn::Or(hn::ShiftRight<kSweepFraction>(py),
                            hn::And(hn::ShiftRight<kSweepFraction - 5>(pz), hn::Set(d, 31u << 5)));
    const auto voxels = hn::GatherIndex(d, rows, hn::BitCast(index, row));
    std::array<std::uint8_t, 8> mask{};
    hn::StoreMaskBits(d, hn::TestBit(voxels, hn::Shl(one, hn::ShiftRight<kSweepFraction>(px))), mask.data());
    word |= std::uint64_t{mask[0] | static_cast<unsigned>(mask[1]) << 8} << i;
  }
  unclear = !hn::AllFalse(d, hn::Lt(least, hn::Set(d, 2 * kUnclear)));
  return word;
}

}  // namespace blackleaf::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blackleaf::detail {
namespace {

HWY_EXPORT(covered_lanes);

std::optional<std::uint64_t> covered_scalar(const CutCentres& centres, const SweepRows& rows) {
  constexpr std::uint32_t kFraction = (std::uint32_t{1} << kSweepFraction) - 1;
  std::uint64_t word = 0;
  for (unsigned bit = 0; bit < 64; ++bit) {
    std::array<std::uint32_t, 3> at = centres.first;
    for (std::size_t i = 0; i < 3; ++i) {
      at[i] +=
          brick_x(bit) * centres.step[0][i] + brick_y(bit) * centres.step[1][i] + brick_z(bit) * centres.step[2][i];
      if (((at[i] + kUnclear) & kFraction) < 2 * kUnclear) return std::nullopt;
    }
    const std::uint32_t row = rows[at[1] >> kSweepFraction | (at[2] >> kSweepFraction) << 5];
    word |= std::uint64_t{row >> (at[0] >> kSweepFraction) & 1} << bit;
  }
  return word;
}

}  // namespace

std::optional<std::uint64_t> covered_voxels(const CutCentres& centres, const SweepRows& rows) {
  if (scalar_kernel_wanted()) return covered_scalar(centres, rows);
  bool unclear = false;
  const std::uint64_t word = HWY_DYNAMIC_DISPATCH(covered_lanes)(centres, rows.data(), unclear);
  return unclear ? std::nullopt : std::optional(word);
}

}  // namespace blackleaf::detail
#endif  // HWY_ONCE
