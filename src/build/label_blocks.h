// LabelBlocks: a volume of labels on its way to runs, 64 slices at a time.
//
// A *block* is a node of level 6, 64^3 voxels; in smaller universes the root. A *slab* is the layer of blocks of one z.
// While a slab is read, strip by strip (a row of bricks along x: four by four rows of voxels), each brick of 4^3 voxels
// becomes one number, its label, or its 64 values are kept. When the slab is complete each of its blocks becomes a run
// stream in the order in which the Millar curve passes it: where a block lies says how, so nothing else of the universe
// needs to be known. In the end the streams are joined in curve order (MHF92, section 4).
//
// So what is held is the runs, and of one slab a sixteenth of its voxels' number in words and its bricks of several
// labels.
//
// The numbers of a block's bricks stand in Morton order: those of any node are neighbours, and whether the node has one
// label is a comparison of an array with its first element.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blackleaf/label_map.h"
#include "blackleaf/work.h"

namespace blackleaf::detail {

/// L: uint8, uint16 or uint32, wide enough for every label.
template <class L>
class LabelBlocks {
 public:
  /// For the voxels [low, high) of the universe; all others have label 0. Requires: 1 <= depth <= 20, and on every axis
  /// 0 <= low < high <= 2^depth.
  LabelBlocks(int depth, const std::array<std::int64_t, 3>& low, const std::array<std::int64_t, 3>& high);

  /// Strips of one layer of bricks have 4 y in [low, high): brick rows [first_strip, last_strip).
  std::int64_t first_strip() const { return low_[1] >> 2; }
  std::int64_t last_strip() const { return (high_[1] + 3) >> 2; }

  /// Sixteen rows of labels at x in [low, high): row r has y = 4 strip + (r & 3), z = 4 layer + (r >> 2). Null: all 0,
  /// as rows outside the volume must be.
  using Rows = std::array<const L*, 16>;
  /// Takes a strip. Safe for different strips at once. Requires: the layer is of the slab that is not yet closed.
  void set(std::int64_t strip, std::int64_t layer, const Rows& rows);
  /// Turns the slab into runs; the next one may begin.
  void close_slab(const Work& work);
  /// The labels of the universe. Requires: all slabs are closed. Leaves the object empty.
  LabelMap join(Frame frame);

 private:
  struct BlockRun {
    std::uint32_t count;  // at most 64^3
    std::uint32_t label;
  };
  using Stream = std::vector<BlockRun>;

  static constexpr int kBlockLevel = 6;
  static constexpr std::size_t kBlockBricks = 4096;
  // Marks a brick whose values are kept: one of several labels, or of this one.
  static constexpr std::uint32_t kMixed = 0xFFFF'FFFF;

  struct Block {
    std::array<std::uint32_t, kBlockBricks> labels{};  // of each brick, or kMixed
    std::array<std::uint32_t, kBlockBricks> where;     // of mixed bricks: the index among those of their strip
  };

  // The number of a brick at these brick coordinates (or others with the same last four bits) in its block.
  static std::size_t morton(std::int64_t x, std::int64_t y, std::int64_t z);
  void classify(const std::array<const L*, 16>& rows, std::int64_t brick, std::int64_t vectors, std::int64_t end,
                std::size_t yz, Block* blocks, std::vector<L>& mixed) const;
  const L* values(const Block& block, std::size_t brick, std::int64_t x, std::int64_t y, std::int64_t z) const;

  class BlockWalk;
  Stream stream(std::size_t index) const;

  const int depth_, level_;  // of the universe, of a block
  const std::array<std::int64_t, 3> low_, high_;
  std::array<std::int64_t, 3> first_{}, count_{};  // blocks that hold the volume
  std::int64_t slab_ = 0;                          // slabs that are closed
  std::vector<L> nothing_;                         // a row outside the volume
  std::vector<Block> blocks_;                      // of the slab, x first
  std::vector<std::vector<L>> mixed_;              // of the slab's strips: the values of mixed bricks, x first, then y
  std::vector<Stream> streams_;                    // of all closed blocks, x first, then y
};

}  // namespace blackleaf::detail
