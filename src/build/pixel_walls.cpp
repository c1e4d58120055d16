#include "pixel_walls.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace blackleaf::detail {
namespace {

__extension__ using UnsignedWide = unsigned __int128;

// A natural number below 2^512, enough for the squares that walls are found by: (t part 2^83)^2 with t < 2^97 and
// part < 2^31 is below 2^422; (a whole 2^30)^2 |A|^2 with a < 2^32, whole < 2^53 and |A|^2 < 2^125 is below 2^355.
class Natural {
 public:
  Natural(UnsignedWide value) {  // NOLINT(google-explicit-constructor): numbers are numbers
    for (; value != 0; value >>= 32) limbs_[size_++] = static_cast<std::uint32_t>(value);
  }
  friend Natural operator*(const Natural& a, const Natural& b) {
    Natural product(0);
    product.size_ = a.size_ + b.size_;
    assert(product.size_ <= kLimbs);
    for (std::size_t i = 0; i < a.size_; ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; j < b.size_; ++j) {
        carry += std::uint64_t{a.limbs_[i]} * b.limbs_[j] + product.limbs_[i + j];
        product.limbs_[i + j] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
      }
      product.limbs_[i + b.size_] = static_cast<std::uint32_t>(carry);
    }
    while (product.size_ > 0 && product.limbs_[product.size_ - 1] == 0) --product.size_;
    return product;
  }
  friend bool operator<=(const Natural& a, const Natural& b) {
    if (a.size_ != b.size_) return a.size_ < b.size_;
    for (std::size_t i = a.size_; i-- > 0;)
      if (a.limbs_[i] != b.limbs_[i]) return a.limbs_[i] < b.limbs_[i];
    return true;
  }
  static Natural power_of_two(int exponent) {
    Natural power(1);
    for (; exponent > 0; exponent -= 64) power = power * Natural(UnsignedWide{1} << std::min(exponent, 64));
    return power;
  }

 private:
  static constexpr std::size_t kLimbs = 16;
  std::array<std::uint32_t, kLimbs> limbs_{};
  std::size_t size_ = 0;  // limbs up to the highest that is not zero
};

// The walls of one axis: t >= a s |A| is decided by comparing (t p)^2 with (a w)^2 |A|^2, s = w / p.
class Wall {
 public:
  Wall(UnsignedWide squared_length, const PixelSize& size)
      : factor_(Natural(size.whole) * Natural::power_of_two(std::max(size.exponent, 0))),
        factor_squared_(factor_ * factor_ * Natural(squared_length)),
        part_(Natural(size.part) * Natural::power_of_two(std::max(-size.exponent, 0))),
        part_squared_(part_ * part_),
        estimate_(static_cast<long double>(size.whole) / static_cast<long double>(size.part) *
                  std::ldexp(1.0L, size.exponent) * std::sqrt(static_cast<long double>(squared_length))) {}

  // The smallest integer that is not less than a s |A|, or one that is as good for comparing with what is at most 2^84.
  Wide at(std::int64_t a) const {
    constexpr Wide kBeyond = Wide{1} << 96;
    const long double near = static_cast<long double>(a) * estimate_;
    if (near >= 0x1p95L) return kBeyond;
    if (near <= -0x1p95L) return -kBeyond;
    const UnsignedWide size = static_cast<UnsignedWide>(a < 0 ? -a : a);
    const Natural target = Natural(size * size) * factor_squared_;
    // (t p)^2 against (a w)^2 |A|^2
    const auto reached = [&](Wide t) {
      if (t >= 0 && a <= 0) return true;
      if (t < 0 && a >= 0) return false;
      const UnsignedWide magnitude = static_cast<UnsignedWide>(t < 0 ? -t : t);
      const Natural square = Natural(magnitude) * Natural(magnitude) * part_squared_;
      return t < 0 ? square <= target : target <= square;
    };
    // The estimate has 50 good bits even where long double is no longer than double.
    const long double error = std::abs(near) * 0x1p-48L + 2;
    Wide low = static_cast<Wide>(std::floor(near - error)), high = static_cast<Wide>(std::ceil(near + error));
    assert(!reached(low) && reached(high));
    while (high - low > 1) {
      const Wide middle = low + (high - low) / 2;
      (reached(middle) ? high : low) = middle;
    }
    return high;
  }

 private:
  Natural factor_, factor_squared_, part_, part_squared_;
  long double estimate_;
};

}  // namespace

PixelSize PixelSize::of(double size) {
  assert(size >= 0x1p-30 && size <= 0x1p30);
  constexpr int kDigits = std::numeric_limits<double>::digits;
  PixelSize exact;
  exact.whole = static_cast<std::uint64_t>(std::ldexp(std::frexp(size, &exact.exponent), kDigits));
  exact.exponent -= kDigits;
  while (exact.whole % 2 == 0) {
    exact.whole /= 2;
    ++exact.exponent;
  }
  return exact;
}

double PixelSize::value() const { return std::ldexp(static_cast<double>(whole) / static_cast<double>(part), exponent); }

PixelWalls::PixelWalls(const std::array<std::int64_t, 3>& axis, std::int32_t count, const PixelSize& size)
    : axis_(axis), count_(count) {
  UnsignedWide squared_length = 0;
  for (const std::int64_t a : axis) squared_length += static_cast<UnsignedWide>(Wide{a} * a);
  assert(squared_length > 0 && squared_length >> 125 == 0 && count >= 1);
  scale_ = 0.5 / (std::sqrt(static_cast<double>(squared_length)) * size.value());
  middle_ = 0.5 * count;
  last_ = count - 1;
  walls_.reserve(static_cast<std::size_t>(count) + 1);
  const Wall wall(squared_length, size);
  for (std::int64_t k = 0; k <= count; ++k) walls_.push_back(wall.at(2 * k - count));
}

}  // namespace blackleaf::detail
