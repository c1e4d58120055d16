// The slow readable twin of exact interference: every black leaf of one solid against every one of the other, along all
// axes along which two boxes can be apart, in integers of 256 bits.
//
// It stands in b's frame: a's cubes are moved there by X -> A X + b (FixedMotion), their corners are projected one by
// one, and normals are cross products of edges. The product does it in a's frame, from bounds of projections.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blackleaf/leaves.h"
#include "blackleaf/motion.h"
#include "blackleaf/octree.h"

namespace blackleaf::reference {

/// An integer modulo 2^256, read as one of -2^255 to 2^255 - 1.
class Big {
 public:
  Big(std::int64_t value = 0) {  // NOLINT(google-explicit-constructor)
    limbs_.fill(value < 0 ? 0xFFFF'FFFFU : 0);
    limbs_[0] = static_cast<std::uint32_t>(value);
    limbs_[1] = static_cast<std::uint32_t>(value >> 32);
  }
  friend Big operator+(const Big& a, const Big& b) {
    Big sum;
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < kLimbs; ++i) {
      carry += std::uint64_t{a.limbs_[i]} + b.limbs_[i];
      sum.limbs_[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    return sum;
  }
  friend Big operator*(const Big& a, const Big& b) {
    Big product;
    for (std::size_t i = 0; i < kLimbs; ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; i + j < kLimbs; ++j) {
        carry += std::uint64_t{a.limbs_[i]} * b.limbs_[j] + product.limbs_[i + j];
        product.limbs_[i + j] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
      }
    }
    return product;
  }
  friend Big operator-(const Big& a, const Big& b) { return a + b * Big(-1); }
  friend bool operator==(const Big&, const Big&) = default;
  friend bool operator<(const Big& a, const Big& b) { return ((a - b).limbs_[kLimbs - 1] >> 31) != 0; }

 private:
  static constexpr std::size_t kLimbs = 8;
  std::array<std::uint32_t, kLimbs> limbs_{};
};

using BigVector = std::array<Big, 3>;

inline BigVector cross(const BigVector& a, const BigVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// What a cube covers along every axis.
using Shadows = std::vector<std::array<Big, 2>>;

inline Shadows shadows(const std::array<BigVector, 8>& corners, const std::vector<BigVector>& axes) {
  Shadows result;
  for (const BigVector& axis : axes) {
    std::array<Big, 2> range;
    for (std::size_t i = 0; i < 8; ++i) {
      const Big at = corners[i][0] * axis[0] + corners[i][1] * axis[1] + corners[i][2] * axis[2];
      if (i == 0 || at < range[0]) range[0] = at;
      if (i == 0 || range[1] < at) range[1] = at;
    }
    result.push_back(range);
  }
  return result;
}

inline bool interiors_meet(const Shadows& a, const Shadows& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(b[i][0] < a[i][1] && a[i][0] < b[i][1])) return false;
  return true;
}

/// Do the interiors of a and of b, moved, share a point?
inline bool interfere_exactly(const Octree& a, const Octree& b, const FixedMotion& motion) {
  std::array<BigVector, 3> edges_a, edges_b;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      edges_a[i][j] = Big(motion.inverse_rotation[j][i]);
      edges_b[i][j] = Big(i == j ? 1 : 0);
    }
  std::vector<BigVector> axes(edges_b.begin(), edges_b.end());
  for (std::size_t i = 0; i < 3; ++i) axes.push_back(cross(edges_a[(i + 1) % 3], edges_a[(i + 2) % 3]));
  for (const BigVector& p : edges_a)
    for (const BigVector& q : edges_b)
      if (const BigVector axis = cross(p, q); axis != BigVector{}) axes.push_back(axis);

  const auto all_shadows = [&](const Octree& octree, const auto& placed) {
    std::vector<Shadows> result;
    for_each_black_leaf(octree, [&](const Leaf& leaf) {
      std::array<BigVector, 8> corners;
      for (std::size_t i = 0; i < 8; ++i)
        corners[i] = placed(std::array{leaf.cube.x + (i & 1 ? leaf.cube.side() : 0),
                                       leaf.cube.y + (i & 2 ? leaf.cube.side() : 0),
                                       leaf.cube.z + (i & 4 ? leaf.cube.side() : 0)});
      result.push_back(shadows(corners, axes));
    });
    return result;
  };
  const auto in_a = all_shadows(a, [&](const std::array<std::int32_t, 3>& x) {
    BigVector moved;
    for (std::size_t j = 0; j < 3; ++j) {
      moved[j] = Big(motion.inverse_translation[j]);
      for (std::size_t i = 0; i < 3; ++i) moved[j] = moved[j] + edges_a[i][j] * Big(x[i]);
    }
    return moved;
  });
  const auto in_b = all_shadows(b, [&](const std::array<std::int32_t, 3>& x) {
    BigVector scaled;
    for (std::size_t j = 0; j < 3; ++j) scaled[j] = Big(std::int64_t{x[j]} << FixedMotion::kFractionBits);
    return scaled;
  });
  for (const Shadows& p : in_a)
    for (const Shadows& q : in_b)
      if (interiors_meet(p, q)) return true;
  return false;
}

}  // namespace blackleaf::reference
