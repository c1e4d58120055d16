// Priority: pieces that fall on each other on one line of the picture are drawn once, by the first pen that has them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <tuple>
#include <vector>

namespace blackleaf::detail {

/// A piece of a picture line that belongs to pen `rank`; of several at one place the lowest rank draws.
template <class Key, class Position>
struct RankedPiece {
  Key key;
  Position low, high;  // low < high
  std::uint32_t rank;
  friend bool operator<(const RankedPiece& p, const RankedPiece& q) {
    return std::tie(p.key, p.low, p.high, p.rank) < std::tie(q.key, q.low, q.high, q.rank);
  }
};

/// Cuts the pieces of each line into stretches where one rank is the lowest, unites those of one rank that touch, and
/// calls emit(key, low, high, rank) for each, in order of (key, low). Every place that some piece covers is covered by
/// exactly one stretch, but for ends that touch. Requires: `pieces` is sorted. O(n log n), O(depth of overlap) memory.
template <class Key, class Position, class Emit>
void by_rank(const std::vector<RankedPiece<Key, Position>>& pieces, const Emit& emit) {
  using Ranked = RankedPiece<Key, Position>;
  struct Later {
    bool operator()(const Ranked* p, const Ranked* q) const { return q->rank < p->rank; }
  };
  std::priority_queue<const Ranked*, std::vector<const Ranked*>, Later> open;  // lowest rank on top
  for (std::size_t i = 0; i < pieces.size();) {
    const Key key = pieces[i].key;
    const auto in_line = [&] { return i < pieces.size() && !(key < pieces[i].key); };
    Ranked last = pieces[i];  // the stretch that is being made: empty at first
    Position at = last.low;
    last.high = at;
    const auto finish = [&] {
      if (last.low < last.high) emit(key, last.low, last.high, last.rank);
    };
    while (in_line() || !open.empty()) {
      if (open.empty() && at < pieces[i].low) at = pieces[i].low;
      for (; in_line() && !(at < pieces[i].low); ++i) open.push(&pieces[i]);
      while (!open.empty() && !(at < open.top()->high)) open.pop();
      if (open.empty()) continue;
      const Ranked& top = *open.top();
      const Position end = in_line() ? std::min(top.high, pieces[i].low) : top.high;
      if (last.rank != top.rank || last.high < at) {
        finish();
        last = {key, at, end, top.rank};
      } else {
        last.high = end;
      }
      at = end;
    }
    finish();
  }
}

}  // namespace blackleaf::detail
