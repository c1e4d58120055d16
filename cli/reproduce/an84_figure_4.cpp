#include <fmt/format.h>

#include <stdexcept>

#include "blackleaf/drawing.h"
#include "blackleaf/drawing_file.h"
#include "blackleaf/implicit.h"
#include "blackleaf/move.h"
#include "canvas.h"
#include "exhibit.h"
#include "papers/an84.h"

namespace blackleaf::cli {
namespace {

// The figure's list of nodes: gray and black ones, each below its parent and indented by its depth, white ones left
// out.
void list_nodes(const Node& node, const std::string& path, std::size_t depth, std::vector<std::string>& lines) {
  if (node.is_white()) return;
  lines.push_back(std::string(2 * depth, ' ') + path + (node.is_black() ? "  black" : "  gray"));
  if (!node.is_gray()) return;
  for (int octant = 0; octant < 8; ++octant)
    list_nodes(node.child(octant), path + std::to_string(octant), depth + 1, lines);
}

std::vector<std::string> list_of(const Octree& octree) {
  std::vector<std::string> lines;
  list_nodes(octree.root(), "r", 0, lines);
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace

Exhibit an84_figure_4(const Work& work) {
  constexpr std::array<std::int64_t, 3> kBy = {4, -50, 0};
  const Octree original = box(6, {8, 56, 0}, {16, 64, 4});
  const Octree moved = translate(original, kBy, Leaving::error, work);
  papers::an84::Tree tree(original);
  const std::size_t nodes_before = tree.nodes();
  tree.translate(kBy);
  // Two programs, one answer: the paper's algorithm is the witness of ours.
  if (!(tree.octree() == moved)) throw std::logic_error("AN84's algorithm and ours disagree");

  const View view({3, -4, 2});
  PageOptions page;
  page.width_mm = page.height_mm = 60;
  page.margin_mm = 2;
  const std::vector<std::string> lists[] = {list_of(original), list_of(moved)};
  const LineDrawing drawings[] = {draw(original, view, work), draw(moved, view, work)};
  const std::string captions[] = {"(a) The original object", "(b) The object in (a) translated by (4, -50, 0)"};

  Exhibit exhibit{"an84-figure-4", "AN84, Figure 4: the nodes of an object before and after a translation", {}, {}, {}};
  // Millimetres: a column each, the drawing above its list.
  constexpr double kColumn = 95, kTop = 66, kLine = 4;
  const double height = kTop + kLine * (static_cast<double>(std::max(lists[0].size(), lists[1].size())) + 2);
  Canvas canvas(2 * kColumn, height);
  for (std::size_t i = 0; i < 2; ++i) {
    const double x = kColumn * static_cast<double>(i);
    canvas.figure({x, 0}, to_svg(drawings[i], page));
    canvas.text({x + 2, kTop}, captions[i], 3.6);
    double y = kTop + 2 * kLine;
    for (const std::string& line : lists[i]) {
      const std::size_t indent = line.find_first_not_of(' ');
      canvas.text({x + 2 + 2.2 * static_cast<double>(indent), y}, line.substr(indent), 3, Canvas::Anchor::start,
                  "monospace");
      y += kLine;
    }
  }

  exhibit.body =
      paragraph(
          "The figure lists the nodes of a simple parallelepiped as a program printed them, white ones left out. Its "
          "coordinates cannot be read, so this is another of its kind: the voxels [8,16) &times; [56,64) &times; "
          "[0,4) of a universe of 64. A node is named by the labels on its path from the root r, "
          "x + 2y + 4z each.") +
      paragraph(
          fmt::format("The displacement 4 leaves cubes of side 4 whole along x; &minus;50 is even but no multiple of "
                      "4, so along y all cubes are split to side 2: H = 1. The paper's algorithm, run here, "
                      "begins with {} nodes and ends with {}, {} of them at most at once; the {} that remain are "
                      "those of our translation, bit for bit.",
                      nodes_before, tree.nodes(), tree.peak_nodes(), lists[1].size())) +
      canvas.svg();
  exhibit.files = {{"an84-figure-4.svg", canvas.file()},
                   {"an84-figure-4a.txt", joined(lists[0])},
                   {"an84-figure-4b.txt", joined(lists[1])}};
  exhibit.drawings = {{"an84-figure-4a.png", drawings[0], page}, {"an84-figure-4b.png", drawings[1], page}};
  return exhibit;
}

}  // namespace blackleaf::cli
