#include "centre_kernel.h"

#include <cstring>

#include "octree/simd_kernels.h"

// Highway compiles what follows once for every instruction set, and chooses when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "motion/centre_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BLACKLEAF_CENTRE_KERNEL_TABLES
#define BLACKLEAF_CENTRE_KERNEL_TABLES
namespace blackleaf::detail {
namespace {

using Bytes = std::array<std::uint8_t, 64>;  // one for each 2^3 voxels of a block

// [axis][pair]: all ones where a byte's pair of voxels is at `pair` or beyond.
constexpr auto kFromPair = [] {
  std::array<std::array<Bytes, 4>, 3> masks{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t pair = 0; pair < 4; ++pair)
      for (std::size_t byte = 0; byte < 64; ++byte) {
        const std::size_t place = (byte >> axis & 1) | (byte >> (3 + axis) & 1) << 1;
        masks[axis][pair][byte] = place >= pair ? 0xFF : 0;
      }
  return masks;
}();

// By the upper four bits of a coordinate, three of which are the voxel: where its byte is, and which of its bits the
// voxel may be.
using Nibbles = std::array<std::uint8_t, 16>;
constexpr auto kByteOf = [] {
  std::array<Nibbles, 3> tables{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t upper = 0; upper < 16; ++upper) {
      const std::size_t place = (upper >> 2 & 1) | (upper >> 3) << 3;
      tables[axis][upper] = static_cast<std::uint8_t>(place << axis);
    }
  return tables;
}();
constexpr auto kBitOf = [] {
  constexpr std::array<std::array<std::uint8_t, 2>, 3> kHalves = {{{0x55, 0xAA}, {0x33, 0xCC}, {0x0F, 0xF0}}};
  std::array<Nibbles, 3> tables{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t upper = 0; upper < 16; ++upper) tables[axis][upper] = kHalves[axis][upper >> 1 & 1];
  return tables;
}();

using Blocks = std::array<Block, Neighbourhood::kCells>;

Block bricks_of(const Neighbourhood& source, std::size_t cell) {
  Block block;
  const std::uint64_t* gray = source.words(cell);
  for (std::size_t octant = 0; octant < 8; ++octant)
    block[octant] =
        (source.gray(cell) >> octant & 1) != 0 ? *gray++ : -std::uint64_t{source.black(cell) >> octant & 1u};
  return block;
}

std::size_t cell_at(const BrickLookUp& brick, std::size_t octant) {
  return brick.cell + (octant & 1 ? brick.next[0] : 0u) + (octant & 2 ? brick.next[1] : 0u) +
         (octant & 4 ? brick.next[2] : 0u);
}

const std::uint8_t* bytes_of(const Block& block) { return reinterpret_cast<const std::uint8_t*>(block.data()); }

}  // namespace
}  // namespace blackleaf::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace blackleaf::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void look_up_lanes(const CentreSteps& steps, const Neighbourhood& source, std::span<BrickLookUp> bricks) {
  Blocks blocks;
  source.for_each_row([&](std::size_t y, std::size_t z) HWY_ATTR {
    for (std::size_t cell = 3 * y + 9 * z, end = cell + 3; cell < end; ++cell) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3  // the gray ones stand side by side in memory
      const __m512i gray = _mm512_maskz_expandloadu_epi64(source.gray(cell), source.words(cell));
      _mm512_storeu_si512(blocks[cell].data(), _mm512_mask_mov_epi64(gray, source.black(cell), _mm512_set1_epi64(-1)));
#else
      blocks[cell] = bricks_of(source, cell);
#endif
    }
  });
  const hn::CappedTag<std::uint8_t, 64> d;
  const hn::Repartition<std::uint16_t, decltype(d)> d16;
  const std::size_t lanes = hn::Lanes(d);
  const auto low_half = hn::Set(d, 0x0F), never = hn::Set(d, 0x70);
  const auto two = hn::Set(d16, 2u << (16 - kCentreBits));
  const auto x_byte = hn::LoadDup128(d, kByteOf[0].data()), x_bit = hn::LoadDup128(d, kBitOf[0].data());
  const auto y_byte = hn::LoadDup128(d, kByteOf[1].data()), y_bit = hn::LoadDup128(d, kBitOf[1].data());
  const auto z_byte = hn::LoadDup128(d, kByteOf[2].data()), z_bit = hn::LoadDup128(d, kBitOf[2].data());
  for (BrickLookUp& brick : bricks) {
    auto* around = reinterpret_cast<std::uint8_t*>(brick.around.data());
    for (std::size_t i = 0; i < 64; i += lanes) {
      const auto cell = [&](std::size_t octant)
                            HWY_ATTR { return hn::LoadU(d, bytes_of(blocks[cell_at(brick, octant)]) + i); };
      const auto from = [&](std::size_t axis) HWY_ATTR { return hn::LoadU(d, &kFromPair[axis][brick.pair[axis]][i]); };
      const auto x = from(0), y = from(1), z = from(2);
      const auto lower =
          hn::IfVecThenElse(y, hn::IfVecThenElse(x, cell(0), cell(1)), hn::IfVecThenElse(x, cell(2), cell(3)));
      const auto upper =
          hn::IfVecThenElse(y, hn::IfVecThenElse(x, cell(4), cell(5)), hn::IfVecThenElse(x, cell(6), cell(7)));
      hn::StoreU(hn::IfVecThenElse(z, lower, upper), d, around + i);
    }
    const auto first = hn::LoadDup128(d, around), second = hn::LoadDup128(d, around + 16);
    const auto third = hn::LoadDup128(d, around + 32), fourth = hn::LoadDup128(d, around + 48);
    std::array<std::uint8_t, 16> bits{}, unclear{};
    for (std::size_t i = 0; i < 64; i += lanes) {
      auto least_even = hn::Set(d16, 0xFFFF), least_odd = least_even;
      // The upper four bits of the coordinates on an axis, by the centres' indices.
      const auto upper = [&](std::size_t axis) HWY_ATTR {
        const auto start = hn::Set(d16, brick.first[axis]);
        const auto even = hn::Add(start, hn::LoadU(d16, &steps.even[axis][i / 2]));
        const auto odd = hn::Add(start, hn::LoadU(d16, &steps.odd[axis][i / 2]));
        least_even = hn::Min(least_even, hn::ShiftLeft<16 - kCentreBits>(even));
        least_odd = hn::Min(least_odd, hn::ShiftLeft<16 - kCentreBits>(odd));
        const auto both = hn::OddEven(hn::BitCast(d, odd), hn::BitCast(d, hn::ShiftRight<8>(even)));
        return hn::And(hn::BitCast(d, hn::ShiftRight<4>(hn::BitCast(d16, both))), low_half);
      };
      const auto x = upper(0), y = upper(1), z = upper(2);
      const auto byte = hn::Or(hn::TableLookupBytes(x_byte, x),
                               hn::Or(hn::TableLookupBytes(y_byte, y), hn::TableLookupBytes(z_byte, z)));
      const auto bit = hn::And(hn::TableLookupBytes(x_bit, x),
                               hn::And(hn::TableLookupBytes(y_bit, y), hn::TableLookupBytes(z_bit, z)));
      // A table of 64 bytes as four of 16: the upper bit of an index that is not one of the sixteen gets set.
      const auto part = [&](auto table, std::uint8_t begin) HWY_ATTR {
        return hn::TableLookupBytesOr0(table, hn::SaturatedAdd(hn::Xor(byte, hn::Set(d, begin)), never));
      };
      const auto voxels = hn::Or(hn::Or(part(first, 0), part(second, 16)), hn::Or(part(third, 32), part(fourth, 48)));
      hn::StoreMaskBits(d, hn::Ne(hn::And(voxels, bit), hn::Zero(d)), &bits[i / 8]);
      const auto near = hn::OddEven(hn::BitCast(d, hn::VecFromMask(d16, hn::Lt(least_odd, two))),
                                    hn::BitCast(d, hn::VecFromMask(d16, hn::Lt(least_even, two))));
      hn::StoreMaskBits(d, hn::MaskFromVec(near), &unclear[i / 8]);
    }
    std::memcpy(&brick.bits, bits.data(), sizeof brick.bits);
    std::memcpy(&brick.unclear, unclear.data(), sizeof brick.unclear);
  }
}

}  // namespace blackleaf::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blackleaf::detail {
namespace {

HWY_EXPORT(look_up_lanes);

void look_up_scalar(const CentreSteps& steps, const Neighbourhood& source, std::span<BrickLookUp> bricks) {
  Blocks blocks;
  source.for_each_row([&](std::size_t y, std::size_t z) {
    for (std::size_t x = 0; x < 3; ++x) blocks[x + 3 * y + 9 * z] = bricks_of(source, x + 3 * y + 9 * z);
  });
  for (BrickLookUp& brick : bricks) {
    auto* around = reinterpret_cast<std::uint8_t*>(brick.around.data());
    for (std::size_t byte = 0; byte < 64; ++byte) {
      std::size_t octant = 0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        octant |= std::size_t{kFromPair[axis][brick.pair[axis]][byte] == 0} << axis;
      around[byte] = bytes_of(blocks[cell_at(brick, octant)])[byte];
    }
    brick.bits = brick.unclear = 0;
    for (std::size_t i = 0; i < 64; ++i) {
      const auto& of_parity = i % 2 == 0 ? steps.even : steps.odd;
      std::array<std::uint16_t, 3> at{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        at[axis] = static_cast<std::uint16_t>(brick.first[axis] + of_parity[axis][i / 2]);
        if ((at[axis] & ((1u << kCentreBits) - 1)) < 2) brick.unclear |= std::uint64_t{1} << i;
      }
      const bool black = brick.black(at[0] >> kCentreBits, at[1] >> kCentreBits, at[2] >> kCentreBits);
      brick.bits |= std::uint64_t{black} << i;
    }
  }
}

}  // namespace

void look_up(const CentreSteps& steps, const Neighbourhood& source, std::span<BrickLookUp> bricks) {
  if (scalar_kernel_wanted()) return look_up_scalar(steps, source, bricks);
  HWY_DYNAMIC_DISPATCH(look_up_lanes)(steps, source, bricks);
}

}  // namespace blackleaf::detail
#endif  // HWY_ONCE
