// VA88: J. Veenstra and N. Ahuja, "Line drawings of octree-represented objects", 1988, as printed.
//
// The octree is traversed front to back and each black leaf becomes a graphics node (BOX) at the end of a list; edges
// between coplanar neighbours ("cracks") are removed; every box is projected, and each of its edges is clipped against
// the projections of all boxes earlier in the list (sections 2.1 and 2.2): quadratic in the number of boxes. At last
// contiguous segments are joined (section 2.3).
//
// Where the paper is silent: neighbours are found by descent from the root instead of by threads; a view along an axis
// or in a coordinate plane projects cubes to rectangles, and a line of sight within the plane of two faces that touch
// is blocked there. Segments are joined wherever they meet in the picture, not only in neighbouring octants.
//
// This is the paper's own algorithm in floating point, kept as a second witness and as a baseline. The product does not
// use it, and it does not use the product's drawing.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blackleaf/octree.h"

namespace blackleaf::papers::va88 {

struct Segment {
  Eigen::Vector2d from, to;
};

struct Drawing {
  std::vector<Segment> segments;     // joined, on the screen of blackleaf::View: u to the right, v upward, voxels
  std::size_t graphics_nodes = 0;    // boxes: black leaves that are not surrounded on six sides
  std::uint64_t comparisons = 0;     // boxes against boxes earlier in the list
  std::uint64_t edge_clippings = 0;  // edge segments against projections that they may meet
  double length() const;
};

/// The drawing seen from `direction`, toward the viewer. Requires: direction is finite and not zero.
/// O(boxes^2) time, at most one box a black leaf.
Drawing draw(const Octree& octree, const Eigen::Vector3d& direction);

}  // namespace blackleaf::papers::va88
