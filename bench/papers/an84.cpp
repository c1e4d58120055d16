#include "papers/an84.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>
#include <string>

#include "blackleaf/error.h"
#include "blackleaf/leaves.h"
#include "papers/run_writer.h"

namespace blackleaf::papers::an84 {
namespace {

Path path_to(const Cube& cube, int depth) {
  Path path;
  for (int bit = depth - 1; bit >= cube.level; --bit)
    path.push((cube.x >> bit & 1) | (cube.y >> bit & 1) << 1 | (cube.z >> bit & 1) << 2);
  return path;
}

}  // namespace

Sum add(const Path& path, std::int64_t displacement, Axis axis) {
  const auto column = static_cast<std::size_t>(axis);
  const auto bits = static_cast<std::uint64_t>(displacement);  // two's complement; bits beyond the path are not read
  Sum sum{path, false};
  bool carry = false;
  for (int position = path.length - 1; position >= 0; --position) {
    std::uint8_t& label = sum.path.labels[static_cast<std::size_t>(position)];
    const auto step = [&] {
      const Transition next = kTransitions[label][column];
      label = next.label;
      return next.carry;
    };
    const bool one = (bits >> (path.length - 1 - position) & 1) != 0;
    // The displacement's digit and the carry from below are added one after the other; at most one of them carries.
    const bool from_carry = carry && step();
    const bool from_digit = one && step();
    carry = from_carry || from_digit;
  }
  sum.carry_lost = carry;
  return sum;
}

Tree::Tree(const Octree& octree) : depth_(octree.depth()), root_(pool_->take()) {
  for_each_black_leaf(octree, [&](const Leaf& leaf) { access(path_to(leaf.cube, depth_))->black = true; });
}

// The node at a path, reached from the root; missing nodes on the way are created gray.
Tree::Node* Tree::access(const Path& path) {
  Node* node = root_;
  for (int i = 0; i < path.length; ++i) {
    Node*& next = node->child[path.labels[static_cast<std::size_t>(i)]];
    if (next == nullptr) next = pool_->take();
    node = next;
  }
  return node;
}

void Tree::split(Node* node, int level, int height) {
  if (level <= height) return;
  if (node->black) {
    node->black = false;
    for (Node*& child : node->child) {
      child = pool_->take();
      child->black = true;
    }
  }
  for (Node* child : node->child)
    if (child != nullptr) split(child, level - 1, height);
}

// One axis of a translation: the traversal that throws each node of level H behind itself.
class Tree::Shift {
 public:
  Shift(Tree& tree, std::int64_t by, Axis axis)
      : tree_(tree), by_(by), axis_(axis), height_(std::countr_zero(static_cast<std::uint64_t>(by))) {}

  void run() {
    tree_.split(tree_.root_, tree_.depth_, height_);
    traverse(tree_.root_, tree_.depth_);
  }

 private:
  // From the side the object moves to, backwards: right to left for positive displacements. A destination has then
  // always been passed already, so that nothing is overwritten and nothing is thrown twice.
  void traverse(Node* node, int level) {
    if (level == height_) {
      throw_node(node);
      return;
    }
    for (int i = 0; i < 8; ++i) {
      const int label = by_ > 0 ? 7 - i : i;
      Node* child = node->child[static_cast<std::size_t>(label)];
      if (child == nullptr) continue;
      path_.push(label);
      traverse(child, level - 1);
      path_.pop();
    }
  }

  void throw_node(Node* source) {
    if (source->is_empty()) return;  // free space left by an earlier axis
    const Sum sum = add(path_, by_ >> height_, axis_);
    assert(sum.carry_lost == (by_ < 0));  // translate() made sure that the object stays inside
    Node* destination = tree_.access(sum.path);
    assert(destination->is_empty());
    *destination = *source;
    *source = Node{};
  }

  Tree& tree_;
  std::int64_t by_;
  Axis axis_;
  int height_;  // H
  Path path_;
};

void Tree::translate(const std::array<std::int64_t, 3>& by) {
  if (root_->is_empty()) return;
  // Wrapping around shows as a wrong carry only once nodes have moved, so the extent is compared beforehand.
  std::array<std::int64_t, 3> low, high;
  low.fill(std::numeric_limits<std::int64_t>::max());
  high.fill(0);
  const auto extend = [&](const auto& self, const Node* node, const Cube& cube) -> void {
    if (node->black) {
      const std::array<std::int64_t, 3> corner = {cube.x, cube.y, cube.z};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], corner[axis]);
        high[axis] = std::max(high[axis], corner[axis] + cube.side());
      }
      return;
    }
    for (int label = 0; label < 8; ++label)
      if (const Node* child = node->child[static_cast<std::size_t>(label)]) self(self, child, cube.child(label));
  };
  extend(extend, root_, {0, 0, 0, depth_});
  const std::int64_t side = std::int64_t{1} << depth_;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (by[axis] < -low[axis] || by[axis] > side - high[axis])
      throw Error(ErrorCode::out_of_universe,
                  "shifting by " + std::to_string(by[axis]) + " along " + "xyz"[axis] + " leaves the universe",
                  "the object can go from " + std::to_string(-low[axis]) + " to " + std::to_string(side - high[axis]));

  for (std::size_t axis = 0; axis < 3; ++axis)
    if (by[axis] != 0) Shift(*this, by[axis], static_cast<Axis>(axis)).run();
  compact(root_);
}

// Post-order: gray nodes without children go, eight black siblings become a black parent. True iff the node is empty.
bool Tree::compact(Node* node) {
  if (node->black) return false;
  int black = 0;
  bool empty = true;
  for (Node*& child : node->child) {
    if (child == nullptr) continue;
    if (compact(child)) {
      pool_->give_back(child);
      child = nullptr;
      continue;
    }
    empty = false;
    if (child->black) ++black;
  }
  if (black == 8) {
    for (Node*& child : node->child) {
      pool_->give_back(child);
      child = nullptr;
    }
    node->black = true;
  }
  return empty;
}

Tree::Link Tree::link(const Node* node) {
  if (node == nullptr || node->is_empty()) return {Colour::white, node};
  return {node->black ? Colour::black : Colour::gray, node};
}

Octree Tree::octree() const {
  return octree_of_links(link(root_), depth_,
                         [](const Link& parent, std::size_t octant) { return link(parent.node->child[octant]); });
}

// Every node of a compacted tree but an empty root holds a black leaf.
bool Tree::meet(const Node* a, const Node* b) {
  if (a->black || b->black) return true;
  for (std::size_t label = 0; label < 8; ++label)
    if (a->child[label] != nullptr && b->child[label] != nullptr && meet(a->child[label], b->child[label])) return true;
  return false;
}

bool interferes(const Tree& a, const Tree& b) {
  assert(a.depth_ == b.depth_);
  if (a.root_->is_empty() || b.root_->is_empty()) return false;
  return Tree::meet(a.root_, b.root_);
}

}  // namespace blackleaf::papers::an84
