// What eight voxels are likely to be when the twelve before them are known.
//
// The solid coder (solid_coder.h) meets the 2^3 voxels of a byte when the three faces behind it, towards -x, -y and -z,
// are known: 4 voxels each. On a surface that is flat at this scale few bytes are possible behind given faces. Which
// they are, and how often, is counted over planes; nothing is taken from any particular object.
//
// Faces that differ by an exchange of axes or of black and white are one context, and so learn together: 4096 faces
// make some 400 contexts. Every context lists its 15 likeliest bytes; symbol 15 stands for all others.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "file/nibble_coder.h"

namespace blackleaf::detail {

class CornerModel {
 public:
  /// Made at first use, in about a millisecond.
  static const CornerModel& get();

  /// The number of the faces behind a byte, from the bytes towards -x, -y and -z.
  unsigned faces(unsigned x, unsigned y, unsigned z) const { return face_[0][x] | face_[1][y] | face_[2][z]; }
  /// The number of their context, below context_count().
  std::size_t context(unsigned faces) const { return contexts_[faces].number; }
  std::size_t context_count() const { return candidates_.size(); }

  /// The rank of a byte behind these faces, or 15 if it is none of the likely ones.
  unsigned rank(unsigned faces, unsigned byte) const {
    const Context& context = contexts_[faces];
    return ranks_[context.number][to_own_[context.exchange][byte]];
  }
  /// The byte of a rank below 15.
  unsigned byte(unsigned faces, unsigned rank) const { return bytes_[faces][rank]; }
  /// The models of all contexts before anything is known of the object.
  const std::vector<NibbleModel>& models() const { return models_; }

 private:
  CornerModel();

  // Faces are one of a context's, but for an exchange of axes and colours.
  struct Context {
    std::uint16_t number;
    std::uint8_t exchange;
  };
  using Bytes = std::array<std::uint8_t, 256>;
  std::array<std::array<std::uint16_t, 256>, 3> face_{};  // [axis][byte]: its upper face as 4 of 12 bits
  std::array<Context, 4096> contexts_{};
  std::array<Bytes, 12> to_own_{};                          // [exchange][byte]
  std::array<std::array<std::uint8_t, 16>, 4096> bytes_{};  // [faces][rank]
  std::vector<std::array<std::uint8_t, 16>> candidates_;    // [context][rank]
  std::vector<Bytes> ranks_;                                // [context][byte]
  std::vector<NibbleModel> models_;
};

}  // namespace blackleaf::detail
