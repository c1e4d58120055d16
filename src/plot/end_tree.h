// A k-d tree of points that can be taken out, for nearest-neighbour questions.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace blackleaf::detail {

/// Built in O(n log n); a question costs O(log n) in practice, also when most points are gone: empty branches are not
/// entered. Among points equally near the one of the least index is the nearest.
class EndTree {
 public:
  explicit EndTree(std::span<const Eigen::Vector2d> points);

  /// Takes a point out. Requires: it is there.
  void remove(std::uint32_t index);
  /// The nearest point left. Requires: there is one.
  std::uint32_t nearest(const Eigen::Vector2d& to) const;
  /// Up to `count` points left that are nearest, the nearest first, without `self` and `other`.
  void nearest(const Eigen::Vector2d& to, std::size_t count, std::uint32_t self, std::uint32_t other,
               std::vector<std::pair<double, std::uint32_t>>& found) const;

 private:
  struct Entry {
    Eigen::Vector2d point;
    std::uint32_t index;
  };
  // Implicit balanced tree: node k has children 2k + 1 and 2k + 2; leaves hold up to kLeaf points, those left first.
  struct Node {
    Eigen::Vector2d low, high;         // around its points
    std::uint32_t begin = 0, end = 0;  // in entries_
    std::uint32_t left = 0;            // points not taken out
  };
  static constexpr std::uint32_t kLeaf = 8;

  void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end);
  double distance(const Node& node, const Eigen::Vector2d& to) const {
    return (node.low - to).cwiseMax(to - node.high).cwiseMax(0).squaredNorm();
  }
  bool is_leaf(const Node& node) const { return node.end - node.begin <= kLeaf; }
  template <class Visit, class Bound>
  void search(std::uint32_t node, const Eigen::Vector2d& to, const Visit& visit, const Bound& bound) const;

  std::vector<Entry> entries_;
  std::vector<std::uint32_t> leaf_of_;  // by index
  std::vector<Node> nodes_;
};

}  // namespace blackleaf::detail
