// Entropy coding: symbols 0..15 with adaptive frequencies, by range asymmetric numeral systems.
//
// A model keeps where each symbol's share of 2^14 begins; after every symbol all of these move a fraction of the way
// towards what would have been best for it. Writer and reader run the same models, so nothing about them is stored.
// The coder itself is Duda's rANS (arXiv:1311.2540) with two states that take turns, so that a processor can work on
// two symbols at once, and 16 bits put out at a time.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#ifdef __SSE4_1__
#include <smmintrin.h>
#endif

#include "file/damage.h"

namespace blackleaf::detail {

inline constexpr int kShareBits = 14;
inline constexpr std::uint32_t kShares = 1u << kShareBits;
// What an update leaves to each other symbol in the long run: a symbol costs at least log2(1 / (1 - 15 * 8 / 2^14)),
// 0.01 bits, which bounds how much a file of given size can stand for.
inline constexpr int kLeftShare = 8;

namespace nibble {

/// kTargets[s][i]: where symbol i would begin if s had all shares but those left to the others.
inline constexpr auto kTargets = [] {
  std::array<std::array<std::int16_t, 16>, 16> targets{};
  for (int s = 0; s < 16; ++s)
    for (int i = 0; i < 16; ++i)
      targets[static_cast<std::size_t>(s)][static_cast<std::size_t>(i)] =
          static_cast<std::int16_t>(i <= s ? kLeftShare * i : static_cast<int>(kShares) - kLeftShare * (16 - i));
  return targets;
}();

/// kReciprocals[s] = floor(2^46 / s) + 1: for x < 2^18 s, x / s rounded down is x kReciprocals[s] / 2^46 rounded down.
/// The error x / 2^46 is below 1 / s since x s < 2^46, and the product is below 2^64 since s < 2^14.
inline constexpr auto kReciprocals = [] {
  std::array<std::uint64_t, kShares> reciprocals{};
  for (std::uint32_t s = 1; s < kShares; ++s) reciprocals[s] = (std::uint64_t{1} << 46) / s + 1;
  return reciprocals;
}();

}  // namespace nibble

/// The frequencies of 16 symbols.
struct alignas(16) NibbleModel {
  /// Where the share of each symbol begins; begins[0] is 0, and every share is at least 1.
  std::array<std::int16_t, 16> begins{};

  /// The model with these shares. Requires: each at least 1, their sum 2^14.
  static NibbleModel of(const std::array<int, 16>& shares) {
    NibbleModel model;
    int begin = 0;
    for (std::size_t i = 0; i < 16; ++i) {
      model.begins[i] = static_cast<std::int16_t>(begin);
      begin += shares[i];
    }
    return model;
  }

  std::uint32_t begin(unsigned symbol) const { return static_cast<std::uint32_t>(begins[symbol]); }
  std::uint32_t share(unsigned symbol) const {
    return static_cast<std::uint32_t>(begins[(symbol + 1) & 15] - begins[symbol]) & (kShares - 1);
  }

  // Moves every boundary 2^-rate of its way to the symbol's targets, rounded down. Shares stay positive: with R =
  // 2^rate a boundary b with target t becomes floor(((R - 1) b + t) / R); boundaries at least 1 apart whose targets are
  // at least 1 apart have numerators at least R apart.
#ifdef __SSE4_1__
  /// The symbol whose share holds `slot`.
  unsigned find(std::uint32_t slot) const {
    const __m128i key = _mm_set1_epi16(static_cast<short>(slot));
    const __m128i above = _mm_packs_epi16(_mm_cmpgt_epi16(load(0), key), _mm_cmpgt_epi16(load(8), key));
    // begins[0] = 0 is never above, so a bit below the first one above is there.
    const auto mask = static_cast<std::uint32_t>(_mm_movemask_epi8(above)) | 0x10000u;
    return static_cast<unsigned>(std::countr_zero(mask)) - 1;
  }
  void update(unsigned symbol, int rate) {
    for (std::size_t i = 0; i < 16; i += 8) {
      const __m128i now = load(i);
      const __m128i target = _mm_loadu_si128(reinterpret_cast<const __m128i*>(nibble::kTargets[symbol].data() + i));
      const __m128i moved = _mm_add_epi16(now, _mm_srai_epi16(_mm_sub_epi16(target, now), rate));
      _mm_store_si128(reinterpret_cast<__m128i*>(begins.data() + i), moved);
    }
  }

 private:
  __m128i load(std::size_t i) const { return _mm_load_si128(reinterpret_cast<const __m128i*>(begins.data() + i)); }
#else
  unsigned find(std::uint32_t slot) const {
    unsigned symbol = 15;
    while (begin(symbol) > slot) --symbol;
    return symbol;
  }
  void update(unsigned symbol, int rate) {
    for (std::size_t i = 0; i < 16; ++i) {
      const int now = begins[i], target = nibble::kTargets[symbol][i];
      begins[i] = static_cast<std::int16_t>(now + ((target - now) >> rate));  // floor, also of negative numbers
    }
  }
#endif
};

inline constexpr std::uint32_t kLowState = 1u << 16;  // states are at least this between symbols

/// Takes down symbols with their models' shares.
class NibbleTaker {
 public:
  /// Requires: there is room.
  [[gnu::always_inline]] unsigned symbol(NibbleModel& model, unsigned symbol, int rate) {
    *next_++ = model.begin(symbol) << 16 | model.share(symbol);
    model.update(symbol, rate);
    return symbol;
  }

