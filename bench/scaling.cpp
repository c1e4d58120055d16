// scaling: what blackleaf-mpi would do with up to 65,536 ranks and volumes of up to 65,536^3 voxels, on paper
// (docs/SCALING.md). No volume is made: the surface of a solid that is known in closed form is found cell by cell along
// the curve, and costs and bytes are counted from it, with the cuts that the program itself would make.
//
//   scaling [--voxel NS] [--build NS] [--move NS] [--decode NS] [--code NS] [--gather NS]
//           [--bytes B]
//
// Costs are those of one thread: of a voxel that is read and tested, of a word of the octree that is built, moved, read
// from a file, coded for one, received from another rank; B is a file's bytes for a word.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "blackleaf/curve.h"
#include "file/octree_format.h"
#include "mpi/stretch.h"

namespace blackleaf::bench {
namespace {

using mpi::Cuts;
using mpi::Stretch;
using mpi::VoxelBox;

std::map<std::string, double> costs = {{"--voxel", 0.18}, {"--build", 68},  {"--move", 160}, {"--decode", 99},
                                       {"--code", 90},    {"--gather", 19}, {"--bytes", 1}};
double seconds(const char* cost) { return costs.at(cost) * 1e-9; }

// A solid in the unit cube by a function of which no value is farther from zero than the surface is from the point.
using Solid = double (*)(double, double, double);

// A ball of radius 0.35.
double ball(double x, double y, double z) { return std::hypot(x - 0.5, y - 0.5, z - 0.5) - 0.35; }

// The same with pores: balls of radius 0.4 of a cell in cells of a sixteenth.
double foam(double x, double y, double z) {
  constexpr double kCell = 1.0 / 16;
  const auto from_middle = [](double v) { return v - (std::floor(v / kCell) + 0.5) * kCell; };
  const double pore = 0.4 * kCell - std::hypot(from_middle(x), from_middle(y), from_middle(z));
  return std::max(ball(x, y, z), pore);
}

// Words of the octree by cells along the curve.
class Surface {
 public:
  Surface(Solid solid, int depth)
      : solid_(solid), level_(std::max(mpi::kBlockLevel, depth - 8)), words_(mpi::voxels_of(depth - level_)) {
    add({0, 0, 0, depth - level_}, 0, 0);
    // Gray nodes four times as many a level, down to bricks, and those above them a third more.
    const double below = std::pow(4.0, level_ - kBelow - 2) * 4 / 3;
    for (double& words : words_) words *= below;
    before_.push_back(0);
    for (const double words : words_) before_.push_back(before_.back() + words);
  }

  int level() const { return level_; }
  double words() const { return before_.back(); }
  double words(const Stretch& stretch) const { return before(stretch.last) - before(stretch.first); }
  const std::vector<double>& cells() const { return words_; }

 private:
  static constexpr int kBelow = 2;  // a cell is looked at this many levels below its own

  double before(std::uint64_t number) const {
    const std::uint64_t cell = number >> (3 * level_);
    const double inside =
        static_cast<double>(number & (mpi::voxels_of(level_) - 1)) / static_cast<double>(mpi::voxels_of(level_));
    return before_[cell] + (inside > 0 ? inside * words_[cell] : 0);
  }

  bool is_gray(double x, double y, double z, double side) const {
    return std::abs(solid_(x + side / 2, y + side / 2, z + side / 2)) <= side * 0.8660254;
  }

  // `cube` in cells.
  void add(const Cube& cube, std::uint8_t table, std::uint64_t first) {
    const double cell = 1.0 / static_cast<double>(std::uint64_t{1} << top_);
    if (!is_gray(cube.x * cell, cube.y * cell, cube.z * cell, cube.side() * cell)) return;
    if (cube.level == 0) {
      constexpr int kSide = 1 << kBelow;
      const double small = cell / kSide;
      int count = 0;
      for (int i = 0; i < kSide * kSide * kSide; ++i)
        count += is_gray(cube.x * cell + (i % kSide) * small, cube.y * cell + (i / kSide % kSide) * small,
                         cube.z * cell + (i / kSide / kSide) * small, small);
      words_[first] = count;
      return;
    }
    const std::uint64_t step = mpi::voxels_of(cube.level - 1);
    for (const curve::Step down : curve::kSteps[table]) {
      add(cube.child(down.octant), down.table, first);
      first += step;
    }
  }

