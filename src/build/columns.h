// Columns: the inside of a closed mesh, by winding numbers, as stretches of bricks (4^3 voxels) along x, computed
// column by column.
//
// A column is the line of voxel centres (y, z) along x. Four by four columns make a brick column; the brick columns of
// one layer of bricks make a slab. What is stored grows with the surface: bricks of two colours with their bits, and
// stretches of black bricks. White is everything else.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

#include "blackleaf/work.h"
#include "grid_mesh.h"

namespace blackleaf::detail {

/// Bricks [first, last) along x: all black, or all of two colours.
struct ColumnStretch {
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
  std::vector<BrickColumn> columns;      // by increasing y; only those that are not white
  std::vector<ColumnStretch> stretches;  // disjoint and increasing within a column
  std::vector<MixedBrick> mixed;

  /// The stretches of the i-th column.
  const ColumnStretch* begin_of(std::size_t i) const {
    return stretches.data() + (i == 0 ? 0 : columns[i - 1].stretch_end);
  }
  const ColumnStretch* end_of(std::size_t i) const { return stretches.data() + columns[i].stretch_end; }
  /// The index of the column at brick coordinate y, or columns.size().
  std::size_t find(std::int32_t y) const;
};

/// Which winding numbers mean inside. 0 never does.
struct InsideRule {
  enum class Kind { not_zero, odd, at_least, at_most } kind = Kind::not_zero;
  int bound = 0;  // of at_least: above 0; of at_most: below 0

  bool inside(int winding) const {
    switch (kind) {
      case Kind::odd:
        return (winding & 1) != 0;
      case Kind::at_least:
        return winding >= bound;
      case Kind::at_most:
        return winding <= bound;
      default:
        return winding != 0;
    }
  }
};

/// What columns show of the winding numbers of voxel centres. A column is of a kind by the bits: 1 some centre has a
/// positive number, 2 a negative one, 4 one beyond 1 or -1.
struct Windings {
  struct Place {
    std::int64_t z = std::numeric_limits<std::int64_t>::max(), y = 0, x = 0;
    friend bool operator<(const Place& a, const Place& b) { return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x); }
  };
  std::array<std::uint64_t, 8> columns{};
  std::array<Place, 8> first{};  // where the first column of the kind became one
  int lowest = 0, highest = 0;   // all numbers lie in [lowest, highest]

  void add(const Windings& other);

  /// Columns that show that the numbers are not all 0 or s, with s = 1 or s = -1, of how many, and the first such
  /// place.
  struct Flaw {
    std::uint64_t columns = 0, of = 0;
    Place first;
  };
  Flaw flaw() const;
};

struct Slabs {
  std::int32_t first = 0;   // brick coordinate z of the first slab
  std::vector<Slab> slabs;  // those that the mesh reaches
  Windings windings;
};

/// The inside of a mesh whose edges all belong to an even number of triangles and, unless the rule is `odd`, are passed
/// equally often in both directions. O(crossings log(crossings of a slab) + rows under triangles).
Slabs slabs_of(const GridMesh& mesh, InsideRule rule, const Work& work);

/// Throws Error(bad_input) if there is a flaw; `frame` serves to say where.
void require_simple(const Windings& windings, int depth, const Frame& frame);

}  // namespace blackleaf::detail
