// PiecePool: memory for pieces that the next drawing uses again.
//
// Memory that one drawing gives back, the system takes away and gives to the next page by page: of the time that a ball
// of radius 32 takes that was a tenth.
#pragma once

#include <mutex>
#include <utility>
#include <vector>

#include "edge_family.h"

namespace blackleaf::detail {

/// Keeps a mebibyte at the most. Safe to use from many threads.
class PiecePool {
 public:
  /// An empty vector, with room if there is one that was given.
  static std::vector<Piece> take() {
    PiecePool& pool = the_one();
    const std::lock_guard lock(pool.mutex_);
    if (pool.kept_.empty()) return {};
    std::vector<Piece> pieces = std::move(pool.kept_.back());
    pool.kept_.pop_back();
    return pieces;
  }
  /// What `pieces` holds is lost; they are left empty, without room.
  static void give(std::vector<Piece>& pieces) {
    std::vector<Piece> given = std::exchange(pieces, {});
    if (given.capacity() == 0 || given.capacity() > kMostPieces) return;
    given.clear();
    PiecePool& pool = the_one();
    const std::lock_guard lock(pool.mutex_);
    if (pool.kept_.size() < kMostVectors) pool.kept_.push_back(std::move(given));
  }

 private:
  static constexpr std::size_t kMostVectors = 8, kMostPieces = (std::size_t{1} << 17) / sizeof(Piece);

  PiecePool() { kept_.reserve(kMostVectors); }
  static PiecePool& the_one() {
    static PiecePool pool;
    return pool;
  }

  std::mutex mutex_;
  std::vector<std::vector<Piece>> kept_;
};

}  // namespace blackleaf::detail
