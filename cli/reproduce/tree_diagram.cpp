#include "tree_diagram.h"

#include <array>
#include <vector>

#include "canvas.h"

namespace blackleaf::cli {
namespace {

constexpr double kLeaf = 5, kLevel = 17, kRadius = 1.2, kMargin = 4;  // millimetres
constexpr double kStub = 0.35;                                        // of a link that leads to no node

struct Placed {
  Colour colour;
  Eigen::Vector2d at;
  std::vector<Placed> children;  // of gray nodes: eight
};

// Leaves take their places from left to right, a parent stands above the middle of its children.
Placed place(const Node& node, int level, double& next) {
  Placed placed{node.colour(), {0, kMargin + kLevel * level}, {}};
  if (!node.is_gray()) {
    placed.at[0] = next;
    next += kLeaf;
    return placed;
  }
  for (int octant = 0; octant < 8; ++octant) placed.children.push_back(place(node.child(octant), level + 1, next));
  placed.at[0] = (placed.children.front().at[0] + placed.children.back().at[0]) / 2;
  return placed;
}

int height_of(const Node& node) {
  int height = 0;
  for (int octant = 0; node.is_gray() && octant < 8; ++octant)
    height = std::max(height, 1 + height_of(node.child(octant)));
  return height;
}

void put(Canvas& canvas, const Placed& node, WhiteLeaves white_leaves) {
  for (std::size_t octant = 0; octant < node.children.size(); ++octant) {
    const Placed& child = node.children[octant];
    const bool nil = child.colour == Colour::white && white_leaves == WhiteLeaves::links;
    const Eigen::Vector2d link = child.at - node.at;
    canvas.line(node.at, node.at + (nil ? kStub : 1.0) * link, nil ? "gray" : "black");
    if (nil) continue;
    const std::string label = std::to_string(octant);
    if (child.children.empty())
      canvas.text(child.at + Eigen::Vector2d(0, 3 * kRadius), label, 3, Canvas::Anchor::middle);
    else if (link[0] > 0)
      canvas.text(child.at + Eigen::Vector2d(1.6 * kRadius, 0.4), label, 3);
    else
      canvas.text(child.at + Eigen::Vector2d(-1.6 * kRadius, 0.4), label, 3, Canvas::Anchor::end);
  }
  for (const Placed& child : node.children) put(canvas, child, white_leaves);
  if (node.colour == Colour::white && white_leaves == WhiteLeaves::links) return;
  canvas.circle(node.at, kRadius,
                node.colour == Colour::black   ? "black"
                : node.colour == Colour::white ? "white"
                                               : "lightgray");
}

}  // namespace

std::string tree_diagram(const Octree& octree, WhiteLeaves white_leaves) {
  double next = kMargin;
  const Placed root = place(octree.root(), 0, next);
  Canvas canvas(next - kLeaf + kMargin, 2 * kMargin + kLevel * height_of(octree.root()));
  put(canvas, root, white_leaves);
  canvas.text(root.at + Eigen::Vector2d(2 * kRadius, 0.5), "r", 4);
  return canvas.svg();
}

}  // namespace blackleaf::cli
