#include "file/solid_coder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "file/corner_model.h"
#include "file/nibble_coder.h"

namespace blackleaf::detail {
namespace {

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

constexpr std::uint32_t kBlackFaces = 0x555555;
constexpr std::array<Known, 2> kUniform = {{{}, {kBlackFaces, 0xFF, 0, 0}}};
constexpr std::array<Block, 2> kUniformBlock = [] {
  std::array<Block, 2> blocks{};
  static_cast<Known&>(blocks[1]) = kUniform[1];
  blocks[1].bricks.fill(~std::uint64_t{0});
  return blocks;
}();

// Two bits for the colour of a face from its four quarters.
constexpr std::array<std::uint8_t, 256> kFaceColour = [] {
  std::array<std::uint8_t, 256> colours{};
  colours.fill(kGray);
  colours[0x00] = kWhite;
  colours[0x55] = kBlack;
  return colours;
}();

// The voxels of a brick's upper faces, by axis.
constexpr std::array<std::uint64_t, 3> kBrickFace = [] {
  std::array<std::uint64_t, 3> faces{};
  for (unsigned bit = 0; bit < 64; ++bit)
    for (unsigned axis = 0; axis < 3; ++axis)
      if ((bit >> axis & 1) && (bit >> (3 + axis) & 1)) faces[axis] |= std::uint64_t{1} << bit;
  return faces;
}();

// The colour of a brick's upper face.
unsigned brick_face(std::uint64_t bits, unsigned axis) {
  const std::uint64_t face = bits & kBrickFace[axis];
  return static_cast<unsigned>(face != 0) << static_cast<unsigned>(face != kBrickFace[axis]);
}

// The four octants on the upper side of an axis, in the order of a face's quarters.
constexpr std::array<std::array<std::uint8_t, 4>, 3> kUpper = {{{1, 3, 5, 7}, {2, 3, 6, 7}, {4, 5, 6, 7}}};

// The bytes of a brick are coded in this order: each is followed by one that does not depend on it where that can be,
// so that a processor can work on both.
using BrickOrder = std::integer_sequence<unsigned, 0, 1, 2, 4, 3, 5, 6, 7>;

// How fast models learn: a share moves 2^-rate of its way. Bytes begin with what planes look like; pairs of children
// know nothing at first and slow down as they learn.
constexpr int kByteRate = 5, kFirstPairRate = 2, kLastPairRate = 5, kSymbolsPerRate = 16;

// A grid of 3^3: where the octants of its upper 2^3 are, and the steps along its axes.
constexpr std::array<std::uint8_t, 8> kGrid = {13, 14, 16, 17, 22, 23, 25, 26};
constexpr std::array<std::uint8_t, 3> kGridStep = {1, 3, 9};

// The symbols of a brick whose bytes are all rare; nothing has more.
constexpr std::size_t kMostSymbols = 24;
static_assert(2 * kMostSymbols <= NibbleDecoder::kPadding);

// Colours behind two children: one face towards -x, two towards -y, two towards -z.
constexpr std::size_t kPairContexts = 3 * 9 * 9;

// What is learnt while a chunk is coded.
struct Models {
  Models() {
    std::array<int, 16> even;
    even.fill(static_cast<int>(kShares) / 16);
    rare.fill(NibbleModel::of(even));
    // Two children of three colours each make nine symbols; the others do not occur.
    std::array<int, 16> nine{};
    for (unsigned symbol = 0; symbol < 16; ++symbol) nine[symbol] = (symbol & 3) < 3 && symbol < 12 ? 1820 : 1;
    nine[0] += static_cast<int>(kShares) - 9 * 1820 - 7;
    pairs.fill(NibbleModel::of(nine));
  }

  std::vector<NibbleModel> bytes = CornerModel::get().models();
  std::array<NibbleModel, 17> rare;                  // of bytes that are not in their context's list: halves
  std::array<NibbleModel, 3 * kPairContexts> pairs;  // [level 3, 4, above][colours behind]
  std::array<std::uint8_t, 3 * kPairContexts> pair_symbols{};
};

// The way through a chunk that writer and reader share: `Coder` takes the true symbols down, or finds them.
template <class Coder>
class Walk {
 public:
  explicit Walk(Coder& coder) : coder_(coder) {}

  /// Goes through the chunk's own node.
  void top(int level, const Node& truth) {
    if (level == 2)
      top_.bricks[0] = brick({}, Coder::kWrites ? truth.brick() : 0);
    else if (level == 3)
      block(top_, {&kUniformBlock[0], &kUniformBlock[0], &kUniformBlock[0]}, truth);
    else
      static_cast<Known&>(top_) = inner(level, {&kUniform[0], &kUniform[0], &kUniform[0]}, truth);
  }

  /// The same nodes in the order of the curve.
  Subtree gather(int level, unsigned table, NodeArrays& arrays) const {
    return level == 2   ? Subtree::brick(top_.bricks[0])
           : level == 3 ? gather_block(top_, arrays)
                        : gather_inner(top_, level, table, arrays);
  }

