// The way through a chunk of a solid, node by node and brick by brick: FILE_FORMAT.md, section "Solids".
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "file/corner_model.h"
#include "file/damage.h"
#include "file/nibble_coder.h"
#include "octree/node_arrays.h"

namespace blackleaf::detail::solid {

// Colours as they are coded; gray also stands for a face of both colours.
enum : unsigned { kWhite = 0, kBlack = 1, kGray = 2 };

// A node above bricks that both writer and reader know. Of a uniform node all bits of the masks are alike.
struct Known {
  std::uint32_t faces = 0;  // colours of the quarters of its upper faces: bits 8a + 2i + 4j are those of axis a and the
                            // quarter with the coordinates i and j on the other two axes, the lower axis first
  std::uint8_t black = 0, gray = 0;
  std::uint64_t first = 0;  // of its gray children, where nodes of their level stand
};

// One of level 3, with its bricks; those of one colour have all bits alike.
struct Block : Known {
  std::array<std::uint64_t, 8> bricks{};
};

inline constexpr std::uint32_t kBlackFaces = 0x555555;
inline constexpr std::array<Known, 2> kUniform = {{{}, {kBlackFaces, 0xFF, 0, 0}}};
inline constexpr std::array<Block, 2> kUniformBlock = [] {
  std::array<Block, 2> blocks{};
  static_cast<Known&>(blocks[1]) = kUniform[1];
  blocks[1].bricks.fill(~std::uint64_t{0});
  return blocks;
}();

// Two bits for the colour of a face from its four quarters.
inline constexpr std::array<std::uint8_t, 256> kFaceColour = [] {
  std::array<std::uint8_t, 256> colours{};
  colours.fill(kGray);
  colours[0x00] = kWhite;
  colours[0x55] = kBlack;
  return colours;
}();

// The voxels of a brick's upper faces, by axis.
inline constexpr std::array<std::uint64_t, 3> kBrickFace = [] {
  std::array<std::uint64_t, 3> faces{};
  for (unsigned bit = 0; bit < 64; ++bit)
    for (unsigned axis = 0; axis < 3; ++axis)
      if ((bit >> axis & 1) && (bit >> (3 + axis) & 1)) faces[axis] |= std::uint64_t{1} << bit;
  return faces;
}();

// The colour of a brick's upper face.
inline unsigned brick_face(std::uint64_t bits, unsigned axis) {
  const std::uint64_t face = bits & kBrickFace[axis];
  return static_cast<unsigned>(face != 0) << static_cast<unsigned>(face != kBrickFace[axis]);
}

// The four octants on the upper side of an axis, in the order of a face's quarters.
inline constexpr std::array<std::array<std::uint8_t, 4>, 3> kUpper = {{{1, 3, 5, 7}, {2, 3, 6, 7}, {4, 5, 6, 7}}};

// How fast models learn: a share moves 2^-rate of its way. Bytes begin with what planes look like; pairs of children
// know nothing at first and slow down as they learn.
inline constexpr int kByteRate = 5, kFirstPairRate = 2, kLastPairRate = 5, kSymbolsPerRate = 16;

// A grid of 3^3: where the octants of its upper 2^3 are, and the steps along its axes.
inline constexpr std::array<std::uint8_t, 8> kGrid = {13, 14, 16, 17, 22, 23, 25, 26};
inline constexpr std::array<std::uint8_t, 3> kGridStep = {1, 3, 9};

// The symbols of a brick whose bytes are all rare; nothing has more.
inline constexpr std::size_t kMostSymbols = 24;
static_assert(2 * kMostSymbols <= NibbleDecoder::kPadding);

// Colours behind two children: one face towards -x, two towards -y, two towards -z.
inline constexpr std::size_t kPairContexts = 3 * 9 * 9;

// What is learnt while a chunk is coded.
struct Models {
  void reset() {
    bytes = CornerModel::get().models();
    std::array<int, 16> even;
    even.fill(static_cast<int>(kShares) / 16);
    rare.fill(NibbleModel::of(even));
    // Two children of three colours each make nine symbols; the others do not occur.
    std::array<int, 16> nine{};
    for (unsigned symbol = 0; symbol < 16; ++symbol) nine[symbol] = (symbol & 3) < 3 && symbol < 12 ? 1820 : 1;
    nine[0] += static_cast<int>(kShares) - 9 * 1820 - 7;
    pairs.fill(NibbleModel::of(nine));
    pair_symbols.fill(0);
  }

