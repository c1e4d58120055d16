#include "plot/end_tree.h"

#include <algorithm>
#include <limits>

namespace blackleaf::detail {

EndTree::EndTree(std::span<const Eigen::Vector2d> points) : leaf_of_(points.size()) {
  entries_.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) entries_.push_back({points[i], i});
  nodes_.reserve(points.size() / 2 + 1);
  if (!points.empty()) build(0, 0, static_cast<std::uint32_t>(points.size()));
}

void EndTree::build(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
  if (nodes_.size() <= node) nodes_.resize(node + 1);
  Eigen::Vector2d low = entries_[begin].point, high = low;
  for (std::uint32_t i = begin; i < end; ++i) {
    low = low.cwiseMin(entries_[i].point);
    high = high.cwiseMax(entries_[i].point);
  }
  nodes_[node] = {low, high, begin, end, end - begin};
  if (is_leaf(nodes_[node])) {
    for (std::uint32_t i = begin; i < end; ++i) leaf_of_[entries_[i].index] = node;
    return;
  }
  const Eigen::Index axis = high[0] - low[0] >= high[1] - low[1] ? 0 : 1;
  const std::uint32_t middle = begin + (end - begin) / 2;
  // The index breaks ties, so that the tree does not depend on the library's selection.
  std::nth_element(entries_.begin() + begin, entries_.begin() + middle, entries_.begin() + end,
                   [&](const Entry& a, const Entry& b) {
                     return a.point[axis] != b.point[axis] ? a.point[axis] < b.point[axis] : a.index < b.index;
                   });
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
}

void EndTree::remove(std::uint32_t index) {
  std::uint32_t node = leaf_of_[index];
  const auto first = entries_.begin() + nodes_[node].begin, last = first + nodes_[node].left;
  const auto is_it = [&](const Entry& entry) { return entry.index == index; };
  std::iter_swap(std::find_if(first, last, is_it), last - 1);
  for (;; node = (node - 1) / 2) {
    --nodes_[node].left;
    if (node == 0) return;
  }
}

// Calls visit(entry) for points left, in branches whose distance is not above bound(), the nearer branch first.
template <class Visit, class Bound>
void EndTree::search(std::uint32_t index, const Eigen::Vector2d& to, const Visit& visit, const Bound& bound) const {
  const Node& node = nodes_[index];
  if (is_leaf(node)) {
    for (std::uint32_t i = node.begin; i < node.begin + node.left; ++i) visit(entries_[i]);
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
      [&](const Entry& entry) {
        best = std::min(best, {(entry.point - to).squaredNorm(), entry.index});
      },
      [&] { return best.first; });
  return best.second;
}

void EndTree::nearest(const Eigen::Vector2d& to, std::size_t count, std::uint32_t self, std::uint32_t other,
                      std::vector<std::pair<double, std::uint32_t>>& found) const {
  found.clear();
  search(
      0, to,
      [&](const Entry& entry) {
        if (entry.index == self || entry.index == other) return;
        const std::pair<double, std::uint32_t> candidate{(entry.point - to).squaredNorm(), entry.index};
        if (found.size() == count && !(candidate < found.back())) return;
        if (found.size() == count) found.pop_back();
        found.insert(std::upper_bound(found.begin(), found.end(), candidate), candidate);
      },
      [&] { return found.size() == count ? found.back().first : std::numeric_limits<double>::infinity(); });
}

}  // namespace blackleaf::detail
