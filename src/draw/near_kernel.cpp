#include "near_kernel.h"

#include <cstring>

#include "feature_edges.h"
#include "octree/simd_kernels.h"

// Highway compiles what follows once for every instruction set, and chooses when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "draw/near_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace blackleaf::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The voxels that rays of an edge enter first, from that above its corner: two, or one twice.
struct EnteredVoxels {
  bool draws = false;
  VoxelStep one, other;

  EnteredVoxels() = default;
  explicit EnteredVoxels(const EdgeFamily& f) : draws(f.mode != EdgeFamily::Mode::end_on) {
    const VoxelStep b = VoxelStep::below(f.b);
    if (f.d_c < 0) one = VoxelStep::below(f.c);
    if (f.mode == EdgeFamily::Mode::general && f.d_b < 0) one = one + b;
    other = f.mode == EdgeFamily::Mode::in_plane ? one + b : one;
  }
};

using Lanes = hn::CappedTag<std::uint32_t, 16>;  // as many rows at once
using Rows = hn::VFromD<Lanes>;

HWY_INLINE Rows voxels(const char* from, const VoxelStep& step) {
  const Lanes d;
  return hn::ShiftRightSame(hn::LoadU(d, reinterpret_cast<const std::uint32_t*>(from + step.bytes)), step.bits);
}

// Calls visit(z, voxels from there on, the place of its first row) for all rows of corners.
template <class Visit>
void for_all_rows(const char* rows, const Visit& visit) {
  for (int z = 0; z < 16; ++z)
    for (int y = 0; y < 16; y += static_cast<int>(hn::Lanes(Lanes())))
      visit(static_cast<std::size_t>(z), rows + VoxelStep::to({0, y, z}).bytes, 16 * z + y);
}

unsigned candidates_lanes(const std::array<EdgeFamily, 3>& families, const char* rows, const VoxelStep& corner,
                          const std::array<EdgeRows, 3>& edges) {
  const Lanes d;
  const auto of_corners = hn::Set(d, 0xFFFF), none = hn::Zero(d);
  constexpr VoxelStep kBelowX = VoxelStep::below(0), kBelowY = VoxelStep::below(1), kBelowZ = VoxelStep::below(2);
  std::array<EnteredVoxels, 3> entered;
  for (const EdgeFamily& family : families) entered[family.a] = EnteredVoxels(family);
  auto any_x = none, any_y = none, any_z = none;
  for_all_rows(rows, [&](std::size_t, const char* from, int row) {
    const auto at = [&](const VoxelStep& step) { return voxels(from, corner + step); };
    // Named after the axes along which they are above the corner.
    const auto x = at(kBelowY + kBelowZ), y = at(kBelowX + kBelowZ), z = at(kBelowX + kBelowY);
    const auto xy = at(kBelowZ), xz = at(kBelowY), yz = at(kBelowX), xyz = at({});
    const auto find = [&](unsigned axis, auto a, auto ab, auto ac, auto& any) {
      auto found = none;
      if (entered[axis].draws) {
        const auto feature =
            hn::And(hn::Or(hn::Xor(xyz, ab), hn::Xor(ac, a)), hn::Or(hn::Xor(xyz, ac), hn::Xor(ab, a)));
        const auto blocked = hn::Or(at(entered[axis].one), at(entered[axis].other));
        found = hn::AndNot(blocked, hn::And(feature, of_corners));
        any = hn::Or(any, found);
      }
      hn::StoreU(found, d, edges[axis] + row);
    };
    find(0, x, xy, xz, any_x);
    find(1, y, xy, yz, any_y);
    find(2, z, xz, yz, any_z);
  });
  const auto bit = [&](auto any) { return hn::AllTrue(d, hn::Eq(any, none)) ? 0u : 1u; };
  return bit(any_x) | bit(any_y) << 1 | bit(any_z) << 2;
}

template <bool kInPlane>
void look_of(const NearQuestion& q, EdgeRows edges, EdgeRows clear, NearMet& met) {
  const Lanes d;
  const auto none = hn::Zero(d);
  met = {};
  for_all_rows(q.rows, [&](std::size_t z, const char* from, int row) {
    auto left = hn::LoadU(d, edges + row);
    if (hn::AllTrue(d, hn::Eq(left, none))) return;
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
    left = hn::AndNot(hidden, left);
    if (hn::AllTrue(d, hn::Eq(left, none))) return hn::StoreU(none, d, edges + row);
    for (const NearLook& look : q.others) touched = hn::Or(touched, black_at(look));
    hn::StoreU(hn::AndNot(touched, left), d, clear + row);
    const auto parts = hn::And(touched, left);
    hn::StoreU(parts, d, edges + row);
    if (hn::AllTrue(d, hn::Eq(parts, none))) return;
    std::size_t i = 0;
    for (const auto looks : {q.first, q.others})
      for (const NearLook& look : looks) {
        const bool some = !hn::AllTrue(d, hn::Eq(hn::And(black_at(look), parts), none));
        met[z][i / 64] |= std::uint64_t{some} << (i % 64);
        ++i;
      }
  });
}

