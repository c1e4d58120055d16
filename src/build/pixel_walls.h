// PixelWalls: which row or column of a picture a point is seen in, decided in integers.
//
// Points are given by q = 2p - 2^n (1,1,1), twice their distance from the universe's centre; for voxel centres p that
// is a vector of odd integers. Along a picture's axis with integer components A (a column's direction, or a row's,
// whose length may be irrational), with pixels of side s voxels, count of them, the point is in pixel k or beyond iff
//
//     A.q / (2 |A| s) + count / 2 >= k,   that is,   A.q >= (2k - count) s |A|.
//
// A.q is an integer, so it can be compared with the right side rounded up: the *wall* of pixel k. The walls of all
// pixels are worked out once, exactly; after that every question is a comparison of integers.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace blackleaf::detail {

__extension__ using Wide = __int128;

/// A positive fraction: whole / part * 2^exponent.
struct PixelSize {
  std::uint64_t whole = 1, part = 1;  // whole < 2^53, part < 2^31
  int exponent = 0;                   // -83 to 30

  /// The value of a double exactly. Requires: 2^-30 <= size <= 2^30.
  static PixelSize of(double size);
  double value() const;
};

class PixelWalls {
 public:
  /// Requires: axis is not zero and at most 2^62.5 long; 1 <= count < 2^31.
  PixelWalls(const std::array<std::int64_t, 3>& axis, std::int32_t count, const PixelSize& size);

  /// The pixel in which points with A.q = `place` are seen: -1 for all places before the first, count for those behind
  /// the last. O(1).
  std::int32_t pixel(Wide place) const {
    const double near = static_cast<double>(place) * scale_ + middle_;
    std::int32_t k = near <= 0 ? 0 : near >= last_ ? count_ - 1 : static_cast<std::int32_t>(near);
    // The estimate is off by one at most.
    while (k >= 0 && place < walls_[static_cast<std::size_t>(k)]) --k;
    while (k < count_ && place >= walls_[static_cast<std::size_t>(k) + 1]) ++k;
    return k;
  }
  /// A.q. At most 2^84 in size for q in a universe.
  Wide place(const std::array<std::int32_t, 3>& q) const {
    return Wide{axis_[0]} * q[0] + Wide{axis_[1]} * q[1] + Wide{axis_[2]} * q[2];
  }
  const std::array<std::int64_t, 3>& axis() const { return axis_; }
  std::int32_t count() const { return count_; }

 private:
  std::array<std::int64_t, 3> axis_;
  std::int32_t count_;
  double scale_, middle_, last_;
  std::vector<Wide> walls_;  // of pixels 0 to count
};

}  // namespace blackleaf::detail
