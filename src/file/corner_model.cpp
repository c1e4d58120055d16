#include "file/corner_model.h"

#include <algorithm>
#include <numeric>

namespace blackleaf::detail {
namespace {

// The exchanges: number 6c + p turns black and white around if c is 1, then axis i of the image is axis kAxes[p][i].
constexpr std::array<std::array<std::uint8_t, 3>, 6> kAxes = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

// Faces as 12 bits: bit 4a + i + 2j belongs to axis a and to the voxel with the coordinates i and j on the other two
// axes, the lower axis first.
struct FaceBit {
  std::array<std::uint8_t, 3> at;  // in 0..2^3, where the byte itself is 1..2^3
};

constexpr std::array<std::uint8_t, 3> face_voxel(unsigned bit) {
  std::array<std::uint8_t, 3> at{};
  const unsigned axis = bit / 4, lower = axis == 0 ? 1 : 0, upper = axis == 2 ? 1 : 2;
  at[lower] = static_cast<std::uint8_t>(1 + (bit & 1));
  at[upper] = static_cast<std::uint8_t>(1 + (bit >> 1 & 1));
  return at;
}

constexpr unsigned face_bit(const std::array<std::uint8_t, 3>& at) {
  const unsigned axis = at[0] == 0 ? 0 : at[1] == 0 ? 1 : 2;
  const unsigned lower = axis == 0 ? 1 : 0, upper = axis == 2 ? 1 : 2;
  return 4 * axis + at[lower] - 1u + 2u * (at[upper] - 1u);
}

constexpr std::array<std::uint8_t, 3> exchanged(const std::array<std::uint8_t, 3>& at, unsigned exchange) {
  const auto& axes = kAxes[exchange % 6];
  return {at[axes[0]], at[axes[1]], at[axes[2]]};
}

// Planes have whole normals on the surface of the cube [-kNormal, kNormal]^3, close enough to all directions alike.
constexpr int kNormal = 5;
// Shares that every symbol has before anything is known, of 2^14.
constexpr int kLeastShare = 24;

}  // namespace

const CornerModel& CornerModel::get() {
  static const CornerModel model;
  return model;
}

CornerModel::CornerModel() {
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned byte = 0; byte < 256; ++byte)
      for (unsigned bit = 4 * axis; bit < 4 * axis + 4; ++bit) {
        auto at = face_voxel(bit);
        at[axis] = 2;  // the upper face of the byte before
        const unsigned octant = (at[0] - 1u) | (at[1] - 1u) << 1 | (at[2] - 1u) << 2;
        if (byte >> octant & 1) face_[axis][byte] |= static_cast<std::uint16_t>(1u << bit);
      }

  std::array<std::array<std::uint16_t, 4096>, 12> exchanged_faces{};
  std::array<Bytes, 12> from_own{};
  for (unsigned e = 0; e < 12; ++e) {
    std::array<unsigned, 12> face_to{};
    std::array<unsigned, 8> octant_to{};
    for (unsigned bit = 0; bit < 12; ++bit) face_to[bit] = face_bit(exchanged(face_voxel(bit), e));
    for (std::uint8_t o = 0; o < 8; ++o) {
      const auto to = exchanged(
          {static_cast<std::uint8_t>(o & 1), static_cast<std::uint8_t>(o >> 1 & 1), static_cast<std::uint8_t>(o >> 2)},
          e);
      octant_to[o] = to[0] + 2u * to[1] + 4u * to[2];
    }
    for (unsigned faces = 0; faces < 4096; ++faces) {
      unsigned to = 0;
      for (unsigned bit = 0; bit < 12; ++bit) to |= (faces >> bit & 1) << face_to[bit];
      exchanged_faces[e][faces] = static_cast<std::uint16_t>(e < 6 ? to : to ^ 0xFFF);
    }
    for (unsigned byte = 0; byte < 256; ++byte) {
      unsigned to = 0;
      for (unsigned o = 0; o < 8; ++o) to |= (byte >> o & 1) << octant_to[o];
      if (e >= 6) to ^= 0xFF;
      to_own_[e][byte] = static_cast<std::uint8_t>(to);
      from_own[e][to] = static_cast<std::uint8_t>(byte);
    }
  }

