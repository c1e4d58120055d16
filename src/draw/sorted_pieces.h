// Pieces of many tasks in order.
#pragma once

#include <algorithm>
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

/// All pieces, sorted; the parts are left empty. Pieces are distributed by their keys among as many ranges of keys as
/// there are pieces, and each range is sorted: O(n) for keys that are spread evenly, O(n log n) in any case.
inline std::vector<Piece> sorted(std::span<std::vector<Piece>* const> parts, const Work& work) {
  std::size_t count = 0;
  std::int64_t least = std::numeric_limits<std::int64_t>::max(), most = std::numeric_limits<std::int64_t>::min();
  for (const std::vector<Piece>* part : parts) {
    count += part->size();
    for (const Piece& piece : *part) least = std::min(least, piece.key), most = std::max(most, piece.key);
  }
  std::vector<Piece> all = PiecePool::take();
  all.resize(count);
  if (count == 0) return all;
  const auto span = static_cast<std::uint64_t>(most - least);  // keys are below 2^42
  const int shift = std::max(0, static_cast<int>(std::bit_width(span)) - static_cast<int>(std::bit_width(count)));
  const auto range = [&](const Piece& piece) { return static_cast<std::size_t>((piece.key - least) >> shift); };
  std::vector<std::size_t> end((span >> shift) + 2, 0);  // of a range; first that of the one before it
  for (const std::vector<Piece>* part : parts)
    for (const Piece& piece : *part) ++end[range(piece) + 1];
  for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
  for (std::vector<Piece>* part : parts) {
    for (const Piece& piece : *part) all[end[range(piece)]++] = piece;
    PiecePool::give(*part);
  }
  constexpr std::size_t kAtOnce = 4096;
  for_each_index((end.size() + kAtOnce - 1) / kAtOnce, {work.threads, {}}, [&](std::size_t i) {
    const std::size_t last = std::min((i + 1) * kAtOnce, end.size());
    const auto at = [&](std::size_t place) { return all.begin() + static_cast<std::ptrdiff_t>(place); };
    for (std::size_t k = i * kAtOnce, begin = k == 0 ? 0 : end[k - 1]; k < last; begin = end[k++])
      if (end[k] > begin + 1) std::sort(at(begin), at(end[k]));
  });
  return all;
}

}  // namespace blackleaf::detail