  std::vector<NibbleModel> bytes;
  std::array<NibbleModel, 17> rare;                  // of bytes that are not in their context's list: halves
  std::array<NibbleModel, 3 * kPairContexts> pairs;  // [level 3, 4, above][colours behind]
  std::array<std::uint8_t, 3 * kPairContexts> pair_symbols{};
};

// The way through a chunk that writer and reader share: `Coder` takes the true symbols down, or finds them. The way is
// cut at bricks: the walk stops at each, and whoever drives it codes the brick, or those of several walks side by side.
template <class Coder>
class Walk {
 public:
  /// Begins a chunk. True if the walk stands at a brick. Throws Damage.
  bool start(Coder coder, int level, const Node& truth) {
    coder_ = std::move(coder);
    models_.reset();
    blocks_.clear();
    for (auto& stored : nodes_) stored.clear();
    top_level_ = level;
    level_ = level + 1;
    block_ = nullptr;
    wrong_rank_ = false;
    bricks_ = 0;
    if (level == 2) {  // as the first of a block that nobody tells of
      top_ = {};
      top_.gray = 1;
      stand_in(top_, kNoBlocks, truth);
    } else if (level == 3) {
      open_block(top_, kNoBlocks, truth);
    } else {
      open_node({&kUniform[0], &kUniform[0], &kUniform[0]}, truth);
    }
    return to_brick();
  }

  /// Takes the coded brick for what it is and goes on. False if that was the last. Throws Damage.
  bool go_on() {
    coder_.check();
    if (wrong_rank_) throw Damage{"tells of likely voxels in the way of unlikely ones"};
    if (*at_ == 0 || ~*at_ == 0) throw Damage{"has a brick of one colour"};
    return to_brick();
  }

  const Coder& coder() const { return coder_; }

  /// The nodes that were gone through, in the order of the curve.
  Subtree gather(unsigned table, NodeArrays& arrays) const {
    arrays.reserve(2, bricks_);
    arrays.reserve(3, blocks_.size());
    for (int level = 4; level < top_level_; ++level) arrays.reserve(level, nodes(level).size());
    return top_level_ == 2   ? Subtree::brick(top_.bricks[0])
           : top_level_ == 3 ? gather_block(top_, arrays)
                             : gather_inner(top_, top_level_, table, arrays);
  }

  // The brick at which the walk stands, and all that coding it needs, as a copy that a loop can keep in registers.
  class Brick {
   public:
    [[gnu::always_inline]] explicit Brick(Walk& walk)
        : walk_(walk),
          coder_(walk.coder_),
          models_(walk.models_.bytes.data()),
          behind_({*(walk.at_ - kGridStep[0]), *(walk.at_ - kGridStep[1]), *(walk.at_ - kGridStep[2])}),
          truth_(walk.true_bits_),
          bits_(Coder::kWrites ? truth_ : 0) {}  // a writer knows all bits: no byte waits for the one before

    template <unsigned kOctant>
    [[gnu::always_inline]] void add_byte(const CornerModel& corners) {
      const auto behind = [&](unsigned axis) {
        const std::uint64_t from = kOctant >> axis & 1 ? bits_ : behind_[axis];
        return static_cast<unsigned>(from >> (8 * (kOctant ^ 1u << axis)) & 0xFF);
      };
      const auto truth = static_cast<unsigned>(truth_ >> (8 * kOctant) & 0xFF);
      const unsigned faces = corners.faces(behind(0), behind(1), behind(2));
      const unsigned rank =
          coder_.symbol(models_[corners.context(faces)], Coder::kWrites ? corners.rank(faces, truth) : 0, kByteRate);
      unsigned byte = Coder::kWrites ? truth : corners.byte(faces, rank);
      if (rank == 15) [[unlikely]] {
        put_back();
        byte = walk_.rare_byte(faces, truth);
        coder_ = walk_.coder_;
      }
      if constexpr (!Coder::kWrites) bits_ |= std::uint64_t{byte} << (8 * kOctant);
    }

