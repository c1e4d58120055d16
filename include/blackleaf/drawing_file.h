// Line drawings in files.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>

#include "blackleaf/drawing.h"

namespace blackleaf {

struct PageOptions {
  double width_mm = 0, height_mm = 0;  // page; 0: the drawing's own shape, 180 mm on its longer side
  double margin_mm = 10;
  double pen_width_mm = 0.25;
  double dots_per_inch = 200;  // PNG only
  std::string title = {};      // what is drawn, for SVG and PDF; UTF-8, may be empty
  /// The part of the picture plane, (u, v) in voxels, that fills the page inside the margins; none: the drawing's own
  /// box. Pictures of one region lie on each other, like the frames of a film. Strokes beyond it are drawn as well.
  std::optional<Eigen::AlignedBox2d> region = {};
};

/// SVG text: millimetres, one <polyline> a stroke, metadata with the view.
std::string to_svg(const LineDrawing& drawing, const PageOptions& page = {});
/// JSON text: {"view": [x,y,z], "right": [..], "up": [..], "strokes": [[[u,v],[u,v]],...]}, voxel units.
std::string to_json(const LineDrawing& drawing);

/// Writes .svg, .json, .png or .pdf by suffix. Atomic. Throws Error(io), and Error(bad_argument) for other suffixes or
/// a page too small for its margins.
void write_drawing(const LineDrawing& drawing, const std::filesystem::path& path, const PageOptions& page = {});

}  // namespace blackleaf