  Solid solid_;
  int level_;
  std::vector<double> words_, before_;
  int top_ = static_cast<int>(std::lround(std::log2(std::cbrt(static_cast<double>(words_.size())))));
};

struct Spread {
  double sum = 0, most = 0;
  void add(double value) {
    sum += value;
    most = std::max(most, value);
  }
  double balance(int ranks) const { return sum > 0 ? most * ranks / sum : 1; }
};

// From parts to chunks: what is sent, and the longest that one rank codes.
struct Chunks {
  double sent_bytes = 0, coding = 0;
};
Chunks chunks_of(const Surface& surface, int depth, const Cuts& cuts) {
  const std::uint64_t chunk = detail::format::chunk_voxels(depth);
  std::map<int, double> coded;
  for (std::uint64_t first = 0; first < mpi::voxels_of(depth); first += chunk)
    coded[mpi::process_at(cuts, first)] += surface.words({first, first + chunk});
  Chunks result;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const std::uint64_t border = (cuts[i] + chunk - 1) / chunk * chunk, end = std::min(cuts[i + 1], border);
    if (cuts[i] < end) result.sent_bytes += 8 * surface.words({cuts[i], end});
  }
  for (const auto& [rank, words] : coded) result.coding = std::max(result.coding, words * seconds("--code"));
  return result;
}

// The longest that one rank decodes of a source like this: shares of the chunks by their bytes (octree_reader.cpp).
double decoding(const Surface& surface, int depth, int ranks) {
  const std::uint64_t chunk = detail::format::chunk_voxels(depth);
  std::vector<double> shares(static_cast<std::size_t>(ranks), 0);
  double before = 0;
  for (std::uint64_t first = 0; first < mpi::voxels_of(depth); first += chunk) {
    const double words = surface.words({first, first + chunk});
    const double middle = (before + words / 2) / surface.words() * ranks;
    shares[static_cast<std::size_t>(std::min(middle, ranks - 1.0))] += words;
    before += words;
  }
  return *std::max_element(shares.begin(), shares.end()) * seconds("--decode");
}

std::string bytes(double value) {
  const std::array<const char*, 6> units = {"B", "KB", "MB", "GB", "TB", "PB"};
  std::size_t unit = 0;
  for (; value >= 999.5 && unit + 1 < units.size(); ++unit) value /= 1000;
  return fmt::format("{:.3g} {}", value, units[unit]);
}
std::string time(double value) {
  return value >= 1 ? fmt::format("{:.3g} s", value) : fmt::format("{:.3g} ms", value * 1e3);
}

// The most pieces that a rank reads, of some ranks spread over the curve, and the shortest of them in bytes.
void pieces(int depth, const Cuts& cuts, const VoxelBox& box, double& most, std::int64_t& shortest) {
  const int ranks = static_cast<int>(cuts.size()) - 1;
  most = 0;
  shortest = std::int64_t{1} << 60;
  const int looked_at = std::min(ranks, 256);
  for (int i = 0; i < looked_at; ++i) {
    double count = 0;
    for (const VoxelBox& part :
         mpi::boxes_of(depth, mpi::stretch_of(cuts, static_cast<int>(std::int64_t{i} * ranks / looked_at)), box)) {
      const std::int64_t x = part.high[0] - part.low[0], y = part.high[1] - part.low[1], z = part.high[2] - part.low[2];
      const bool rows = x == box.high[0], slices = rows && y == box.high[1];
      const std::int64_t length = slices ? x * y * std::min<std::int64_t>(z, 4) : rows ? x * y : x;
      count += static_cast<double>(x * y * z) / static_cast<double>(length);
      shortest = std::min(shortest, length);
    }
    most = std::max(most, count);
  }
  if (most == 0) shortest = 0;
}

void study(const char* name, Solid solid) {
  for (const int depth : {10, 12, 14, 16}) {
    const Surface surface(solid, depth);
    const std::int64_t side = std::int64_t{1} << depth;
    const VoxelBox box{{0, 0, 0}, {side, side, side}};
    const auto voxels = static_cast<double>(mpi::voxels_of(depth));
    fmt::print("\n### {}, {}^3: {} of voxels, {:.3g} million words, file {}\n\n", name, side, bytes(voxels),
               surface.words() / 1e6, bytes(surface.words() * costs.at("--bytes")));
    fmt::print(
        "| ranks | build: balance | time | speed-up | read a rank | pieces, shortest | seams | move: balance | time | "
        "speed-up | seams |\n");
    fmt::print("|---|---|---|---|---|---|---|---|---|---|---|\n");
    double build_one = 0, move_one = 0;
    for (int ranks = 1; ranks <= 65536; ranks *= 4) {
      const Cuts cuts = mpi::cuts_by_voxels(depth, box, ranks);
      Spread work, read;
      for (int i = 0; i < ranks; ++i) {
        const Stretch stretch = mpi::stretch_of(cuts, i);
        const auto here = static_cast<double>(stretch.last - stretch.first);
        read.add(here);
        work.add(here * seconds("--voxel") + surface.words(stretch) * seconds("--build"));
      }
      const Chunks built = chunks_of(surface, depth, cuts);
      const double build = work.most + built.coding;
      double most = 0;
      std::int64_t shortest = 0;
      pieces(depth, cuts, box, most, shortest);

      // Units of the weight that balanced_cuts() gives them: cells, or eighths of cells by their share if there are
      // few.
      std::vector<std::uint64_t> numbers, weights;
      const auto& cells = surface.cells();
      const int split = surface.level() > 3 && cells.size() < (std::size_t{1} << 21) ? 1 : 0;
      for (std::size_t i = 0; i < cells.size(); ++i)
        if (cells[i] > 0)
          for (std::uint64_t part = 0; part < (split ? 8u : 1u); ++part) {
            numbers.push_back((i << (3 * surface.level())) +
                              part * (mpi::voxels_of(surface.level()) / (split ? 8 : 1)));
            weights.push_back(static_cast<std::uint64_t>(cells[i] / (split ? 8 : 1)) + 1);
          }
      const Cuts move_cuts = mpi::cuts_by_weight(depth, numbers, weights, ranks);
      Spread moved;
      for (int i = 0; i < ranks; ++i) moved.add(surface.words(mpi::stretch_of(move_cuts, i)) * seconds("--move"));
      const Chunks parts = chunks_of(surface, depth, move_cuts);
      const double source = decoding(surface, depth, ranks) + (ranks > 1 ? surface.words() * seconds("--gather") : 0);
      const double move = source + moved.most + parts.coding;
      if (ranks == 1) {
        build_one = build;
        move_one = move;
      }
      fmt::print("| {} | {:.2f} | {} | {:.3g} | {} | {:.3g}, {} | {} | {:.2f} | {} | {:.3g} | {} |\n", ranks,
                 work.balance(ranks), time(build), build_one / build, bytes(read.most), most,
                 bytes(static_cast<double>(shortest)), bytes(built.sent_bytes), moved.balance(ranks), time(move),
                 move_one / move, bytes(parts.sent_bytes));
    }
  }
}

}  // namespace
}  // namespace blackleaf::bench

int main(int argc, char** argv) {
  using namespace blackleaf::bench;
  for (int i = 1; i + 1 < argc; i += 2) {
    const auto found = costs.find(argv[i]);
    if (found == costs.end()) {
      fmt::print(stderr, "scaling: unknown option {}; see the head of bench/scaling.cpp\n", argv[i]);
      return 2;
    }
    found->second = std::atof(argv[i + 1]);
  }
  for (const auto& [name, value] : costs) fmt::print("{} {}\n", name, value);
  study("Ball", ball);
  study("Foam", foam);
}
