#include "shift_producer.h"

#include <algorithm>
#include <bit>

#include "relabelled.h"
#include "shift_kernel.h"

namespace blackleaf::detail {
namespace {

// Octants as bits 0..7 of a mask to the same as places x + 4 y + 16 z of 2^3 among 4^3.
constexpr auto kPlaces = [] {
  std::array<std::uint32_t, 256> places{};
  for (unsigned mask = 0; mask < 256; ++mask)
    for (unsigned octant = 0; octant < 8; ++octant)
      if ((mask >> octant & 1) != 0)
        places[mask] |= std::uint32_t{1} << ((octant & 1) + 4 * (octant >> 1 & 1) + 16 * (octant >> 2));
  return places;
}();

// And back, of the lowest place.
constexpr unsigned octants(std::uint64_t places) {
  std::uint64_t bits = places & 0x330033;
  bits = (bits | bits >> 2) & 0xF000F;
  return static_cast<unsigned>((bits | bits >> 12) & 0xFF);
}

// By axis: how far into its lower source cell a target node of the given level begins.
std::array<unsigned, 3> begin(const std::array<std::int64_t, 3>& by, int level) {
  std::array<unsigned, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = static_cast<unsigned>(-by[i] & ((std::int64_t{1} << level) - 1));
  return result;
}

}  // namespace

ShiftProducer::ShiftProducer(const std::array<std::int64_t, 3>& by, const Octree& source, int depth)
    : source_(source), block_shift_(begin(by, 2)) {
  const int top = std::max(depth, 3);
  static constexpr std::uint64_t kNone = 0;
  for (int k = 2; k <= source.depth(); ++k) counts_[static_cast<std::size_t>(k)] = source.words(k).size();
  for (int k = 0; k < source_.level(); ++k) {
    const bool none = source.depth() < 3 ? source_.words(k) == nullptr : source.words(k).empty();
    words_[static_cast<std::size_t>(k)] = none ? &kNone : source_.words(k);
  }
  for (int k = source_.level(); k <= top; ++k) {
    const auto level = static_cast<std::size_t>(k);
    above_[level] = 0x100;  // octant 0 is gray, the rest white
    if (k <= source_.level() + 1 && source_.root() == SourceTree::kBlack) above_[level] = 0x01;
    if (k == source_.level()) above_[level] = source_.root();
    words_[level] = &above_[level];
  }
  for (int k = 3; k <= top; ++k) {
    Level& level = levels_[static_cast<std::size_t>(k)];
    const std::array<unsigned, 3> start = begin(by, k), child_start = begin(by, k - 1);
    for (unsigned i = 0; i < 3; ++i) level.first |= start[i] >> (k - 1) << i;
    level.places = (level.first & 1) + 4 * (level.first >> 1 & 1) + 16 * (level.first >> 2);
    level.one_cell = (start[0] | start[1] | start[2]) == 0;
    level.x = child_start[0] != 0 ? 1 : 0;
    level.y = child_start[1] != 0 ? 4 : 0;
    level.z = child_start[2] != 0 ? 16 : 0;
  }
  // At the root's level the source is cell (0, 0, 0).
  std::size_t cell = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t low = -by[i] >> top;
    if (low != 0 && low != -1) return;
    cell |= (low == 0 ? 0u : 1u) << i;
  }
  root_[cell] = above_[static_cast<std::size_t>(top)];
}

void ShiftProducer::reserve(NodeArrays& arrays) const {
  for (int k = 2; k <= source_.level(); ++k) {
    const std::size_t count = counts_[static_cast<std::size_t>(k)];
    arrays.reserve(k, count + count / 16);
  }
}

ShiftProducer::Cells ShiftProducer::alone(const Task& task) {
  Cells cells{};
  for (std::size_t i = 0; i < 8; ++i) cells[8 * i] = task[i];
  return cells;
}

