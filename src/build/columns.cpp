#include "columns.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "blackleaf/error.h"
#include "octree/brick.h"
#include "octree/parallel.h"

namespace blackleaf::detail {
namespace {

Wide ceil_divide(Wide numerator, Wide denominator) {  // denominator > 0
  const Wide quotient = numerator / denominator;
  return quotient + (numerator % denominator > 0 ? 1 : 0);
}

// A crossing of a column with a triangle, packed so that sorting puts together what a brick column needs, in order of
// x: brick y (18 bits) | centres before the crossing (21 bits) | column in the brick, y + 4z (4 bits) | 1 if leaving.
using Crossing = std::uint64_t;

constexpr Crossing pack(std::int64_t y, std::int64_t z, std::int64_t before, bool leaving) {
  const auto column = static_cast<std::uint64_t>((y & 3) | (z & 3) << 2);
  return static_cast<std::uint64_t>(y >> 2) << 26 | static_cast<std::uint64_t>(before) << 5 | column << 1 |
         static_cast<std::uint64_t>(leaving);
}
constexpr std::int32_t brick_of(Crossing c) { return static_cast<std::int32_t>(c >> 26); }
constexpr std::int32_t before_of(Crossing c) { return static_cast<std::int32_t>(c >> 5 & 0x1FFFFF); }
constexpr unsigned column_of(Crossing c) { return static_cast<unsigned>(c >> 1 & 15); }

// The columns that cross one triangle, and where.
//
// A centre on the surface counts as moved by (e, e^2, e^3). Seen along x, its column moves by (e^2, e^3) in y and z: a
// row through a vertex passes above it, a column on an edge passes beyond it in y. So rows take edges from their lower
// end (included) to their upper (excluded), and columns are taken from the first edge crossing (included) to the second
// (excluded): two triangles at an edge never both take a column nor leave it out. Along x the centre moves by e, which
// outweighs what e^2 and e^3 do to the crossing, so a centre on the triangle lies beyond it.
//
// Everything is estimated in floating point first; where the estimate is too near to a whole number it is computed
// again in integers.
class TriangleScan {
 public:
  TriangleScan(const GridMesh& mesh, const Triangle& triangle)
      : mesh_(mesh), p_{&mesh.vertices[triangle[0]], &mesh.vertices[triangle[1]], &mesh.vertices[triangle[2]]} {
    low_row_ = mesh.centres_before(std::min({z(0), z(1), z(2)}));
    high_row_ = mesh.centres_before(std::max({z(0), z(1), z(2)}));
  }

  // Rows whose edges it crosses, [low, high).
  std::int64_t low_row() const { return low_row_; }
  std::int64_t high_row() const { return high_row_; }

  // False if no column can cross the triangle; else prepares scan().
  bool prepare() {
    const std::int64_t y_min = std::min({y(0), y(1), y(2)}), y_max = std::max({y(0), y(1), y(2)});
    if (low_row_ >= high_row_ || mesh_.centres_before(y_min) >= mesh_.centres_before(y_max)) return false;
    for (std::size_t i = 0; i < 3; ++i) normal_[i] = normal(*p_[0], *p_[1], *p_[2], i);
    if (normal_[0] == 0) return false;
    leaving_ = normal_[0] > 0;
    if (!leaving_)
      for (Wide& component : normal_) component = -component;
    const double n = static_cast<double>(normal_[0]);
    slope_y_ = -static_cast<double>(normal_[1]) / n;
    slope_z_ = -static_cast<double>(normal_[2]) / n;
    // A crossing, in voxels, is estimated as x0 + slope_y dy + slope_z dz with exact dy and dz inside the triangle's
    // extent: slopes are off by 3 roundings of 2^-53 relatively, products by 4, and each of two sums by one more.
    const double extent_y = voxels(y_max - y_min);
    const double extent_z = voxels(std::max({z(0), z(1), z(2)}) - std::min({z(0), z(1), z(2)}));
    tolerance_ = 0x1p-49 *
                 (std::abs(slope_y_) * extent_y + std::abs(slope_z_) * extent_z + voxels(std::int64_t{1} << kGridBits));
    return true;
  }

