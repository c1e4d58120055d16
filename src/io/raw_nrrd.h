// NRRD files with raw values, slab by slab: never a whole volume in memory, and any number of writers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "blackleaf/frame.h"
#include "blackleaf/measures.h"
#include "blackleaf/octree.h"

namespace blackleaf::detail {

/// The 0/1 volume of a box of an octree as a raw NRRD file.
class RawNrrd {
 public:
  /// Of the bounding box if `crop` (one white voxel for an empty solid), else of the universe. Throws
  /// Error(bad_argument) for a frame that no header can tell, and unless `path` ends in .nrrd.
  RawNrrd(const Octree& octree, const std::filesystem::path& path, bool crop);

  const std::string& header() const { return header_; }
  std::uint64_t slice_bytes() const;
  std::int64_t slices() const;
  /// The values of the slices [first, last), x fastest. Requires: room for them. O(values).
  void values(std::int64_t first, std::int64_t last, std::uint8_t* values) const;

  using Write = std::function<void(std::uint64_t offset, std::span<const std::uint8_t> bytes)>;
  /// Calls write() for slices [first, last), at most 16 MiB or a slice at a time, at their place in the file.
  void write_slices(std::int64_t first, std::int64_t last, const Write& write) const;

 private:
  Octree octree_;
  Box box_;
  std::string header_;
};

}  // namespace blackleaf::detail