 protected:
  std::uint32_t* next_ = nullptr;
};

/// Takes down symbols forwards; their bytes are made at the end, backwards.
class NibbleEncoder : public NibbleTaker {
 public:
  static constexpr bool kWrites = true;
  using InHand = NibbleTaker;  // a copy that a loop can keep in registers

  /// Room for so many more symbols.
  void make_room(std::size_t symbols) {
    if (static_cast<std::size_t>(end_ - next_) < symbols) grow(symbols);
  }
  void check() const {}

  std::vector<std::uint8_t> finish() const {
    const auto count = static_cast<std::size_t>(next_ - taken_.get());
    // A symbol puts out 16 bits at most.
    const auto bits = std::make_unique_for_overwrite<std::uint16_t[]>(count);
    std::uint16_t* const end = bits.get() + count;
    std::uint16_t* first = end;
    std::uint32_t odd = kLowState, even = kLowState;
    const auto put = [&](std::uint32_t& state, std::uint32_t taken) {
      const std::uint32_t begin = taken >> 16, share = taken & 0xFFFF;
      // The quotient below must fit in 32 - kShareBits bits.
      // A branch that is often guessed wrong, and yet faster than the longer way without it.
      if (state >> (32 - kShareBits) >= share) {
        *--first = static_cast<std::uint16_t>(state);
        state >>= 16;
      }
      const auto quotient = static_cast<std::uint32_t>(state * nibble::kReciprocals[share] >> 46);
      state = (quotient << kShareBits) + (state - quotient * share) + begin;
    };
    std::size_t i = count;
    if (i & 1) put(even, taken_[--i]);
    for (; i > 0; i -= 2) {
      put(odd, taken_[i - 1]);
      put(even, taken_[i - 2]);
    }
    const auto length = 2 * static_cast<std::size_t>(end - first);
    std::vector<std::uint8_t> bytes(8 + length);
    std::memcpy(bytes.data(), &even, 4);
    std::memcpy(bytes.data() + 4, &odd, 4);
    if (length) std::memcpy(bytes.data() + 8, first, length);
    return bytes;
  }

 private:
  [[gnu::noinline]] void grow(std::size_t symbols) {
    const auto used = static_cast<std::size_t>(next_ - taken_.get());
    const std::size_t room = 2 * used + symbols + 4000;
    auto more = std::make_unique_for_overwrite<std::uint32_t[]>(room);
    std::copy_n(taken_.get(), used, more.get());
    taken_ = std::move(more);
    next_ = taken_.get() + used;
    end_ = taken_.get() + room;
  }

  std::unique_ptr<std::uint32_t[]> taken_;
  std::uint32_t* end_ = nullptr;  // of the room
};

/// Gives the symbols back. It does not look for the end of the bytes at every symbol: check() does, and is called
/// before more than kPadding / 2 symbols have been read since the last time.
class NibbleDecoder {
 public:
  static constexpr bool kWrites = false;
  using InHand = NibbleDecoder;  // a copy that a loop can keep in registers
  /// Readable bytes behind the last one, whatever they are.
  static constexpr std::size_t kPadding = 64;

  NibbleDecoder() = default;
  /// Requires: kPadding more bytes can be read behind these, and all live as long as the decoder.
  explicit NibbleDecoder(std::span<const std::uint8_t> bytes) : next_(bytes.data()), end_(next_ + bytes.size()) {
    if (bytes.size() < 8 || bytes.size() % 2 != 0) throw Damage{"is too short"};
    std::memcpy(&state_, next_, 4);
    std::memcpy(&other_, next_ + 4, 4);
    next_ += 8;
    if (state_ < kLowState || other_ < kLowState) throw Damage{"begins with no state of its coder"};
  }

  [[gnu::always_inline]] unsigned symbol(NibbleModel& model, unsigned /*truth*/, int rate) {
    const std::uint32_t slot = state_ & (kShares - 1);
    const unsigned symbol = model.find(slot);
    std::uint32_t state = model.share(symbol) * (state_ >> kShareBits) + slot - model.begin(symbol);
    model.update(symbol, rate);
    // Without a branch, which nobody could predict.
    std::uint16_t more;
    std::memcpy(&more, next_, 2);
    const std::uint32_t low = state < kLowState;
    state = state << 16 * low | (more & (0 - low));
    next_ += 2 * low;
    state_ = other_;
    other_ = state;
    return symbol;
  }

  void make_room(std::size_t /*symbols*/) {}
  /// Throws Damage if more has been read than there is.
  void check() const {
    if (next_ > end_) throw Damage{"ends too early"};
  }

  /// Everything that was written has been read, and nothing else.
  void expect_end() const {
    if (next_ != end_) throw Damage{"goes on after its last node"};
    if (state_ != kLowState || other_ != kLowState) throw Damage{"does not end where its coder began"};
  }

 private:
  const std::uint8_t *next_ = nullptr, *end_ = nullptr;
  std::uint32_t state_ = 0, other_ = 0;
};

}  // namespace blackleaf::detail
