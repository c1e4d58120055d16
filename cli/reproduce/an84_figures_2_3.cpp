#include <fmt/format.h>

#include <array>
#include <set>
#include <stdexcept>
#include <tuple>

#include "blackleaf/drawing.h"
#include "blackleaf/implicit.h"
#include "blackleaf/measures.h"
#include "blackleaf/move.h"
#include "blackleaf/picture.h"
#include "blackleaf/set_operations.h"
#include "canvas.h"
#include "exhibit.h"
#include "papers/an84.h"
#include "tree_diagram.h"

namespace blackleaf::cli {
namespace {

constexpr double kSide = 55;  // millimetres of a drawing

using Corner = std::array<std::int32_t, 3>;
using Edges = std::set<std::pair<Corner, Corner>>;  // lower corner first

void add_edges(const Cube& cube, Edges& edges) {
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned octant = 0; octant < 8; ++octant) {
      if (octant >> axis & 1) continue;
      Corner from = {cube.x, cube.y, cube.z};
      for (unsigned i = 0; i < 3; ++i)
        if (octant >> i & 1) from[i] += cube.side();
      Corner to = from;
      to[axis] += cube.side();
      edges.insert({from, to});
    }
}

// The edges of all cubes that the octree divides its universe into.
void subdivision(const Node& node, const Cube& cube, Edges& edges) {
  add_edges(cube, edges);
  if (!node.is_gray()) return;
  for (int octant = 0; octant < 8; ++octant) subdivision(node.child(octant), cube.child(octant), edges);
}

// The object in its universe: `edges` behind it in gray.
std::string object_svg(const Octree& octree, const View& view, const Edges& edges, const Work& work) {
  Layer thin{"universe", {{160, 160, 160}, 0.15}, {}}, object{"object", {{0, 0, 0}, 0.4}, {}};
  const auto seen = [&](const Corner& p) {
    const Eigen::Vector3d point(p[0], p[1], p[2]);
    return Eigen::Vector2d(view.right().dot(point), view.up().dot(point));
  };
  for (const auto& [from, to] : edges) thin.lines.add(seen(from), seen(to));
  object.lines = polylines(draw(octree, view, work).strokes);
  PageOptions page;
  page.width_mm = page.height_mm = kSide;
  page.margin_mm = 1;
  return to_svg(lay_out({thin, object}, view, page));
}

}  // namespace

Exhibit an84_figure_2(const Work& work) {
  const auto piece = [](const Corner& min, const Corner& max) { return box(2, min, max); };
  // A plate without its north-east corner, a low wall on half of it, and a small block in the corner.
  const Octree octree = unite(unite(piece({0, 0, 0}, {4, 2, 2}), piece({0, 2, 0}, {2, 4, 2})),
                              unite(piece({0, 0, 2}, {2, 2, 3}), piece({2, 2, 0}, {3, 3, 1})));
  const View view({4, -7, 4});
  Edges universe, divided;
  add_edges(octree.universe(), universe);
  subdivision(octree.root(), octree.universe(), divided);
  const std::string tree = tree_diagram(octree, WhiteLeaves::circles);

  Canvas canvas(2 * kSide + 20, 2 * kSide + 12);
  canvas.figure({0, 0}, object_svg(octree, view, universe, work));
  canvas.figure({kSide + 20, 0}, object_svg(octree, view, divided, work));
  canvas.text({kSide / 2, kSide + 4}, "(a)", 4, Canvas::Anchor::middle);
  canvas.text({1.5 * kSide + 20, kSide + 4}, "(b)", 4, Canvas::Anchor::middle);
  canvas.figure({0, kSide + 8}, tree);
  canvas.text({kSide + 10, kSide + 62}, "(c)", 4, Canvas::Anchor::middle);

  const Measures measures = measure(octree);
  Exhibit exhibit{"an84-figure-2", "AN84, Figure 2: an object and its octree", {}, {}, {}};
  exhibit.body =
      paragraph(
          "<b>In the paper.</b> &ldquo;(a) A simple object. (b) Recursive subdivision of space superimposed on the "
          "object in (a) to obtain its representation. (c) Octree for the object in (a); r denotes the root node. "
          "Black (white) leaves are indicated by darkened (empty) circles.&rdquo;") +
      paragraph(fmt::format("<b>Here.</b> The paper's object cannot be told from the print; this one, in a universe of "
                            "4 &times; 4 &times; 4 voxels, has {} internal nodes (gray circles), {} black and {} white "
                            "leaves. Labels are x + 2y + 4z: x to the east, y to the north, z upward.",
                            measures.internal_nodes, measures.black_leaves, measures.white_leaves)) +
      "<figure>" + canvas.svg() + "</figure>\n";
  exhibit.files = {{"an84-figure-2.svg", canvas.file()}};
  return exhibit;
}

