// Lattice symmetries: the 48 turns and reflections of a cube, done by relabelling octants alone.
//
// A turn by quarters about a coordinate axis, a reflection across a coordinate plane, and whatever they make together,
// takes nodes to nodes when it is done about the universe's centre: only octant labels change. So nothing is resampled
// and nothing is lost, no node is made that was not there, and the cost is that of copying the tree.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cassert>
#include <cstdint>
#include <optional>

#include "blackleaf/label_map.h"
#include "blackleaf/move.h"
#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// One of the 48 symmetries of the cube as a signed permutation of the axes: coordinate i of the image is coordinate
/// source(i) of the argument, negated where reversed(i). Axes are 0, 1, 2 for x, y, z. They form a group.
class LatticeSymmetry {
 public:
  /// The identity.
  constexpr LatticeSymmetry() = default;

  /// A turn by quarters of 90 degrees about an axis, right-handed; any number. Requires: 0 <= axis < 3.
  static constexpr LatticeSymmetry turn(int axis, int quarters) {
    assert(axis >= 0 && axis < 3);
    LatticeSymmetry quarter;
    const auto j = static_cast<std::size_t>((axis + 1) % 3), k = static_cast<std::size_t>((axis + 2) % 3);
    quarter.source_[j] = static_cast<std::uint8_t>(k);
    quarter.source_[k] = static_cast<std::uint8_t>(j);
    quarter.reversed_[j] = true;
    LatticeSymmetry result;
    for (int i = 0; i < (quarters % 4 + 4) % 4; ++i) result = quarter * result;
    return result;
  }
  /// The reflection that negates one axis. Requires: 0 <= axis < 3.
  static constexpr LatticeSymmetry reflection(int axis) {
    assert(axis >= 0 && axis < 3);
    LatticeSymmetry result;
    result.reversed_[static_cast<std::size_t>(axis)] = true;
    return result;
  }
  /// The symmetry with this matrix, if its entries are exactly those of a signed permutation.
  static std::optional<LatticeSymmetry> from(const Eigen::Matrix3d& matrix);
  /// All 48, the identity first.
  static const std::array<LatticeSymmetry, 48>& all();

  constexpr int source(int axis) const { return source_[static_cast<std::size_t>(axis)]; }
  constexpr bool reversed(int axis) const { return reversed_[static_cast<std::size_t>(axis)]; }
  Eigen::Matrix3d matrix() const;
  /// True iff the determinant is -1.
  constexpr bool is_reflection() const {
    const bool odd = (source_[0] != 0) + (source_[1] != 1) + (source_[2] != 2) == 2;  // one exchange
    return odd != (reversed_[0] != (reversed_[1] != reversed_[2]));
  }

  constexpr LatticeSymmetry inverse() const {
    LatticeSymmetry result;
    for (std::size_t i = 0; i < 3; ++i) {
      result.source_[source_[i]] = static_cast<std::uint8_t>(i);
      result.reversed_[source_[i]] = reversed_[i];
    }
    return result;
  }
  /// (second * first)(X) = second(first(X)).
  friend constexpr LatticeSymmetry operator*(const LatticeSymmetry& second, const LatticeSymmetry& first) {
    LatticeSymmetry result;
    for (std::size_t i = 0; i < 3; ++i) {
      result.source_[i] = first.source_[second.source_[i]];
      result.reversed_[i] = second.reversed_[i] != first.reversed_[second.source_[i]];
    }
    return result;
  }
  friend constexpr bool operator==(const LatticeSymmetry&, const LatticeSymmetry&) = default;

  /// Where an octant goes when its parent is turned about its centre.
  constexpr unsigned octant(unsigned label) const {
    unsigned image = 0;
    for (unsigned i = 0; i < 3; ++i) image |= ((label >> source_[i] & 1u) ^ (reversed_[i] ? 1u : 0u)) << i;
    return image;
  }

 private:
  std::array<std::uint8_t, 3> source_ = {0, 1, 2};
  std::array<bool, 3> reversed_{};
};

/// The solid turned or reflected about the universe's centre. The frame stays, as in every motion: the solid is turned
/// in the world too. O(words).
Octree transform(const Octree& octree, const LatticeSymmetry& symmetry, const Work& work = {});
/// The same about another point: X' = S (X - about) + about. Throws Error(bad_argument) unless that takes voxels to
/// voxels (`about` - S `about` is whole on every axis, as it is for voxel corners and centres), Error(out_of_universe)
/// as translate(). O(words of source and target).
Octree transform(const Octree& octree, const LatticeSymmetry& symmetry, const Eigen::Vector3d& about,
                 Leaving leaving = Leaving::error, const Work& work = {});

/// The same with all labels at once. O(runs * depth).
LabelMap transform(const LabelMap& map, const LatticeSymmetry& symmetry, const Work& work = {});
LabelMap transform(const LabelMap& map, const LatticeSymmetry& symmetry, const Eigen::Vector3d& about,
                   Leaving leaving = Leaving::error, const Work& work = {});

/// A solid or a label map turned by quarters of 90 degrees about the axis 0, 1 or 2 through the universe's centre,
/// right-handed.
template <class Solid>
Solid turn(const Solid& solid, int axis, int quarters = 1, const Work& work = {}) {
  return transform(solid, LatticeSymmetry::turn(axis, quarters), work);
}
/// Its mirror image along the axis 0, 1 or 2 about the universe's centre.
template <class Solid>
Solid reflect(const Solid& solid, int axis, const Work& work = {}) {
  return transform(solid, LatticeSymmetry::reflection(axis), work);
}

}  // namespace blackleaf
