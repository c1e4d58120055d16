// Columns: the inside of a closed mesh as stretches of bricks (4^3 voxels) along x, computed column by column.
//
// A column is the line of voxel centres (y, z) along x. Four by four columns make a brick column; the brick columns of
// one layer of bricks make a slab. What is stored grows with the surface: bricks of two colours with their bits, and
// stretches of black bricks. White is everything else.
#pragma once

#include <cstdint>
#include <vector>

#include "blackleaf/work.h"
#include "grid_mesh.h"

namespace blackleaf::detail {

/// Bricks [first, last) along x: all black, or all of two colours.
struct Stretch {
  std::int32_t first, last;
  bool black;
};

struct BrickColumn {
  std::int32_t y;             // in bricks
  std::uint32_t stretch_end;  // its stretches end here in Slab::stretches and begin where the last column's end
};

struct MixedBrick {
  std::int32_t x, y;  // in bricks
  std::uint64_t bits;
};

/// One layer of bricks.
struct Slab {
  std::vector<BrickColumn> columns;  // by increasing y; only those that are not white
  std::vector<Stretch> stretches;    // disjoint and increasing within a column
  std::vector<MixedBrick> mixed;

  /// The stretches of the i-th column.
  const Stretch* begin_of(std::size_t i) const { return stretches.data() + (i == 0 ? 0 : columns[i - 1].stretch_end); }
  const Stretch* end_of(std::size_t i) const { return stretches.data() + columns[i].stretch_end; }
  /// The index of the column at brick coordinate y, or columns.size().
  std::size_t find(std::int32_t y) const;
};

struct Slabs {
  std::int32_t first = 0;   // brick coordinate z of the first slab
  std::vector<Slab> slabs;  // those that the mesh reaches
};

/// Throws Error(bad_input) if the winding numbers of voxel centres are not all 0 or s, with s = 1 or s = -1; `frame`
/// serves to say where. O(crossings log(crossings of a slab) + rows under triangles).
Slabs slabs_of(const GridMesh& mesh, const Frame& frame, const Work& work);

}  // namespace blackleaf::detail
