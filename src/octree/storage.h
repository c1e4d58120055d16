// The shared part of an octree: its words, level by level.
#pragma once

#include <array>
#include <memory>
#include <utility>

#include "blackleaf/octree.h"
#include "directory.h"
#include "word_array.h"

namespace blackleaf {

namespace detail {

/// The words of all levels. Immutable once an Octree holds it.
struct Words {
  std::array<WordArray, kMaxDepth + 1> of_level;
  std::array<const std::uint64_t*, kMaxDepth + 1> levels{};  // first word of each level
  Directory directory;                                       // for looking up voxels
};

}  // namespace detail

struct Octree::Storage {
  int depth = 1;
  Colour root = Colour::white;                // gray: the root's word is the only one of level `depth`
  std::shared_ptr<const detail::Words> tree;  // null for a root of one colour
  Frame frame;
};

}  // namespace blackleaf
