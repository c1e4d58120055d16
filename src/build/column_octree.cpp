// Octrees of what the columns of a closed mesh leave, without a dense volume.
//
// The columns (columns.h) leave black stretches of bricks and bricks of two colours. Laid out on the Millar curve, a
// brick is *explicit* if it has two colours, or if it is black and shares a face with a brick that is white. Between
// two explicit bricks the curve does not change colour: consecutive bricks share a face, so a change between two plain
// bricks would make the black one explicit. The sorted explicit bricks, each with the colour of the gap behind it, are
// thus the whole solid; a node without explicit bricks has the colour of the gap that it lies in.
#include "column_octree.h"

#include <algorithm>
#include <limits>

#include "blackleaf/curve.h"
#include "octree/parallel.h"
#include "octree/produce.h"

namespace blackleaf::detail {
namespace {

struct ExplicitBrick {
  std::uint64_t number;  // on the curve of bricks
  std::uint64_t bits;
  friend bool operator<(const ExplicitBrick& a, const ExplicitBrick& b) { return a.number < b.number; }
  friend bool operator==(const ExplicitBrick&, const ExplicitBrick&) = default;
};

std::uint64_t brick_number(int order, std::int32_t x, std::int32_t y, std::int32_t z) {
  return curve::first_number(order, {4 * x, 4 * y, 4 * z, 2}) >> 6;
}

// Calls visit(first, last) for the parts of [first, last) outside the stretches from `begin` on. Leaves `begin` at the
// first stretch that can meet a later part. Requires: stretches are increasing.
template <class Visit>
void for_each_gap(std::int32_t first, std::int32_t last, const ColumnStretch*& begin, const ColumnStretch* end,
                  const Visit& visit) {
  while (begin != end && begin->last <= first) ++begin;
  for (const ColumnStretch* s = begin; first < last; ++s) {
    const std::int32_t stop = s == end ? last : std::min(last, s->first);
    if (first < stop) visit(first, stop);
    if (s == end) break;
    first = s->last;
  }
}

class Explicit {
 public:
  Explicit(const Slabs& slabs, int depth, const Work& work)
      : slabs_(slabs), order_(std::max(depth, 2)), side_(1 << (order_ - 2)) {
    std::vector<std::vector<ExplicitBrick>> parts(slabs.slabs.size());
    for_each_index(parts.size(), work, [&](std::size_t i) { collect(i, parts[i]); });
    std::size_t size = 0;
    for (const auto& part : parts) size += part.size();
    bricks_.reserve(size);
    for (auto& part : parts) {
      bricks_.insert(bricks_.end(), part.begin(), part.end());
      part = {};
    }
    sort(bricks_, work);
    bricks_.erase(std::unique(bricks_.begin(), bricks_.end()), bricks_.end());
    gaps_.resize(bricks_.size() + 1);
    gaps_[0] = is_black(0);
    // In blocks, so that progress and scheduling cost little.
    constexpr std::size_t kBlock = 4096;
    for_each_index((bricks_.size() + kBlock - 1) / kBlock, {work.threads, {}}, [&](std::size_t block) {
      const std::size_t last = std::min(bricks_.size(), (block + 1) * kBlock);
      for (std::size_t i = block * kBlock; i < last; ++i) gaps_[i + 1] = gap_behind(i);
    });
  }

  const std::vector<ExplicitBrick>& bricks() const { return bricks_; }
  /// The colour of the bricks between explicit bricks i - 1 and i, if there are any.
  Colour gap_before(std::size_t i) const { return gaps_[i] ? Colour::black : Colour::white; }

 private:
  void collect(std::size_t index, std::vector<ExplicitBrick>& out) const {
    const Slab& slab = slabs_.slabs[index];
    const std::int32_t z = slabs_.first + static_cast<std::int32_t>(index);
    for (const MixedBrick& brick : slab.mixed) out.push_back({brick_number(order_, brick.x, brick.y, z), brick.bits});
    const Slab none;
    const Slab& below = index > 0 ? slabs_.slabs[index - 1] : none;
    const Slab& above = index + 1 < slabs_.slabs.size() ? slabs_.slabs[index + 1] : none;
    for (std::size_t i = 0; i < slab.columns.size(); ++i) {
      const std::int32_t y = slab.columns[i].y;
      const auto mark = [&](std::int32_t first, std::int32_t last) {
        for (std::int32_t x = first; x < last; ++x) out.push_back({brick_number(order_, x, y, z), ~std::uint64_t{0}});
      };
      const ColumnStretch *const begin = slab.begin_of(i), *const end = slab.end_of(i);
      for (const ColumnStretch* s = begin; s != end; ++s) {
        if (!s->black) continue;
        if (s->first > 0 && (s == begin || s[-1].last < s->first)) mark(s->first, s->first + 1);
        if (s->last < side_ && (s + 1 == end || s[1].first > s->last)) mark(s->last - 1, s->last);
      }
      if (y > 0) mark_beside(begin, end, slab, y - 1, mark);
      if (y + 1 < side_) mark_beside(begin, end, slab, y + 1, mark);
      if (z > 0) mark_beside(begin, end, below, y, mark);
      if (z + 1 < side_) mark_beside(begin, end, above, y, mark);
    }
  }