    [[gnu::always_inline]] void finish() {
      put_back();
      *walk_.at_ = bits_;
    }

   private:
    using InHand = typename Coder::InHand;
    [[gnu::always_inline]] void put_back() { static_cast<InHand&>(walk_.coder_) = coder_; }

    Walk& walk_;
    InHand coder_;
    NibbleModel* const models_;
    const std::array<std::uint64_t, 3> behind_;
    const std::uint64_t truth_;
    std::uint64_t bits_;
  };

  void make_room() { coder_.make_room(kMostSymbols); }

 private:
  using Behind = std::array<const Known*, 3>;  // the neighbours towards -x, -y and -z
  using BlocksBehind = std::array<const Block*, 3>;
  static constexpr BlocksBehind kNoBlocks = {&kUniformBlock[0], &kUniformBlock[0], &kUniformBlock[0]};

  // A node of level 4 or more whose children are being gone through.
  struct Open {
    Known node;
    Behind behind{};
    std::array<const Known*, 8> children{};  // those known so far, blocks if the node is of level 4
    std::array<Known, 8> made;               // the gray ones; blocks stand elsewhere
    unsigned rest = 0, octant = 0;           // gray children to come, and the one at hand
    Node truth;
  };

  static Subtree gather_block(const Block& block, NodeArrays& arrays) {
    std::array<std::uint64_t, 8> words;
    std::size_t count = 0;
    for (unsigned rest = block.gray; rest; rest &= rest - 1)
      words[count++] = block.bricks[static_cast<unsigned>(std::countr_zero(rest))];
    return arrays.close(3, block.black, block.gray, std::span(words).first(count));
  }

  Subtree gather_inner(const Known& node, int level, unsigned table, NodeArrays& arrays) const {
    std::array<std::uint64_t, 8> words;  // of the gray children
    // The gray ones along the curve: which octants are gray is nothing that a processor could predict.
    unsigned along = 0;
    for (unsigned i = 0; i < 8; ++i)
      along |= (static_cast<unsigned>(node.gray) >> curve::kSteps[table][i].octant & 1) << i;
    for (; along; along &= along - 1) {
      const curve::Step step = curve::kSteps[table][static_cast<unsigned>(std::countr_zero(along))];
      const std::size_t i = before(node.gray, step.octant);
      words[i] = (level == 4 ? gather_block(blocks_[node.first + i], arrays)
                             : gather_inner(nodes(level - 1)[node.first + i], level - 1, step.table, arrays))
                     .word;
    }
    return arrays.close(level, node.black, node.gray, std::span(words).first(before(node.gray, 8)));
  }

  // The number of set bits below a place.
  static std::size_t before(unsigned mask, unsigned place) {
    return static_cast<std::size_t>(std::popcount(mask & ((1u << place) - 1)));
  }

  static std::size_t at(int level) { return static_cast<std::size_t>(level); }
  std::vector<Known>& nodes(int level) { return nodes_[at(level)]; }
  const std::vector<Known>& nodes(int level) const { return nodes_[at(level)]; }

  bool to_brick() {
    for (;;) {
      if (block_) {
        if (rest_) {
          const auto o = static_cast<unsigned>(std::countr_zero(rest_));
          rest_ &= rest_ - 1;
          ++bricks_;
          at_ = grid_.data() + kGrid[o];
          if constexpr (Coder::kWrites)
            true_bits_ = top_level_ == 2 ? block_truth_.word() : block_truth_.child(static_cast<int>(o)).word();
          return true;
        }
        close_block();
      }
      while (level_ <= top_level_ && open_[at(level_)].rest == 0) close_node();
      if (level_ > top_level_) return false;
      open_child();
    }
  }

