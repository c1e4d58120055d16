#include "plot/end_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace blackleaf::detail {

EndTree::EndTree(std::span<const Eigen::Vector2d> points)
    : points_(points), order_(points.size()), leaf_of_(points.size()), gone_(points.size(), false) {
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.reserve(points.size() / 2 + 1);
  if (!points.empty()) build(0, 0, static_cast<std::uint32_t>(points.size()));
}

void EndTree::build(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
  if (nodes_.size() <= node) nodes_.resize(node + 1);
  Eigen::Vector2d low = points_[order_[begin]], high = low;
  for (std::uint32_t i = begin; i < end; ++i) {
    low = low.cwiseMin(points_[order_[i]]);
    high = high.cwiseMax(points_[order_[i]]);
  }
  nodes_[node] = {low, high, begin, end, end - begin};
  if (is_leaf(nodes_[node])) {
    for (std::uint32_t i = begin; i < end; ++i) leaf_of_[order_[i]] = node;
    return;
  }
  const Eigen::Index axis = high[0] - low[0] >= high[1] - low[1] ? 0 : 1;
  const std::uint32_t middle = begin + (end - begin) / 2;
  // The index breaks ties, so that the tree does not depend on the library's selection.
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     return points_[a][axis] != points_[b][axis] ? points_[a][axis] < points_[b][axis] : a < b;
                   });
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
}

void EndTree::remove(std::uint32_t index) {
  gone_[index] = true;
  for (std::uint32_t node = leaf_of_[index];; node = (node - 1) / 2) {
    --nodes_[node].left;
    if (node == 0) return;
  }
}

// Calls visit(index) for points left, in branches whose distance is not above bound(), the nearer branch first.
template <class Visit, class Bound>
void EndTree::search(std::uint32_t index, const Eigen::Vector2d& to, const Visit& visit, const Bound& bound) const {
  const Node& node = nodes_[index];
  if (is_leaf(node)) {
    for (std::uint32_t i = node.begin; i < node.end; ++i)
      if (!gone_[order_[i]]) visit(order_[i]);
    return;
  }
  std::uint32_t near = 2 * index + 1, far = near + 1;
  double near_distance = distance(nodes_[near], to), far_distance = distance(nodes_[far], to);
  if (far_distance < near_distance) {
    std::swap(near, far);
    std::swap(near_distance, far_distance);
  }
  if (nodes_[near].left > 0 && near_distance <= bound()) search(near, to, visit, bound);
  if (nodes_[far].left > 0 && far_distance <= bound()) search(far, to, visit, bound);
}

std::uint32_t EndTree::nearest(const Eigen::Vector2d& to) const {
  std::pair<double, std::uint32_t> best{std::numeric_limits<double>::infinity(), 0};
  search(
      0, to,
      [&](std::uint32_t i) {
        best = std::min(best, {(points_[i] - to).squaredNorm(), i});
      },
      [&] { return best.first; });
  return best.second;
}

void EndTree::nearest(const Eigen::Vector2d& to, std::size_t count, std::uint32_t self, std::uint32_t other,
                      std::vector<std::pair<double, std::uint32_t>>& found) const {
  found.clear();
  search(
      0, to,
      [&](std::uint32_t i) {
        if (i == self || i == other) return;
        const std::pair<double, std::uint32_t> candidate{(points_[i] - to).squaredNorm(), i};
        if (found.size() == count && !(candidate < found.back())) return;
        if (found.size() == count) found.pop_back();
        found.insert(std::upper_bound(found.begin(), found.end(), candidate), candidate);
      },
      [&] { return found.size() == count ? found.back().first : std::numeric_limits<double>::infinity(); });
}

}  // namespace blackleaf::detail