Exhibit an84_figure_3(const Work& work) {
  struct Step {
    const char *caption, *path, *addition;
    std::int32_t by;
  };
  const std::array<Step, 3> steps = {
      {{"(a) A unit-size object block r057", "r057", "", 0},
       {"(b) The object in (a) translated by a unit distance", "r075", "r057 + 001 = r075", 1},
       {"(c) The object in (a) translated by 5 distance units", "r275", "r057 + 101 = r275", 5}}};
  const Octree original = box(3, {3, 1, 3}, {4, 2, 4});
  const View view({4, -7, 4});
  Edges universe;
  add_edges(original.universe(), universe);

  constexpr double kTree = 125, kRow = 68;
  Canvas canvas(kTree + kSide, kRow * static_cast<double>(steps.size()));
  std::string paths;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    const Octree moved = translate(original, {0, step.by, 0}, Leaving::error, work);
    papers::an84::Tree tree(original);
    tree.translate({0, step.by, 0});
    // Two programs, one answer: the paper's algorithm is the witness of ours.
    if (!(tree.octree() == moved)) throw std::logic_error("AN84's algorithm and ours disagree");
    std::string path = "r";
    for (Node node = moved.root(); node.is_gray();)
      for (int octant = 0; octant < 8; ++octant)
        if (!node.child(octant).is_white()) {
          path += std::to_string(octant);
          node = node.child(octant);
          break;
        }
    if (path != step.path) throw std::logic_error("AN84's sums come out wrong");
    paths += path + "\n";
    const double y = kRow * static_cast<double>(i);
    canvas.text({2, y + 5}, step.caption, 4);
    canvas.text({2, y + 10}, step.addition, 4);
    canvas.figure({0, y + 8}, tree_diagram(moved, WhiteLeaves::links));
    canvas.figure({kTree, y + 6}, object_svg(moved, view, universe, work));
  }
  Exhibit exhibit{"an84-figure-3", "AN84, Figure 3: translating a unit-size block along y", {}, {}, {}};
  exhibit.body =
      paragraph(
          "<b>In the paper.</b> &ldquo;Translating a unit size block parallel to the positive y axis. The links not "
          "leading to any node denote &lsquo;NIL&rsquo; links or white children. (a) A unit-size object block "
          "r057. (b) The object in (a) translated by a unit distance. (c) The object in (a) translated by 5 distance "
          "units.&rdquo; The labels on the path from the root are added to the distance's binary digits: a carry "
          "moves the parent as well.") +
      paragraph(
          "<b>Here.</b> The trees of our translation, the same as those of the paper's algorithm, run here; beside "
          "them the block in its universe of 8 &times; 8 &times; 8 voxels.") +
      "<figure>" + canvas.svg() + "</figure>\n";
  exhibit.files = {{"an84-figure-3.svg", canvas.file()}, {"an84-figure-3.txt", paths}};
  return exhibit;
}

}  // namespace blackleaf::cli
