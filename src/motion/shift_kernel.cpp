#include "shift_kernel.h"

#include <bit>

// Highway compiles what follows once for every instruction set, and chooses when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "motion/shift_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace blackleaf::detail::HWY_NAMESPACE {

// The words of a cell's children by octant, or what stands for one of one colour, `black` for black ones. Without a
// branch, because what is met is as good as random.
inline void decode(std::uint64_t cell, const std::uint64_t* below, std::uint64_t black, std::uint64_t* children) {
  const std::uint64_t* next = below + (cell >> 16);
  for (unsigned octant = 0; octant < 8; ++octant) {
    const std::uint64_t is_black = cell >> octant & 1, is_gray = cell >> (octant + 8) & 1;
    children[octant] = (*(is_gray != 0 ? next : below) & (0 - is_gray)) | (black & (0 - is_black));
    next += is_gray;
  }
}

constexpr std::uint64_t kBlackCell = 0xFF, kBlackBrick = ~std::uint64_t{0};

#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2

namespace hn = hwy::HWY_NAMESPACE;
using Four = hn::FixedTag<std::uint64_t, 4>;
using Lanes = hn::Vec<Four>;

// Eight cells or bricks of one cell in octant order, or those between two cells.
struct Eight {
  Lanes low, high;
};

inline Eight decoded(std::uint64_t cell, const std::uint64_t* below, std::uint64_t black) {
#if HWY_TARGET <= HWY_AVX3
  const auto gray = static_cast<__mmask8>(cell >> 8 & 0xFF);
  const auto blacks = static_cast<__mmask8>(cell & 0xFF);
  const __m512i words = _mm512_maskz_expandloadu_epi64(gray, below + (cell >> 16));
  const __m512i all = _mm512_mask_set1_epi64(words, blacks, static_cast<long long>(black));
  return {Lanes{_mm512_castsi512_si256(all)}, Lanes{_mm512_extracti64x4_epi64(all, 1)}};
#else
  alignas(32) std::uint64_t children[8];
  decode(cell, below, black, children);
  return {hn::Load(Four(), children), hn::Load(Four(), children + 4)};
#endif
}

// The eight that begin one place up an axis from `a`, where `b` is next.
template <unsigned kAxis>
inline Eight between(const Eight& a, const Eight& b) {
  const Four d;
  if constexpr (kAxis == 0)
    return {hn::CombineShiftRightBytes<8>(d, b.low, a.low), hn::CombineShiftRightBytes<8>(d, b.high, a.high)};
  else if constexpr (kAxis == 1)
    return {hn::ConcatLowerUpper(d, b.low, a.low), hn::ConcatLowerUpper(d, b.high, a.high)};
  else
    return {a.high, b.low};
}

// Makes two cells the eight at the first and the second place; `first`: the places begin at the second.
template <unsigned kAxis>
inline void place(Eight& a, Eight& b, unsigned first) {
  const Eight middle = between<kAxis>(a, b);
  if ((first >> kAxis & 1) != 0)
    a = middle;
  else
    b = middle;
}

inline Lanes shifted(const Lanes& low, const Lanes& high, const BrickShift& shift) {
  const Four d;
  const auto& parts = shift.parts();
  const auto down = [&](std::size_t i) {
    return hn::And(hn::ShiftRightSame(low, static_cast<int>(parts[i].shift)), hn::Set(d, parts[i].mask));
  };
  const auto up = [&](std::size_t i) {
    return hn::And(hn::ShiftLeftSame(high, static_cast<int>(parts[i].shift)), hn::Set(d, parts[i].mask));
  };
  return hn::Or(hn::Or(down(0), down(1)), hn::Or(up(2), up(3)));
}

template <unsigned kAxis>
inline Eight shifted(Eight a, Eight b, unsigned first, const BlockShift& shift) {
  place<kAxis>(a, b, first);
  return {shifted(a.low, b.low, shift.axis(kAxis)), shifted(a.high, b.high, shift.axis(kAxis))};
}