  [[gnu::noinline]] unsigned rare_byte(unsigned faces, unsigned truth) {
    const unsigned upper = coder_.symbol(models_.rare[16], truth >> 4, kByteRate);
    const unsigned byte = upper << 4 | coder_.symbol(models_.rare[upper], truth & 15, kByteRate);
    wrong_rank_ |= corners_.rank(faces, byte) < 15;
    return byte;
  }

  // Tells the colours of a node's children.
  void colours(Known& node, int level, const std::array<std::uint32_t, 3>& faces, const Node& truth) {
    const std::uint64_t true_word = Coder::kWrites ? truth.word() : 0;
    const auto true_pair = [&](unsigned i) {
      const std::uint64_t black = true_word >> (2 * i), gray = true_word >> (8 + 2 * i);
      return static_cast<unsigned>((black & 1) | (gray & 1) << 1 | (black & 2) << 1 | (gray & 2) << 2);
    };
    coder_.make_room(kMostSymbols);
    const std::size_t set = kPairContexts * static_cast<std::size_t>(std::min(level, 5) - 3);
    std::array<unsigned, 4> pairs{};
    unsigned black = 0, gray = 0;
    typename Coder::InHand coder = coder_;
    NibbleModel* const models = models_.pairs.data() + set;
    std::uint8_t* const all_symbols = models_.pair_symbols.data() + set;
    for (unsigned i = 0; i < 4; ++i) {  // the octants 2i and 2i + 1
      const unsigned x = faces[0] >> (2 * i) & 3;
      const unsigned y = i & 1 ? pairs[i ^ 1] : faces[1] >> (8 + 2 * i) & 15;
      const unsigned z = i & 2 ? pairs[i ^ 2] : faces[2] >> (16 + 4 * i) & 15;
      const unsigned at = x + 3 * (y - (y >> 2)) + 27 * (z - (z >> 2));
      const unsigned seen = all_symbols[at];
      const int rate = std::min(kLastPairRate, kFirstPairRate + static_cast<int>(seen) / kSymbolsPerRate);
      all_symbols[at] = static_cast<std::uint8_t>(seen + (seen < 255));
      const unsigned pair = coder.symbol(models[at], true_pair(i), rate);
      if (pair & pair >> 1 & 5) throw Damage{"has a node of unknown colour"};
      pairs[i] = pair;
      black |= ((pair & 1) | (pair >> 1 & 2)) << (2 * i);
      gray |= ((pair >> 1 & 1) | (pair >> 2 & 2)) << (2 * i);
    }
    static_cast<typename Coder::InHand&>(coder_) = coder;
    coder_.check();
    if (gray == 0 && (black == 0 || black == 0xFF)) throw Damage{"has a node of one colour"};
    node.black = static_cast<std::uint8_t>(black);
    node.gray = static_cast<std::uint8_t>(gray);
  }

  void open_block(Block& block, const BlocksBehind& behind, const Node& truth) {
    colours(block, 3, {behind[0]->faces, behind[1]->faces, behind[2]->faces}, truth);
    stand_in(block, behind, truth);
  }

  void stand_in(Block& block, const BlocksBehind& behind, const Node& truth) {
    block_ = &block;
    rest_ = block.gray;
    if constexpr (Coder::kWrites) block_truth_ = truth;
    for (unsigned axis = 0; axis < 3; ++axis)
      for (const unsigned o : kUpper[axis]) grid_[kGrid[o] - 2u * kGridStep[axis]] = behind[axis]->bricks[o];
    for (unsigned o = 0; o < 8; ++o) grid_[kGrid[o]] = -static_cast<std::uint64_t>(block.black >> o & 1);
  }

  void close_block() {
    for (unsigned o = 0; o < 8; ++o) block_->bricks[o] = grid_[kGrid[o]];
    std::uint32_t faces = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
      for (unsigned quarter = 0; quarter < 4; ++quarter)
        faces |= brick_face(block_->bricks[kUpper[axis][quarter]], axis) << (8 * axis + 2 * quarter);
    block_->faces = faces;
    block_ = nullptr;
  }

