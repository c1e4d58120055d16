// Octrees from silhouette images: the solid that a set of outlines, each seen from a known direction, allows (the
// octree generation that VA88's objects came from).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// What a viewer at infinity in direction `view` sees of an object, as a picture of two colours.
///
/// The picture's columns run along u = up x d normalised and its rows downward, against v = d x u, as in drawings
/// (drawing.h); its middle is the projection of the universe's centre. A pixel owns its left and its upper edge, not
/// the other two.
struct Silhouette {
  std::int32_t width = 0, height = 0;  // pixels
  std::vector<std::uint8_t> pixels;    // row by row from the top, each from the left; object where not zero
  /// Toward the viewer. Whole-number directions are kept exactly, others rounded once, as by View (drawing.h).
  Eigen::Vector3d view = {0, -1, 0};
  /// Upward in the picture as far as the picture's plane allows; none: +z, or +y when the view is parallel to z.
  /// Exact or rounded as `view` is.
  std::optional<Eigen::Vector3d> up = {};
  /// Side of a pixel in voxels, 2^-30 to 2^30, taken exactly; none: 2^depth / width, so that the picture is as wide as
  /// the universe.
  std::optional<double> pixel_size = {};
};

/// The octree of the largest solid with these silhouettes: a voxel is black iff its centre is seen in an object pixel
/// of every one; what lies beside a picture is not object. Decided exactly, in integers, also where the axes of a
/// picture have irrational lengths. A node is black where the hull of its voxel centres is seen inside every
/// silhouette, white where it is outside one, and split otherwise; summed-area tables answer for a rectangle of pixels
/// at a time. Throws Error(bad_argument) for a depth outside 1..20, no silhouettes, or one without pixels, with a
/// number of pixels other than width x height or 2^30 or more of them, a direction that is zero or not finite, an up
/// parallel to it, or a pixel size out of range; the message names the silhouette by its place, counted from 0.
/// O(pixels + gray nodes x silhouettes) time; 4 bytes a pixel and the octree.
Octree octree_from_silhouettes(const std::vector<Silhouette>& silhouettes, int depth, Frame frame = {},
                               const Work& work = {});

}  // namespace blackleaf
