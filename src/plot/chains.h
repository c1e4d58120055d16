// Chains: lines that meet end to end, drawn without lifting the pen.
#pragma once

#include "blackleaf/picture.h"

namespace blackleaf::detail {

/// Ends of lines no farther apart than this (in x and in y, millimetres) are one point.
inline constexpr double kSamePoint = 1e-6;

inline bool same_point(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a - b).cwiseAbs().maxCoeff() <= kSamePoint;
}

/// The same lines in the fewest polylines: every connected set of lines is one graph whose edges are lines, cut into
/// Euler trails, one for two vertices of odd degree, or one closed trail if there are none. O(n log n) for n lines.
Polylines joined(const Polylines& lines);

}  // namespace blackleaf::detail