  // Goes down into a node of level 4 or more.
  void open_node(const Behind& behind, const Node& truth) {
    --level_;
    Open& open = open_[at(level_)];
    open.node = {};
    colours(open.node, level_, {behind[0]->faces, behind[1]->faces, behind[2]->faces}, truth);
    open.behind = behind;
    open.rest = open.node.gray;
    if constexpr (Coder::kWrites) open.truth = truth;
    if (level_ == 4) {
      if (blocks_.capacity() - blocks_.size() < 8) blocks_.reserve(2 * blocks_.size() + 64);  // none moves below
      open.node.first = blocks_.size();
    }
    for (unsigned o = 0; o < 8; ++o) open.children[o] = uniform(open.node.black >> o & 1);
  }

  // A node of one colour below the level that is open.
  const Known* uniform(unsigned black) const { return level_ == 4 ? &kUniformBlock[black] : &kUniform[black]; }

  // Goes down into the next gray child.
  void open_child() {
    Open& open = open_[at(level_)];
    const auto o = static_cast<unsigned>(std::countr_zero(open.rest));
    open.rest &= open.rest - 1;
    open.octant = o;
    Behind near;
    for (unsigned axis = 0; axis < 3; ++axis)
      near[axis] = o >> axis & 1 ? open.children[o ^ 1u << axis] : child(*open.behind[axis], o ^ 1u << axis);
    const Node truth = Coder::kWrites ? open.truth.child(static_cast<int>(o)) : Node();
    if (level_ == 4) {
      Block& block = blocks_.emplace_back();
      open.children[o] = &block;
      open_block(block, {as_block(near[0]), as_block(near[1]), as_block(near[2])}, truth);
    } else {
      open.children[o] = &open.made[o];
      open_node(near, truth);
    }
  }

  static const Block* as_block(const Known* node) { return static_cast<const Block*>(node); }

  // A child of a neighbour of the open node; all that are gray are stored.
  const Known* child(const Known& node, unsigned octant) const {
    if (!(node.gray >> octant & 1)) return uniform(node.black >> octant & 1);
    const std::size_t at = node.first + before(node.gray, octant);
    return level_ == 4 ? &blocks_[at] : &nodes(level_ - 1)[at];
  }

  void close_node() {
    Open& open = open_[at(level_)];
    for (unsigned axis = 0; axis < 3; ++axis)
      for (unsigned quarter = 0; quarter < 4; ++quarter)
        open.node.faces |= std::uint32_t{kFaceColour[open.children[kUpper[axis][quarter]]->faces >> (8 * axis) & 0xFF]}
                           << (8 * axis + 2 * quarter);
    if (level_ > 4) {
      // Only now: until here the neighbours' children stay where they are.
      auto& below = nodes(level_ - 1);
      open.node.first = below.size();
      for (unsigned rest = open.node.gray; rest; rest &= rest - 1)
        below.push_back(open.made[static_cast<unsigned>(std::countr_zero(rest))]);
    }
    if (level_ == top_level_)
      static_cast<Known&>(top_) = open.node;
    else
      open_[at(level_ + 1)].made[open_[at(level_ + 1)].octant] = open.node;
    ++level_;
  }

  Coder coder_;
  const CornerModel& corners_ = CornerModel::get();
  Models models_;
  Block top_;
  std::vector<Block> blocks_;                            // the gray nodes of level 3, children of one node together
  std::array<std::vector<Known>, kMaxDepth + 1> nodes_;  // the gray children of finished nodes, by level

  int top_level_ = 0, level_ = 1;  // the chunk's own, and that of the innermost open node, above it if there is none
  std::array<Open, kMaxDepth + 1> open_;
  bool wrong_rank_ = false;

  // The block at hand. The bricks behind it and its own eight stand in one grid, so that every brick finds its
  // neighbours in the same way: which octants are gray is nothing that a processor could predict.
  Block* block_ = nullptr;
  unsigned rest_ = 0;  // its gray children to come
  Node block_truth_;
  std::array<std::uint64_t, 27> grid_{};
  std::uint64_t* at_ = nullptr;  // the brick at hand
  std::uint64_t true_bits_ = 0;
  std::size_t bricks_ = 0;
};

}  // namespace blackleaf::detail::solid
