#include <bit>
#include <string>

#include "blackleaf/curve.h"
#include "blackleaf/measures.h"

namespace blackleaf {
namespace {

class Validator {
 public:
  explicit Validator(const Octree& octree) : octree_(octree) {}

  std::string run() {
    const int depth = octree_.depth();
    if (depth < 1 || depth > kMaxDepth) return "depth " + std::to_string(depth) + " is not in 1..20";
    const Node root = octree_.root();
    for (int level = 0; level <= kMaxDepth; ++level) {
      const std::size_t expected = level == depth ? (root.is_gray() ? 1 : 0) : octree_.words(level).size();
      if (octree_.words(level).size() != expected) return "level " + std::to_string(level) + " has no single root word";
      if ((level > depth || (level < 2 && level != depth) || !root.is_gray()) && !octree_.words(level).empty())
        return "level " + std::to_string(level) + " holds words where none belong";
    }
    if (root.is_gray()) node(root.word(), depth, 0);
    for (int level = 2; problem_.empty() && level < depth; ++level)
      if (next_[static_cast<std::size_t>(level)] != octree_.words(level).size())
        problem_ = "level " + std::to_string(level) + " holds words that the root does not reach";
    return problem_;
  }

 private:
  void node(std::uint64_t word, int level, std::uint8_t table) {
    if (!problem_.empty()) return;
    const auto here = [&] { return " at level " + std::to_string(level); };
    if (level == 1) {
      if (word >> 8) problem_ = "a byte has more than eight bits" + here();
      if (word == 0 || word == 0xFF) problem_ = "a byte of one colour" + here();
      return;
    }
    if (level == 2) {
      if (word == 0 || ~word == 0) problem_ = "a brick of one colour" + here();
      return;
    }
    const std::uint64_t black = word & 0xFF, gray = word >> 8 & 0xFF, first = word >> 16;
    const auto count = static_cast<unsigned>(std::popcount(gray));
    if (black & gray)
      problem_ = "a child both black and gray" + here();
    else if (gray == 0 && (black == 0 || black == 0xFF))
      problem_ = "a gray node of one colour" + here();
    else if (gray == 0 && first != 0)
      problem_ = "a child index without gray children" + here();
    const auto words = octree_.words(level - 1);
    if (problem_.empty() && gray && (first > words.size() || words.size() - first < count))
      problem_ = "a child index beyond the words of the level below" + here();
    if (!problem_.empty()) return;
    for (const curve::Step step : curve::kSteps[table]) {
      const std::uint64_t bit = std::uint64_t{1} << step.octant;
      if (gray & bit)
        node(words[first + static_cast<unsigned>(std::popcount(gray & (bit - 1)))], level - 1, step.table);
    }
    auto& next = next_[static_cast<std::size_t>(level - 1)];
    if (gray && problem_.empty()) {
      if (first != next) problem_ = "a group of children out of curve order" + here();
      next += count;
    }
  }

  const Octree& octree_;
  std::array<std::size_t, kMaxDepth + 1> next_{};  // words of each level accounted for so far
  std::string problem_;
};

}  // namespace

std::string validate(const Octree& octree) { return Validator(octree).run(); }

}  // namespace blackleaf
