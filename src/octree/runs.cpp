#include "blackleaf/runs.h"

#include <algorithm>
#include <bit>
#include <string>

#include "blackleaf/curve.h"
#include "blackleaf/error.h"
#include "brick.h"
#include "node_arrays.h"

namespace blackleaf {
namespace {

using detail::NodeArrays;
using detail::Subtree;

constexpr std::uint64_t voxels_of(int level) { return std::uint64_t{1} << (3 * level); }

// Merges neighbouring runs of one colour and passes them on.
template <class Visit>
class Merger {
 public:
  explicit Merger(Visit& visit) : visit_(visit) {}
  void add(std::uint64_t count, bool black) {
    if (count == 0) return;
    if (black != black_ && count_ > 0) flush();
    black_ = black;
    count_ += count;
  }
  void flush() {
    if (count_ > 0) visit_(count_, black_);
    count_ = 0;
  }

 private:
  Visit& visit_;
  std::uint64_t count_ = 0;
  bool black_ = false;
};

template <class Visit>
void walk(const Node& node, std::uint8_t table, Merger<Visit>& out) {
  if (!node.is_gray()) {
    out.add(voxels_of(node.level()), node.is_black());
  } else if (node.level() == 2) {
    std::uint64_t bits = detail::to_curve_order(node.word(), table);
    for (int left = 64; left > 0;) {
      const bool black = bits & 1;
      const int count = std::min(left, black ? std::countr_one(bits) : std::countr_zero(bits));
      out.add(static_cast<std::uint64_t>(count), black);
      bits = count < 64 ? bits >> count : 0;
      left -= count;
    }
  } else {
    for (const curve::Step step : curve::kSteps[table]) walk(node.child(step.octant), step.table, out);
  }
}

template <class Visit>
void visit_runs(const Octree& octree, Visit&& visit) {
  Merger<std::remove_reference_t<Visit>> merger(visit);
  walk(octree.root(), 0, merger);
  merger.flush();
}

// Builds the tree from the root down, taking from the stream what each node needs. Source: bool(uint64_t&, bool&).
template <class Source>
class Reader {
 public:
  Reader(Source& source, int depth) : source_(source), depth_(depth) {}

  Octree read(Frame frame) {
    const Subtree root = depth_ == 1 ? byte(0) : node(depth_, 0);
    std::uint64_t extra = count_;
    for (std::uint64_t count = 0; extra == 0 && next(count);) extra = count;
    if (extra > 0)
      throw Error(ErrorCode::bad_input,
                  "the stream is longer than the 8^" + std::to_string(depth_) + " voxels of its universe",
                  "give the depth it was made for");
    return arrays_.finish(depth_, root, std::move(frame));
  }

 private:
  bool next(std::uint64_t& count) { return source_(count, next_black_); }

  // Makes count_ the rest of the current run, with as many equal neighbours as needed to reach `wanted`.
  void fill(std::uint64_t wanted) {
    while (count_ < wanted) {
      if (pending_ == 0) {
        std::uint64_t count = 0;
        if (!next(count)) break;
        pending_ = count;
      }
      if (pending_ == 0) continue;
      if (count_ > 0 && next_black_ != black_) return;
      black_ = next_black_;
      if (pending_ > voxels_of(kMaxDepth))
        pending_ = voxels_of(kMaxDepth) + 1;  // too long in any universe; no overflow
      count_ += pending_;
      pending_ = 0;
    }
    if (count_ == 0)
      throw Error(ErrorCode::bad_input,
                  "the stream ends before the 8^" + std::to_string(depth_) + " voxels of its universe are told",
                  "give the depth it was made for");
  }

  Subtree node(int level, std::uint8_t table) {
    const std::uint64_t voxels = voxels_of(level);
    fill(voxels);
    if (count_ >= voxels) {
      count_ -= voxels;
      return Subtree::uniform(black_ ? Colour::black : Colour::white);
    }
    if (level == 2) return Subtree::brick(detail::from_curve_order(bits(64), table));
    std::array<Subtree, 8> children;
    for (const curve::Step step : curve::kSteps[table]) children[step.octant] = node(level - 1, step.table);
    return arrays_.close(level, children);
  }

