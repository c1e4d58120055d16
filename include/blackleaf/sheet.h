// Engineering sheets: front, top and side views and an isometric one on a framed page with a title block.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "blackleaf/picture.h"

namespace blackleaf {

/// Where views stand (ISO 5456-2). Third angle: the top view above the front view, the view from the right to its
/// right. First angle: the top view below, the view from the left to the right.
enum class ProjectionAngle { first, third };

/// The directions toward the viewer of a sheet's views: front (0,-1,0), top (0,0,1), side (1,0,0) or, in the first
/// angle,
/// (-1,0,0), and isometric (1,-1,1). Front and top share their right axis, +x; front and side their up axis, +z.
std::array<View, 4> sheet_views(ProjectionAngle angle);

struct SheetOptions {
  double width_mm = 297, height_mm = 210;  // A4, lying
  ProjectionAngle angle = ProjectionAngle::third;
  double voxel_mm = 1;  // a voxel's side in the world
  double scale = 0;     // millimetres on the page for one in the world; 0: the largest of 1, 2, 5, 10 ... that fits
  double pen_width_mm = 0.35;  // of the title block's walls; the frame is twice as heavy, its text thinner
  std::string title = {}, source = {}, date = {}, size_name = {};  // UTF-8, for the title block; each may be empty
  std::string scale_note = {};                                     // behind the scale, e.g. "1 voxel = 1 mm"
};

/// The four views, in the order of sheet_views() and in voxels, at one scale, in line with each other. Layers of one
/// name and pen are one layer. The frame keeps 20 mm from the left edge and 10 mm from the others (ISO 5457); the title
/// block of 180 x 28 mm stands in its lower right corner, the views above it. Text is drawn by strokes. Throws
/// Error(bad_argument) for options out of range, a page too small for the title block or for the views at the scale
/// given, and points that are not finite.
Picture engineering_sheet(const std::array<std::vector<Layer>, 4>& views, const SheetOptions& options = {});

/// A scale as people write it: "2:1", "1:2.5".
std::string scale_text(double scale);

}  // namespace blackleaf
