#include "blackleaf/octree.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "brick.h"
#include "node_arrays.h"
#include "storage.h"

namespace blackleaf {

Octree::Octree(int depth, Colour colour, Frame frame)
    : storage_(std::make_shared<const Storage>(Storage{depth, colour, nullptr, std::move(frame)})) {
  assert(depth >= 1 && depth <= kMaxDepth && colour != Colour::gray);
}

Octree::Octree(std::shared_ptr<const Storage> storage) : storage_(std::move(storage)) {}

int Octree::depth() const { return storage_->depth; }

const Frame& Octree::frame() const { return storage_->frame; }

Octree Octree::with_frame(Frame frame) const {
  Storage storage = *storage_;
  storage.frame = std::move(frame);
  return Octree(std::make_shared<const Storage>(std::move(storage)));
}

Node Octree::root() const {
  const Storage& s = *storage_;
  if (s.root != Colour::gray) return Node::uniform(s.depth, s.root);
  const auto level = static_cast<std::size_t>(s.depth);
  return Node(s.tree->levels.data(), *s.tree->levels[level], s.depth, Colour::gray);
}

// The descent of Node::child without a cursor: from the directory, and colours are told apart once, at the end.
bool Octree::contains(std::int64_t x, std::int64_t y, std::int64_t z) const {
  using detail::Directory;
  const Storage& s = *storage_;
  if ((static_cast<std::uint64_t>(x) | static_cast<std::uint64_t>(y) | static_cast<std::uint64_t>(z)) >> s.depth != 0)
    return false;
  if (s.root != Colour::gray) return s.root == Colour::black;
  const auto& levels = s.tree->levels;
  auto level = static_cast<std::size_t>(s.depth);
  std::uint64_t word = 0;
  if (s.depth < Directory::kLeastDepth) {
    word = *levels[level];
  } else {
    level -= Directory::kLevels;
    const std::uint64_t* nodes = s.tree->directory.nodes(levels.data(), s.depth);
    word = nodes[x >> level | y >> level << Directory::kLevels | z >> level << 2 * Directory::kLevels];
    if (word == Directory::kWhite || word == Directory::kBlack) return word == Directory::kBlack;
  }
  for (; level > 2; --level) {
    const std::size_t below = level - 1;
    const auto octant = static_cast<unsigned>((x >> below & 1) | (y >> below & 1) << 1 | (z >> below & 1) << 2);
    if ((word >> (8 + octant) & 1) == 0) return word >> octant & 1;
    word = levels[below][detail::gray_child_index(word, octant)];
  }
  // A brick; the byte of a tree of depth 1 has its voxels where the first eight of a brick are.
  const auto low = [](std::int64_t coordinate) { return static_cast<unsigned>(coordinate & 3); };
  return word >> detail::brick_bit(low(x), low(y), low(z)) & 1;
}

std::span<const std::uint64_t> Octree::words(int level) const {
  assert(level >= 0 && level <= kMaxDepth);
  if (!storage_->tree) return {};
  const auto& words = storage_->tree->of_level[static_cast<std::size_t>(level)];
  return {words.data(), words.size()};
}

std::size_t Octree::memory_bytes() const {
  std::size_t bytes = sizeof(Octree) + sizeof(Storage);
  if (!storage_->tree) return bytes;
  bytes += sizeof(detail::Words);
  for (const auto& words : storage_->tree->of_level) bytes += words.size() * sizeof(std::uint64_t);
  return bytes;
}

bool operator==(const Octree& a, const Octree& b) {
  const auto &s = *a.storage_, &t = *b.storage_;
  if (s.depth != t.depth || s.root != t.root) return false;
  if (s.tree == t.tree) return true;
  return std::ranges::equal(s.tree->of_level, t.tree->of_level,
                            [](const auto& words, const auto& others) { return std::ranges::equal(words, others); });
}

namespace detail {

namespace {

/// Words [begin, end) of a level.
struct Interval {
  std::uint64_t begin = 0, end = 0;
};

// The children of the nodes `parents`, which are whole groups of siblings. Groups of children follow each other in
// curve order, but in which order the curve visits the siblings of one group only the group's table tells; so the
// interval begins with the least first child among the group of the first parent that has any, at most seven words
// further on, and ends likewise.
Interval children_of(const std::uint64_t* words, Interval parents) {
  const auto parent = [&](std::uint64_t i) { return (words[i] & 0xFF00) != 0; };
  const auto begin = [&](std::uint64_t i) { return words[i] >> 16; };
  const auto end = [&](std::uint64_t i) { return begin(i) + static_cast<unsigned>(std::popcount(words[i] & 0xFF00)); };
  std::uint64_t first = parents.begin, last = parents.end;
  while (first < last && !parent(first)) ++first;
  if (first == last) return {};
  while (!parent(last - 1)) --last;
  Interval children{begin(first), end(last - 1)};
  for (std::uint64_t i = first; i < std::min(first + 8, last); ++i)
    if (parent(i)) children.begin = std::min(children.begin, begin(i));
  for (std::uint64_t i = last; i-- > std::max(first, last - std::min<std::uint64_t>(last, 8));)
    if (parent(i)) children.end = std::max(children.end, end(i));
  return children;
}

}  // namespace

Subtree NodeArrays::copy(const LevelWords& from, std::uint64_t word, int level, bool exchange) {
  const auto moved = [&](std::uint64_t old, std::uint64_t by) {
    const std::uint64_t now = exchange ? exchanged(old) : old;
    return (now & 0xFF00) ? now + (by << 16) : now;
  };
  auto below = static_cast<std::size_t>(level - 1);
  Interval interval{word >> 16, (word >> 16) + static_cast<unsigned>(std::popcount(word & 0xFF00))};
  const Subtree top{moved(word, levels_[below].size() - interval.begin), Colour::gray};
  for (; below > 2 && interval.begin != interval.end; --below) {
    const Interval next = children_of(from[below], interval);
    const std::uint64_t by = levels_[below - 1].size() - next.begin;
    auto& words = levels_[below];
    const std::size_t before = words.size();
    words.append(from[below] + interval.begin, interval.end - interval.begin);
    for (auto* copied = words.begin() + before; copied != words.end(); ++copied) *copied = moved(*copied, by);
    interval = next;
  }
  auto& bricks = levels_[2];
  const std::size_t before = bricks.size();
  if (below == 2) bricks.append(from[2] + interval.begin, interval.end - interval.begin);
  if (exchange)
    for (auto* copied = bricks.begin() + before; copied != bricks.end(); ++copied) *copied = ~*copied;
  return top;
}

PackedNode NodeArrays::pack(const Subtree& top, int level) {
  assert(level >= 3);
  PackedNode node;
  node.colour_ = top.colour;
  node.level_ = static_cast<std::uint8_t>(level);
  if (top.colour != Colour::gray) return node;
  const auto end = static_cast<std::size_t>(level);
  node.words_ = std::make_unique_for_overwrite<std::uint64_t[]>(end - 1 + size());
  node.words_[0] = top.word;
  std::uint64_t* next = &node.words_[end - 1];
  for (std::size_t k = 2; k < end; ++k) {
    node.words_[k - 1] = levels_[k].size();
    next = std::copy(levels_[k].begin(), levels_[k].end(), next);
    levels_[k].clear();
  }
  return node;
}

Subtree NodeArrays::append(PackedNode node) {
  if (!node.words_) return Subtree::uniform(node.colour_);
  const std::uint64_t* next = &node.words_[node.level_ - 1u];
  std::uint64_t offset = 0;  // of the level below
  for (int k = 2; k < node.level_; ++k) {
    auto& level = levels_[static_cast<std::size_t>(k)];
    const std::size_t before = level.size(), count = node.count(k);
    level.append(next, count);
    if (k >= 3)
      for (std::uint64_t* word = level.begin() + before; word != level.end(); ++word) *word = shifted(*word, offset);
    next += count;
    offset = before;
  }
  return {shifted(node.words_[0], offset), Colour::gray};
}

Subtree NodeArrays::append(NodeArrays& stretch, Subtree top, int level) {
  std::array<std::uint64_t, kMaxDepth + 2> offset{};
  for (std::size_t k = 0; k < levels_.size(); ++k) offset[k] = levels_[k].size();
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    auto& from = stretch.levels_[k];
    if (k >= 3)
      for (auto& word : from) word = shifted(word, offset[k - 1]);
    levels_[k].append(from.data(), from.size());
    from = {};
  }
  if (top.colour == Colour::gray && level >= 3)
    top.word = shifted(top.word, offset[static_cast<std::size_t>(level - 1)]);
  return top;
}

void NodeArrays::reserve(int level, std::size_t count) {
  auto& words = levels_[static_cast<std::size_t>(level)];
  words.reserve(words.size() + count);
}

Octree NodeArrays::finish(int depth, Subtree root, Frame frame) {
  if (root.colour != Colour::gray) {
    *this = {};
    return Octree(depth, root.colour, std::move(frame));
  }
  levels_[static_cast<std::size_t>(depth)].push_back(root.word);
  auto tree = std::make_shared<Words>();
  tree->of_level = std::exchange(levels_, {});
  for (std::size_t k = 0; k < tree->levels.size(); ++k) {
    tree->of_level[k].shrink_to_fit();
    tree->levels[k] = tree->of_level[k].data();
  }
  return Octree(
      std::make_shared<const Octree::Storage>(Octree::Storage{depth, Colour::gray, std::move(tree), std::move(frame)}));
}

std::size_t NodeArrays::size() const {
  std::size_t total = 0;
  for (const auto& level : levels_) total += level.size();
  return total;
}

}  // namespace detail
}  // namespace blackleaf
