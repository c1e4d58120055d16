// Labels in vectors: the inner loops of LabelBlocks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "octree/brick.h"

namespace blackleaf::detail {

/// Sixteen bytes of a row of labels: kBricks bricks, four labels wide each.
template <class L>
class LabelVector {
 public:
  static constexpr std::int64_t kBricks = 4 / sizeof(L);

  explicit LabelVector(const L* labels) { std::memcpy(&lanes_, labels, sizeof lanes_); }

  /// Zero in the bricks whose four labels are equal: each is compared with the next, the last with the first.
  LabelVector neighbours() const {
#if defined(__clang__)  // which has no shuffle by a vector, and finds the instruction by itself
    Lanes next{};
    for (std::size_t i = 0; i < 16 / sizeof(L); ++i) next[i] = lanes_[(i & ~std::size_t{3}) | ((i + 1) & 3)];
#else
    const Lanes next = __builtin_shuffle(lanes_, kTurned);
#endif
    return LabelVector(lanes_ ^ next);
  }
  /// Sets bits where two vectors differ.
  void mark(const LabelVector& a, const LabelVector& b) { lanes_ |= a.lanes_ ^ b.lanes_; }
  /// True iff the four of a brick are zero.
  bool is_zero(std::int64_t brick) const {
    std::array<std::uint32_t, sizeof(L)> words;
    std::memcpy(words.data(), &reinterpret_cast<const char*>(&lanes_)[static_cast<std::size_t>(brick) * sizeof words],
                sizeof words);
    std::uint32_t any = 0;
    for (const std::uint32_t word : words) any |= word;
    return any == 0;
  }

 private:
  using Lanes [[gnu::vector_size(16)]] = L;
  explicit LabelVector(Lanes lanes) : lanes_(lanes) {}

  static constexpr Lanes turned() {
    Lanes order{};
    for (std::size_t i = 0; i < 16 / sizeof(L); ++i) order[i] = static_cast<L>((i & ~std::size_t{3}) | ((i + 1) & 3));
    return order;
  }
  static inline const Lanes kTurned = turned();

  Lanes lanes_;
};

/// kCurveRow[table][i]: where the i-th voxel that the Millar curve visits in a brick stands among the brick's values in
/// rows: x + 4 y + 16 z.
inline constexpr auto kCurveRow = [] {
  std::array<std::array<std::uint8_t, 64>, 24> order{};
  for (std::size_t table = 0; table < 24; ++table)
    for (std::size_t i = 0; i < 64; ++i) {
      const unsigned bit = kBrickOrder[table][i];
      order[table][i] = static_cast<std::uint8_t>(brick_x(bit) + 4 * brick_y(bit) + 16 * brick_z(bit));
    }
  return order;
}();
/// The same for the octants of the brick's first eight voxels.
inline constexpr std::array<std::uint8_t, 8> kOctantRow = {0, 1, 4, 5, 16, 17, 20, 21};

/// The 64 labels of a brick in curve order.
template <class L>
class CurveOrder {
 public:
  CurveOrder(const L* values, std::uint8_t table) {
    const auto& order = kCurveRow[table];
    for (std::size_t i = 0; i < 64; ++i) labels_[i + 1] = values[order[i]];
    labels_[0] = labels_[1];
  }

  L operator[](std::size_t i) const { return labels_[i + 1]; }

  /// Bit i: label i differs from the one before it; bit 0 is 0.
  std::uint64_t borders() const {
#ifdef __SSE2__
    std::uint64_t same = 0;
    for (std::size_t i = 0; i < 64; i += 16) same |= std::uint64_t{equal16(&labels_[i], &labels_[i + 1])} << i;
    return ~same;
#else
    std::uint64_t borders = 0;
    for (std::size_t i = 0; i < 64; ++i) borders |= std::uint64_t{labels_[i] != labels_[i + 1]} << i;
    return borders;
#endif
  }

 private:
#ifdef __SSE2__
  static __m128i load(const L* labels) {
    __m128i vector;
    std::memcpy(&vector, labels, sizeof vector);
    return vector;
  }
  static __m128i equal(const L* a, const L* b) {
    if constexpr (sizeof(L) == 1)
      return _mm_cmpeq_epi8(load(a), load(b));
    else if constexpr (sizeof(L) == 2)
      return _mm_cmpeq_epi16(load(a), load(b));
    else
      return _mm_cmpeq_epi32(load(a), load(b));
  }
  // All ones or zero in each lane: signed saturation keeps both.
  static std::uint32_t equal16(const L* a, const L* b) {
    __m128i all;
    if constexpr (sizeof(L) == 1)
      all = equal(a, b);
    else if constexpr (sizeof(L) == 2)
      all = _mm_packs_epi16(equal(a, b), equal(a + 8, b + 8));
    else
      all = _mm_packs_epi16(_mm_packs_epi32(equal(a, b), equal(a + 4, b + 4)),
                            _mm_packs_epi32(equal(a + 8, b + 8), equal(a + 12, b + 12)));
    return static_cast<std::uint32_t>(_mm_movemask_epi8(all));
  }
#endif

  std::array<L, 65> labels_;
};

}  // namespace blackleaf::detail
