// Polygons into triangles, with none lost.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace blackleaf::detail {

/// Appends the corners.size() - 2 triangles of a polygon, by the vertices' numbers, in its orientation. Whatever the
/// polygon, the edges of the triangles add up to its own, so a closed surface stays closed and, where the polygon is
/// plane, the solid is the same; where it is simple as well, and seen along the axis its normal is nearest to, the
/// triangles do not overlap (up to rounding): a fan if one does it, else ears cut off one by one (Meisters 1975), those
/// of no area last. A polygon that crosses itself, and a concave one of more than 4096 corners, is made a fan. O(n) for
/// convex ones, O(n^2) typically for others. Requires: vertex numbers in range; fewer than three corners give nothing.
void append_polygon(std::span<const Eigen::Vector3d> vertices, std::span<const std::uint32_t> corners,
                    std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace blackleaf::detail