  // Calls visit(y, centres before the crossing) for the columns of a row in [low_row, high_row).
  template <class Visit>
  void scan(std::int64_t row, Visit visit) const {
    std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = -1;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const bool up = z(i) < z(j);
      const std::size_t lower = up ? i : j, upper = up ? j : i;
      if (row < mesh_.centres_before(z(lower)) || row >= mesh_.centres_before(z(upper))) continue;
      const std::int64_t before = columns_before(lower, upper, row);
      low = std::min(low, before);
      high = std::max(high, before);
    }
    const double x0 = voxels(x(0)) - 0.5 + slope_z_ * (static_cast<double>(row) + 0.5 - voxels(z(0)));
    const double y0 = 0.5 - voxels(y(0));
    for (std::int64_t column = low; column < high; ++column) {
      const double estimate = x0 + slope_y_ * (static_cast<double>(column) + y0);
      const double whole = std::floor(estimate), rest = estimate - whole;
      if (rest > tolerance_ && rest < 1 - tolerance_)
        visit(column, static_cast<std::int64_t>(whole) + 1);
      else
        visit(column, centres_before(column, row));
    }
  }

  bool leaving() const { return leaving_; }

 private:
  std::int64_t x(std::size_t i) const { return (*p_[i])[0]; }
  std::int64_t y(std::size_t i) const { return (*p_[i])[1]; }
  std::int64_t z(std::size_t i) const { return (*p_[i])[2]; }
  double voxels(std::int64_t length) const { return std::ldexp(static_cast<double>(length), -mesh_.fraction_bits()); }

  // Columns of a row strictly before the edge from vertex `a` up to vertex `b`.
  std::int64_t columns_before(std::size_t a, std::size_t b, std::int64_t row) const {
    const std::int64_t dy = y(b) - y(a), dz = z(b) - z(a), rise = mesh_.centre(row) - z(a);
    const double estimate = voxels(y(a)) - 0.5 + voxels(dy) * (static_cast<double>(rise) / static_cast<double>(dz));
    // Four roundings of numbers up to 2^20 voxels: the estimate is off by less than 2^-30.
    constexpr double kTolerance = 0x1p-28;
    const double whole = std::floor(estimate), rest = estimate - whole;
    if (rest > kTolerance && rest < 1 - kTolerance) return static_cast<std::int64_t>(whole) + 1;
    const Wide numerator = Wide{y(a) - mesh_.centre(0)} * dz + Wide{dy} * rise;  // below 2^81
    return static_cast<std::int64_t>(ceil_divide(numerator, Wide{dz} << mesh_.fraction_bits()));
  }

  // Centres of a column strictly before the triangle's plane: the least i with N (centre_i - a) >= 0, N_x > 0.
  std::int64_t centres_before(std::int64_t column, std::int64_t row) const {
    const Wide distance = normal_[0] * (x(0) - mesh_.centre(0)) + normal_[1] * (y(0) - mesh_.centre(column)) +
                          normal_[2] * (z(0) - mesh_.centre(row));                                 // below 2^123
    return static_cast<std::int64_t>(ceil_divide(distance, normal_[0] << mesh_.fraction_bits()));  // below 2^121
  }

  const GridMesh& mesh_;
  std::array<const GridPoint*, 3> p_;
  std::int64_t low_row_, high_row_;
  std::array<Wide, 3> normal_{};  // turned so that its x is positive
  double slope_y_ = 0, slope_z_ = 0, tolerance_ = 0;
  bool leaving_ = false;  // whether the triangle as given faces +x
};

// Follows the crossings of one brick column along x.
class ColumnSweep {
 public:
  ColumnSweep(std::int32_t bricks, InsideRule rule, Slab& slab, Windings& windings)
      : bricks_(bricks), rule_(rule), slab_(slab), windings_(windings) {}

  // Crossings of one brick column, sorted.
  void run(const Crossing* begin, const Crossing* end, std::int64_t slab_z) {
    const std::int32_t y = brick_of(*begin);
    winding_.fill(0);
    kind_.fill(0);
    column_begin_ = slab_.stretches.size();
    unsigned inside = 0;  // the columns that are inside after the last brick
    std::int32_t next = 0;
    for (const Crossing* c = begin; c != end;) {
      const std::int32_t x = before_of(*c) >> 2;
      repeat(next, x, y, inside);
      std::uint64_t bits = spread(inside);
      while (c != end && before_of(*c) >> 2 == x) {
        const std::int32_t before = before_of(*c);
        const unsigned column = column_of(*c);
        int change = 0;
        for (; c != end && before_of(*c) == before && column_of(*c) == column; ++c) change += (*c & 1) ? -1 : 1;
        if (!step(column, change, before, y, slab_z)) continue;
        inside ^= 1u << column;
        bits ^= kRow[static_cast<std::size_t>(before & 3)] << shift(column);
      }
      next = x + 1;
      if (x < bricks_) put(x, y, bits);
    }
    repeat(next, bricks_, y, inside);
    if (slab_.stretches.size() > column_begin_)
      slab_.columns.push_back({y, static_cast<std::uint32_t>(slab_.stretches.size())});
    for (std::size_t column = 0; column < 16; ++column)
      if (kind_[column]) {
        ++windings_.columns[kind_[column]];
        windings_.first[kind_[column]] = std::min(windings_.first[kind_[column]], place_[column]);
      }
  }

