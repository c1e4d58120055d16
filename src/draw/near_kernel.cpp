#include "near_kernel.h"

#include <cstring>

#include "feature_edges.h"
#include "motion/centre_kernel.h"

// Highway compiles what follows once for every instruction set, and chooses when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "draw/near_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace blackleaf::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// As many rows at once as there are lanes.
template <bool kInPlane>
void look_lanes_of(const NearQuestion& q, std::uint32_t* clear, std::uint32_t* partly, NearMet& met) {
  const hn::CappedTag<std::uint32_t, 16> d;
  const auto voxels = [&](const char* from, const VoxelStep& step) {
    return hn::ShiftRightSame(hn::LoadU(d, reinterpret_cast<const std::uint32_t*>(from + step.bytes)), step.bits);
  };
  const VoxelStep b = q.corner + q.beside_b, c = q.corner + q.beside_c, bc = b + q.beside_c;
  // The voxels that rays enter first.
  const EdgeFamily& f = q.family;
  const bool up_b = f.d_b > 0, up_c = f.d_c > 0;
  const VoxelStep entered = kInPlane ? (up_c ? q.corner : c) : up_b ? (up_c ? q.corner : c) : (up_c ? b : bc);
  const auto of_corners = hn::Set(d, 0xFFFF);
  met = {};
  for (int z = 0; z < 16; ++z)
    for (int y = 0; y < 16; y += static_cast<int>(hn::Lanes(d))) {
      const char* const from = q.rows + VoxelStep::to({0, y, z}).bytes;
      const auto at = voxels(from, q.corner), at_b = voxels(from, b), at_c = voxels(from, c), at_bc = voxels(from, bc);
      auto edges =
          hn::And(hn::Or(hn::Xor(at, at_b), hn::Xor(at_c, at_bc)), hn::Or(hn::Xor(at, at_c), hn::Xor(at_b, at_bc)));
      auto blocked = voxels(from, entered);
      if constexpr (kInPlane) blocked = hn::Or(blocked, voxels(from, entered + q.beside_b));
      edges = hn::AndNot(blocked, hn::And(edges, of_corners));
      const auto none = hn::Zero(d);
      if (hn::AllTrue(d, hn::Eq(edges, none))) continue;
      const auto black_at = [&](const NearLook& look) {
        auto black = voxels(from, look.step);
        if constexpr (kInPlane) black = hn::And(black, voxels(from, look.step + q.beside_b));
        return black;
      };
      auto touched = none, hidden = none, last = none;
      for (const NearLook& look : q.first) {
        const auto black = black_at(look);
        touched = hn::Or(touched, black);
        if (look.alone) hidden = hn::Or(hidden, black);
        if (look.with_last) hidden = hn::Or(hidden, hn::And(black, last));
        last = black;
      }
      edges = hn::AndNot(hidden, edges);
      if (hn::AllTrue(d, hn::Eq(edges, none))) continue;
      for (const NearLook& look : q.others) touched = hn::Or(touched, black_at(look));
      hn::StoreU(hn::AndNot(touched, edges), d, clear + 16 * z + y);
      const auto parts = hn::And(touched, edges);
      if (hn::AllTrue(d, hn::Eq(parts, none))) continue;
      hn::StoreU(parts, d, partly + 16 * z + y);
      std::size_t i = 0;
      for (const auto looks : {q.first, q.others})
        for (const NearLook& look : looks) {
          const bool some = !hn::AllTrue(d, hn::Eq(hn::And(black_at(look), parts), none));
          met[static_cast<std::size_t>(z)][i / 64] |= std::uint64_t{some} << (i % 64);
          ++i;
        }
    }
}

