// Interference by parallel traversal (AN84, section 5).
#include <bit>

#include "blackleaf/contact.h"
#include "octree/node_arrays.h"
#include "octree/same_depth.h"

namespace blackleaf {
namespace {

// Children that are not white, as a mask. Requires: a gray node of level >= 3.
unsigned filled(const Node& node) { return static_cast<unsigned>((node.word() | node.word() >> 8) & 0xFF); }

bool meet(const Node& a, const Node& b) {
  if (a.is_white() || b.is_white()) return false;
  if (a.is_black() || b.is_black()) return true;  // the other is black or gray, and every gray node has a black voxel
  if (a.level() == 2) return (a.word() & b.word()) != 0;
  const unsigned both = filled(a) & filled(b);
  if (both & (a.word() | b.word())) return true;  // a black child against one that is not white
  for (unsigned rest = both; rest; rest &= rest - 1) {
    const int octant = std::countr_zero(rest);
    if (meet(a.child(octant), b.child(octant))) return true;
  }
  return false;
}

std::uint64_t common_volume(const Node& a, const Node& b) {
  if (a.is_white() || b.is_white()) return 0;
  if (a.is_black() && b.is_black()) return std::uint64_t{1} << (3 * a.level());
  if (a.level() == 2) return static_cast<unsigned>(std::popcount(a.brick() & b.brick()));
  std::uint64_t sum = 0;
  for (int octant = 0; octant < 8; ++octant) sum += common_volume(a.child(octant), b.child(octant));
  return sum;
}

}  // namespace

bool interferes(const Octree& a, const Octree& b) {
  detail::require_same_depth(a, b);
  return meet(detail::brick_level_root(a), detail::brick_level_root(b));
}

std::uint64_t overlap_volume(const Octree& a, const Octree& b) {
  detail::require_same_depth(a, b);
  return common_volume(detail::brick_level_root(a), detail::brick_level_root(b));
}

}  // namespace blackleaf
