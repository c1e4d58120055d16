#include "near_kernel.h"

#include <array>
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

// As many rows at once as there are lanes: a block. Looks are gone through for several blocks at a time.
template <bool kInPlane>
class Looking {
 public:
  explicit Looking(const NearQuestion& question) : q_(question) {}

  void run(std::uint32_t* clear, std::uint32_t* partly, NearMet& met) {
    find_edges();
    keep_unhidden();
    sort_out(clear, partly);
    find_met(partly, met);
  }

 private:
  using D = hn::CappedTag<std::uint32_t, 16>;
  using V = hn::Vec<D>;
  static constexpr std::size_t kMostBlocks = 256 / HWY_MIN(16, HWY_LANES(std::uint32_t));

  V voxels(std::size_t place, const VoxelStep& step) const {
    const char* const from =
        q_.rows + VoxelStep::to({0, static_cast<int>(place % 16), static_cast<int>(place / 16)}).bytes;
    return hn::ShiftRightSame(hn::LoadU(d_, reinterpret_cast<const std::uint32_t*>(from + step.bytes)), step.bits);
  }
  V black(std::size_t place, const NearLook& look) const {
    V black = voxels(place, look.step);
    if constexpr (kInPlane) black = hn::And(black, voxels(place, look.step + q_.beside_b));
    return black;
  }
  bool none(const V& v) const { return hn::AllTrue(d_, hn::Eq(v, hn::Zero(d_))); }
  V edges(std::size_t i) const { return hn::LoadU(d_, edges_.data() + i * hn::Lanes(d_)); }
  // The next block that stays.
  void keep(std::size_t& count, std::size_t place, const V& edges) {
    places_[count] = place;
    hn::StoreU(edges, d_, edges_.data() + count * hn::Lanes(d_));
    ++count;
  }

  // Those that may be visible at all.
  void find_edges() {
    const VoxelStep b = q_.corner + q_.beside_b, c = q_.corner + q_.beside_c, bc = b + q_.beside_c;
    // The voxels that rays enter first.
    const EdgeFamily& f = q_.family;
    const bool up_b = f.d_b > 0, up_c = f.d_c > 0;
    const VoxelStep entered = kInPlane ? (up_c ? q_.corner : c) : up_b ? (up_c ? q_.corner : c) : (up_c ? b : bc);
    const V of_corners = hn::Set(d_, 0xFFFF);
    for (std::size_t place = 0; place < 256; place += hn::Lanes(d_)) {
      const V at = voxels(place, q_.corner), at_b = voxels(place, b), at_c = voxels(place, c),
              at_bc = voxels(place, bc);
      const V feature =
          hn::And(hn::Or(hn::Xor(at, at_b), hn::Xor(at_c, at_bc)), hn::Or(hn::Xor(at, at_c), hn::Xor(at_b, at_bc)));
      V blocked = voxels(place, entered);
      if constexpr (kInPlane) blocked = hn::Or(blocked, voxels(place, entered + q_.beside_b));
      const V edges = hn::AndNot(blocked, hn::And(feature, of_corners));
      if (!none(edges)) keep(count_, place, edges);
    }
  }

  // Takes away those that the first looks hide; touched_ are those for which they meet anything.
  void keep_unhidden() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; i += 2) {
      const std::size_t one = places_[i], other = i + 1 < count_ ? places_[i + 1] : one;
      V touched = hn::Zero(d_), hidden = touched, last = touched, touched2 = touched, hidden2 = touched,
        last2 = touched;
      for (const NearLook& look : q_.first) {
        const V here = black(one, look), here2 = black(other, look);
        touched = hn::Or(touched, here), touched2 = hn::Or(touched2, here2);
        if (look.alone) hidden = hn::Or(hidden, here), hidden2 = hn::Or(hidden2, here2);
        if (look.with_last) {
          hidden = hn::Or(hidden, hn::And(here, last));
          hidden2 = hn::Or(hidden2, hn::And(here2, last2));
        }
        last = here, last2 = here2;
      }
      const auto keep_rest = [&](std::size_t k, const V& touched_k, const V& hidden_k) {
        const V left = hn::AndNot(hidden_k, edges(k));
        if (none(left)) return;
        hn::StoreU(touched_k, d_, touched_.data() + kept * hn::Lanes(d_));
        keep(kept, places_[k], left);
      };
      const bool two = i + 1 < count_;
      keep_rest(i, touched, hidden);  // takes a place up to the i-th
      if (two) keep_rest(i + 1, touched2, hidden2);
    }
    count_ = kept;
  }

  void sort_out(std::uint32_t* clear, std::uint32_t* partly) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; i += 4) {
      std::array<std::size_t, 4> at;
      for (std::size_t k = 0; k < 4; ++k) at[k] = places_[i + k < count_ ? i + k : i];
      V m0 = hn::Zero(d_), m1 = m0, m2 = m0, m3 = m0;
      for (const NearLook& look : q_.others) {
        m0 = hn::Or(m0, black(at[0], look)), m1 = hn::Or(m1, black(at[1], look));
        m2 = hn::Or(m2, black(at[2], look)), m3 = hn::Or(m3, black(at[3], look));
      }
      const auto tell = [&](std::size_t k, const V& met) {
        if (i + k >= count_) return;
        const V all = edges(i + k), touched = hn::Or(met, hn::LoadU(d_, touched_.data() + (i + k) * hn::Lanes(d_)));
        hn::StoreU(hn::AndNot(touched, all), d_, clear + at[k]);
        const V parts = hn::And(touched, all);
        if (none(parts)) return;
        hn::StoreU(parts, d_, partly + at[k]);
        places_[kept++] = at[k];
      };
      tell(0, m0), tell(1, m1), tell(2, m2), tell(3, m3);
    }
    count_ = kept;
  }

  // For the layers that have partly clear edges.
  void find_met(const std::uint32_t* partly, NearMet& met) const {
    met = {};
    for (std::size_t i = 0; i < count_; i += 2) {
      const std::size_t one = places_[i], other = places_[i + 1 < count_ ? i + 1 : i];
      const V parts = hn::LoadU(d_, partly + one), parts2 = hn::LoadU(d_, partly + other);
      std::size_t bit = 0;
      for (const auto looks : {q_.first, q_.others})
        for (const NearLook& look : looks) {
          const std::uint64_t mask = std::uint64_t{1} << (bit % 64);
          if (!none(hn::And(black(one, look), parts))) met[one / 16][bit / 64] |= mask;
          if (!none(hn::And(black(other, look), parts2))) met[other / 16][bit / 64] |= mask;
          ++bit;
        }
    }
  }

  const D d_{};
  const NearQuestion& q_;
  // Blocks: their first rows, edges, and those of them that the first looks touch.
  std::size_t count_ = 0;
  std::array<std::size_t, kMostBlocks> places_;
  std::array<std::uint32_t, 256> edges_, touched_;
};

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
  if (q.family.mode == EdgeFamily::Mode::in_plane)
    Looking<true>(q).run(clear, partly, met);
  else
    Looking<false>(q).run(clear, partly, met);
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
