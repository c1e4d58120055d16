// NodePool: the memory of the papers' pointer trees, with the count that WA87's Table 2 asks for.
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

namespace blackleaf::papers {

/// Hands out nodes that stay where they are; released nodes are handed out again. Counts the nodes alive and the most
/// that were ever alive at once.
template <class Node>
class NodePool {
 public:
  Node* take() {
    if (++alive_ > peak_) peak_ = alive_;
    if (free_.empty()) return &nodes_.emplace_back();
    Node* node = free_.back();
    free_.pop_back();
    *node = Node{};
    return node;
  }
  void give_back(Node* node) {
    --alive_;
    free_.push_back(node);
  }

  std::size_t alive() const { return alive_; }
  std::size_t peak() const { return peak_; }

 private:
  std::deque<Node> nodes_;
  std::vector<Node*> free_;
  std::size_t alive_ = 0, peak_ = 0;
};

}  // namespace blackleaf::papers
