// VisibleSet: what is still visible of a run of edges while boxes are taken out of it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "edge_family.h"

namespace blackleaf::detail {

/// Disjoint closed intervals of positive length in increasing order. Taking away an open interval can leave single
/// points; they are dropped, for the drawing has no strokes of zero length.
template <class Interval>
class BasicVisibleSet {
  using Position = decltype(Interval::low);

 public:
  /// Requires: low < high.
  void reset(Position low, Position high) { intervals_.assign(1, {low, high}); }

  const std::vector<Interval>& intervals() const { return intervals_; }

  /// Whether (low, high) meets the set in more than nothing. O(log intervals).
  bool meets(Position low, Position high) const {
    if (intervals_.empty() || high <= intervals_.front().low || low >= intervals_.back().high) return false;
    return intervals_.size() == 1 || first_above(low)->low < high;
  }

  /// Takes (low, high) away; true iff nothing is left. Requires: meets(low, high).
  bool subtract(Position low, Position high) {
    const auto first = intervals_.begin() + (first_above(low) - intervals_.cbegin());
    auto last = first;  // first one that begins at or above `high`
    while (last != intervals_.end() && last->low < high) ++last;
    const Interval left{first->low, low}, right{high, (last - 1)->high};
    auto out = first;
    if (left.low < left.high) *out++ = left;
    if (right.low < right.high) {
      if (out == last) {
        intervals_.insert(out, right);
        return false;
      }
      *out++ = right;
    }
    intervals_.erase(out, last);
    return intervals_.empty();
  }

 private:
  // The first interval that ends above `low`. Requires: there is one.
  typename std::vector<Interval>::const_iterator first_above(Position low) const {
    return std::partition_point(intervals_.begin(), intervals_.end(), [&](const Interval& i) { return i.high <= low; });
  }

  std::vector<Interval> intervals_;
};
using VisibleSet = BasicVisibleSet<Interval>;

}  // namespace blackleaf::detail