  // Marks the black bricks of a column that have a white neighbour in another column.
  template <class Mark>
  static void mark_beside(const ColumnStretch* begin, const ColumnStretch* end, const Slab& slab, std::int32_t y,
                          const Mark& mark) {
    const std::size_t column = slab.find(y);
    const bool any = column < slab.columns.size();
    const ColumnStretch* other = any ? slab.begin_of(column) : nullptr;
    const ColumnStretch* const other_end = any ? slab.end_of(column) : nullptr;
    for (; begin != end; ++begin)
      if (begin->black) for_each_gap(begin->first, begin->last, other, other_end, mark);
  }

  // Whether a brick that is not explicit is black.
  bool is_black(std::uint64_t number) const {
    const Cube cube = curve::cube(order_, number << 6, 2);
    const std::int64_t index = std::int64_t{cube.z >> 2} - slabs_.first;
    if (index < 0 || index >= static_cast<std::int64_t>(slabs_.slabs.size())) return false;
    const Slab& slab = slabs_.slabs[static_cast<std::size_t>(index)];
    const std::size_t column = slab.find(cube.y >> 2);
    if (column == slab.columns.size()) return false;
    const std::int32_t x = cube.x >> 2;
    const ColumnStretch* const end = slab.end_of(column);
    const ColumnStretch* const at =
        std::partition_point(slab.begin_of(column), end, [x](const ColumnStretch& s) { return s.last <= x; });
    return at != end && at->first <= x && at->black;
  }

  bool gap_behind(std::size_t i) const {
    const std::uint64_t next = bricks_[i].number + 1;
    const bool gap = i + 1 < bricks_.size() ? bricks_[i + 1].number != next : next >> 3 * (order_ - 2) == 0;
    return gap && is_black(next);
  }

  const Slabs& slabs_;
  const int order_;          // of the curve of voxels
  const std::int32_t side_;  // of the universe in bricks
  std::vector<ExplicitBrick> bricks_;
  std::vector<std::uint8_t> gaps_;
};

// A node is the range of explicit bricks in it.
struct ExplicitProducer {
  struct Task {
    std::size_t low, high;  // explicit bricks [low, high)
    std::uint64_t first;    // number of the node's first brick
    std::uint8_t table;     // of the curve in the node
  };
  const Explicit& source;
  const bool complement;

  Task root() const { return {0, source.bricks().size(), 0, 0}; }
  Colour classify(const Task& task, const Cube&) const {
    if (task.low != task.high) return Colour::gray;
    const bool black = source.gap_before(task.low) == Colour::black;
    return black != complement ? Colour::black : Colour::white;
  }
  Task child(const Task& task, const Cube& cube, int octant) const {
    const curve::Step digit = curve::kDigits[task.table][static_cast<std::size_t>(octant)];
    const std::uint64_t size = std::uint64_t{1} << 3 * (cube.level - 2);
    const std::uint64_t first = task.first + digit.octant * size;
    return {lower_bound(task, first), lower_bound(task, first + size), first, digit.table};
  }
  std::uint64_t brick(const Task& task, const Cube&) const {
    const std::uint64_t bits = source.bricks()[task.low].bits;
    return complement ? ~bits : bits;
  }

 private:
  std::size_t lower_bound(const Task& task, std::uint64_t number) const {
    const auto begin = source.bricks().begin();
    return static_cast<std::size_t>(std::lower_bound(begin + static_cast<std::ptrdiff_t>(task.low),
                                                     begin + static_cast<std::ptrdiff_t>(task.high),
                                                     ExplicitBrick{number, 0}) -
                                    begin);
  }
};

}  // namespace

Octree octree_of_columns(const Slabs& slabs, int depth, const Frame& frame, bool complement, const Work& work) {
  const Explicit bricks(slabs, depth, part_of(work, 0, 0.5));
  return produce(ExplicitProducer{bricks, complement}, depth, frame, part_of(work, 0.5, 1));
}

}  // namespace blackleaf::detail
