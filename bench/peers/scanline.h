// The plain way to voxelise a closed mesh: every row of a dense array changes colour where it passes a triangle. Exact,
// with the tie rule of docs/BUILDING.md, but otherwise unlike the product: a witness against which wrong voxels are
// counted, and a contender.
#pragma once

#include <cstdint>
#include <vector>

namespace blackleaf::bench {

/// The bunny in a universe of the given depth as bytes 0 and 1, x fastest. O(voxels + rows that triangles cover).
void scanline_bunny(int depth, std::vector<std::uint8_t>& voxels);

/// Compares a solid, told as disjoint boxes of black voxels, with scanline_bunny.
class WrongVoxels {
 public:
  explicit WrongVoxels(int depth);
  void add(std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t size_x, std::int64_t size_y,
           std::int64_t size_z);
  /// Voxels that are black in one of the two only.
  std::int64_t count() const { return wrongly_black_ + black_ - rightly_black_; }

 private:
  int depth_;
  const std::vector<std::uint8_t>& volume_;
  std::int64_t black_, rightly_black_ = 0, wrongly_black_ = 0;
};

}  // namespace blackleaf::bench
