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

// A node that both writer and reader know.
struct Known {
  std::uint64_t word = 0;  // as in octree.h, children by their index in Walk::nodes_; of a uniform node all bits alike
  std::uint32_t faces =
      0;  // above bricks: colours of the quarters of its upper faces: bits 8a + 2i + 4j are those of axis a and the
          // quarter with the coordinates i and j on the other two axes, the lower axis first
  std::uint32_t colour = kWhite;
};

constexpr std::array<Known, 2> kUniform = {{{0, 0, kWhite}, {~std::uint64_t{0}, 0x555555, kBlack}}};

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
  std::array<NibbleModel, 17> rare;         // of bytes that are not in their context's list: halves
  std::array<NibbleModel, 3 * 1024> pairs;  // [level 3, 4, above][colours behind]
  std::array<std::uint8_t, 3 * 1024> pair_symbols{};
};

// The way through a chunk that writer and reader share: `Coder` takes the true symbols down, or finds them.
template <class Coder>
class Walk {
 public:
  explicit Walk(Coder& coder) : coder_(coder) {}

  using Behind = std::array<const Known*, 3>;  // the neighbours towards -x, -y and -z

  Known node(int level, const Behind& behind, const Node& truth) {
    return level == 2 ? brick(behind, truth, BrickOrder()) : inner(level, behind, truth);
  }

  // The same nodes in the order of the curve.
  Subtree gather(const Known& node, int level, unsigned table, NodeArrays& arrays) const {
    if (level == 2) return Subtree::brick(node.word);
    const auto black = static_cast<unsigned>(node.word & 0xFF), gray = static_cast<unsigned>(node.word >> 8 & 0xFF);
    const Known* next = first_child(node, level);
    std::array<std::uint64_t, 8> words;  // of the gray children
    const auto count = static_cast<unsigned>(std::popcount(gray));
    if (level == 3) {
      for (unsigned i = 0; i < count; ++i) words[i] = next[i].word;
    } else {
      for (const curve::Step step : curve::kSteps[table]) {
        if (!(gray >> step.octant & 1)) continue;
        const auto i = static_cast<unsigned>(std::popcount(gray & ((1u << step.octant) - 1)));
        words[i] = gather(next[i], level - 1, step.table, arrays).word;
      }
    }
    return arrays.close(level, black, gray, std::span(words).first(count));
  }

 private:
  const Known* first_child(const Known& node, int level) const {
    return nodes_[static_cast<std::size_t>(level - 1)].data() + (node.word >> 16);
  }

  const Known* child(const Known& node, int level, unsigned octant) const {
    // Without branches, which nobody could predict. The word of a uniform node has all bits alike.
    const bool gray = (node.word >> (8 + octant) & (node.colour >> 1) & 1) != 0;
    const auto before = static_cast<std::size_t>(std::popcount(node.word >> 8 & ((1u << octant) - 1)));
    const Known* const stored =
        nodes_[static_cast<std::size_t>(level - 1)].data() + ((node.word >> 16) + before) * gray;
    const Known* const uniform = &kUniform[node.word >> octant & 1];
    return gray ? stored : uniform;
  }

  template <unsigned... kOctants>
  Known brick(const Behind& behind, const Node& truth, std::integer_sequence<unsigned, kOctants...>) {
    const std::array<std::uint64_t, 3> before = {behind[0]->word, behind[1]->word, behind[2]->word};
    const std::uint64_t true_bits = Coder::kWrites ? truth.brick() : 0;
    std::uint64_t bits = 0;
    // Coder and pointers in hand, so that the models' stores are not feared to change them.
    typename Coder::InHand coder = coder_;
    NibbleModel* const models = models_.bytes.data();
    const CornerModel& corners = corners_;
    (add_byte<kOctants>(coder, models, corners, bits, before,
                        static_cast<unsigned>(true_bits >> (8 * kOctants) & 0xFF)),
     ...);
    put_back(coder);
    if (bits == 0 || ~bits == 0) throw Damage{"has a brick of one colour"};
    return {bits, 0, kGray};
  }

  void put_back(typename Coder::InHand& coder) {
    if constexpr (!Coder::kWrites) coder_ = coder;
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
    unsigned byte = corners.byte(faces, rank);
    if (rank == 15) [[unlikely]] {
      put_back(coder);
      byte = rare_byte(faces, truth);
      if constexpr (!Coder::kWrites) coder = coder_;
    }
    bits |= std::uint64_t{byte} << (8 * kOctant);
  }

