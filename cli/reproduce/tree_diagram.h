// Diagrams of octrees, as AN84 draws them: the root above, black leaves dark, white ones empty.
#pragma once

#include <string>

#include "blackleaf/octree.h"

namespace blackleaf::cli {

enum class WhiteLeaves {
  circles,  // empty circles (AN84, Figure 2)
  links,    // links that lead to no node: "NIL" (AN84, Figure 3)
};

/// An SVG text of the tree, all octants in order of their labels from left to right, labels beside the links.
/// Requires: a small tree; leaves have 5 mm each.
std::string tree_diagram(const Octree& octree, WhiteLeaves white_leaves);

}  // namespace blackleaf::cli
