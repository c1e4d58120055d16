#include "blackleaf/set_operations.h"

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

#include "octree/produce.h"
#include "octree/same_depth.h"

namespace blackleaf {
namespace {

using detail::LevelWords;
using detail::NodeArrays;
using detail::Subtree;

constexpr std::uint64_t kAll = ~std::uint64_t{0};

// An operation on the colours of a and b, one bit a voxel or a child.
struct And {
  static constexpr std::uint64_t bits(std::uint64_t a, std::uint64_t b) { return a & b; }
};
struct Or {
  static constexpr std::uint64_t bits(std::uint64_t a, std::uint64_t b) { return a | b; }
};
struct Minus {
  static constexpr std::uint64_t bits(std::uint64_t a, std::uint64_t b) { return a & ~b; }
};
struct Xor {
  static constexpr std::uint64_t bits(std::uint64_t a, std::uint64_t b) { return a ^ b; }
};

// What an operation makes of one operand when the other has one colour.
enum class Share { white, black, same, exchanged };

constexpr Share share(std::uint64_t of_white, std::uint64_t of_black) {
  if ((of_white & 1) == (of_black & 1)) return (of_white & 1) != 0 ? Share::black : Share::white;
  return (of_black & 1) != 0 ? Share::same : Share::exchanged;
}
template <class Operation>
constexpr Share share_of_a(bool b) {
  return share(Operation::bits(0, b ? kAll : 0), Operation::bits(kAll, b ? kAll : 0));
}
template <class Operation>
constexpr Share share_of_b(bool a) {
  return share(Operation::bits(a ? kAll : 0, 0), Operation::bits(a ? kAll : 0, kAll));
}

// The most nodes of each level that a result can have: a gray node of it is gray in an operand. Room that is never
// written to costs nothing.
class Room {
 public:
  void add(const Octree& octree) {
    for (int level = 2; level < octree.depth(); ++level)
      nodes_[static_cast<std::size_t>(level)] += octree.words(level).size();
  }
  void reserve(NodeArrays& arrays) const {
    for (int level = 2; level < kMaxDepth; ++level) arrays.reserve(level, nodes_[static_cast<std::size_t>(level)]);
  }

 private:
  std::array<std::size_t, kMaxDepth> nodes_{};
};

std::uint64_t all(const Node& node) { return node.is_black() ? kAll : 0; }

unsigned black_of(std::uint64_t word) { return static_cast<unsigned>(word & 0xFF); }
unsigned gray_of(std::uint64_t word) { return static_cast<unsigned>(word >> 8 & 0xFF); }
// The word of the gray child with this bit.
std::uint64_t child_word(const std::uint64_t* below, std::uint64_t word, unsigned bit) {
  return below[(word >> 16) + static_cast<unsigned>(std::popcount(gray_of(word) & (bit - 1)))];
}

template <class Operation>
class PairProducer {
 public:
  struct Task {
    Node a, b;
  };

  PairProducer(const LevelWords& a, const LevelWords& b) : a_words_(a), b_words_(b) {}
  PairProducer(const Octree& a, const Octree& b)
      : a_words_(detail::level_words(a)),
        b_words_(detail::level_words(b)),
        top_{detail::brick_level_root(a), detail::brick_level_root(b)} {
    room_.add(a);
    room_.add(b);
  }

  void reserve(NodeArrays& arrays) const { room_.reserve(arrays); }

  Task root() const { return top_; }
  Task child(const Task& task, const Cube&, int octant) const { return {task.a.child(octant), task.b.child(octant)}; }

  Colour classify(Task& task, const Cube&) const {
    const bool a = !task.a.is_gray(), b = !task.b.is_gray();
    const auto colour_of = [](Share share) {
      return share == Share::white ? Colour::white : share == Share::black ? Colour::black : Colour::gray;
    };
    if (a && b) return Operation::bits(all(task.a), all(task.b)) ? Colour::black : Colour::white;
    if (b) return colour_of(share_of_a<Operation>(task.b.is_black()));
    if (a) return colour_of(share_of_b<Operation>(task.a.is_black()));
    return Colour::gray;
  }

  Subtree subtree(Task& task, const Cube& cube, std::uint8_t table, NodeArrays& arrays) const {
    const Colour colour = classify(task, cube);
    if (colour != Colour::gray) return Subtree::uniform(colour);
    if (cube.level == 2) return Subtree::brick(Operation::bits(task.a.brick(), task.b.brick()));
    if (!task.b.is_gray())
      return arrays.copy(a_words_, task.a.word(), cube.level,
                         share_of_a<Operation>(task.b.is_black()) == Share::exchanged);
    if (!task.a.is_gray())
      return arrays.copy(b_words_, task.b.word(), cube.level,
                         share_of_b<Operation>(task.a.is_black()) == Share::exchanged);
    return both_gray(task.a.word(), task.b.word(), cube.level, table, arrays);
  }