  [[gnu::noinline]] unsigned rare_byte(unsigned faces, unsigned truth) {
    const unsigned upper = coder_.symbol(models_.rare[16], truth >> 4, kByteRate);
    const unsigned byte = upper << 4 | coder_.symbol(models_.rare[upper], truth & 15, kByteRate);
    if (corners_.rank(faces, byte) < 15) throw Damage{"tells of likely voxels in the way of unlikely ones"};
    return byte;
  }

  Known inner(int level, const Behind& behind, const Node& truth) {
    const std::uint64_t true_word = Coder::kWrites ? truth.word() : 0;
    const auto true_colour = [&](unsigned octant) {
      return static_cast<unsigned>((true_word >> octant & 1) | (true_word >> (7 + octant) & 2));
    };
    const std::size_t set = 1024 * static_cast<std::size_t>(std::min(level, 5) - 3);
    std::array<unsigned, 4> pairs{};
    unsigned black = 0, gray = 0;
    typename Coder::InHand coder = coder_;
    NibbleModel* const models = models_.pairs.data() + set;
    std::uint8_t* const all_symbols = models_.pair_symbols.data() + set;
    for (unsigned i = 0; i < 4; ++i) {  // the octants 2i and 2i + 1
      const unsigned x = behind[0]->faces >> (2 * i) & 3;
      const unsigned y = i & 1 ? pairs[i ^ 1] : behind[1]->faces >> (8 + 2 * i) & 15;
      const unsigned z = i & 2 ? pairs[i ^ 2] : behind[2]->faces >> (16 + 4 * i) & 15;
      const unsigned at = x | y << 2 | z << 6;
      std::uint8_t& symbols = all_symbols[at];
      const int rate = std::min(kLastPairRate, kFirstPairRate + symbols / kSymbolsPerRate);
      symbols = static_cast<std::uint8_t>(symbols + (symbols < 255));
      const unsigned pair = coder.symbol(models[at], true_colour(2 * i) | true_colour(2 * i + 1) << 2, rate);
      if ((pair & 3) == 3 || pair >= 12) throw Damage{"has a node of unknown colour"};
      pairs[i] = pair;
      black |= ((pair & 1) | (pair >> 1 & 2)) << (2 * i);
      gray |= ((pair >> 1 & 1) | (pair >> 2 & 2)) << (2 * i);
    }
    put_back(coder);
    if (gray == 0 && (black == 0 || black == 0xFF)) throw Damage{"has a node of one colour"};

    std::array<Known, 8> children;
    for (unsigned o = 0; o < 8; ++o) children[o] = kUniform[black >> o & 1];
    for (unsigned rest = gray; rest; rest &= rest - 1) {
      const auto o = static_cast<unsigned>(std::countr_zero(rest));
      // These stay where they are: the nodes of the children's level are stored when this node is done.
      Behind before;
      for (unsigned axis = 0; axis < 3; ++axis)
        before[axis] = o >> axis & 1 ? &children[o ^ 1u << axis] : child(*behind[axis], level, o ^ 1u << axis);
      children[o] = node(level - 1, before, Coder::kWrites ? truth.child(static_cast<int>(o)) : Node());
    }
    unsigned faces = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
      for (unsigned quarter = 0; quarter < 4; ++quarter) {
        const Known& part = children[kUpper[axis][quarter]];
        const unsigned colour = level == 3 ? brick_face(part.word, axis) : kFaceColour[part.faces >> (8 * axis) & 0xFF];
        faces |= colour << (8 * axis + 2 * quarter);
      }
    auto& below = nodes_[static_cast<std::size_t>(level - 1)];
    const std::uint64_t first = gray ? below.size() : 0;
    for (unsigned rest = gray; rest; rest &= rest - 1)
      below.push_back(children[static_cast<unsigned>(std::countr_zero(rest))]);
    return {black | gray << 8 | first << 16, faces, kGray};
  }

  Coder& coder_;
  const CornerModel& corners_ = CornerModel::get();
  Models models_;
  std::array<std::vector<Known>, kMaxDepth + 1> nodes_;  // the gray children of finished nodes, by level
};

constexpr std::array<const Known*, 3> kNothingBehind = {&kUniform[0], &kUniform[0], &kUniform[0]};

}  // namespace

std::vector<std::uint8_t> encode_solid(const Node& node) {
  NibbleEncoder coder;
  Walk<NibbleEncoder> walk(coder);
  walk.node(node.level(), kNothingBehind, node);
  return coder.finish();
}

Subtree decode_solid(std::span<const std::uint8_t> bytes, int level, unsigned table, NodeArrays& arrays) {
  NibbleDecoder coder(bytes);
  Walk<NibbleDecoder> walk(coder);
  const Known top = walk.node(level, kNothingBehind, Node());
  coder.expect_end();
  return walk.gather(top, level, table, arrays);
}

}  // namespace blackleaf::detail