 private:
  // The voxels x..3 of the first row of a brick.
  static constexpr std::array<std::uint64_t, 4> kRow = {0x303, 0x302, 0x300, 0x200};
  static unsigned shift(unsigned column) {
    return static_cast<unsigned>(kSpread[column & 3]) << 1 | static_cast<unsigned>(kSpread[column >> 2]) << 2;
  }
  static std::uint64_t spread(unsigned columns) {
    if (columns == 0) return 0;
    if (columns == 0xFFFF) return ~std::uint64_t{0};
    std::uint64_t bits = 0;
    for (unsigned column = 0; column < 16; ++column)
      if (columns >> column & 1) bits |= kRow[0] << shift(column);
    return bits;
  }

  // True if the column passes between outside and inside.
  bool step(unsigned column, int change, std::int32_t before, std::int32_t y, std::int64_t slab_z) {
    const bool was_inside = rule_.inside(winding_[column]);
    const int winding = winding_[column] += change;
    windings_.lowest = std::min(windings_.lowest, winding);
    windings_.highest = std::max(windings_.highest, winding);
    const unsigned kind = (winding > 0 ? 1u : winding < 0 ? 2u : 0u) | (winding > 1 || winding < -1 ? 4u : 0u);
    if (kind & ~kind_[column]) {
      kind_[column] |= kind;
      place_[column] = {4 * slab_z + (column >> 2), 4 * std::int64_t{y} + (column & 3), before};
    }
    return was_inside != rule_.inside(winding);
  }

  void repeat(std::int32_t from, std::int32_t to, std::int32_t y, unsigned inside) {
    if (inside == 0 || from >= to) return;
    if (inside == 0xFFFF) {
      stretch(from, to, true);
      return;
    }
    const std::uint64_t bits = spread(inside);
    stretch(from, to, false);
    for (std::int32_t x = from; x < to; ++x) slab_.mixed.push_back({x, y, bits});
  }

  void put(std::int32_t x, std::int32_t y, std::uint64_t bits) {
    if (bits == 0) return;
    stretch(x, x + 1, ~bits == 0);
    if (~bits != 0) slab_.mixed.push_back({x, y, bits});
  }

  void stretch(std::int32_t first, std::int32_t last, bool black) {
    if (slab_.stretches.size() > column_begin_) {
      ColumnStretch& previous = slab_.stretches.back();
      if (previous.last == first && previous.black == black) {
        previous.last = last;
        return;
      }
    }
    slab_.stretches.push_back({first, last, black});
  }

  const std::int32_t bricks_;  // along x in the universe
  const InsideRule rule_;
  Slab& slab_;
  Windings& windings_;
  std::size_t column_begin_ = 0;
  std::array<int, 16> winding_{};
  std::array<unsigned, 16> kind_{};
  std::array<Windings::Place, 16> place_{};
};

}  // namespace

void Windings::add(const Windings& other) {
  lowest = std::min(lowest, other.lowest);
  highest = std::max(highest, other.highest);
  for (std::size_t kind = 0; kind < 8; ++kind) {
    columns[kind] += other.columns[kind];
    first[kind] = std::min(first[kind], other.first[kind]);
  }
}

Windings::Flaw Windings::flaw() const {
  std::uint64_t positive = 0, negative = 0;
  Flaw result;
  for (unsigned kind = 1; kind < 8; ++kind) {
    positive += kind & 1 ? columns[kind] : 0;
    negative += kind & 2 ? columns[kind] : 0;
    result.of += columns[kind];
  }
  const unsigned wrong = 4u | (positive >= negative ? 2u : 1u);
  for (unsigned kind = 1; kind < 8; ++kind)
    if (kind & wrong && columns[kind] > 0) {
      result.columns += columns[kind];
      result.first = std::min(result.first, first[kind]);
    }
  return result;
}

