#include "strokes.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>

namespace blackleaf::detail {

namespace {

// Calls visit(key, low, high) for each maximal piece, in order.
template <class Visit>
void for_each_united(std::span<const Piece> pieces, const Visit& visit) {
  for (std::size_t i = 0; i < pieces.size();) {
    const std::int64_t key = pieces[i].key, low = pieces[i].low;
    std::int64_t high = pieces[i].high;
    for (++i; i < pieces.size() && pieces[i].key == key && pieces[i].low <= high; ++i)
      high = std::max(high, pieces[i].high);
    visit(key, low, high);
  }
}

// Far from the origin a stroke can be shorter than the doubles tell apart; such a one draws nothing.
bool draws_nothing(const Stroke& stroke) { return stroke.from == stroke.to; }

// Ranges of (key, low), in order: of keys, or, if there are few keys, of positions on each.
class PieceRanges {
 public:
  // No more than about 2^bits.
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
  std::int64_t key_, low_;
  int key_shift_, low_bits_, low_shift_;
  std::size_t count_;
};

// Pieces on neighbouring picture lines, of all who have found some.
class Bucket {
 public:
  Bucket(std::span<FoundPieces* const> parts, const ClassLines& of, const PieceBuckets& buckets, std::size_t index)
      : parts_(parts), of_(of), index_(index), keys_(buckets.keys(index)) {
    for (const FoundPieces* part : parts) count_ += part->count(of.line_class, index);
  }

  std::size_t count() const { return count_; }

  // Puts them in order and unites those that overlap or touch.
  void unite() {
    const bool few = count_ <= std::numeric_limits<std::uint32_t>::max();
    std::vector<Piece> pieces = few ? sorted<std::uint32_t>() : sorted<std::size_t>();
    count_ = 0;
    for_each_united(pieces, [&](std::int64_t key, std::int64_t low, std::int64_t high) {
      pieces[count_++] = {key, low, high};
    });
    std::span<const Piece> left(pieces.data(), count_);
    for (FoundPieces* part : parts_) {
      const std::size_t count = std::min(left.size(), part->count(of_.line_class, index_));
      part->replace(of_.line_class, index_, left.first(count));
      left = left.subspan(count);
    }
  }

  // Writes a stroke for each; whether all draw something.
  bool draw(Stroke* next) const {
    bool all_draw = true;
    for_each([&](const Piece& piece) {
      const Stroke stroke{of_.picture.point(piece.key, piece.low), of_.picture.point(piece.key, piece.high)};
      all_draw &= !draws_nothing(stroke);
      *next++ = stroke;
    });
    return all_draw;
  }

 private:
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const FoundPieces* part : parts_) part->for_each(of_.line_class, index_, visit);
  }

  // They are distributed among about as many ranges as there are pieces, and each range is sorted. Place holds count().
  template <class Place>
  std::vector<Piece> sorted() const {
    const auto bits = static_cast<int>(std::bit_width(count_));
    Bounds lows;
    if (keys_.bits() >= bits)
      lows = {0, 0};  // does not matter
    else
      for_each([&](const Piece& piece) { lows.add(piece.low); });
    const PieceRanges ranges(keys_, lows, bits);
    std::vector<Place> places(ranges.count());  // how many pieces, then where the next goes, then where they end
    for_each([&](const Piece& piece) { ++places[ranges.of(piece)]; });
    Place place = 0;
    for (Place& of_range : places) place += std::exchange(of_range, place);
    std::vector<Piece> pieces(count_);
    for_each([&](const Piece& piece) { pieces[places[ranges.of(piece)]++] = piece; });
    std::size_t begin = 0;
    for (const std::size_t end : places) {
      if (end > begin + 1) std::sort(&pieces[begin], &pieces[begin] + (end - begin));
      begin = end;
    }
    return pieces;
  }

  std::span<FoundPieces* const> parts_;
  const ClassLines& of_;
  std::size_t index_;  // among the buckets of the class
  Bounds keys_;
  std::size_t count_ = 0;
};

}  // namespace

std::vector<Stroke> strokes_of(std::span<FoundPieces* const> parts, const ClassBuckets& buckets,
                               std::span<const ClassLines> classes, Team& team) {
  std::vector<Bucket> filled;
  for (const ClassLines& of : classes) {
    const PieceBuckets& of_class = buckets[of.line_class];
    for (std::size_t i = 0; i < of_class.count(); ++i)
      if (const Bucket bucket(parts, of, of_class, i); bucket.count() > 0) filled.push_back(bucket);
  }
  team.for_each_index(filled.size(), [&](std::size_t i) { filled[i].unite(); });
  std::vector<std::size_t> places;
  places.reserve(filled.size());
  std::size_t count = 0;
  for (const Bucket& bucket : filled) places.push_back(std::exchange(count, count + bucket.count()));
  std::vector<Stroke> strokes(count);
  std::atomic<bool> all_draw = true;
  team.for_each_index(filled.size(), [&](std::size_t i) {
    if (!filled[i].draw(strokes.data() + places[i])) all_draw = false;
  });
  if (!all_draw) std::erase_if(strokes, draws_nothing);
  return strokes;
}

}  // namespace blackleaf::detail