  // Two gray nodes of one place, of level 3 or more.
  Subtree both_gray(std::uint64_t a, std::uint64_t b, int level, std::uint8_t table, NodeArrays& arrays) const {
    const unsigned black_a = black_of(a), gray_a = gray_of(a), black_b = black_of(b), gray_b = gray_of(b);
    const auto below = static_cast<std::size_t>(level - 1);
    unsigned gray = 0;
    auto black = static_cast<unsigned>(Operation::bits(black_a, black_b)) & ~(gray_a | gray_b) & 0xFF;
    std::array<std::uint64_t, 8> words;  // of the gray children, by octant
    const auto add = [&](unsigned octant, const Subtree& child) {
      words[octant] = child.word;
      black |= (child.colour == Colour::black ? 1u : 0u) << octant;
      gray |= (child.colour == Colour::gray ? 1u : 0u) << octant;
    };
    if (level == 3) {
      const auto brick = [&](const std::uint64_t* bricks, std::uint64_t word, unsigned bit) {
        if (gray_of(word) & bit) return child_word(bricks, word, bit);
        return black_of(word) & bit ? kAll : 0;
      };
      for (unsigned rest = gray_a | gray_b; rest != 0; rest &= rest - 1) {
        const unsigned bit = rest & -rest;
        add(static_cast<unsigned>(std::countr_zero(rest)),
            Subtree::brick(Operation::bits(brick(a_words_[2], a, bit), brick(b_words_[2], b, bit))));
      }
    } else {
      // Children with one gray side are shares of it, in curve order like all others.
      const auto part = [&](const LevelWords& words_of, std::uint64_t word, unsigned bit, Share share) {
        if (share == Share::white || share == Share::black)
          return Subtree::uniform(share == Share::black ? Colour::black : Colour::white);
        return arrays.copy(words_of, child_word(words_of[below], word, bit), level - 1, share == Share::exchanged);
      };
      for (const curve::Step step : curve::kSteps[table]) {
        const unsigned bit = 1u << step.octant;
        if (gray_a & gray_b & bit)
          add(step.octant, both_gray(child_word(a_words_[below], a, bit), child_word(b_words_[below], b, bit),
                                     level - 1, step.table, arrays));
        else if (gray_a & bit)
          add(step.octant, part(a_words_, a, bit, share_of_a<Operation>((black_b & bit) != 0)));
        else if (gray_b & bit)
          add(step.octant, part(b_words_, b, bit, share_of_b<Operation>((black_a & bit) != 0)));
      }
    }
    std::size_t count = 0;
    for (unsigned rest = gray; rest != 0; rest &= rest - 1)
      words[count++] = words[static_cast<unsigned>(std::countr_zero(rest))];
    return arrays.close(level, black, gray, {words.data(), count});
  }

 private:
  LevelWords a_words_, b_words_;
  Task top_;
  Room room_;
};

// Any number of operands of And or Or: those whose colour leaves the others as they are drop out on the way down, one
// of the other colour decides, and the last two are a pair.
template <class Operation>
class ManyProducer {
 public:
  struct Operand {
    Node node;
    std::size_t number;  // of the octree it belongs to
  };
  using Task = std::vector<Operand>;  // those that are not neutral

  explicit ManyProducer(std::span<const Octree> octrees) {
    for (const Octree& octree : octrees) {
      top_.push_back({detail::brick_level_root(octree), words_.size()});
      words_.push_back(detail::level_words(octree));
      room_.add(octree);
    }
  }

  void reserve(NodeArrays& arrays) const { room_.reserve(arrays); }

  Task root() const { return top_; }

  Task child(const Task& task, const Cube&, int octant) const {
    Task below;
    for (const Operand& operand : task) {
      const Node node = operand.node.child(octant);
      if (node.colour() == kDecides) return {{node, operand.number}};
      if (node.is_gray()) below.push_back({node, operand.number});
    }
    return below;
  }

  Colour classify(Task& task, const Cube&) const {
    if (std::any_of(task.begin(), task.end(), [](const Operand& o) { return o.node.colour() == kDecides; }))
      return kDecides;
    std::erase_if(task, [](const Operand& o) { return o.node.colour() == kNeutral; });
    return task.empty() ? kNeutral : Colour::gray;
  }

