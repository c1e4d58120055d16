// FoundPieces: pieces as they are found, already among those of neighbouring picture lines.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "edge_family.h"
#include "kept_memory.h"

namespace blackleaf::detail {

/// The least and the most of some numbers.
struct Bounds {
  std::int64_t least = std::numeric_limits<std::int64_t>::max(), most = std::numeric_limits<std::int64_t>::min();

  void add(std::int64_t number) { least = std::min(least, number), most = std::max(most, number); }
  /// Bits of the numbers, counted from the least. Requires: there are some.
  int bits() const { return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(most - least))); }
};

/// Buckets of picture lines of a class: so many neighbouring keys each, in order.
class PieceBuckets {
 public:
  PieceBuckets() = default;  // none
  /// About 2^bits, or one a key.
  PieceBuckets(const Bounds& keys, int bits)
      : least_(keys.least),
        shift_(std::max(0, keys.bits() - bits)),
        count_((static_cast<std::size_t>(keys.most - keys.least) >> shift_) + 1) {}

  std::size_t count() const { return count_; }
  std::size_t of(std::int64_t key) const {
    assert(key >= least_ && static_cast<std::size_t>(key - least_) >> shift_ < count_);
    return static_cast<std::size_t>(key - least_) >> shift_;
  }
  /// The keys that a bucket can have.
  Bounds keys(std::size_t bucket) const {
    const std::int64_t first = least_ + static_cast<std::int64_t>(bucket << shift_);
    return {first, first + (std::int64_t{1} << shift_) - 1};
  }

 private:
  std::int64_t least_ = 0;
  int shift_ = 0;
  std::size_t count_ = 0;
};

using ClassBuckets = std::array<PieceBuckets, 3>;  // by line class

/// For one thread.
class FoundPieces {
 public:
  explicit FoundPieces(const ClassBuckets& buckets) {
    for (std::size_t k = 0; k < classes_.size(); ++k) classes_[k] = {buckets[k], std::vector<List>(buckets[k].count())};
  }
  FoundPieces(const FoundPieces&) = delete;
  FoundPieces& operator=(const FoundPieces&) = delete;
  ~FoundPieces() {
    for (std::vector<Chunk>& slab : slabs_) KeptMemory<Chunk>::give(slab);
  }

  void add(unsigned line_class, const Piece& piece) {
    Class& of = classes_[line_class];
    List& list = of.lists[of.buckets.of(piece.key)];
    if (list.next == list.end) [[unlikely]]
      grow(list);
    // One number at a time: what has just been written in parts is slow to read as a whole.
    Piece& next = *list.next++;
    next.key = piece.key, next.low = piece.low, next.high = piece.high;
  }

  std::size_t count(std::size_t line_class, std::size_t bucket) const {
    return classes_[line_class].lists[bucket].count();
  }
  /// Calls visit(piece) for the pieces of a bucket, in the order in which they came.
  template <class Visit>
  void for_each(std::size_t line_class, std::size_t bucket, const Visit& visit) const {
    const List& list = classes_[line_class].lists[bucket];
    for (const Chunk* chunk = list.first; chunk; chunk = chunk->next) {
      const Piece* const end = chunk == list.last ? list.next : chunk->end();
      for (const Piece* piece = chunk->pieces.data(); piece != end; ++piece) visit(*piece);
      if (chunk == list.last) return;
    }
  }
  /// Puts other pieces in the place of those of a bucket. Requires: they are not more.
  void replace(std::size_t line_class, std::size_t bucket, std::span<const Piece> pieces) {
    List& list = classes_[line_class].lists[bucket];
    assert(pieces.size() <= list.count());
    Chunk* chunk = list.first;
    for (list.room = 0; chunk; chunk = chunk->next) {
      const std::size_t count = std::min(pieces.size() - list.room, chunk->pieces.size());
      const auto from = pieces.begin() + static_cast<std::ptrdiff_t>(list.room);
      list.next = std::copy(from, from + static_cast<std::ptrdiff_t>(count), chunk->pieces.data());
      list.end = chunk->end(), list.last = chunk;
      list.room += chunk->pieces.size();
      if (list.room >= pieces.size()) return;
    }
  }

 private:
  struct Chunk {
    Chunk() {}
    Piece* end() { return pieces.data() + pieces.size(); }
    const Piece* end() const { return pieces.data() + pieces.size(); }

    Chunk* next;  // of all but the last
    std::array<Piece, 64> pieces;
  };
  struct List {
    Piece *next = nullptr, *end = nullptr;  // in the last chunk
    Chunk *first = nullptr, *last = nullptr;
    std::size_t room = 0;

    std::size_t count() const { return room - static_cast<std::size_t>(end - next); }
  };

  struct Class {
    PieceBuckets buckets;
    std::vector<List> lists;
  };

  [[gnu::noinline]] void grow(List& list) {
    constexpr std::size_t kChunks = KeptMemory<Chunk>::kMost;
    if (slabs_.empty() || slabs_.back().size() == kChunks) {
      slabs_.push_back(KeptMemory<Chunk>::take());
      slabs_.back().reserve(kChunks);
    }
    Chunk& chunk = slabs_.back().emplace_back();
    (list.first ? list.last->next : list.first) = &chunk;
    list.last = &chunk;
    list.next = chunk.pieces.data(), list.end = chunk.end();
    list.room += chunk.pieces.size();
  }

  std::array<Class, 3> classes_;
  std::vector<std::vector<Chunk>> slabs_;
};

}  // namespace blackleaf::detail
