// KeptMemory: memory that the next drawing uses again.
//
// Memory that one drawing gives back, the system takes away and gives to the next page by page: of the time that a ball
// of radius 32 takes that was a tenth.
#pragma once

#include <cstddef>
#include <mutex>
#include <utility>
#include <vector>

namespace blackleaf::detail {

/// Vectors of T whose elements need not be set to anything; keeps a mebibyte at the most. Safe to use from many
/// threads.
template <class T>
class KeptMemory {
 public:
  static constexpr std::size_t kMost = (std::size_t{1} << 17) / sizeof(T);  // elements of one vector

  /// An empty vector, with room if there is one that was given.
  static std::vector<T> take() {
    KeptMemory& memory = the_one();
    const std::lock_guard lock(memory.mutex_);
    if (memory.kept_.empty()) return {};
    std::vector<T> vector = std::move(memory.kept_.back());
    memory.kept_.pop_back();
    return vector;
  }
  /// What `vector` holds is lost; it is left empty, without room.
  static void give(std::vector<T>& vector) {
    std::vector<T> given = std::exchange(vector, {});
    if (given.capacity() == 0 || given.capacity() > kMost) return;
    given.clear();
    KeptMemory& memory = the_one();
    const std::lock_guard lock(memory.mutex_);
    if (memory.kept_.size() < kMostVectors) memory.kept_.push_back(std::move(given));
  }

 private:
  static constexpr std::size_t kMostVectors = 8;

  KeptMemory() { kept_.reserve(kMostVectors); }
  static KeptMemory& the_one() {
    static KeptMemory memory;
    return memory;
  }

  std::mutex mutex_;
  std::vector<std::vector<T>> kept_;
};

}  // namespace blackleaf::detail
