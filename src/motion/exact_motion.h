// ExactMotion: a motion's 106 bits as numbers to compute with.
#pragma once

#include <array>
#include <cstddef>

#include "blackleaf/motion.h"
#include "octree/double_double.h"

namespace blackleaf::detail {

using ExactVector = std::array<DoubleDouble, 3>;
using ExactMatrix = std::array<ExactVector, 3>;  // rows

inline DoubleDouble dot(const ExactVector& a, const ExactVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline ExactMatrix transposed(const ExactMatrix& m) {
  ExactMatrix result;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) result[i][j] = m[j][i];
  return result;
}

inline ExactMatrix operator*(const ExactMatrix& a, const ExactMatrix& b) {
  const ExactMatrix columns = transposed(b);
  ExactMatrix result;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) result[i][j] = dot(a[i], columns[j]);
  return result;
}

inline ExactVector operator*(const ExactMatrix& a, const ExactVector& x) {
  return {dot(a[0], x), dot(a[1], x), dot(a[2], x)};
}

inline ExactVector operator+(const ExactVector& a, const ExactVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

inline ExactVector operator-(const ExactVector& a) { return {-a[0], -a[1], -a[2]}; }

struct ExactMotion {
  ExactMatrix rotation;
  ExactVector translation;

  static ExactMotion of(const Motion& motion);
  /// Throws Error(bad_argument) for entries that are not finite. Requires: `rotation` is one to 106 bits.
  Motion motion() const;
};

/// One Newton step toward the nearest orthogonal matrix: a deviation d becomes about d^2.
ExactMatrix orthonormalised(const ExactMatrix& rotation);

}  // namespace blackleaf::detail