void lay_out_lanes(const SideBySide& pieces, char* rows) {
  const hn::CappedTag<std::uint32_t, 8> d;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  for (std::size_t z = 0; z < 8; ++z)
    for (std::size_t y = 0; y < 8; y += hn::Lanes(d)) {
      const auto of = [&](std::size_t x) { return hn::PromoteTo(d, hn::LoadU(bytes, pieces[x] + 16 * z + y)); };
      const auto lower = hn::Or(hn::ShiftRight<4>(of(0)), hn::ShiftLeft<4>(of(1)));
      const auto upper = hn::Or(hn::ShiftLeft<20>(of(3)), hn::ShiftLeft<28>(of(4)));
      hn::StoreU(hn::Or(hn::Or(lower, upper), hn::ShiftLeft<12>(of(2))), d,
                 reinterpret_cast<std::uint32_t*>(rows) + kRows * z + y);
    }
}

void look_lanes(const NearQuestion& q, EdgeRows edges, EdgeRows clear, NearMet& met) {
  q.family.mode == EdgeFamily::Mode::in_plane ? look_of<true>(q, edges, clear, met)
                                              : look_of<false>(q, edges, clear, met);
}

}  // namespace HWY_NAMESPACE
}  // namespace blackleaf::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blackleaf::detail {
namespace {

HWY_EXPORT(lay_out_lanes);
HWY_EXPORT(candidates_lanes);
HWY_EXPORT(look_lanes);

void lay_out_scalar(const SideBySide& pieces, char* rows) {
  for (std::size_t z = 0; z < 8; ++z)
    for (std::size_t y = 0; y < 8; ++y) {
      const auto of = [&](std::size_t x) { return std::uint32_t{pieces[x][16 * z + y]}; };
      const std::uint32_t row = of(0) >> 4 | of(1) << 4 | of(2) << 12 | of(3) << 20 | of(4) << 28;
      std::memcpy(rows + sizeof(row) * (kRows * z + y), &row, sizeof(row));
    }
}

// 32 voxels, that many steps away from the corners of a row.
std::uint32_t voxels_scalar(const char* rows, int row, const VoxelStep& step) {
  std::uint32_t bits;
  std::memcpy(&bits, rows + VoxelStep::to({0, row % 16, row / 16}).bytes + step.bytes, sizeof(bits));
  return bits >> step.bits;
}

unsigned candidates_scalar(const std::array<EdgeFamily, 3>& families, const char* rows, const VoxelStep& corner,
                           const std::array<EdgeRows, 3>& edges) {
  unsigned any = 0;
  for (const EdgeFamily& family : families)
    for (int row = 0; row < 256; ++row) {
      const auto voxels = [&](const VoxelStep& step) { return voxels_scalar(rows, row, corner + step); };
      const VoxelStep b = VoxelStep::below(family.b), c = VoxelStep::below(family.c);
      const bool drawn = family.mode != EdgeFamily::Mode::end_on;
      edges[family.a][row] = drawn ? candidates(family, voxels({}), voxels(b), voxels(c), voxels(b + c)) & 0xFFFF : 0;
      if (edges[family.a][row] != 0) any |= 1u << family.a;
    }
  return any;
}

void look_scalar(const NearQuestion& q, EdgeRows edges, EdgeRows clear, NearMet& met) {
  met = {};
  for (int row = 0; row < 256; ++row) {
    const auto black_at = [&](const NearLook& look) {
      const bool in_plane = q.family.mode == EdgeFamily::Mode::in_plane;
      return voxels_scalar(q.rows, row, look.step) &
             (in_plane ? voxels_scalar(q.rows, row, look.step + q.beside_b) : ~0u);
    };
    std::uint32_t touched = 0, hidden = 0, last = 0;
    for (const NearLook& look : q.first) {
      const std::uint32_t black = black_at(look);
      touched |= black;
      if (look.alone) hidden |= black;
      if (look.with_last) hidden |= black & last;
      last = black;
    }
    for (const NearLook& look : q.others) touched |= black_at(look);
    clear[row] = edges[row] & ~touched;
    edges[row] &= touched & ~hidden;
    std::size_t i = 0;
    for (const auto looks : {q.first, q.others})
      for (const NearLook& look : looks) {
        const bool some = (black_at(look) & edges[row]) != 0;
        met[static_cast<std::size_t>(row / 16)][i / 64] |= std::uint64_t{some} << (i % 64);
        ++i;
      }
  }
}

}  // namespace

void lay_out(const SideBySide& pieces, char* rows) {
  if (scalar_kernel_wanted()) return lay_out_scalar(pieces, rows);
  HWY_DYNAMIC_DISPATCH(lay_out_lanes)(pieces, rows);
}

unsigned candidates(const std::array<EdgeFamily, 3>& families, const char* rows, const VoxelStep& corner,
                    const std::array<EdgeRows, 3>& edges) {
  if (scalar_kernel_wanted()) return candidates_scalar(families, rows, corner, edges);
  return HWY_DYNAMIC_DISPATCH(candidates_lanes)(families, rows, corner, edges);
}

void look(const NearQuestion& question, EdgeRows edges, EdgeRows clear, NearMet& met) {
  if (scalar_kernel_wanted()) return look_scalar(question, edges, clear, met);
  HWY_DYNAMIC_DISPATCH(look_lanes)(question, edges, clear, met);
}

}  // namespace blackleaf::detail
#endif  // HWY_ONCE