  // The next `wanted` voxels in curve order.
  std::uint64_t bits(unsigned wanted) {
    std::uint64_t result = 0;
    for (unsigned at = 0; at < wanted;) {
      fill(1);
      const auto take = static_cast<unsigned>(std::min<std::uint64_t>(count_, wanted - at));
      if (black_) result |= (take == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << take) - 1) << at;
      count_ -= take;
      at += take;
    }
    return result;
  }

  Subtree byte(std::uint8_t table) {
    const std::uint64_t in_order = bits(8);
    std::uint64_t byte = 0;
    for (unsigned i = 0; i < 8; ++i) byte |= (in_order >> i & 1) << curve::kSteps[table][i].octant;
    return {byte, byte == 0 ? Colour::white : byte == 0xFF ? Colour::black : Colour::gray};
  }

  Source& source_;
  const int depth_;
  std::uint64_t count_ = 0, pending_ = 0;  // voxels left of the current run; a run read but not yet begun
  bool black_ = false, next_black_ = false;
  NodeArrays arrays_;
};

template <class Source>
Octree read(Source&& source, int depth, Frame frame) {
  if (depth < 1 || depth > kMaxDepth)
    throw Error(ErrorCode::bad_argument, "depth " + std::to_string(depth) + " is out of range", "use 1 to 20");
  return Reader<std::remove_reference_t<Source>>(source, depth).read(std::move(frame));
}

}  // namespace

void for_each_run(const Octree& octree, const std::function<void(std::uint64_t, bool)>& visit) {
  visit_runs(octree, visit);
}

std::vector<Run> runs(const Octree& octree) {
  std::vector<Run> result;
  visit_runs(octree, [&](std::uint64_t count, bool black) { result.push_back({count, black ? 1u : 0u}); });
  return result;
}

std::vector<std::uint64_t> monochrome(const Octree& octree) {
  std::vector<std::uint64_t> counts;
  visit_runs(octree, [&](std::uint64_t count, bool black) {
    if (counts.empty() && !black) counts.push_back(0);
    counts.push_back(count);
  });
  return counts;
}

Octree octree_from_runs(std::span<const Run> runs, int depth, Frame frame,
                        const std::function<bool(std::uint32_t)>& is_black) {
  std::size_t at = 0;
  return read(
      [&](std::uint64_t& count, bool& black) {
        if (at == runs.size()) return false;
        count = runs[at].count;
        black = is_black ? is_black(runs[at].colour) : runs[at].colour != 0;
        ++at;
        return true;
      },
      depth, std::move(frame));
}

Octree octree_from_monochrome(std::span<const std::uint64_t> counts, int depth, Frame frame) {
  std::size_t at = 0;
  return read(
      [&](std::uint64_t& count, bool& black) {
        if (at == counts.size()) return false;
        count = counts[at];
        black = at % 2 == 0;
        ++at;
        return true;
      },
      depth, std::move(frame));
}

Octree octree_from_source(const RunSource& source, int depth, Frame frame) {
  return read(source, depth, std::move(frame));
}

std::vector<CubeRun> cubes(std::span<const Run> runs) {
  std::vector<CubeRun> result;
  std::uint64_t at = 0;
  for (std::size_t i = 0; i < runs.size();) {
    const std::uint32_t colour = runs[i].colour;
    std::uint64_t left = 0;
    for (; i < runs.size() && runs[i].colour == colour; ++i) left += runs[i].count;
    while (left > 0) {
      int level = at == 0 ? kMaxDepth : std::countr_zero(at) / 3;
      while (voxels_of(level) > left) --level;
      result.push_back({level, colour});
      at += voxels_of(level);
      left -= voxels_of(level);
    }
  }
  return result;
}

}  // namespace blackleaf
