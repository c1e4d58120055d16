#include "blackleaf/hatch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>

#include "blackleaf/error.h"
#include "blackleaf/runs.h"
#include "hatch_slice.h"
#include "octree/parallel.h"
#include "screen.h"

namespace blackleaf {
namespace {

using detail::HatchFamily;
using detail::HatchPiece;
using detail::HatchSlice;
using detail::Wide;

constexpr std::int64_t kMostLines = std::int64_t{1} << 20;

// Labels of the scene's voxels: 0, or 1 + 64 * (the first solid that has it) + the sides of it that are cut faces, bit
// 2 axis + upward.
constexpr std::uint32_t label_of(std::size_t solid, unsigned cut) {
  return static_cast<std::uint32_t>(1 + 64 * solid + cut);
}
constexpr std::size_t solid_of(std::uint32_t label) { return (label - 1) / 64; }
constexpr bool is_cut(std::uint32_t label, unsigned side) { return (label - 1) >> side & 1; }

LabelMap labels_of(const Scene& scene, const Work& work) {
  struct Change {
    std::uint64_t at;
    std::uint32_t solid;
    std::uint8_t bits;  // what begins or ends there: bit 6 the solid, bits 0 to 5 its cut faces
    bool begins;
    bool operator<(const Change& other) const { return at < other.at; }
  };
  std::vector<Change> changes;
  const auto add = [&](const Octree& octree, std::size_t solid, unsigned bit) {
    std::uint64_t at = 0;
    for_each_run(octree, [&](std::uint64_t count, bool black) {
      const auto bits = static_cast<std::uint8_t>(1u << bit);
      if (black) {
        changes.push_back({at, static_cast<std::uint32_t>(solid), bits, true});
        changes.push_back({at + count, static_cast<std::uint32_t>(solid), bits, false});
      }
      at += count;
    });
  };
  const std::span<const Octree> solids = scene.solids();
  for (std::size_t i = 0; i < solids.size(); ++i) {
    add(solids[i], i, 6);
    for (unsigned side = 0; side < 6; ++side) add(scene.cut_voxels(i, side / 2, side % 2 == 1), i, side);
  }
  detail::sort(changes, work);  // those at one place in any order: they are taken together

  std::vector<std::uint8_t> state(solids.size(), 0);
  std::set<std::uint32_t> there;  // solids that have the voxel
  LabelMapBuilder builder(scene.all().depth());
  for (std::size_t i = 0; i < changes.size();) {
    const std::uint64_t at = changes[i].at;
    const std::uint32_t label = there.empty() ? 0 : label_of(*there.begin(), state[*there.begin()] & 63u);
    builder.add(at - builder.end(), label);
    for (; i < changes.size() && changes[i].at == at; ++i) {
      const Change& change = changes[i];
      state[change.solid] = static_cast<std::uint8_t>(change.begins ? state[change.solid] | change.bits
                                                                    : state[change.solid] & ~change.bits);
      if (change.bits != 64) continue;
      if (change.begins)
        there.insert(change.solid);
      else
        there.erase(change.solid);
    }
  }
  builder.add((std::uint64_t{1} << (3 * scene.all().depth())) - builder.end(), 0);
  return builder.finish();
}

// One set of parallel lines, and whose faces they are for.
struct Lines {
  HatchFamily family;
  bool cut;                                     // for cut faces, or for all others
  std::optional<bool> odd;                      // for solids with odd or even places only
  std::int64_t step = 0, first = 0, count = 0;  // 512 w.p of the lines

  Lines(HatchFamily of, bool for_cuts, std::optional<bool> places, double distance, const Box& box)
      : family(of), cut(for_cuts), odd(places) {
    double square = 0;
    std::int64_t low = 0, high = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      square += static_cast<double>(family.w[i]) * static_cast<double>(family.w[i]);
      low += 512 * family.w[i] * (family.w[i] < 0 ? box.max : box.min)[i];
      high += 512 * family.w[i] * (family.w[i] < 0 ? box.min : box.max)[i];
    }
    const double wanted = distance * std::sqrt(square) * 256;
    if (!(wanted < 4503599627370496.0)) return;  // 2^52: farther than the universe
    if (wanted < 0.5)
      throw Error(ErrorCode::bad_argument, fmt::format("hatch lines {} voxels apart are too close", distance),
                  "set them farther apart");
    step = 2 * std::max<std::int64_t>(1, std::llround(wanted));
    const auto floor = [&](std::int64_t a) { return a / step - (a % step < 0 ? 1 : 0); };
    const std::int64_t j0 = floor(low - 1) + 1, j1 = floor(high - 1);  // low < step j + 1 <= high, never equal
    first = j0 * step + 1;
    count = std::max<std::int64_t>(0, j1 - j0 + 1);
  }

  bool wants(std::uint32_t label) const {
    if (odd && *odd != (solid_of(label) % 2 == 1)) return false;
    return is_cut(label, 2 * family.n + (family.d[family.n] > 0 ? 1 : 0)) == cut;
  }
};

// Places of a line on the screen.
class LinePlaces {
 public:
  LinePlaces(const HatchFamily& family, std::int64_t line, const detail::Screen& screen)
      : f_(family), line_(static_cast<double>(line) / 512), screen_(screen) {}

