// Pieces of many threads in order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "blackleaf/work.h"
#include "edge_family.h"
#include "octree/parallel.h"
#include "piece_pool.h"

namespace blackleaf::detail {

/// By line class.
using ClassedPieces = std::array<std::vector<Piece>, 3>;

/// The least and the most of some numbers.
struct Bounds {
  std::int64_t least = std::numeric_limits<std::int64_t>::max(), most = std::numeric_limits<std::int64_t>::min();

  void add(std::int64_t number) { least = std::min(least, number), most = std::max(most, number); }
  void add(const Bounds& bounds) { least = std::min(least, bounds.least), most = std::max(most, bounds.most); }
  /// Bits of the numbers, counted from the least. Requires: there are some.
  int bits() const { return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(most - least))); }
};

/// Ranges of (key, low), in order: of keys, or, if there are few keys, of positions on each.
class PieceRanges {
 public:
  PieceRanges() = default;
  /// No more than about 2^bits.
  PieceRanges(const Bounds& keys, const Bounds& lows, int bits) : key_(keys.least), low_(lows.least) {
    key_shift_ = std::max(0, keys.bits() - bits);
    low_bits_ = std::min(lows.bits(), std::max(0, bits - keys.bits()));
    low_shift_ = lows.bits() - low_bits_;
    count_ = ((static_cast<std::size_t>(keys.most - keys.least) >> key_shift_) + 1) << low_bits_;
  }
  std::size_t count() const { return count_; }
  std::size_t of(const Piece& piece) const {
    const std::size_t key = static_cast<std::size_t>(piece.key - key_) >> key_shift_;
    if (low_bits_ == 0) return key;
    return key << low_bits_ | static_cast<std::size_t>(piece.low - low_) >> low_shift_;
  }

 private:
  std::int64_t key_ = 0, low_ = 0;
  int key_shift_ = 0, low_bits_ = 0, low_shift_ = 0;
  std::size_t count_ = 0;
};

/// All pieces of all parts, each class sorted; the parts are left empty. Pieces are distributed among about as many
/// ranges as there are pieces, part by part into places known from counting, and each range is sorted: O(n) for pieces
/// that are spread evenly, O(n log n) in any case.
inline ClassedPieces sorted(std::span<ClassedPieces* const> parts, const Work& work) {
  struct Share {  // of a part, of a class
    Bounds keys{}, lows{};
    std::vector<std::size_t> place{};  // by range: how many, then where the next goes
  };
  ClassedPieces all;
  const std::size_t n = all.size();
  std::array<PieceRanges, 3> ranges;  // by class
  std::vector<Share> shares(n * parts.size());
  const Work quietly{work.threads, {}};
  const auto for_each_share = [&](const auto& body) {
    for_each_index(shares.size(), quietly, [&](std::size_t i) { body(shares[i], (*parts[i / n])[i % n], i % n); });
  };

  for_each_share([](Share& share, const std::vector<Piece>& pieces, std::size_t) {
    for (const Piece& piece : pieces) share.keys.add(piece.key), share.lows.add(piece.low);
  });
  for_each_index(n, quietly, [&](std::size_t k) {
    std::size_t count = 0;
    Bounds keys, lows;
    for (std::size_t i = k; i < shares.size(); i += n) {
      count += (*parts[i / n])[k].size();
      keys.add(shares[i].keys), lows.add(shares[i].lows);
    }
    all[k] = PiecePool::take();
    if (count == 0) return;
    all[k].resize(count);
    // Of many parts each has a counter for every range.
    const int coarser = std::max(0, static_cast<int>(std::bit_width(parts.size())) - 2);
    ranges[k] = {keys, lows, static_cast<int>(std::bit_width(count)) - coarser};
  });
  for_each_share([&](Share& share, const std::vector<Piece>& pieces, std::size_t k) {
    share.place.resize(ranges[k].count());
    for (const Piece& piece : pieces) ++share.place[ranges[k].of(piece)];
  });
  for_each_index(n, quietly, [&](std::size_t k) {
    std::size_t place = 0;
    for (std::size_t range = 0; range < ranges[k].count(); ++range)
      for (std::size_t i = k; i < shares.size(); i += n) {
        const std::size_t count = shares[i].place[range];
        shares[i].place[range] = place;
        place += count;
      }
  });
  for_each_share([&](Share& share, std::vector<Piece>& pieces, std::size_t k) {
    for (const Piece& piece : pieces) all[k][share.place[ranges[k].of(piece)]++] = piece;
    PiecePool::give(pieces);
  });

  // A range ends where the last part's pieces of it do.
  constexpr std::size_t kAtOnce = 4096;
  struct Task {
    std::size_t k, begin, end;
  };
  std::vector<Task> tasks;
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t begin = 0; begin < ranges[k].count(); begin += kAtOnce)
      tasks.push_back({k, begin, std::min(begin + kAtOnce, ranges[k].count())});
  for_each_index(tasks.size(), quietly, [&](std::size_t i) {
    const auto [k, first, last] = tasks[i];
    const std::vector<std::size_t>& ends = shares[shares.size() - n + k].place;
    const auto at = [&, k = k](std::size_t place) { return all[k].begin() + static_cast<std::ptrdiff_t>(place); };
    for (std::size_t range = first, begin = first == 0 ? 0 : ends[first - 1]; range < last; begin = ends[range++])
      if (ends[range] > begin + 1) std::sort(at(begin), at(ends[range]));
  });
  return all;
}

}  // namespace blackleaf::detail
