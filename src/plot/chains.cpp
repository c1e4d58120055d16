#include "plot/chains.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace blackleaf::detail {
namespace {

using Vertex = std::uint32_t;
constexpr Vertex kNone = std::numeric_limits<Vertex>::max();

// Which ends of lines are one point: end 2i is the first of line i, end 2i + 1 its last.
struct Vertices {
  std::vector<Vertex> of_end;
  std::size_t count = 0;
};

Vertices vertices_of(const Polylines& lines) {
  struct End {
    std::int64_t x, y;
    Vertex end;
    bool operator<(const End& other) const {
      return x != other.x ? x < other.x : y != other.y ? y < other.y : end < other.end;
    }
  };
  // Cells of the size of kSamePoint. Their walls are moved by an odd fraction, off the round numbers on which ends may
  // lie by the thousand; two roundings of one point fall on two sides of a wall by bad luck only, which costs a lift.
  const auto cell = [](double mm) {
    return static_cast<std::int64_t>(std::floor(mm / kSamePoint + 0.3183098861837907));
  };
  std::vector<End> ends;
  ends.reserve(2 * lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto line = lines[i];
    ends.push_back({cell(line.front()[0]), cell(line.front()[1]), static_cast<Vertex>(2 * i)});
    ends.push_back({cell(line.back()[0]), cell(line.back()[1]), static_cast<Vertex>(2 * i + 1)});
  }
  std::sort(ends.begin(), ends.end());
  Vertices vertices;
  vertices.of_end.resize(ends.size());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (i == 0 || ends[i].x != ends[i - 1].x || ends[i].y != ends[i - 1].y) ++vertices.count;
    vertices.of_end[ends[i].end] = static_cast<Vertex>(vertices.count - 1);
  }
  return vertices;
}

// Edges that leave each vertex. Edge i of the lines has the ends 2i and 2i + 1; further edges, which are no lines, join
// odd vertices in pairs, so that all degrees are even.
class Graph {
 public:
  explicit Graph(Vertices vertices) : ends_(std::move(vertices.of_end)), count_(vertices.count) {
    lines_ = ends_.size() / 2;
    std::vector<std::uint32_t> degree(count_);
    for (const Vertex v : ends_) ++degree[v];
    // Neighbours along the sorted vertices: any pairing gives the same number of trails.
    Vertex waiting = kNone;
    for (Vertex v = 0; v < count_; ++v) {
      if (degree[v] % 2 == 0) continue;
      if (waiting == kNone) {
        waiting = v;
      } else {
        ends_.push_back(waiting);
        ends_.push_back(v);
        waiting = kNone;
      }
    }
    first_.assign(count_ + 1, 0);
    for (const Vertex v : ends_) ++first_[v + 1];
    for (std::size_t v = 0; v < count_; ++v) first_[v + 1] += first_[v];
    leaving_.resize(ends_.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t end = 0; end < ends_.size(); ++end) leaving_[next[ends_[end]]++] = end;
    next_.assign(first_.begin(), first_.end() - 1);
    used_.assign(ends_.size() / 2, false);
  }

  std::size_t vertex_count() const { return count_; }
  bool is_line(std::uint32_t end) const { return end / 2 < lines_; }

  // The ends through which a closed walk from `start` over all edges within reach leaves its vertices, in order
  // (Hierholzer 1873). Empty if no edge is left there.
  void circuit(Vertex start, std::vector<std::uint32_t>& walk) {
    struct Step {
      Vertex at;
      std::uint32_t through;  // the end by which the edge that led here was entered
    };
    constexpr std::uint32_t kStart = std::numeric_limits<std::uint32_t>::max();
    std::vector<Step> stack{{start, kStart}};
    walk.clear();
    while (!stack.empty()) {
      const Vertex at = stack.back().at;
      std::uint32_t& next = next_[at];
      while (next < first_[at + 1] && used_[leaving_[next] / 2]) ++next;
      if (next < first_[at + 1]) {
        const std::uint32_t end = leaving_[next++];
        used_[end / 2] = true;
        stack.push_back({ends_[end ^ 1], end});
      } else {
        if (stack.back().through != kStart) walk.push_back(stack.back().through);
        stack.pop_back();
      }
    }
    std::reverse(walk.begin(), walk.end());
  }

 private:
  std::vector<Vertex> ends_;
  std::size_t count_, lines_ = 0;
  std::vector<std::uint32_t> first_, leaving_, next_;
  std::vector<bool> used_;
};

}  // namespace

Polylines joined(const Polylines& lines) {
  Graph graph(vertices_of(lines));
  Polylines result;
  result.reserve(lines.size(), lines.points().size());
  std::vector<std::uint32_t> walk;
  std::vector<Eigen::Vector2d> chain;
  const auto finish = [&] {
    if (!chain.empty()) result.add(chain);
    chain.clear();
  };
  for (Vertex start = 0; start < graph.vertex_count(); ++start) {
    graph.circuit(start, walk);
    // A circuit is cut where it jumps from one odd vertex to another; it begins after such a jump if it has any.
    const auto jump = std::find_if(walk.begin(), walk.end(), [&](std::uint32_t end) { return !graph.is_line(end); });
    if (jump != walk.end()) std::rotate(walk.begin(), jump + 1, walk.end());
    for (const std::uint32_t end : walk) {
      if (!graph.is_line(end)) {
        finish();
        continue;
      }
      const auto line = lines[end / 2];
      const std::size_t skip = chain.empty() ? 0 : 1;  // the point that the chain has already
      if (end % 2 == 0)
        chain.insert(chain.end(), line.begin() + static_cast<std::ptrdiff_t>(skip), line.end());
      else
        chain.insert(chain.end(), line.rbegin() + static_cast<std::ptrdiff_t>(skip), line.rend());
    }
    finish();
  }
  return result;
}

}  // namespace blackleaf::detail
