// TextBuffer: text that grows by small pieces and by numbers with a fixed number of decimals, faster than the disk.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace blackleaf::detail {

class TextBuffer {
 public:
  explicit TextBuffer(std::size_t expected = 0) { text_.resize(expected + kSpare); }

  void put(std::string_view piece) {
    reserve(piece.size());
    std::memcpy(text_.data() + used_, piece.data(), piece.size());
    used_ += piece.size();
  }
  void put(char character) {
    reserve(1);
    text_[used_++] = character;
  }
  void put_integer(std::int64_t value) {
    reserve(kLongestNumber);
    char* const begin = text_.data() + used_;
    used_ += static_cast<std::size_t>(std::to_chars(begin, begin + kLongestNumber, value).ptr - begin);
  }
  /// The shortest text that gives the same double back; 0 for -0. Requires: finite.
  void put_exact(double value) {
    reserve(kLongestNumber);
    char* const begin = text_.data() + used_;
    used_ += static_cast<std::size_t>(std::to_chars(begin, begin + kLongestNumber, value + 0).ptr - begin);
  }
  /// Rounded to at most four decimals, halves away from zero; no trailing zeros and no "-0".
  /// Requires: |value| < 1e14.
  void put_decimal(double value) {
    // 19 digits, a sign and a point.
    reserve(kLongestNumber);
    char* at = text_.data() + used_;
    const auto ticks = static_cast<std::int64_t>(value * kTicks + (value < 0 ? -0.5 : 0.5));
    if (ticks < 0) *at++ = '-';
    const auto size = static_cast<std::uint64_t>(ticks < 0 ? -ticks : ticks);
    const std::uint64_t whole = size / kTicks;
    if (whole < 1000) {
      at = put_small(at, static_cast<std::uint32_t>(whole));
    } else {
      at = std::to_chars(at, at + kLongestNumber, whole).ptr;
    }
    if (const auto rest = static_cast<std::uint32_t>(size % kTicks); rest != 0) {
      *at = '.';
      std::memcpy(at + 1, kPairs.data() + 2 * (rest / 100), 2);
      std::memcpy(at + 3, kPairs.data() + 2 * (rest % 100), 2);
      at += 5;
      while (at[-1] == '0') --at;
    }
    used_ = static_cast<std::size_t>(at - text_.data());
  }

  std::size_t size() const { return used_; }
  /// The text; leaves the buffer empty.
  std::string take() {
    text_.resize(used_);
    used_ = 0;
    return std::move(text_);
  }

 private:
  static constexpr std::uint64_t kTicks = 10000;
  static constexpr std::size_t kLongestNumber = 32;
  static constexpr std::size_t kSpare = 256;
  // "00" "01" ... "99".
  static constexpr std::array<char, 200> kPairs = [] {
    std::array<char, 200> pairs{};
    for (std::size_t i = 0; i < 100; ++i) {
      pairs[2 * i] = static_cast<char>('0' + i / 10);
      pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
    }
    return pairs;
  }();

  static char* put_small(char* at, std::uint32_t below_1000) {
    if (below_1000 >= 100) *at++ = static_cast<char>('0' + below_1000 / 100);
    const std::uint32_t rest = below_1000 % 100;
    if (below_1000 >= 10) *at++ = kPairs[2 * rest];
    *at++ = kPairs[2 * rest + 1];
    return at;
  }
  void reserve(std::size_t more) {
    if (used_ + more > text_.size()) text_.resize(2 * (used_ + more) + kSpare);
  }

  std::string text_;
  std::size_t used_ = 0;
};

}  // namespace blackleaf::detail
