#include "papers/mhf92.h"

#include <cassert>

#include "blackleaf/implicit.h"

namespace blackleaf::papers::mhf92 {
namespace {

struct ConverseRow {
  std::uint8_t digits, next;
};

// The converse tables (Figure 6), by xyz triplet: x is the leading bit of the key.
constexpr std::array<std::array<ConverseRow, 8>, 24> kConverse = [] {
  std::array<std::array<ConverseRow, 8>, 24> converse{};
  for (std::size_t t = 0; t < 24; ++t)
    for (std::size_t digits = 0; digits < 8; ++digits) {
      const Row& row = kTables[t][digits];
      converse[t][static_cast<std::size_t>(4 * row.x + 2 * row.y + row.z)] = {static_cast<std::uint8_t>(digits),
                                                                              row.next};
    }
  return converse;
}();

}  // namespace

Coordinates node_no_to_xyz(int order, std::uint64_t number, const Tables& tables) {
  assert(order >= 1 && order <= kMaxDepth && number >> (3 * order) == 0);
  Coordinates at;
  std::size_t table = 1;
  for (int triple = order - 1; triple >= 0; --triple) {
    const Row& row = tables[table - 1][number >> (3 * triple) & 7];
    at = {at.x << 1 | row.x, at.y << 1 | row.y, at.z << 1 | row.z};
    table = row.next;
  }
  return at;
}

std::uint64_t xyz_to_node_no(int order, const Coordinates& at) {
  assert(order >= 1 && order <= kMaxDepth && (at.x | at.y | at.z) >> order == 0);
  std::uint64_t number = 0;
  std::size_t table = 1;
  for (int bit = order - 1; bit >= 0; --bit) {
    const ConverseRow row = kConverse[table - 1][(at.x >> bit & 1) << 2 | (at.y >> bit & 1) << 1 | (at.z >> bit & 1)];
    number = number << 3 | row.digits;
    table = row.next;
  }
  return number;
}

std::vector<Tuple> data_stream_joiner(std::span<const std::vector<Tuple>> streams) {
  std::vector<Tuple> joined;
  for (const std::vector<Tuple>& stream : streams) {
    auto next = stream.begin();
    if (!joined.empty() && next != stream.end() && joined.back().datum == next->datum)
      joined.back().count += next++->count;
    joined.insert(joined.end(), next, stream.end());
  }
  return joined;
}

std::vector<CubicTuple> cubic_numbers(std::span<const Tuple> stream) {
  std::vector<CubicTuple> cubes;
  std::uint64_t walked = 0;
  for (Tuple tuple : stream) {
    while (tuple.count > 0) {
      int level = 0;
      std::uint64_t size = 1;
      while (level < kMaxDepth && walked % (8 * size) == 0 && 8 * size <= tuple.count) {
        size *= 8;
        ++level;
      }
      cubes.push_back({level, tuple.datum});
      walked += size;
      tuple.count -= size;
    }
  }
  return cubes;
}

Tree::Tree(int order, std::span<const Tuple> stream) : depth_(order) {
  const std::vector<CubicTuple> cubes = cubic_numbers(stream);
  auto next = cubes.begin();
  // Neighbouring tuples differ, so a cubic number of the node's own size is all of the node, and a smaller one means
  // that the node is of several colours.
  const auto form = [&](const auto& self, int level, std::size_t table) -> Link {
    assert(next != cubes.end() && next->level <= level);
    if (next->level == level) return {nullptr, next++->datum};
    Node* node = pool_->take();
    for (const Row& row : kTables[table - 1])
      node->child[static_cast<std::size_t>(row.x + 2 * row.y + 4 * row.z)] = self(self, level - 1, row.next);
    return {node, 0};
  };
  root_ = form(form, depth_, 1);
  assert(next == cubes.end());
}

std::uint32_t Tree::datum(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
  Link link = root_;
  for (int bit = depth_ - 1; link.node != nullptr; --bit)
    link = link.node->child[(x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2];
  return link.datum;
}

Octree Tree::octree(const std::function<bool(std::uint32_t)>& is_black) const {
  return octree_from_classifier(depth_, [&](const Cube& cube) {
    Link link = root_;
    for (int bit = depth_ - 1; bit >= cube.level && link.node != nullptr; --bit)
      link = link.node->child[static_cast<std::size_t>((cube.x >> bit & 1) | (cube.y >> bit & 1) << 1 |
                                                       (cube.z >> bit & 1) << 2)];
    if (link.node != nullptr) return Colour::gray;
    return is_black(link.datum) ? Colour::black : Colour::white;
  });
}

}  // namespace blackleaf::papers::mhf92
