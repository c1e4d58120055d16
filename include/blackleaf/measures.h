// Measures: what can be said of a solid in numbers.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "blackleaf/octree.h"

namespace blackleaf {

/// A box of voxels, [min, max) on every axis.
struct Box {
  std::array<std::int32_t, 3> min{}, max{};
  friend bool operator==(const Box&, const Box&) = default;
};

struct Measures {
  std::uint64_t black_leaves = 0, white_leaves = 0;
  std::uint64_t internal_nodes = 0;                  // I = (T - 1) / 8 with T all nodes (WA87, lemma)
  std::vector<std::uint64_t> black_leaves_by_level;  // index = level, depth + 1 entries
  std::uint64_t volume = 0;                          // black voxels
  std::uint64_t surface_area = 0;           // unit faces between black and white; outside the universe is white
  std::optional<Box> bounding_box;          // none for the empty solid
  std::optional<Eigen::Vector3d> centroid;  // in voxel coordinates; none for the empty solid
  std::uint64_t runs = 0;                   // maximal runs on the Millar curve
};

/// All measures, exact but for the last rounding of the centroid. O(words).
Measures measure(const Octree& octree);

/// Black voxels. O(words).
std::uint64_t volume(const Octree& octree);
/// The smallest box that holds all black voxels, or none. O(words), usually far less.
std::optional<Box> bounding_box(const Octree& octree);
/// The centre of mass in voxel coordinates, or none for the empty solid. O(words).
std::optional<Eigen::Vector3d> centroid(const Octree& octree);

/// Empty if every invariant of octree.h holds, else the first broken one in one line: node words refer to existing
/// children, no child is both black and gray, no gray node is of one colour, groups stand in curve order without gaps
/// or overlaps, nothing is stored that the root does not reach. O(words).
std::string validate(const Octree& octree);

}  // namespace blackleaf
