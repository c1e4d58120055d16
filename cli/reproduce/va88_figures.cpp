#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "blackleaf/drawing.h"
#include "blackleaf/measures.h"
#include "blackleaf/picture.h"
#include "blackleaf/silhouettes_file.h"
#include "canvas.h"
#include "exhibit.h"
#include "papers/va88.h"
#include "va88_objects.h"

namespace blackleaf::cli {
namespace {

struct Words {
  const char *title, *paper, *ours;
  std::array<double, 3> view;
  int depth = 7;  // of the drawn octree; what is round and has many edges is drawn from a smaller one
};

// By figure, from 5 on.
const std::array<Words, 7> kWords = {{
    {"a cylinder",
     "The paper's cylinder stands upright. &ldquo;The blocky structure of the surfaces actually represented by the "
     "constructed octree can be seen in all figures. For example, there are small steps leading down from the top face "
     "of the cylinder&rdquo;: its silhouettes were digital regions with jagged boundaries.",
     "A disc from above and two rectangles. Our silhouettes have straight sides, so there are no steps at the top; "
     "those "
     "of the round side are the pixels of the disc.",
     {12, -16, 15}},
    {"a cone",
     "One of four &ldquo;simple geometric objects&rdquo;.",
     "A disc from above and a triangle from eight sides: &ldquo;the intersections performed over successive cylinders "
     "give only a polyhedral approximation to a smooth surface&rdquo;.",
     {12, -16, 9},
     6},
    {"a sphere",
     "One of four &ldquo;simple geometric objects&rdquo;.",
     "A disc from 13 sides: the faces, edges and corners of a cube. Three of them alone would leave the intersection "
     "of "
     "three cylinders.",
     {12, -16, 15},
     6},
    {"a pyramid",
     "One of four &ldquo;simple geometric objects&rdquo;.",
     "A triangle from the front and from the right, a square from above: the same object, with steps of a voxel.",
     {12, -16, 15}},
    {"a coffee cup",
     "The octree &ldquo;was obtained from gray-level silhouette images of a coffee cup taken from three orthogonal "
     "viewing directions&rdquo;.",
     "Three orthogonal views as well. A cup is hollow, but no silhouette looks into it: it comes out full. The handle "
     "is "
     "open, because the front view sees through it.",
     {7, -16, 8}},
    {"a complex object that exhibits self-occlusion",
     "&ldquo;A more complex object, which exhibits self-occlusion.&rdquo;",
     "The paper does not describe it. This one has a base, two towers and a step, a notch in the base and a window "
     "through the taller tower; the nearer tower hides parts of the rest.",
     {12, -16, 11}},
    {"a diamond-shaped object",
     "&ldquo;An object whose silhouette is a diamond when viewed from any face of the universe cube that contains "
     "it.&rdquo;",
     "A diamond from front, right and above: the largest such solid is a rhombic dodecahedron.",
     {4, -16, 10}},
}};

constexpr double kPageSide = 110, kImageSide = 34;  // millimetres

// An image as small black and white squares: a path of its runs of object pixels.
std::string image_svg(const Silhouette& image) {
  std::string path;
  const std::uint8_t* line = image.pixels.data();
  for (int row = 0; row < image.height; ++row, line += image.width)
    for (int column = 0; column < image.width;) {
      int end = column;
      while (end < image.width && line[end] != 0) ++end;
      if (end > column) path += fmt::format("M{} {}h{}v1H{}z", column, row, end - column, column);
      column = end + 1;
    }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}mm\" height=\"{0}mm\" viewBox=\"0 0 {1} {2}\">"
      "<rect width=\"100%\" height=\"100%\" fill=\"black\"/><path fill=\"white\" d=\"{3}\"/></svg>\n",
      kImageSide, image.width, image.height, path);
}

std::string direction(const Eigen::Vector3d& view) { return fmt::format("({}, {}, {})", view[0], view[1], view[2]); }

}  // namespace

