// How fast a generalised winding number changes: a matter of the rims of its holes alone.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "caps.h"
#include "grid_mesh.h"

namespace blackleaf::detail {

using Place = std::array<double, 3>;  // voxels

/// Away from its surface the generalised winding number is smooth, and so is that of its caps up to integers, with one
/// gradient but for the sign: the integral of dl x r / |r|^3 along the rims, r from the place to the rim, over 4 pi
/// (the law of Biot and Savart; the solid angle of a current loop is its magnetic potential). A piece of length L at a
/// distance d thus adds at most L / d^2, and a straight one at most 2 / d; a whole loop whose caps have the area A also
/// at most 2 A / d^3. The rims are kept in a hierarchy of balls: loops, then pieces of loops.
class RimField {
 public:
  RimField(const GridMesh& mesh, const Caps& caps);

  /// An upper bound of the size of the gradient, per voxel, within h voxels of a place; infinite if above `limit`.
  double slope(const Place& p, double h, double limit) const;

 private:
  struct Edge {
    Place a, b;
  };
  struct Ball {
    Place centre{};
    double radius = 0, length = 0;
    double area = 0;           // of the caps, if it is made of whole loops; else infinite
    std::uint32_t edge = 0;    // if it has no children
    std::uint32_t second = 0;  // its children are the next ball and this one; 0: none
  };

  class Builder;

  std::vector<Edge> edges_;
  std::vector<Ball> balls_;  // parents first, each followed by its first child
};

}  // namespace blackleaf::detail