  // A context is the smallest number that the exchanges make of its faces; contexts are numbered in that order.
  std::vector<int> number(4096, -1);
  for (unsigned faces = 0; faces < 4096; ++faces) {
    unsigned least = 0;
    for (unsigned e = 1; e < 12; ++e)
      if (exchanged_faces[e][faces] < exchanged_faces[least][faces]) least = e;
    int& own = number[exchanged_faces[least][faces]];
    if (own < 0) {
      own = static_cast<int>(candidates_.size());
      candidates_.emplace_back();
    }
    contexts_[faces] = {static_cast<std::uint16_t>(own), static_cast<std::uint8_t>(least)};
  }

  ranks_.resize(candidates_.size());
  std::vector<std::array<int, 256>> counts(candidates_.size());
  for (int a = -kNormal; a <= kNormal; ++a)
    for (int b = -kNormal; b <= kNormal; ++b)
      for (int c = -kNormal; c <= kNormal; ++c) {
        if (std::max({std::abs(a), std::abs(b), std::abs(c)}) != kNormal) continue;
        const auto height = [&](const std::array<std::uint8_t, 3>& at) { return a * at[0] + b * at[1] + c * at[2]; };
        const int least = 2 * (std::min(a, 0) + std::min(b, 0) + std::min(c, 0));
        const int most = 2 * (std::max(a, 0) + std::max(b, 0) + std::max(c, 0));
        for (int above = least; above <= most + 1; ++above) {  // black: height below `above`
          unsigned faces = 0, byte = 0;
          for (unsigned bit = 0; bit < 12; ++bit) faces |= (height(face_voxel(bit)) < above ? 1u : 0u) << bit;
          for (unsigned o = 0; o < 8; ++o)
            byte |= (height({static_cast<std::uint8_t>(1 + (o & 1)), static_cast<std::uint8_t>(1 + (o >> 1 & 1)),
                             static_cast<std::uint8_t>(1 + (o >> 2))}) < above
                         ? 1u
                         : 0u)
                    << o;
          const Context& context = contexts_[faces];
          ++counts[context.number][to_own_[context.exchange][byte]];
        }
      }

  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    std::array<int, 256> order;
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int p, int q) {
      return counts[i][static_cast<std::size_t>(p)] > counts[i][static_cast<std::size_t>(q)];
    });
    std::array<int, 16> shares{};
    const int all = std::accumulate(counts[i].begin(), counts[i].end(), 1);
    int left = static_cast<int>(kShares);
    ranks_[i].fill(15);
    for (std::size_t rank = 0; rank < 16; ++rank) {
      if (rank < 15) ranks_[i][static_cast<std::size_t>(order[rank])] = static_cast<std::uint8_t>(rank);
      if (rank < 15) candidates_[i][rank] = static_cast<std::uint8_t>(order[rank]);
      const int seen = rank < 15 ? counts[i][static_cast<std::size_t>(order[rank])] : 0;
      shares[rank] = kLeastShare + (static_cast<int>(kShares) - 16 * kLeastShare) / all * seen;
      left -= shares[rank];
    }
    // What is left over by rounding goes to all alike, the rest of that to the first.
    for (int& share : shares) share += left / 16;
    shares[0] += left % 16;
    models_.push_back(NibbleModel::of(shares));
  }

  for (unsigned faces = 0; faces < 4096; ++faces)
    for (unsigned rank = 0; rank < 15; ++rank)
      bytes_[faces][rank] = from_own[contexts_[faces].exchange][candidates_[contexts_[faces].number][rank]];
}

}  // namespace blackleaf::detail