Exhibit va88_figure(int figure, const Work& work) {
  const Words& words = kWords.at(static_cast<std::size_t>(figure - kVa88FirstFigure));
  Va88Object object = va88_object(figure);
  const double pixel = std::exp2(words.depth) / object.silhouettes.front().width;
  for (Silhouette& seen : object.silhouettes) seen.pixel_size = pixel;
  const Octree octree = octree_from_silhouettes(object.silhouettes, words.depth, {}, {work.threads, {}});
  const LineDrawing drawing = draw(octree, View({words.view[0], words.view[1], words.view[2]}), {work.threads, {}});
  // Two programs, one answer: the paper's algorithm is the witness of ours.
  const papers::va88::Drawing paper =
      papers::va88::draw(octree, {words.view[0], words.view[1], words.view[2]}, papers::va88::Comparing::extents);
  if (std::abs(paper.length() - drawing.length()) > 1e-6 * drawing.length())
    throw std::logic_error("VA88's algorithm and ours disagree");

  Exhibit exhibit{
      fmt::format("va88-figure-{}", figure),
      fmt::format("VA88, Figure {}: the line drawing for the octree representation of {}", figure, words.title),
      {},
      {},
      {}};
  const std::string stem = exhibit.id;
  PageOptions page;
  page.width_mm = page.height_mm = kPageSide;
  page.margin_mm = 2;
  page.pen_width_mm = 0.1;
  page.dots_per_inch = 150;
  const std::string svg = to_svg(drawing, page);

  // Views that see the same share an image.
  nlohmann::ordered_json views = nlohmann::ordered_json::array();
  std::map<std::vector<std::uint8_t>, std::string> names;
  std::string images, sides;
  for (const Silhouette& seen : object.silhouettes) {
    const auto [at, is_new] = names.emplace(seen.pixels, fmt::format("va88-{}-{}.png", object.name, names.size() + 1));
    if (is_new) {
      const std::vector<std::uint8_t> png = to_png(seen);
      exhibit.files.push_back({at->second, std::string(png.begin(), png.end())});
      images += image_svg(seen);
    }
    sides += (sides.empty() ? "" : ", ") + direction(seen.view);
    views.push_back(
        {{"image", at->second}, {"view", {seen.view[0], seen.view[1], seen.view[2]}}, {"pixel_size", pixel}});
  }
  const std::string set_name = fmt::format("va88-{}.json", object.name);
  exhibit.files.push_back(
      {set_name, nlohmann::ordered_json{{"depth", words.depth}, {"views", std::move(views)}}.dump(2) + "\n"});
  exhibit.files.push_back({stem + ".svg", svg});
  exhibit.drawings = {{stem + ".png", drawing, page}};

  const Measures measures = measure(octree);
  exhibit.body =
      paragraph("<b>In the paper.</b> " + std::string(words.paper)) +
      paragraph(fmt::format(
          "<b>Here.</b> {} Silhouettes of 128 &times; 128 pixels, seen from {}; the octree, of depth {}, has {} "
          "black leaves and {} internal nodes, the drawing, seen from {}, {} strokes of together "
          "{:.6g} voxels. The paper's own algorithm, run here, finds the same length.",
          words.ours, sides, words.depth, measures.black_leaves, measures.internal_nodes,
          direction({words.view[0], words.view[1], words.view[2]}), drawing.strokes.size(), drawing.length())) +
      "<figure>" + without_head(svg) + "<figcaption>" + images + "</figcaption></figure>\n" +
      paragraph(
          fmt::format("<code>blackleaf build {0} -o {1}.octree &amp;&amp; blackleaf draw {1}.octree --view {2},{3},{4} "
                      "-o {1}.svg</code>",
                      set_name, object.name, words.view[0], words.view[1], words.view[2]));
  return exhibit;
}

}  // namespace blackleaf::cli
