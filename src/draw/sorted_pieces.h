// Pieces of many threads in order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "blackleaf/work.h"
#include "edge_family.h"
#include "octree/parallel.h"
#include "piece_pool.h"

namespace blackleaf::detail {

/// The least and the most of some numbers.
struct Bounds {
  std::int64_t least = std::numeric_limits<std::int64_t>::max(), most = std::numeric_limits<std::int64_t>::min();

  void add(std::int64_t number) { least = std::min(least, number), most = std::max(most, number); }
  void add(const Bounds& bounds) { least = std::min(least, bounds.least), most = std::max(most, bounds.most); }
  /// Bits of the numbers, counted from the least. Requires: there are some.
  int bits() const { return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(most - least))); }
};

/// Pieces of a line class as they are found.
struct FoundPieces {
  std::vector<Piece> pieces = PiecePool::take();
  Bounds keys{}, lows{};

  void add(const Piece& piece) {
    pieces.push_back(piece);
    keys.add(piece.key), lows.add(piece.low);
  }
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

/// All pieces of all parts, each line class sorted; the parts are left empty. Pieces are distributed among about as
/// many ranges as there are pieces, part by part into places known from counting, and each range is sorted: O(n) for
/// pieces that are spread evenly, O(n log n) in any case.
inline std::array<std::vector<Piece>, 3> sorted(std::span<std::array<FoundPieces, 3>* const> parts, const Work& work) {
  std::array<std::vector<Piece>, 3> all;
  const std::size_t n = all.size();
  std::array<std::size_t, 3> counts{};  // by class
  std::array<PieceRanges, 3> ranges;
  for (std::size_t k = 0; k < n; ++k) {
    Bounds keys, lows;
    for (const auto* part : parts) {
      counts[k] += (*part)[k].pieces.size();
      keys.add((*part)[k].keys), lows.add((*part)[k].lows);
    }
    // Of many parts each has a counter for every range.
    const int coarser = std::max(0, static_cast<int>(std::bit_width(parts.size())) - 2);
    if (counts[k] > 0) ranges[k] = {keys, lows, static_cast<int>(std::bit_width(counts[k])) - coarser};
  }
  const Work quietly{work.threads, {}};
  using Places = std::vector<std::size_t>;  // by range: how many pieces, then where the next goes
  std::vector<Places> shares(n * parts.size());
  const auto for_each_share = [&](const auto& body) {
    for_each_index(shares.size(), quietly,
                   [&](std::size_t i) { body(shares[i], (*parts[i / n])[i % n].pieces, i % n); });
  };

  for_each_share([&](Places& places, const std::vector<Piece>& pieces, std::size_t k) {
    places.resize(ranges[k].count());
    for (const Piece& piece : pieces) ++places[ranges[k].of(piece)];
  });
  for_each_index(n, quietly, [&](std::size_t k) {
    if (counts[k] == 0) return;
    all[k] = PiecePool::take();
    all[k].resize(counts[k]);
    std::size_t place = 0;
    for (std::size_t range = 0; range < ranges[k].count(); ++range)
      for (std::size_t i = k; i < shares.size(); i += n) place += std::exchange(shares[i][range], place);
  });
  for_each_share([&](Places& places, std::vector<Piece>& pieces, std::size_t k) {
    for (const Piece& piece : pieces) all[k][places[ranges[k].of(piece)]++] = piece;
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
    const Places& ends = shares[shares.size() - n + k];
    const auto at = [&, k = k](std::size_t place) { return all[k].begin() + static_cast<std::ptrdiff_t>(place); };
    for (std::size_t range = first, begin = first == 0 ? 0 : ends[first - 1]; range < last; begin = ends[range++])
      if (ends[range] > begin + 1) std::sort(at(begin), at(ends[range]));
  });
  return all;
}

}  // namespace blackleaf::detail
