// WordArray: the words of one level while a tree grows, and for good once it is complete.
//
// A std::vector that doubles needs three times its content at the moment it grows, and a copy of all when it is done. A
// level here grows by an eighth, in place where the allocator can (from some hundred kilobytes on it moves page tables
// and not words), and becomes a part of the octree as it is. So a tree is never held twice.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>

namespace blackleaf::detail {

class WordArray {
 public:
  WordArray() = default;
  WordArray(WordArray&& other) noexcept { *this = std::move(other); }
  WordArray& operator=(WordArray&& other) noexcept {
    words_ = std::move(other.words_);
    size_ = std::exchange(other.size_, 0);
    capacity_ = std::exchange(other.capacity_, 0);
    return *this;
  }
  WordArray(const WordArray&) = delete;
  WordArray& operator=(const WordArray&) = delete;
  ~WordArray() = default;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::uint64_t* data() { return words_.get(); }
  const std::uint64_t* data() const { return words_.get(); }
  std::uint64_t* begin() { return data(); }
  std::uint64_t* end() { return data() + size_; }
  const std::uint64_t* begin() const { return data(); }
  const std::uint64_t* end() const { return data() + size_; }

  void push_back(std::uint64_t word) {
    if (size_ == capacity_) resize(grown(size_ + 1));
    words_.get()[size_++] = word;
  }
  /// Requires: the words are not this array's.
  void append(const std::uint64_t* words, std::size_t count) {
    if (count > capacity_ - size_) resize(grown(size_ + count));
    std::copy_n(words, count, end());
    size_ += count;
  }
  /// Room for so many words in all.
  void reserve(std::size_t capacity) {
    if (capacity > capacity_) resize(capacity);
  }
  void shrink_to_fit() {
    if (size_ < capacity_) resize(size_);
  }
  /// The room stays.
  void clear() { size_ = 0; }

 private:
  struct Free {
    void operator()(std::uint64_t* words) const { std::free(words); }  // NOLINT(*-no-malloc): from realloc
  };

  static std::size_t grown(std::size_t needed) {
    constexpr std::size_t kSmall = 512;  // a page
    return needed < kSmall ? std::max<std::size_t>(8, 2 * needed) : needed + needed / 8;
  }

  void resize(std::size_t capacity) {
    if (capacity == 0) {
      words_.reset();
    } else {
      void* const moved = std::realloc(words_.get(), capacity * sizeof(std::uint64_t));  // NOLINT(*-no-malloc)
      if (moved == nullptr) throw std::bad_alloc();
      static_cast<void>(words_.release());
      words_.reset(static_cast<std::uint64_t*>(moved));
    }
    capacity_ = capacity;
  }

  std::unique_ptr<std::uint64_t, Free> words_;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace blackleaf::detail
