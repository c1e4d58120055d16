#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "blackleaf/error.h"
#include "blackleaf/implicit.h"
#include "blackleaf/measures.h"
#include "blackleaf/move.h"
#include "exhibit.h"
#include "papers/wa87.h"

namespace blackleaf::cli {
namespace {

namespace wa87 = papers::wa87;

// SplitMix64 (Steele, Lea and Flood, 2014): the same numbers with every compiler and library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  /// Uniform in [-1, 1).
  double next() {
    state_ += 0x9E3779B97F4A7C15u;
    std::uint64_t z = state_;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-52 - 1;
  }
  /// Every rotation alike: a point of the unit ball of quaternions, made one of its surface.
  Eigen::Quaterniond rotation() {
    Eigen::Vector4d q;
    do q = {next(), next(), next(), next()};
    while (q.squaredNorm() > 1 || q.squaredNorm() < 1e-4);
    return Eigen::Quaterniond(q.normalized());
  }

 private:
  std::uint64_t state_;
};

std::string ratio(double value) { return fmt::format("{:.2g}", value); }

// As WA87 prints them, at n = 5 m. rho_I with the sign and number of Theorem 2, -277, and with those of the formula
// below Table 1, -227.
Table bounds() {
  Table table{"Bounds on the ratios of nodes to voxels for an m-cube in any place and orientation, n = 5m",
              {"m", "black: printed", "black: Theorem 1", "internal: printed", "internal: Theorem 2",
               "internal: formula as printed", "all: printed", "all: corollary"},
              {}};
  struct Printed {
    int m;
    const char *black, *internal, *all;
  };
  for (const Printed& row : {Printed{8, "0.092", "0.0228", "0.186"}, Printed{10, "0.024", "0.0057", "0.047"},
                             Printed{12, "0.0060", "0.0015", "0.012"}, Printed{14, "0.0015", "0.00036", "0.0029"}}) {
    const double volume = std::exp2(3 * row.m);
    const double internal = wa87::internal_node_bound(row.m, 5 * row.m);
    table.rows.push_back({std::to_string(row.m), row.black,
                          fmt::format("{:.5f}", wa87::black_leaf_bound(row.m) / volume), row.internal,
                          fmt::format("{:.6f}", internal / volume), fmt::format("{:.6f}", (internal + 50) / volume),
                          row.all, fmt::format("{:.5f}", wa87::node_bound(row.m, 5 * row.m) / volume)});
  }
  return table;
}

Table measured(const Work& work) {
  Table table{"The most nodes that random motions of an m-cube met, in a universe of depth n = m + 2",
              {"m", "motions", "most black", "bound", "part of it", "most internal", "bound", "part of it",
               "most of all", "bound", "part of it", "black/voxels", "internal/voxels", "all/voxels"},
              {}};
  // Fewer of the large ones, so that each m takes about the same time.
  struct Row {
    int m, motions;
  };
  constexpr Row kRows[] = {{0, 400}, {1, 400}, {2, 400}, {3, 400}, {4, 400},
                           {5, 200}, {6, 100}, {7, 40},  {8, 12},  {9, 4}};
  double done = 0;
  for (const auto& [m, motions] : kRows) {
    const int n = m + 2;
    const double side = std::exp2(m), middle = 2 * side;
    const Octree cube = box(n, {0, 0, 0}, {1 << m, 1 << m, 1 << m});
    Random random(static_cast<std::uint64_t>(m));
    std::uint64_t black = 0, internal = 0;
    for (int i = 0; i < motions; ++i) {
      // The first is only shifted, about the middle, where one voxel becomes eight.
      const Motion turn = i == 0 ? Motion() : Motion::rotation(random.rotation());
      // Where all of it stays inside, whatever the turn; every fourth cube about the middle, where most nodes are
      // split.
      const double reach = i % 4 == 0 ? 0 : middle - std::sqrt(0.75) * side;
      const Eigen::Vector3d to(middle + reach * random.next(), middle + reach * random.next(),
                               middle + reach * random.next());
      const Eigen::Vector3d centre = Eigen::Vector3d::Constant(side / 2);
      const Motion motion = Motion::translation(to) * turn * Motion::translation(-centre);
      const Measures measures = measure(move(cube, motion, Leaving::error, {work.threads, {}}));
      black = std::max(black, measures.black_leaves);
      internal = std::max(internal, measures.internal_nodes);
      done += 1.0 / motions / std::size(kRows);
      if (work.progress && !work.progress(done)) throw Error(ErrorCode::cancelled, "interrupted");
    }
    const double volume = std::exp2(3 * m);
    const std::uint64_t all = 8 * internal + 1;
    const auto entries = [&](std::uint64_t most, double bound) {
      return std::vector<std::string>{std::to_string(most), fmt::format("{:.0f}", bound),
                                      fmt::format("{:.0f} %", 100 * static_cast<double>(most) / bound)};
    };
    std::vector<std::string> row = {std::to_string(m), std::to_string(motions)};
    for (const auto& part : {entries(black, wa87::black_leaf_bound(m)),
                             entries(internal, wa87::internal_node_bound(m, n)), entries(all, wa87::node_bound(m, n))})
      row.insert(row.end(), part.begin(), part.end());
    for (const std::uint64_t most : {black, internal, all}) row.push_back(ratio(static_cast<double>(most) / volume));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

Exhibit wa87_table_1(const Work& work) {
  const Table printed = bounds(), found = measured(work);
  Exhibit exhibit{"wa87-table-1", "WA87, Table 1: bounds on the nodes of a cube, and what motions need", {}, {}, {}};
  exhibit.body =
      paragraph(
          "The bounds of Theorems 1 and 2 and of the corollary, divided by the voxels of an m-cube, give the printed "
          "numbers back, most of them rounded up. The formula below Table 1 has &minus;227 where Theorem 2 has "
          "&minus;277; beyond the digits that are printed nothing depends on it.") +
      printed.html() +
      paragraph(
          "Cubes turned and placed at random need far fewer nodes than the bounds allow, because the bounds count "
          "every cell that a cube may touch on all sides at once. No motion may exceed a bound.") +
      found.html();
  exhibit.files = {{"wa87-table-1-bounds.csv", printed.csv()}, {"wa87-table-1-measured.csv", found.csv()}};
  return exhibit;
}

}  // namespace blackleaf::cli