void require_simple(const Windings& windings, int depth, const Frame& frame) {
  const Windings::Flaw flaw = windings.flaw();
  if (flaw.columns == 0) return;
  const double x = static_cast<double>(std::min(flaw.first.x, (std::int64_t{1} << depth) - 1));
  const Eigen::Vector3d world = frame.to_world(
      Eigen::Vector3d(x + 0.5, static_cast<double>(flaw.first.y) + 0.5, static_cast<double>(flaw.first.z) + 0.5));
  std::array<char, 160> place{};
  std::snprintf(place.data(), place.size(), "first near (%.6g, %.6g, %.6g)", world.x(), world.y(), world.z());
  throw Error(ErrorCode::bad_input,
              "the mesh passes through itself or is oriented inconsistently in " + std::to_string(flaw.columns) +
                  " of " + std::to_string(flaw.of) + " columns of voxels, " + place.data(),
              "unite its overlapping parts and turn all its triangles outward");
}

std::size_t Slab::find(std::int32_t y) const {
  const auto at = std::lower_bound(columns.begin(), columns.end(), y,
                                   [](const BrickColumn& column, std::int32_t value) { return column.y < value; });
  return at != columns.end() && at->y == y ? static_cast<std::size_t>(at - columns.begin()) : columns.size();
}

Slabs slabs_of(const GridMesh& mesh, InsideRule rule, const Work& work) {
  Slabs result;
  // The triangles of each slab, as ranges of one list.
  std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = -1;
  std::vector<std::uint32_t> crossed;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    TriangleScan scan(mesh, mesh.triangles[i]);
    if (!scan.prepare()) continue;
    crossed.push_back(i);
    low = std::min(low, scan.low_row() >> 2);
    high = std::max(high, (scan.high_row() - 1) >> 2);
  }
  if (crossed.empty()) return result;
  result.first = static_cast<std::int32_t>(low);
  result.slabs.resize(static_cast<std::size_t>(high - low + 1));
  std::vector<std::size_t> end(result.slabs.size() + 1, 0);
  std::vector<std::uint32_t> list;
  for (const bool counting : {true, false}) {
    for (const std::uint32_t i : crossed) {
      const TriangleScan scan(mesh, mesh.triangles[i]);
      for (std::int64_t s = scan.low_row() >> 2; s <= (scan.high_row() - 1) >> 2; ++s) {
        if (counting)
          ++end[static_cast<std::size_t>(s - low + 1)];
        else
          list[end[static_cast<std::size_t>(s - low)]++] = i;
      }
    }
    if (!counting) break;
    for (std::size_t s = 1; s < end.size(); ++s) end[s] += end[s - 1];
    list.resize(end.back());
  }

  std::vector<Windings> windings(result.slabs.size());
  const std::int32_t bricks = mesh.depth < 2 ? 1 : 1 << (mesh.depth - 2);
  for_each_index(result.slabs.size(), work, [&](std::size_t s) {
    std::vector<Crossing> crossings;
    const std::int64_t z = low + static_cast<std::int64_t>(s);
    for (std::size_t at = s == 0 ? 0 : end[s - 1]; at < end[s]; ++at) {
      TriangleScan scan(mesh, mesh.triangles[list[at]]);
      scan.prepare();
      const std::int64_t last = std::min(scan.high_row(), 4 * z + 4);
      for (std::int64_t row = std::max(scan.low_row(), 4 * z); row < last; ++row)
        scan.scan(row, [&](std::int64_t y, std::int64_t before) {
          crossings.push_back(pack(y, row, before, scan.leaving()));
        });
    }
    std::sort(crossings.begin(), crossings.end());
    ColumnSweep sweep(bricks, rule, result.slabs[s], windings[s]);
    for (const Crossing* begin = crossings.data(); begin != crossings.data() + crossings.size();) {
      const Crossing* stop = begin;
      while (stop != crossings.data() + crossings.size() && brick_of(*stop) == brick_of(*begin)) ++stop;
      sweep.run(begin, stop, z);
      begin = stop;
    }
  });
  for (const Windings& w : windings) result.windings.add(w);
  return result;
}

}  // namespace blackleaf::detail
