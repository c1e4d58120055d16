// PreparedSolid: an octree made ready for many questions of contact.
//
// Every node of it knows the tight box of its black voxels and a plane that they do not cross, so that what is apart is
// seen to be from large nodes. Answers are those of the octree itself, sooner.
#pragma once

#include <cstddef>
#include <memory>

#include "blackleaf/octree.h"

namespace blackleaf {

/// An immutable value; copies share what they hold and may be used from many threads.
class PreparedSolid {
 public:
  /// O(words); pays from some tens or hundreds of questions on. 88 bytes for every gray node of level 3 or more.
  explicit PreparedSolid(const Octree& octree);

  const Octree& octree() const;
  int depth() const { return octree().depth(); }
  bool is_empty() const { return octree().is_empty(); }
  /// Bytes beside the octree's own.
  std::size_t memory_bytes() const;

  struct Storage;  // src/contact/contact_node.h
  const Storage& storage() const { return *storage_; }

 private:
  std::shared_ptr<const Storage> storage_;
};

}  // namespace blackleaf
