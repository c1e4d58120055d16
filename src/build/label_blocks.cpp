#include "label_blocks.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <utility>

#include "blackleaf/curve.h"
#include "label_bits.h"
#include "octree/parallel.h"

namespace blackleaf::detail {
namespace {

constexpr std::uint64_t voxels_of(int level) { return std::uint64_t{1} << (3 * level); }

// Four bits of a coordinate on their places in a Morton number.
constexpr std::array<std::uint16_t, 16> kApart = [] {
  std::array<std::uint16_t, 16> apart{};
  for (unsigned i = 0; i < 16; ++i)
    apart[i] = static_cast<std::uint16_t>((i & 1) | (i & 2) << 2 | (i & 4) << 4 | (i & 8) << 6);
  return apart;
}();

// The table with which the curve enters a node of the universe.
std::uint8_t entry_table(int depth, const Cube& cube) {
  std::uint8_t table = 0;
  for (int bit = depth - 1; bit >= cube.level; --bit)
    table = curve::kDigits[table][static_cast<std::size_t>((cube.x >> bit & 1) | (cube.y >> bit & 1) << 1 |
                                                           (cube.z >> bit & 1) << 2)]
                .table;
  return table;
}

}  // namespace

// The walk through one block.
template <class L>
class LabelBlocks<L>::BlockWalk {
 public:
  BlockWalk(const LabelBlocks& all, const Block& block, Stream& stream) : all_(all), block_(block), stream_(stream) {}

  void node(const Cube& cube, std::uint8_t table, std::size_t first) {
    const std::size_t bricks = std::size_t{1} << (3 * (cube.level - 2));
    const std::uint32_t* const labels = &block_.labels[first];
    if (labels[0] != kMixed && std::all_of(labels + 1, labels + bricks, [&](auto other) { return other == labels[0]; }))
      return add(static_cast<std::uint32_t>(64 * bricks), labels[0]);
    if (cube.level == 2) return brick(all_.values(block_, first, cube.x, cube.y, cube.z), table);
    for (const curve::Step step : curve::kSteps[table])
      node(cube.child(step.octant), step.table, first + step.octant * (bricks / 8));
  }

  // A universe of depth 1 is octant 0 of its only brick.
  void eight_voxels() {
    if (block_.labels[0] != kMixed) return add(8, block_.labels[0]);
    const L* const values = all_.values(block_, 0, 0, 0, 0);
    for (const curve::Step step : curve::kSteps[0]) add(1, values[kOctantRow[step.octant]]);
  }

 private:
  void add(std::uint32_t count, std::uint32_t label) {
    if (!stream_.empty() && stream_.back().label == label)
      stream_.back().count += count;
    else
      stream_.push_back({count, label});
  }

  void brick(const L* values, std::uint8_t table) {
    const CurveOrder<L> ordered(values, table);
    std::uint64_t borders = ordered.borders();
    std::uint32_t begin = 0;
    for (; borders != 0; borders &= borders - 1) {
      const auto end = static_cast<std::uint32_t>(std::countr_zero(borders));
      add(end - begin, ordered[begin]);
      begin = end;
    }
    add(64 - begin, ordered[begin]);
  }

  const LabelBlocks& all_;
  const Block& block_;
  Stream& stream_;
};

template <class L>
LabelBlocks<L>::LabelBlocks(int depth, const std::array<std::int64_t, 3>& low, const std::array<std::int64_t, 3>& high)
    : depth_(depth), level_(std::min(depth, kBlockLevel)), low_(low), high_(high) {
  assert(depth >= 1 && depth <= kMaxDepth);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    assert(0 <= low[axis] && low[axis] < high[axis] && high[axis] <= std::int64_t{1} << depth);
    first_[axis] = low[axis] >> kBlockLevel;
    count_[axis] = ((high[axis] - 1) >> kBlockLevel) + 1 - first_[axis];
  }
  nothing_.resize(static_cast<std::size_t>(high[0] - low[0]));
  blocks_.resize(static_cast<std::size_t>(count_[0] * count_[1]));
  mixed_.resize(static_cast<std::size_t>(16 * (last_strip() - first_strip())));
}

template <class L>
std::size_t LabelBlocks<L>::morton(std::int64_t x, std::int64_t y, std::int64_t z) {
  return static_cast<std::size_t>(kApart[static_cast<std::size_t>(x & 15)] |
                                  kApart[static_cast<std::size_t>(y & 15)] << 1 |
                                  kApart[static_cast<std::size_t>(z & 15)] << 2);
}

template <class L>
const L* LabelBlocks<L>::values(const Block& block, std::size_t brick, std::int64_t, std::int64_t y,
                                std::int64_t z) const {
  const std::int64_t strips = last_strip() - first_strip();
  const auto strip = static_cast<std::size_t>((y >> 2) - first_strip() + strips * (z >> 2 & 15));
  return &mixed_[strip][std::size_t{64} * block.where[brick]];
}

