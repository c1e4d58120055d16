#include "centre_kernel.h"

// Highway compiles what follows once for every instruction set, and chooses when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "motion/centre_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace blackleaf::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

unsigned look_up_lanes(const FirstCentres& firsts, const CentreSteps& steps, const std::uint32_t* rows,
                       std::array<std::uint64_t, 8>& bits) {
  constexpr std::uint32_t kMargin = VoxelRows::kMargin, kRows = VoxelRows::kRows;
  const hn::CappedTag<std::uint32_t, 16> d;
  const hn::Rebind<std::int32_t, decltype(d)> index;
  const std::size_t lanes = hn::Lanes(d);
  const auto one = hn::Set(d, 1), two = hn::Set(d, 2), margin = hn::Set(d, kMargin), row_length = hn::Set(d, kRows);
  const auto fraction = hn::Set(d, (1u << kCentreBits) - 1);
  const auto first_row = hn::Set(d, kMargin + kRows * kMargin);
  unsigned unclear = 0;
  for (unsigned brick = 0; brick < 8; ++brick) {
    const auto x0 = hn::Set(d, firsts[brick][0]), y0 = hn::Set(d, firsts[brick][1]), z0 = hn::Set(d, firsts[brick][2]);
    auto least = fraction;
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < 64; i += lanes) {
      const auto x = hn::Add(x0, hn::LoadU(d, &steps[0][i]));
      const auto y = hn::Add(y0, hn::LoadU(d, &steps[1][i]));
      const auto z = hn::Add(z0, hn::LoadU(d, &steps[2][i]));
      least = hn::Min(least, hn::Min(hn::And(hn::Add(x, one), fraction),
                                     hn::Min(hn::And(hn::Add(y, one), fraction), hn::And(hn::Add(z, one), fraction))));
      const auto row = hn::Add(hn::Add(hn::ShiftRight<kCentreBits>(y), first_row),
                               hn::Mul(hn::ShiftRight<kCentreBits>(z), row_length));
      const auto voxels = hn::GatherIndex(d, rows, hn::BitCast(index, row));
      const auto bit = hn::Shl(one, hn::Add(hn::ShiftRight<kCentreBits>(x), margin));
      std::array<std::uint8_t, 8> mask{};
      hn::StoreMaskBits(d, hn::TestBit(voxels, bit), mask.data());
      word |= std::uint64_t{mask[0] | static_cast<unsigned>(mask[1]) << 8} << i;
    }
    bits[brick] = word;
    if (!hn::AllFalse(d, hn::Lt(least, two))) unclear |= 1u << brick;
  }
  return unclear;
}

}  // namespace blackleaf::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blackleaf::detail {
namespace {

HWY_EXPORT(look_up_lanes);

bool scalar_wanted = false;

unsigned look_up_scalar(const FirstCentres& firsts, const CentreSteps& steps, const VoxelRows& rows,
                        std::array<std::uint64_t, 8>& bits) {
  constexpr std::uint32_t kFraction = (std::uint32_t{1} << kCentreBits) - 1;
  unsigned unclear = 0;
  for (unsigned brick = 0; brick < 8; ++brick) {
    bits[brick] = 0;
    for (std::size_t i = 0; i < 64; ++i) {
      const std::uint32_t x = firsts[brick][0] + steps[0][i], y = firsts[brick][1] + steps[1][i],
                          z = firsts[brick][2] + steps[2][i];
      for (const std::uint32_t coordinate : {x, y, z})
        if (((coordinate + 1) & kFraction) < 2) unclear |= 1u << brick;
      bits[brick] |= std::uint64_t{rows.black(x >> kCentreBits, y >> kCentreBits, z >> kCentreBits)} << i;
    }
  }
  return unclear;
}

}  // namespace

unsigned look_up(const FirstCentres& firsts, const CentreSteps& steps, const VoxelRows& rows,
                 std::array<std::uint64_t, 8>& bits) {
  if (scalar_wanted) return look_up_scalar(firsts, steps, rows, bits);
  return HWY_DYNAMIC_DISPATCH(look_up_lanes)(firsts, steps, rows.data(), bits);
}

std::vector<std::string> centre_kernels() {
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) names.emplace_back(hwy::TargetName(target));
  names.emplace_back("scalar");
  return names;
}

void use_centre_kernel(const std::string& name) {
  scalar_wanted = name == "scalar";
  std::int64_t wanted = 0;  // all that there are
  hwy::SetSupportedTargetsForTest(0);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    if (name == hwy::TargetName(target)) wanted = target;
  hwy::SetSupportedTargetsForTest(wanted);
  hwy::GetChosenTarget().DeInit();
}

}  // namespace blackleaf::detail
#endif  // HWY_ONCE
