#include "directory.h"

namespace blackleaf::detail {
namespace {

// Puts a node of the given level, or its colour, at all its places; x, y, z count nodes of its level.
void put(const std::uint64_t* const* levels, int level, int least, std::uint64_t word, std::size_t x, std::size_t y,
         std::size_t z, std::uint64_t* nodes) {
  const bool plain = word == Directory::kWhite || word == Directory::kBlack;
  if (level == least) {
    nodes[x | y << Directory::kLevels | z << 2 * Directory::kLevels] = word;
    return;
  }
  std::size_t next = plain ? 0 : word >> 16;
  for (unsigned octant = 0; octant < 8; ++octant) {
    std::uint64_t child = word;
    if (!plain) {
      child = word >> octant & 1 ? Directory::kBlack : Directory::kWhite;
      if (word >> (8 + octant) & 1) child = levels[level - 1][next++];
    }
    put(levels, level - 1, least, child, 2 * x + (octant & 1), 2 * y + (octant >> 1 & 1), 2 * z + (octant >> 2), nodes);
  }
}

}  // namespace

const Directory::Nodes& Directory::made(const std::uint64_t* const* levels, int depth) const {
  auto mine = std::make_unique<Nodes>();
  put(levels, depth, depth - kLevels, *levels[depth], 0, 0, 0, mine->data());
  const Nodes* first = nullptr;  // of all threads that were making one
  if (nodes_.compare_exchange_strong(first, mine.get(), std::memory_order_acq_rel)) return *mine.release();
  return *first;
}

}  // namespace blackleaf::detail
