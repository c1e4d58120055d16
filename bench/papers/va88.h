// VA88: J. Veenstra and N. Ahuja, "Line drawings of octree-represented objects", 1988, as printed.
//
// The octree is traversed front to back and each black leaf becomes a graphics node (BOX) at the end of a list; edges
// between coplanar neighbours ("cracks") are removed; every box is projected, and each of its edges is clipped against
// the projections of all boxes earlier in the list (sections 2.1 and 2.2): quadratic in the number of boxes. At last
// contiguous segments are joined (section 2.3).
//
// How a box is compared with one before it can be read in two ways. Section 2.2: "each edge of a projected octant is
// tested for intersection with projections of all other octants whose graphics nodes occur earlier in the list", by the
// bit codes of its ends; nothing else is said to come before that. But a BOX also stores the extremes of its projection
// (section 2.4), whose use is not told, and section 3.2 says that "extra processing is required at a node if its screen
// projection overlaps the screen projections of other nodes": both would do for a test of extents. Both readings are
// here; they draw the same, and both are quadratic.
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

enum class Comparing {
  every_edge,  // section 2.2 to the letter
  extents,     // edges only where the upright rectangles around the two projections overlap
};

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
Drawing draw(const Octree& octree, const Eigen::Vector3d& direction, Comparing comparing = Comparing::every_edge);

}  // namespace blackleaf::papers::va88