template <class L>
void LabelBlocks<L>::set(std::int64_t strip, std::int64_t layer, const Rows& given) {
  assert(layer >> 4 == first_[2] + slab_ && strip >= first_strip() && strip < last_strip());
  std::array<const L*, 16> rows;
  for (std::size_t row = 0; row < 16; ++row) rows[row] = given[row] != nullptr ? given[row] : nothing_.data();
  std::vector<L>& mixed =
      mixed_[static_cast<std::size_t>(strip - first_strip() + (last_strip() - first_strip()) * (layer & 15))];
  mixed.clear();
  Block* const blocks = &blocks_[static_cast<std::size_t>(count_[0] * ((strip >> 4) - first_[1]))];
  const std::size_t yz = morton(0, strip, layer);

  // What does not fill vectors of whole bricks, at either end, is first copied into rows of zeros.
  using Vector = LabelVector<L>;
  constexpr std::int64_t kWidth = 4 * Vector::kBricks;
  const auto padded = [&](std::int64_t brick, std::int64_t x0, std::int64_t x1, std::int64_t end) {
    std::array<std::array<L, static_cast<std::size_t>(kWidth)>, 16> copies{};
    std::array<const L*, 16> copied;
    for (std::size_t row = 0; row < 16; ++row) {
      std::copy(rows[row] + (x0 - low_[0]), rows[row] + (x1 - low_[0]),
                &copies[row][static_cast<std::size_t>(x0 - 4 * brick)]);
      copied[row] = copies[row].data();
    }
    classify(copied, brick, 1, end, yz, blocks, mixed);
  };
  std::int64_t brick = low_[0] >> 2;
  const std::int64_t end = (high_[0] + 3) >> 2;
  if ((low_[0] & 3) != 0) {
    padded(brick, low_[0], std::min(high_[0], 4 * (brick + 1)), brick + 1);
    ++brick;
  }
  if (const std::int64_t vectors = (high_[0] - 4 * brick) / kWidth; vectors > 0) {
    std::array<const L*, 16> here;
    for (std::size_t row = 0; row < 16; ++row) here[row] = rows[row] + (4 * brick - low_[0]);
    classify(here, brick, vectors, end, yz, blocks, mixed);
    brick += vectors * Vector::kBricks;
  }
  if (brick < end) padded(brick, 4 * brick, high_[0], end);
}

// Bricks [brick, end), or as many of them as so many vectors hold.
template <class L>
void LabelBlocks<L>::classify(const std::array<const L*, 16>& rows, std::int64_t brick, std::int64_t vectors,
                              std::int64_t end, std::size_t yz, Block* blocks, std::vector<L>& mixed) const {
  using Vector = LabelVector<L>;
  const std::int64_t first_x = 16 * first_[0];
  for (std::int64_t v = 0; v < vectors; ++v) {
    const std::int64_t offset = v * 4 * Vector::kBricks;
    const Vector first(rows[0] + offset);
    Vector difference = first.neighbours();
#pragma GCC unroll 16
    for (std::size_t row = 1; row < 16; ++row) difference.mark(first, Vector(rows[row] + offset));
    for (std::int64_t i = 0; i < Vector::kBricks && brick < end; ++i, ++brick) {
      Block& block = blocks[(brick - first_x) >> 4];
      const std::size_t number = yz | kApart[static_cast<std::size_t>(brick & 15)];
      const std::int64_t at = offset + 4 * i;
      const std::uint32_t label = rows[0][at];
      if (difference.is_zero(i) && label != kMixed) {
        block.labels[number] = label;
        continue;
      }
      block.labels[number] = kMixed;
      block.where[number] = static_cast<std::uint32_t>(mixed.size() / 64);
      std::array<L, 64> values;
      for (std::size_t row = 0; row < 16; ++row) std::memcpy(&values[4 * row], rows[row] + at, 4 * sizeof(L));
      mixed.insert(mixed.end(), values.begin(), values.end());
    }
  }
}

template <class L>
typename LabelBlocks<L>::Stream LabelBlocks<L>::stream(std::size_t index) const {
  const std::int64_t x = static_cast<std::int64_t>(index) % count_[0], y = static_cast<std::int64_t>(index) / count_[0];
  const auto corner = [&](std::int64_t i, std::size_t axis) {
    return static_cast<std::int32_t>((first_[axis] + i) << kBlockLevel);
  };
  const Cube cube{corner(x, 0), corner(y, 1), corner(slab_, 2), level_};
  Stream stream;
  BlockWalk walk(*this, blocks_[index], stream);
  if (level_ == 1)
    walk.eight_voxels();
  else
    walk.node(cube, entry_table(depth_, cube), 0);
  stream.shrink_to_fit();
  return stream;
}

template <class L>
void LabelBlocks<L>::close_slab(const Work& work) {
  assert(slab_ < count_[2]);
  const std::size_t begin = streams_.size();
  streams_.resize(begin + blocks_.size());
  for_each_index(blocks_.size(), work, [&](std::size_t i) {
    streams_[begin + i] = stream(i);
    blocks_[i].labels.fill(0);  // for strips that the next slab lacks
  });
  ++slab_;
}

template <class L>
LabelMap LabelBlocks<L>::join(Frame frame) {
  assert(slab_ == count_[2]);
  LabelMapBuilder builder(depth_);
  std::size_t runs = 0;
  for (const Stream& stream : streams_) runs += stream.size();
  builder.reserve(runs + 1);
  const auto node = [&](const auto& self, const Cube& cube, std::uint8_t table) -> void {
    const std::array<std::int64_t, 3> corner = {cube.x, cube.y, cube.z};
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (corner[axis] >= high_[axis] || corner[axis] + cube.side() <= low_[axis])
        return builder.add(voxels_of(cube.level), 0);
    if (cube.level > level_) {
      for (const curve::Step step : curve::kSteps[table]) self(self, cube.child(step.octant), step.table);
      return;
    }
    std::array<std::int64_t, 3> place{};
    for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = (corner[axis] >> kBlockLevel) - first_[axis];
    Stream& stream = streams_[static_cast<std::size_t>(place[0] + count_[0] * (place[1] + count_[1] * place[2]))];
    for (const BlockRun run : stream) builder.add(run.count, run.label);
    stream = {};
  };
  node(node, {0, 0, 0, depth_}, 0);
  return builder.finish(std::move(frame));
}

template class LabelBlocks<std::uint8_t>;
template class LabelBlocks<std::uint16_t>;
template class LabelBlocks<std::uint32_t>;

}  // namespace blackleaf::detail
