#include "papers/wa87.h"

#include <Eigen/Core>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string>

#include "blackleaf/error.h"
#include "blackleaf/leaves.h"
#include "papers/run_writer.h"

namespace blackleaf::papers::wa87 {
namespace {

constexpr std::uint8_t bit(std::size_t octant) { return static_cast<std::uint8_t>(1u << octant); }

Eigen::Vector3d centre_of(const Cube& cube) {
  return Eigen::Vector3d(cube.x, cube.y, cube.z) + Eigen::Vector3d::Constant(0.5 * cube.side());
}

}  // namespace

Tree::Tree(const Octree& octree) : depth_(octree.depth()) {
  blackleaf::for_each_black_leaf(octree, [&](const Leaf& leaf) {
    Node* parent = &holder_;
    std::size_t octant = 0;
    for (int k = depth_ - 1; k >= leaf.cube.level; --k) {
      if (!(parent->gray & bit(octant))) {
        parent->gray |= bit(octant);
        parent->child[octant] = pool_->take();
      }
      parent = parent->child[octant];
      octant =
          static_cast<std::size_t>((leaf.cube.x >> k & 1) | (leaf.cube.y >> k & 1) << 1 | (leaf.cube.z >> k & 1) << 2);
    }
    parent->black |= bit(octant);
  });
}

Tree::Link Tree::link(const Node& parent, std::size_t octant) {
  if (parent.gray & bit(octant)) return {Colour::gray, parent.child[octant]};
  return {parent.black & bit(octant) ? Colour::black : Colour::white, nullptr};
}

Octree Tree::octree() const {
  return octree_of_links(link(holder_, 0), depth_,
                         [](const Link& parent, std::size_t octant) { return link(*parent.node, octant); });
}

// fdleaf's traversal: children in order of their labels.
template <class Visit>
void Tree::for_each_black_leaf(const Visit& visit) const {
  const auto fdleaf = [&](const auto& self, const Link& link, const Cube& cube) -> void {
    if (link.colour == Colour::black) visit(cube);
    if (link.colour != Colour::gray) return;
    for (int octant = 0; octant < 8; ++octant)
      self(self, Tree::link(*link.node, static_cast<std::size_t>(octant)), cube.child(octant));
  };
  fdleaf(fdleaf, link(holder_, 0), {0, 0, 0, depth_});
}

std::size_t Tree::black_leaves() const {
  std::size_t count = 0;
  for_each_black_leaf([&](const Cube&) { ++count; });
  return count;
}

std::uint64_t Tree::volume() const {
  std::uint64_t voxels = 0;
  for_each_black_leaf([&](const Cube& cube) { voxels += std::uint64_t{1} << (3 * cube.level); });
  return voxels;
}

// Eight children of one colour: they go, and their parent takes the colour.
void Tree::condense(Node& parent, std::size_t octant) {
  Node* node = parent.child[octant];
  const bool white = (node->black | node->gray) == 0;
  if (node->black != 0xFF && !white) return;
  pool_->give_back(node);
  parent.child[octant] = nullptr;
  parent.gray &= static_cast<std::uint8_t>(~bit(octant));
  if (!white) parent.black |= bit(octant);
}

class Tree::Mover {
 public:
  Mover(Tree& target, const FixedMotion& motion) : target_(target), motion_(motion) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      for (std::size_t j = 0; j < 3; ++j)
        backward_(row, static_cast<Eigen::Index>(j)) = static_cast<double>(motion.inverse_rotation[i][j]) / kUnit;
      backward_shift_[row] = static_cast<double>(motion.inverse_translation[i]) / kUnit;
      forward_shift_[row] = static_cast<double>(motion.forward_translation[i]) / kUnit;
    }
  }

  void add(const Cube& source) {
    source_ = source;
    source_centre_ = centre_of(source);
    moved_centre_ = forward(source_centre_);
    check_space();
    intersect(target_.holder_, 0, {0, 0, 0, target_.depth_});
  }

 private:
  static constexpr double kUnit = std::int64_t{1} << FixedMotion::kFractionBits;
  // Spheres only prune, so they may be a little too large: far more than doubles and the motion's rounding can be wrong
  // by (2^-38 an entry over 2^20 voxels), far less than what would cost tests.
  static constexpr double kMargin = 1e-3;

  Eigen::Vector3d forward(const Eigen::Vector3d& x) const { return backward_.transpose() * x + forward_shift_; }
  Eigen::Vector3d backward(const Eigen::Vector3d& x) const { return backward_ * x + backward_shift_; }

  void check_space() const {
    const double side = std::int64_t{1} << target_.depth_;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d at(source_.x + (corner & 1) * source_.side(),
                               source_.y + (corner >> 1 & 1) * source_.side(),
                               source_.z + (corner >> 2) * source_.side());
      const Eigen::Vector3d moved = forward(at);
      if (moved.minCoeff() < -0x1p-16 || moved.maxCoeff() > side + 0x1p-16)
        throw Error(ErrorCode::out_of_universe,
                    "the motion takes the point (" + std::to_string(moved.x()) + ", " + std::to_string(moved.y()) +
                        ", " + std::to_string(moved.z()) + ") out of the universe",
                    "move the object less far or give it a larger universe");
    }
  }

  // True iff the voxel centre (c_x, c_y, c_z) / 2, moved back, is on or inside the source cube. Exact: FixedMotion.
  bool holds(const std::array<std::int64_t, 3>& c) const {
    const std::array<std::int64_t, 3> low = {source_.x, source_.y, source_.z};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& row = motion_.inverse_rotation[i];
      const std::int64_t at = row[0] * c[0] + row[1] * c[1] + row[2] * c[2] + 2 * motion_.inverse_translation[i];
      constexpr int kShift = FixedMotion::kFractionBits + 1;
      if (at < low[i] << kShift || at > (low[i] + source_.side()) << kShift) return false;
    }
    return true;
  }

  // Relation B, "inside": the corners of q, the cube of the voxel centres of the target node, moved back.
  bool inside(const Cube& target) const {
    const std::int64_t span = 2 * (std::int64_t{target.side()} - 1);
    for (int corner = 0; corner < 8; ++corner)
      if (!holds({2 * std::int64_t{target.x} + 1 + (corner & 1) * span,
                  2 * std::int64_t{target.y} + 1 + (corner >> 1 & 1) * span,
                  2 * std::int64_t{target.z} + 1 + (corner >> 2) * span}))
        return false;
    return true;
  }

  // Relation B, "outside": the sphere about the smaller cube misses the larger cube.
  bool outside(const Cube& target) const {
    const double l1 = source_.side(), l2 = target.side();
    if (source_.level < target.level) {
      const double disa = (std::numbers::sqrt3 * l1 + l2 - 1) / 2;
      return (moved_centre_ - centre_of(target)).cwiseAbs().maxCoeff() > disa + kMargin;
    }
    const double disb = (l1 + std::numbers::sqrt3 * (l2 - 1)) / 2;
    return (source_centre_ - backward(centre_of(target))).cwiseAbs().maxCoeff() > disb + kMargin;
  }

  // The target node is the child `octant` of `parent`.
  void intersect(Node& parent, std::size_t octant, const Cube& target) {
    if (parent.black & bit(octant)) return;  // an earlier leaf covers all of it
    if (target.level == 0) {
      if (holds({2 * std::int64_t{target.x} + 1, 2 * std::int64_t{target.y} + 1, 2 * std::int64_t{target.z} + 1}))
        parent.black |= bit(octant);
      return;
    }
    if (outside(target)) return;
    if (source_.level >= target.level && inside(target)) {
      if (parent.gray & bit(octant)) release(parent, octant);
      parent.black |= bit(octant);
      return;
    }
    if (!(parent.gray & bit(octant))) {
      parent.gray |= bit(octant);
      parent.child[octant] = target_.pool_->take();
    }
    for (int below = 0; below < 8; ++below)
      intersect(*parent.child[octant], static_cast<std::size_t>(below), target.child(below));
    target_.condense(parent, octant);
  }

  // A gray node that a later leaf covers whole: its subtree goes.
  void release(Node& parent, std::size_t octant) {
    Node* node = parent.child[octant];
    for (std::size_t below = 0; below < 8; ++below)
      if (node->gray & bit(below)) release(*node, below);
    target_.pool_->give_back(node);
    parent.child[octant] = nullptr;
    parent.gray &= static_cast<std::uint8_t>(~bit(octant));
  }

  Tree& target_;
  const FixedMotion& motion_;
  Eigen::Matrix3d backward_;  // R^T
  Eigen::Vector3d backward_shift_, forward_shift_;
  Cube source_;  // a_1
  Eigen::Vector3d source_centre_, moved_centre_;
};

Tree move(const Tree& source, const FixedMotion& motion) {
  Tree target(source.depth_);
  Tree::Mover mover(target, motion);
  source.for_each_black_leaf([&](const Cube& leaf) { mover.add(leaf); });
  return target;
}

double black_leaf_bound(int m) {
  assert(m >= 0);
  return 24.25 * std::exp2(2 * m) - 200 * std::exp2(m) + 1454;
}

double internal_node_bound(int m, int n) {
  assert(m >= 0 && n >= m);
  switch (m) {
    case 0:
      return 8.0 * n - 7;
    case 1:
      return 8.0 * n + 12;
    case 2:
      return 8.0 * n + 101;
    default:
      return 5.76 * std::exp2(2 * m) + 17 * std::exp2(m) + 8 * n + 76 * m - 277;
  }
}

double node_bound(int m, int n) {
  if (m < 3) return 8 * internal_node_bound(m, n) + 1;
  return 47 * std::exp2(2 * m) + 136 * std::exp2(m) + 64 * n + 608 * m - 2215;
}

}  // namespace blackleaf::papers::wa87