void cells_below_lanes(const std::uint64_t* cells, const std::uint64_t* below, unsigned first, std::uint64_t* result) {
  Eight at[8];
  for (std::size_t i = 0; i < 8; ++i) at[i] = decoded(cells[8 * i], below, kBlackCell);
  for (std::size_t i = 0; i < 8; i += 2) place<0>(at[i], at[i + 1], first);
  for (const std::size_t i : {0, 1, 4, 5}) place<1>(at[i], at[i + 2], first);
  for (std::size_t i = 0; i < 4; ++i) place<2>(at[i], at[i + 4], first);
  for (std::size_t i = 0; i < 8; ++i) {
    hn::StoreU(at[i].low, Four(), result + 8 * i);
    hn::StoreU(at[i].high, Four(), result + 8 * i + 4);
  }
}

void shifted_bricks_lanes(const std::uint64_t* cells, const std::uint64_t* below, unsigned first,
                          const BlockShift& shift, std::uint64_t* result) {
  Eight at[8];
  for (std::size_t i = 0; i < 8; ++i) at[i] = decoded(cells[8 * i], below, kBlackBrick);
  for (std::size_t i = 0; i < 8; i += 2) at[i] = shifted<0>(at[i], at[i + 1], first, shift);
  for (std::size_t i = 0; i < 8; i += 4) at[i] = shifted<1>(at[i], at[i + 2], first, shift);
  at[0] = shifted<2>(at[0], at[4], first, shift);
  hn::StoreU(at[0].low, Four(), result);
  hn::StoreU(at[0].high, Four(), result + 4);
}

#else

// The 4^3 children of 2^3 cells: 8 times cell + octant. This one is the readable twin.
struct Children {
  std::uint64_t words[64];

  Children(const std::uint64_t* cells, const std::uint64_t* below, std::uint64_t black) {
    for (std::size_t i = 0; i < 8; ++i) decode(cells[8 * i], below, black, words + 8 * i);
  }
  // The one at a place.
  std::uint64_t at(unsigned x, unsigned y, unsigned z) const {
    return words[8 * ((x >> 1) + 2 * (y >> 1) + 4 * (z >> 1)) + (x & 1) + 2 * (y & 1) + 4 * (z & 1)];
  }
};

void cells_below_lanes(const std::uint64_t* cells, const std::uint64_t* below, unsigned first, std::uint64_t* result) {
  const Children children(cells, below, kBlackCell);
  const unsigned x = first & 1, y = first >> 1 & 1, z = first >> 2;
  for (unsigned i = 0; i < 8; ++i)
    for (unsigned octant = 0; octant < 8; ++octant)
      result[8 * i + octant] =
          children.at(x + (i & 1) + (octant & 1), y + (i >> 1 & 1) + (octant >> 1 & 1), z + (i >> 2) + (octant >> 2));
}

void shifted_bricks_lanes(const std::uint64_t* cells, const std::uint64_t* below, unsigned first,
                          const BlockShift& shift, std::uint64_t* result) {
  const Children children(cells, below, kBlackBrick);
  std::array<std::uint64_t, 27> bricks;
  for (unsigned i = 0; i < 27; ++i)
    bricks[i] = children.at((first & 1) + i / 9, (first >> 1 & 1) + i / 3 % 3, (first >> 2) + i % 3);
  const std::array<std::uint64_t, 8> shifted = shift(bricks);
  for (unsigned octant = 0; octant < 8; ++octant)
    result[octant] = shifted[4 * (octant & 1) + (octant & 2) + (octant >> 2)];
}

#endif

}  // namespace blackleaf::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blackleaf::detail {
namespace {

HWY_EXPORT(cells_below_lanes);
HWY_EXPORT(shifted_bricks_lanes);

}  // namespace

void cells_below(const std::uint64_t* cells, const std::uint64_t* below, unsigned first, std::uint64_t* result) {
  HWY_DYNAMIC_DISPATCH(cells_below_lanes)(cells, below, first, result);
}

void shifted_bricks(const std::uint64_t* cells, const std::uint64_t* below, unsigned first, const BlockShift& shift,
                    std::uint64_t* result) {
  HWY_DYNAMIC_DISPATCH(shifted_bricks_lanes)(cells, below, first, shift, result);
}

}  // namespace blackleaf::detail
#endif  // HWY_ONCE
