// Directory: the nodes four levels below the root, side by side, so that looking up a voxel begins there.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace blackleaf::detail {

/// Of a tree with a gray root and a depth of 6 at least. It is made when it is first asked for: 32 kB, some ten
/// microseconds. Any number of threads may ask.
class Directory {
 public:
  static constexpr int kLevels = 4;                                       // below the root
  static constexpr int kLeastDepth = 6;                                   // that the nodes are bricks at least
  static constexpr std::uint64_t kWhite = 0, kBlack = ~std::uint64_t{0};  // no gray node has such a word

  Directory() = default;
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;
  ~Directory() { delete nodes_.load(std::memory_order_relaxed); }

  /// The words of the nodes at x + 16 y + 256 z, or their colour. `levels`: the tree's words by level.
  const std::uint64_t* nodes(const std::uint64_t* const* levels, int depth) const {
    const Nodes* known = nodes_.load(std::memory_order_acquire);
    return (known ? *known : made(levels, depth)).data();
  }

 private:
  static constexpr std::size_t kSide = std::size_t{1} << kLevels;
  using Nodes = std::array<std::uint64_t, kSide * kSide * kSide>;

  const Nodes& made(const std::uint64_t* const* levels, int depth) const;

  mutable std::atomic<const Nodes*> nodes_{nullptr};
};

}  // namespace blackleaf::detail
