// Relabelled copies of subtrees: what is left of a motion where it takes nodes to nodes.
//
// A subtree that is moved by a multiple of its side, turned by quarters or reflected keeps its nodes; only the octant
// labels change, and the order in which the Millar curve leaves its nodes, by which they are stored. So it is copied in
// the order of the target's curve, a few steps a node, and nothing is classified. The bricks of one parent stand in the
// order of their labels whatever the curve does: where labels stay they are copied together.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "octree/node_arrays.h"

namespace blackleaf::detail {

/// Labels stay as they are.
struct SameLabels {
  static constexpr bool kSame = true;
  static unsigned octants(unsigned mask) { return mask; }
  static unsigned source(unsigned octant) { return octant; }
  static std::uint64_t brick(std::uint64_t bits) { return bits; }
};

/// Copies nodes of a source tree into arrays. `Labels` says what becomes of octant labels:
///   kSame                   whether that is nothing at all
///   octants(mask)           the target's octants for a mask of the source's
///   source(octant)          the source's octant for one of the target
///   brick(bits)             the target's brick for one of the source
template <class Labels>
class RelabelledCopy {
 public:
  /// words[k] is the first word of level k of the source.
  RelabelledCopy(const std::uint64_t* const* words, const Labels& labels) : words_(words), labels_(labels) {}

  /// The node of a source word of the given level, or of what stands for one of one colour (SourceTree), where the
  /// curve enters the target with `table`. Requires: level >= 3. O(nodes below it).
  Subtree node(std::uint64_t word, int level, std::uint8_t table, NodeArrays& arrays) const {
    const unsigned source_gray = word >> 8 & 0xFF;
    const unsigned black = labels_.octants(word & 0xFF), gray = labels_.octants(source_gray);
    const std::uint64_t* below = words_[level - 1] + (gray == 0 ? 0 : word >> 16);
    const auto child_word = [&](unsigned octant) {
      const unsigned from = labels_.source(octant);
      return below[std::popcount(source_gray & ((1u << from) - 1))];
    };
    const auto count = static_cast<std::size_t>(std::popcount(gray));
    if constexpr (Labels::kSame)
      if (level == 3) return arrays.close(3, black, gray, {below, count});
    std::array<std::uint64_t, 8> words;
    if (level == 3) {
      std::size_t i = 0;
      for (unsigned rest = gray; rest != 0; rest &= rest - 1)
        words[i++] = labels_.brick(child_word(static_cast<unsigned>(std::countr_zero(rest))));
    } else {
      for (const curve::Step step : curve::kSteps[table])
        if ((gray >> step.octant & 1) != 0)
          words[static_cast<std::size_t>(std::popcount(gray & ((1u << step.octant) - 1)))] =
              node(child_word(step.octant), level - 1, step.table, arrays).word;
    }
    return arrays.close(level, black, gray, {words.data(), count});
  }

 private:
  const std::uint64_t* const* words_;
  const Labels& labels_;
};

}  // namespace blackleaf::detail