  // The point p with w.p = line / 512, q.p = position / unit and p_n = 0; as q_b = 0 and |w_b| = |w_c|, nothing is
  // lost.
  Eigen::Vector2d operator()(Wide position) const {
    const unsigned b = (f_.n + 1) % 3, c = (f_.n + 2) % 3;
    const double along = static_cast<double>(position) / static_cast<double>(f_.unit);
    const double p_c = along / static_cast<double>(f_.q[c]);
    const double p_b = (line_ - static_cast<double>(f_.w[c]) * p_c) / static_cast<double>(f_.w[b]);
    const auto on = [&](const std::array<std::int64_t, 3>& axis, double norm) {
      return (static_cast<double>(axis[b]) * p_b + static_cast<double>(axis[c]) * p_c) / norm;
    };
    return {on(screen_.u, screen_.u_norm), on(screen_.v, screen_.v_norm)};
  }

 private:
  const HatchFamily& f_;
  double line_;
  const detail::Screen& screen_;
};

void check(const HatchOptions& options) {
  const auto require = [](double value, const char* name) {
    if (!std::isfinite(value) || value < 0)
      throw Error(ErrorCode::bad_argument, fmt::format("a {} of {} is not possible", name, value),
                  "give a number above zero, or 0 for none");
  };
  require(options.faces, "distance of hatch lines");
  require(options.cuts, "distance of hatch lines");
  for (const double tone : options.tone) require(tone, "tone");
}

// Whether lines along e_b + e_c rise to the right on the screen.
bool plain_diagonal_rises(unsigned n, const detail::Screen& screen) {
  const unsigned b = (n + 1) % 3, c = (n + 2) % 3;
  return (screen.u[b] + screen.u[c] > 0) == (screen.v[b] + screen.v[c] > 0);
}

}  // namespace

std::vector<SceneLines> hatch(const Scene& scene, const View& view, const HatchOptions& options, const Work& work) {
  check(options);
  const detail::Direction& d = view.direction();
  const detail::Screen screen(d);
  const std::optional<Box> box = bounding_box(scene.all());
  std::vector<Lines> families;
  if (!box) return {};
  for (unsigned n = 0; n < 3; ++n) {
    if (d[n] == 0) continue;  // seen edge-on
    // Faces lean to one side, cut faces of the first solid to the other.
    const bool rises = plain_diagonal_rises(n, screen);
    if (options.faces > 0 && options.tone[n] > 0)
      families.emplace_back(HatchFamily(n, rises, d), false, std::nullopt, options.faces * options.tone[n], *box);
    if (!(options.cuts > 0)) continue;
    for (const bool odd : {false, true}) {
      bool some = false;
      for (std::size_t i = odd ? 1 : 0; i < scene.solids().size() && !some; i += 2)
        some = !scene.cut_voxels(i, n, d[n] > 0).is_empty();
      if (some) families.emplace_back(HatchFamily(n, odd == rises, d), true, odd, options.cuts, *box);
    }
  }
  std::int64_t total = 0;
  for (const Lines& lines : families) total += std::min(lines.count, kMostLines + 1);
  if (total > kMostLines)
    throw Error(ErrorCode::bad_argument, fmt::format("hatching would take more than {} lines", kMostLines),
                "set them farther apart");
  if (total == 0) return {};

  const detail::LabelTree tree(labels_of(scene, work), scene.all().depth());
  struct Found {
    const Lines* lines;
    std::int64_t line;
    std::vector<HatchPiece> pieces;
  };
  std::vector<Found> found;
  found.reserve(static_cast<std::size_t>(total));
  for (const Lines& lines : families)
    for (std::int64_t i = 0; i < lines.count; ++i) found.push_back({&lines, lines.first + i * lines.step, {}});
  detail::for_each_index(found.size(), work, [&](std::size_t i) {
    const Lines& lines = *found[i].lines;
    found[i].pieces = HatchSlice(tree, scene.all().depth(), lines.family).seen(found[i].line, [&](std::uint32_t label) {
      return lines.wants(label) ? static_cast<std::uint32_t>(1 + solid_of(label)) : 0;
    });
  });

  const std::size_t solids = scene.solids().size();
  std::vector<std::vector<Stroke>> strokes(2 * solids);
  for (const Found& one : found) {
    const LinePlaces places(one.lines->family, one.line, screen);
    for (const HatchPiece& piece : one.pieces) {
      const Stroke stroke{places(piece.low), places(piece.high)};
      if (stroke.from != stroke.to) strokes[(one.lines->cut ? solids : 0) + piece.label - 1].push_back(stroke);
    }
  }
  std::vector<SceneLines> result;
  for (std::size_t i = 0; i < strokes.size(); ++i)
    if (!strokes[i].empty())
      result.push_back({i % solids, i < solids ? LineKind::hatch : LineKind::cut, std::move(strokes[i])});
  return result;
}

}  // namespace blackleaf