 private:
  using Behind = std::array<const Known*, 3>;  // the neighbours towards -x, -y and -z
  using BlocksBehind = std::array<const Block*, 3>;

  static Subtree gather_block(const Block& block, NodeArrays& arrays) {
    std::array<std::uint64_t, 8> words;
    std::size_t count = 0;
    for (unsigned rest = block.gray; rest; rest &= rest - 1)
      words[count++] = block.bricks[static_cast<unsigned>(std::countr_zero(rest))];
    return arrays.close(3, block.black, block.gray, std::span(words).first(count));
  }

  Subtree gather_inner(const Known& node, int level, unsigned table, NodeArrays& arrays) const {
    std::array<std::uint64_t, 8> words;  // of the gray children
    for (const curve::Step step : curve::kSteps[table]) {
      if (!(node.gray >> step.octant & 1)) continue;
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

  std::vector<Known>& nodes(int level) { return nodes_[static_cast<std::size_t>(level)]; }
  const std::vector<Known>& nodes(int level) const { return nodes_[static_cast<std::size_t>(level)]; }

  // A child of a node whose children are stored among `stored`.
  template <class Child>
  static const Child* child(const Known& node, unsigned octant, const Child* stored,
                            const std::array<Child, 2>& uniform) {
    return node.gray >> octant & 1 ? stored + node.first + before(node.gray, octant)
                                   : &uniform[node.black >> octant & 1];
  }

  template <unsigned... kOctants>
  [[gnu::always_inline]] std::uint64_t brick(const std::array<std::uint64_t, 3>& behind, std::uint64_t true_bits,
                                             std::integer_sequence<unsigned, kOctants...>) {
    // The writer knows all bits beforehand, so that no byte waits for the one before.
    std::uint64_t bits = Coder::kWrites ? true_bits : 0;
    // Coder and pointers in hand, so that the models' stores are not feared to change them.
    typename Coder::InHand coder = coder_;
    NibbleModel* const models = models_.bytes.data();
    const CornerModel& corners = corners_;
    (add_byte<kOctants>(coder, models, corners, bits, behind,
                        static_cast<unsigned>(true_bits >> (8 * kOctants) & 0xFF)),
     ...);
    put_back(coder);
    if (bits == 0 || ~bits == 0) throw Damage{"has a brick of one colour"};
    return bits;
  }

  [[gnu::noinline]] std::uint64_t brick(const std::array<std::uint64_t, 3>& behind, std::uint64_t true_bits) {
    coder_.make_room(kMostSymbols);
    return brick(behind, true_bits, BrickOrder());
  }

  void put_back(const typename Coder::InHand& coder) {
    static_cast<typename Coder::InHand&>(coder_) = coder;
    coder_.check();
  }

  template <unsigned kOctant>
  [[gnu::always_inline]] void add_byte(typename Coder::InHand& coder, NibbleModel* models, const CornerModel& corners,
                                       std::uint64_t& bits, const std::array<std::uint64_t, 3>& before,
                                       unsigned truth) {
    const auto behind = [&](unsigned axis) {
      const std::uint64_t from = kOctant >> axis & 1 ? bits : before[axis];
      return static_cast<unsigned>(from >> (8 * (kOctant ^ 1u << axis)) & 0xFF);
    };
    const unsigned faces = corners.faces(behind(0), behind(1), behind(2));
    const unsigned rank =
        coder.symbol(models[corners.context(faces)], Coder::kWrites ? corners.rank(faces, truth) : 0, kByteRate);
    unsigned byte = Coder::kWrites ? truth : corners.byte(faces, rank);
    if (rank == 15) [[unlikely]] {
      put_back(coder);
      byte = rare_byte(faces, truth);
      coder = coder_;
    }
    if constexpr (!Coder::kWrites) bits |= std::uint64_t{byte} << (8 * kOctant);
  }

  [[gnu::noinline]] unsigned rare_byte(unsigned faces, unsigned truth) {
    const unsigned upper = coder_.symbol(models_.rare[16], truth >> 4, kByteRate);
    const unsigned byte = upper << 4 | coder_.symbol(models_.rare[upper], truth & 15, kByteRate);
    if (corners_.rank(faces, byte) < 15) throw Damage{"tells of likely voxels in the way of unlikely ones"};
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
    put_back(coder);
    if (gray == 0 && (black == 0 || black == 0xFF)) throw Damage{"has a node of one colour"};
    node.black = static_cast<std::uint8_t>(black);
    node.gray = static_cast<std::uint8_t>(gray);
  }

  void block(Block& block, const BlocksBehind& behind, const Node& truth) {
    colours(block, 3, {behind[0]->faces, behind[1]->faces, behind[2]->faces}, truth);
    // The bricks behind and the eight of the block in one grid, so that every brick finds its neighbours in the same
    // way: which octants are gray is nothing that a processor could predict.
    std::array<std::uint64_t, 27> grid;
    for (unsigned axis = 0; axis < 3; ++axis)
      for (const unsigned o : kUpper[axis]) grid[kGrid[o] - 2u * kGridStep[axis]] = behind[axis]->bricks[o];
    for (unsigned o = 0; o < 8; ++o) grid[kGrid[o]] = -static_cast<std::uint64_t>(block.black >> o & 1);
    for (unsigned rest = block.gray; rest; rest &= rest - 1) {
      const auto o = static_cast<unsigned>(std::countr_zero(rest));
      std::uint64_t* const at = grid.data() + kGrid[o];
      *at = brick({*(at - kGridStep[0]), *(at - kGridStep[1]), *(at - kGridStep[2])},
                  Coder::kWrites ? truth.child(static_cast<int>(o)).word() : 0);
    }
    for (unsigned o = 0; o < 8; ++o) block.bricks[o] = grid[kGrid[o]];
    std::uint32_t faces = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
      for (unsigned quarter = 0; quarter < 4; ++quarter)
        faces |= brick_face(block.bricks[kUpper[axis][quarter]], axis) << (8 * axis + 2 * quarter);
    block.faces = faces;
  }

  // A node of level 4 or more.
  Known inner(int level, const Behind& behind, const Node& truth) {
    Known node;
    colours(node, level, {behind[0]->faces, behind[1]->faces, behind[2]->faces}, truth);
    if (level == 4) {
      if (blocks_.capacity() - blocks_.size() < 8) blocks_.reserve(2 * blocks_.size() + 64);  // none moves below
      node.first = blocks_.size();
      children<Block>(node, behind, blocks_.data(), kUniformBlock, [&](const BlocksBehind& near, unsigned o) {
        blocks_.emplace_back();
        block(blocks_.back(), near, Coder::kWrites ? truth.child(static_cast<int>(o)) : Node());
        return &blocks_.back();
      });
    } else {
      // These stay where they are: the nodes of the children's level are stored when this node is done.
      auto& below = nodes(level - 1);
      std::array<Known, 8> made;
      children<Known>(node, behind, below.data(), kUniform, [&](const Behind& near, unsigned o) {
        made[o] = inner(level - 1, near, Coder::kWrites ? truth.child(static_cast<int>(o)) : Node());
        return &made[o];
      });
      node.first = below.size();
      for (unsigned rest = node.gray; rest; rest &= rest - 1)
        below.push_back(made[static_cast<unsigned>(std::countr_zero(rest))]);
    }
    return node;
  }

  // Calls make(neighbours, octant) for the gray children and finds the node's faces. The neighbours' children are among
  // `stored`.
  template <class Child, class Make>
  void children(Known& node, const Behind& behind, const Child* stored, const std::array<Child, 2>& uniform,
                const Make& make) {
    std::array<const Child*, 8> all;
    for (unsigned o = 0; o < 8; ++o) all[o] = &uniform[node.black >> o & 1];
    for (unsigned rest = node.gray; rest; rest &= rest - 1) {
      const auto o = static_cast<unsigned>(std::countr_zero(rest));
      std::array<const Child*, 3> near;
      for (unsigned axis = 0; axis < 3; ++axis)
        near[axis] = o >> axis & 1 ? all[o ^ 1u << axis] : child(*behind[axis], o ^ 1u << axis, stored, uniform);
      all[o] = make(near, o);
    }
    for (unsigned axis = 0; axis < 3; ++axis)
      for (unsigned quarter = 0; quarter < 4; ++quarter)
        node.faces |= std::uint32_t{kFaceColour[all[kUpper[axis][quarter]]->faces >> (8 * axis) & 0xFF]}
                      << (8 * axis + 2 * quarter);
  }

  Coder& coder_;
  const CornerModel& corners_ = CornerModel::get();
  Models models_;
  Block top_;
  std::vector<Block> blocks_;                            // the gray nodes of level 3, children of one node together
  std::array<std::vector<Known>, kMaxDepth + 1> nodes_;  // the gray children of finished nodes, by level
};

}  // namespace

std::vector<std::uint8_t> encode_solid(const Node& node) {
  NibbleEncoder coder;
  Walk<NibbleEncoder> walk(coder);
  walk.top(node.level(), node);
  return coder.finish();
}

Subtree decode_solid(std::span<const std::uint8_t> bytes, int level, unsigned table, NodeArrays& arrays) {
  std::vector<std::uint8_t> padded;
  padded.reserve(bytes.size() + NibbleDecoder::kPadding);
  padded.assign(bytes.begin(), bytes.end());
  padded.resize(bytes.size() + NibbleDecoder::kPadding);
  NibbleDecoder coder({padded.data(), bytes.size()});
  Walk<NibbleDecoder> walk(coder);
  walk.top(level, Node());
  coder.expect_end();
  return walk.gather(level, table, arrays);
}

}  // namespace blackleaf::detail
