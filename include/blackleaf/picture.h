// Pictures: drawings on a page, in layers that each have a pen. What plotters, printers and screens are given.
//
// A picture is measured in millimetres from the lower left corner of its page, x to the right and y upward, as plotters
// do. A layer is a name, a pen and polylines; layers are drawn one after the other, the first lowest.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "blackleaf/drawing.h"

namespace blackleaf {

struct PenColour {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend bool operator==(const PenColour&, const PenColour&) = default;
};

struct Pen {
  PenColour colour = {};
  double width_mm = 0.25;
  std::vector<double> dashes_mm = {};  // on, off, on, off ...: an even number of positive lengths; none: a whole line
  friend bool operator==(const Pen&, const Pen&) = default;
};

/// Polylines in one piece of memory: 16 bytes a point and 8 a polyline.
class Polylines {
 public:
  std::size_t size() const { return ends_.size(); }
  bool empty() const { return ends_.empty(); }
  /// The points of one polyline, two at least. Requires: i < size().
  std::span<const Eigen::Vector2d> operator[](std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : ends_[i - 1];
    return {points_.data() + begin, ends_[i] - begin};
  }
  /// All points of all polylines, one polyline after another.
  std::span<const Eigen::Vector2d> points() const { return points_; }
  std::span<Eigen::Vector2d> points() { return points_; }
  /// Straight pieces of all polylines together.
  std::size_t segment_count() const { return points_.size() - ends_.size(); }

  void reserve(std::size_t polylines, std::size_t points);
  void add(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    points_.push_back(from);
    points_.push_back(to);
    ends_.push_back(points_.size());
  }
  /// Requires: two points at least, none of them in this object.
  void add(std::span<const Eigen::Vector2d> points) {
    points_.insert(points_.end(), points.begin(), points.end());
    ends_.push_back(points_.size());
  }

  friend bool operator==(const Polylines&, const Polylines&) = default;

 private:
  std::vector<Eigen::Vector2d> points_;
  std::vector<std::size_t> ends_;  // of polyline i in points_, exclusive
};

/// Every stroke as a polyline of two points.
Polylines polylines(std::span<const Stroke> strokes);

struct Layer {
  std::string name;  // UTF-8
  Pen pen;
  Polylines lines;
};

/// Where a view lies on the page: its point (u, v), in voxels, at (x_mm + mm_per_voxel u, y_mm + mm_per_voxel v).
struct PlacedView {
  std::string name;  // may be empty
  View view;
  double mm_per_voxel = 1, x_mm = 0, y_mm = 0;
};

struct Picture {
  double width_mm = 0, height_mm = 0;
  std::vector<Layer> layers;
  std::vector<PlacedView> views;
  std::string title = {};   // UTF-8, may be empty
  std::string source = {};  // the names of what is drawn; UTF-8, may be empty
};

struct PageOptions {
  double width_mm = 0, height_mm = 0;  // page; 0: the drawing's own shape, 180 mm on its longer side
  double margin_mm = 10;
  double pen_width_mm = 0.25;
  double dots_per_inch = 200;  // PNG only
  std::string title = {};      // what is drawn; UTF-8, may be empty
  /// The part of the picture plane, (u, v) in voxels, that fills the page inside the margins; none: the drawing's own
  /// box. Pictures of one region lie on each other, like the frames of a film. Strokes beyond it are drawn as well.
  std::optional<Eigen::AlignedBox2d> region = {};
};

/// Layers in voxels on the screen of `view`, put on a page: as large as the margins allow and centred. A side of the
/// page that is not given follows from the drawing's shape. The pens are the layers' own (not options.pen_width_mm).
/// Throws Error(bad_argument) for options out of range, a page too small for its margins, and points that are not
/// finite.
Picture lay_out(std::vector<Layer> layers, const View& view, const PageOptions& options = {});
/// The same for a drawing: one layer, a black pen of options.pen_width_mm.
Picture lay_out(const LineDrawing& drawing, const PageOptions& options = {});

/// SVG text: a group a layer that Inkscape shows as a layer, a <polyline> a polyline, metadata with the views. Numbers
/// have at most four decimals of a millimetre. O(points); some hundred MB/s.
std::string to_svg(const Picture& picture);
std::string to_svg(const LineDrawing& drawing, const PageOptions& page = {});

/// JSON text: {"view": [x,y,z], "right": [..], "up": [..], "strokes": [[[u,v],[u,v]],...]}, voxel units, numbers that
/// give the same doubles back; after "up" perspective drawings have "eye" and "target". Throws Error(bad_argument) for
/// points that are not finite.
std::string to_json(const LineDrawing& drawing);
std::string to_json(const Polylines& strokes, const View& view);
/// The same for layers in voxels: {"view", "right", "up", "layers": [{"name": "..", "colour": "#rrggbb", "width": mm,
/// "dashes": [mm,...], "strokes": [...]},...]}. A stroke is a polyline of two points or more.
std::string to_json(std::span<const Layer> layers, const View& view);
/// The same for a whole page, in millimetres: {"page": [width, height], "unit": "mm", "views": [{"name", "view",
/// "right", "up", "mm_per_voxel", "origin"},...], "layers": [...]}.
std::string to_json(const Picture& picture);

/// HP-GL for pen plotters: IN, SP, PU, PD and PA in units of 1/40 mm, the origin at the page's lower left corner. Pens
/// are numbered from 1 in order of their first layer; after pen 8 comes 1 again. Dashes are drawn as single strokes.
/// Throws Error(bad_argument) for points outside the instructions' range of 0 to 32767 units (819.175 mm).
std::string to_hpgl(const Picture& picture);

/// DXF as AutoCAD Release 12 reads it (AC1009): LINE and POLYLINE entities in millimetres, layers with their colours
/// (the nearest of AutoCAD's first nine; black is 7, which is white on dark screens) and line types.
std::string to_dxf(const Picture& picture);

}  // namespace blackleaf