  Subtree subtree(Task& task, const Cube& cube, std::uint8_t table, NodeArrays& arrays) const {
    const Colour colour = classify(task, cube);
    if (colour != Colour::gray) return Subtree::uniform(colour);
    if (cube.level == 2) {
      std::uint64_t bits = task.front().node.brick();
      for (const Operand& operand : task) bits = Operation::bits(bits, operand.node.brick());
      return Subtree::brick(bits);
    }
    if (task.size() == 1) return arrays.copy(words_[task.front().number], task.front().node.word(), cube.level, false);
    if (task.size() == 2)
      return PairProducer<Operation>(words_[task[0].number], words_[task[1].number])
          .both_gray(task[0].node.word(), task[1].node.word(), cube.level, table, arrays);
    std::array<Subtree, 8> children;
    for (const curve::Step step : curve::kSteps[table]) {
      Task below = child(task, cube, step.octant);
      children[step.octant] = subtree(below, cube.child(step.octant), step.table, arrays);
    }
    return arrays.close(cube.level, children);
  }

 private:
  static constexpr Colour kDecides = Operation::bits(0, kAll) != 0 ? Colour::black : Colour::white;
  static constexpr Colour kNeutral = kDecides == Colour::black ? Colour::white : Colour::black;

  std::vector<LevelWords> words_;
  Task top_;
  Room room_;
};

std::size_t size(const Octree& octree) { return octree.memory_bytes() / sizeof(std::uint64_t); }

// Below this many words threads cost more than they save.
constexpr std::size_t kWordsForThreads = std::size_t{1} << 18;

Work worth_it(const Work& work, std::size_t words) {
  Work chosen = work;
  if (words < kWordsForThreads) chosen.threads = 1;
  return chosen;
}

template <class Operation>
Octree combine(const Octree& a, const Octree& b, const Work& work) {
  detail::require_same_depth(a, b);
  return detail::produce(PairProducer<Operation>(a, b), a.depth(), a.frame(), worth_it(work, size(a) + size(b)));
}

template <class Operation>
Octree combine(std::span<const Octree> octrees, const Work& work) {
  assert(!octrees.empty());
  std::size_t words = 0;
  for (const Octree& octree : octrees) {
    detail::require_same_depth(octrees.front(), octree);
    words += size(octree);
  }
  return detail::produce(ManyProducer<Operation>(octrees), octrees.front().depth(), octrees.front().frame(),
                         worth_it(work, words));
}

}  // namespace

Octree unite(const Octree& a, const Octree& b, const Work& work) { return combine<Or>(a, b, work); }
Octree intersect(const Octree& a, const Octree& b, const Work& work) { return combine<And>(a, b, work); }
Octree subtract(const Octree& a, const Octree& b, const Work& work) { return combine<Minus>(a, b, work); }
Octree symmetric_difference(const Octree& a, const Octree& b, const Work& work) { return combine<Xor>(a, b, work); }

Octree unite(std::span<const Octree> octrees, const Work& work) { return combine<Or>(octrees, work); }
Octree intersect(std::span<const Octree> octrees, const Work& work) { return combine<And>(octrees, work); }

Octree symmetric_difference(std::span<const Octree> octrees, const Work& work) {
  assert(!octrees.empty());
  std::vector<Octree> level(octrees.begin(), octrees.end());
  for (const Octree& octree : level) detail::require_same_depth(level.front(), octree);
  for (std::size_t count = level.size(), done = 0; count > 1; count = (count + 1) / 2) {
    for (std::size_t i = 0; i < count / 2; ++i, ++done) {
      const double all_pairs = static_cast<double>(octrees.size() - 1);
      level[i] = symmetric_difference(
          level[2 * i], level[2 * i + 1],
          detail::part_of(work, static_cast<double>(done) / all_pairs, static_cast<double>(done + 1) / all_pairs));
    }
    if (count % 2 != 0) level[count / 2] = level[count - 1];
  }
  return level.front();
}

Octree complement(const Octree& a, const Work&) {
  const Node root = a.root();
  if (!root.is_gray()) return Octree(a.depth(), root.is_black() ? Colour::white : Colour::black, a.frame());
  NodeArrays arrays;
  const Subtree top = a.depth() > 2 ? arrays.copy(detail::level_words(a), root.word(), a.depth(), true)
                                    : Subtree{a.depth() == 2 ? ~root.word() : ~root.word() & 0xFF, Colour::gray};
  return arrays.finish(a.depth(), top, a.frame());
}

}  // namespace blackleaf
