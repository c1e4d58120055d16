// Scenes: several solids in one picture, each with its own lines, all hiding one another.
//
// A scene is a list of solids of one universe; they may touch and overlap. Each solid has its own feature edges, also
// where it touches another one: the line in which two labels of an atlas meet on a flat surface is an edge of both.
// What hides is one thing, the union of all solids: a point is hidden iff its sight line meets the interior of the
// union, so no one looks into the plane between two solids that touch.
//
// Where lines of several solids or kinds fall on each other in the picture, the line is drawn once: outlines go before
// other visible lines, visible lines before hidden ones, and within a kind it belongs to the solid that comes first in
// the scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "blackleaf/drawing.h"
#include "blackleaf/label_map.h"
#include "blackleaf/measures.h"
#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

/// An immutable list of solids of one universe and their union. Copies share their storage.
class Scene {
 public:
  /// Requires: at least one solid. Throws Error(bad_argument) when depths differ, Error(cancelled). Frames are not
  /// compared: see align.h. O(words of all).
  explicit Scene(std::vector<Octree> solids, const Work& work = {});

  std::span<const Octree> solids() const;
  /// The union: what hides.
  const Octree& all() const;

  /// The scene without the voxels of some boxes, cut open: a face between a voxel that is left and one that was taken
  /// away, both of which were in the union, is a cut face and can be hatched (hatch.h). Other faces were surface
  /// before, also where they end at a box. Solids keep their places in the list, also when nothing is left of them.
  /// O(words of all and of the cut faces).
  Scene without(std::span<const Box> removed, const Work& work = {}) const;

  /// The voxels of one solid whose face towards lower (`upward` false) or higher coordinates along an axis (0..2) is a
  /// cut face. The empty universe for scenes that are not cut. O(1).
  const Octree& cut_voxels(std::size_t solid, unsigned axis, bool upward) const;

 private:
  struct Storage;
  explicit Scene(std::shared_ptr<const Storage> storage);
  std::shared_ptr<const Storage> storage_;
};

/// The solid of a label.
struct LabelledSolid {
  std::uint32_t label = 0;
  Octree octree;
};
/// The solids of all labels but 0, in increasing order: what octree_from_label() gives for each, in one pass.
/// O(runs * depth), whatever the number of labels.
std::vector<LabelledSolid> solids_of_labels(const LabelMap& map, const Work& work = {});

/// Kinds of lines, each drawn with a pen of its own.
enum class LineKind : std::uint8_t {
  outline,  // visible, with nothing behind it for a while: see SceneOptions::outline_gap
  visible,  // all other visible lines
  hidden,   // what is left of all feature edges
  hatch,    // on visible faces (hatch.h)
  cut,      // on visible cut faces (hatch.h)
};

/// The lines of one kind of one solid.
struct SceneLines {
  std::size_t solid = 0;  // its place in the scene
  LineKind kind = LineKind::visible;
  std::vector<Stroke> strokes;  // none of zero length, no two that could be joined
};

struct SceneOptions {
  bool visible = true;   // draw visible lines and outlines
  bool hidden = false;   // draw hidden lines
  bool outline = false;  // tell outlines from other visible lines
  /// A visible point is on the outline iff the sight line through it, followed away from the viewer, meets no interior
  /// for this many voxels: what lies behind it there is at least so far away, or the background. Any positive number;
  /// infinity keeps only what stands out against the background. In times of d, the whole-number view direction, the
  /// gap is rounded up once to a multiple of 1/D, D being |d_b d_c| for edges along axis a (or the one of the two that
  /// is not zero).
  double outline_gap = std::numeric_limits<double>::infinity();
};

/// The feature edges of all solids seen from `view`, by kind and solid: kinds in the order above, solids in that of the
/// scene, those without strokes left out. Visible points are as draw(octree, view) has them; hidden are all points of
/// feature edges, but for edges seen end-on, whose place in the picture no visible point takes. So the visible and the
/// hidden strokes together cover every feature edge, and no place is drawn twice. Exact, in integers; near-linear in
/// the feature edges of all solids; the same for every thread count. Throws Error(bad_argument) for a gap that is not
/// positive, Error(cancelled).
std::vector<SceneLines> draw(const Scene& scene, const View& view, const SceneOptions& options = {},
                             const Work& work = {});

}  // namespace blackleaf