void lay_out_lanes(const std::array<NearBlock, 5>& blocks, char* rows) {
  const hn::CappedTag<std::uint32_t, 8> d;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  for (std::size_t z = 0; z < 8; ++z)
    for (std::size_t y = 0; y < 8; y += hn::Lanes(d)) {
      const auto of = [&](std::size_t x) { return hn::PromoteTo(d, hn::LoadU(bytes, &blocks[x][z][y])); };
      const auto lower = hn::Or(hn::ShiftRight<4>(of(0)), hn::ShiftLeft<4>(of(1)));
      const auto upper = hn::Or(hn::ShiftLeft<20>(of(3)), hn::ShiftLeft<28>(of(4)));
      hn::StoreU(hn::Or(hn::Or(lower, upper), hn::ShiftLeft<12>(of(2))), d,
                 reinterpret_cast<std::uint32_t*>(rows) + kRows * z + y);
    }
}

void look_lanes(const NearQuestion& q, std::uint32_t* clear, std::uint32_t* partly, NearMet& met) {
  q.family.mode == EdgeFamily::Mode::in_plane ? look_lanes_of<true>(q, clear, partly, met)
                                              : look_lanes_of<false>(q, clear, partly, met);
}

}  // namespace HWY_NAMESPACE
}  // namespace blackleaf::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blackleaf::detail {
namespace {

HWY_EXPORT(lay_out_lanes);
HWY_EXPORT(look_lanes);

void lay_out_scalar(const std::array<NearBlock, 5>& blocks, char* rows) {
  for (std::size_t z = 0; z < 8; ++z)
    for (std::size_t y = 0; y < 8; ++y) {
      const std::uint32_t row = std::uint32_t{blocks[0][z][y]} >> 4 | std::uint32_t{blocks[1][z][y]} << 4 |
                                std::uint32_t{blocks[2][z][y]} << 12 | std::uint32_t{blocks[3][z][y]} << 20 |
                                std::uint32_t{blocks[4][z][y]} << 28;
      std::memcpy(rows + sizeof(row) * (kRows * z + y), &row, sizeof(row));
    }
}

// Row by row.
void look_scalar(const NearQuestion& q, std::uint32_t* clear, std::uint32_t* partly, NearMet& met) {
  met = {};
  for (int row = 0; row < 256; ++row) {
    const auto voxels = [&](const VoxelStep& step) {
      std::uint32_t bits;
      std::memcpy(&bits, q.rows + VoxelStep::to({0, row % 16, row / 16}).bytes + step.bytes, sizeof(bits));
      return bits >> step.bits;
    };
    const auto black_at = [&](const NearLook& look) {
      const bool in_plane = q.family.mode == EdgeFamily::Mode::in_plane;
      return voxels(look.step) & (in_plane ? voxels(look.step + q.beside_b) : ~0u);
    };
    const VoxelStep b = q.corner + q.beside_b, c = q.corner + q.beside_c;
    const std::uint32_t edges =
        candidates(q.family, voxels(q.corner), voxels(b), voxels(c), voxels(b + q.beside_c)) & 0xFFFF;
    std::uint32_t touched = 0, hidden = 0, last = 0;
    for (const NearLook& look : q.first) {
      const std::uint32_t black = black_at(look);
      touched |= black;
      if (look.alone) hidden |= black;
      if (look.with_last) hidden |= black & last;
      last = black;
    }
    for (const NearLook& look : q.others) touched |= black_at(look);
    clear[row] = edges & ~touched;
    partly[row] = edges & touched & ~hidden;
    std::size_t i = 0;
    for (const auto looks : {q.first, q.others})
      for (const NearLook& look : looks) {
        const bool some = (black_at(look) & partly[row]) != 0;
        met[static_cast<std::size_t>(row / 16)][i / 64] |= std::uint64_t{some} << (i % 64);
        ++i;
      }
  }
}

}  // namespace

void lay_out(const std::array<NearBlock, 5>& blocks, char* rows) {
  if (scalar_kernel_wanted()) return lay_out_scalar(blocks, rows);
  HWY_DYNAMIC_DISPATCH(lay_out_lanes)(blocks, rows);
}

void look(const NearQuestion& question, std::uint32_t* clear, std::uint32_t* partly, NearMet& met) {
  if (scalar_kernel_wanted()) return look_scalar(question, clear, partly, met);
  HWY_DYNAMIC_DISPATCH(look_lanes)(question, clear, partly, met);
}

}  // namespace blackleaf::detail
#endif  // HWY_ONCE