ShiftProducer::Colours ShiftProducer::children(const std::uint64_t* cells, int level) const {
  std::uint64_t all = 0, some = 0;
  for (unsigned i = 0; i < 8; ++i) {
    const unsigned place = 2 * (i & 1) + 8 * (i >> 1 & 1) + 32 * (i >> 2);
    all |= std::uint64_t{kPlaces[cells[8 * i] & 0xFF]} << place;
    some |= std::uint64_t{kPlaces[cells[8 * i] >> 8 & 0xFF]} << place;
  }
  some |= all;
  const Level& on = levels_[static_cast<std::size_t>(level)];
  for (const unsigned step : {on.x, on.y, on.z}) {
    all &= all >> step;
    some |= some >> step;
  }
  const unsigned black = octants(all >> on.places);
  return {black, octants(some >> on.places) & ~black};
}

Colour ShiftProducer::classify(const Task& task, const Cube& cube) const {
  const Colours colours = children(alone(task).data(), cube.level);
  if (colours.mixed == 0 && colours.black == 0) return Colour::white;
  return colours.black == 0xFF ? Colour::black : Colour::gray;
}

ShiftProducer::Task ShiftProducer::child(const Task& task, const Cube& cube, int octant) const {
  const auto level = static_cast<std::size_t>(cube.level) + 1;
  Cells below;
  cells_below(alone(task).data(), words_[level - 1], levels_[level].first, below.data());
  Task result;
  for (std::size_t i = 0; i < 8; ++i) result[i] = below[8 * i + static_cast<std::size_t>(octant)];
  return result;
}

Subtree ShiftProducer::subtree(const Task& task, const Cube& cube, std::uint8_t table, NodeArrays& arrays) const {
  if (cube.level >= 3) return node(alone(task).data(), cube.level, table, arrays);
  std::array<std::uint64_t, 8> bricks;
  shifted_bricks(alone(task).data(), words_[2], levels_[3].first, block_shift_, bricks.data());
  return Subtree::brick(bricks[0]);
}

Subtree ShiftProducer::bricks(const std::uint64_t* cells, NodeArrays& arrays) const {
  std::array<std::uint64_t, 8> bits, words;
  shifted_bricks(cells, words_[2], levels_[3].first, block_shift_, bits.data());
  unsigned black = 0, gray = 0;
  std::size_t count = 0;
  for (unsigned octant = 0; octant < 8; ++octant) {
    const bool full = ~bits[octant] == 0, mixed = !full && bits[octant] != 0;
    black |= (full ? 1u : 0u) << octant;
    gray |= (mixed ? 1u : 0u) << octant;
    words[count] = bits[octant];
    count += mixed ? 1 : 0;
  }
  return arrays.close(3, black, gray, {words.data(), count});
}

Subtree ShiftProducer::node(const std::uint64_t* cells, int level, std::uint8_t table, NodeArrays& arrays) const {
  const auto k = static_cast<std::size_t>(level);
  if (levels_[k].one_cell) return RelabelledCopy<SameLabels>(words_.data(), {}).node(cells[0], level, table, arrays);
  if (level == 3) return bricks(cells, arrays);
  const Colours colours = children(cells, level);
  unsigned black = colours.black, gray = 0;
  std::array<std::uint64_t, 8> words;
  std::size_t count = 0;
  if (colours.mixed != 0) {
    Cells below;
    cells_below(cells, words_[k - 1], levels_[k].first, below.data());
    std::array<std::uint64_t, 8> by_octant;
    for (const curve::Step step : curve::kSteps[table]) {
      if ((colours.mixed >> step.octant & 1) == 0) continue;
      const Subtree child = node(&below[step.octant], level - 1, step.table, arrays);
      black |= (child.colour == Colour::black ? 1u : 0u) << step.octant;
      gray |= (child.colour == Colour::gray ? 1u : 0u) << step.octant;
      by_octant[step.octant] = child.word;
    }
    for (unsigned rest = gray; rest != 0; rest &= rest - 1)
      words[count++] = by_octant[static_cast<std::size_t>(std::countr_zero(rest))];
  }
  return arrays.close(level, black, gray, {words.data(), count});
}

}  // namespace blackleaf::detail
