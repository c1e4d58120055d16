// NearLooks: which voxels the rays of an edge meet first, the same for every edge of a family.
//
// Seen from its corner, a lattice edge [0, D] along a looks through cells of the plane (b, c), one after the other. In
// a cell, between the times `enter` and `leave`, a black voxel m further along a hides
//   (m D - max(tau d_a), (m + 1) D - min(tau d_a)).
// That meets the edge iff m is from floor(min / D) to ceil(max / D). One of them hides all of the edge by itself iff
// min <= m D <= max; two neighbours always do together, but for a point.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "edge_family.h"

namespace blackleaf::detail {

/// How far looks go along each axis, in voxels.
inline constexpr int kNearReach = 12;

/// Steps along b and c, and along a what is met in each step and what the edge adds: there are fewer looks than this.
inline constexpr std::size_t kMostNearLooks = 4 * (2 * kNearReach + 1) + kNearReach;

/// How many voxels are wanted below the edges' corners along an axis: those that rays go to, or a brick of those that
/// they come from.
constexpr int voxels_below(std::int64_t d) { return d < 0 ? kNearReach : 4; }

/// How voxels are laid out: layers along z of rows along y of 32 voxels along x, with four rows and layers to spare on
/// each side.
inline constexpr int kRows = 40, kSpareRows = 4;

/// Where a voxel stands among them, or from another.
struct VoxelStep {
  std::int32_t bytes = 0, bits = 0;

  static constexpr VoxelStep to(const std::array<int, 3>& at) { return {4 * (kRows * at[2] + at[1]), at[0]}; }
  /// To the next voxel below along an axis.
  static constexpr VoxelStep below(unsigned axis) {
    std::array<int, 3> at{};
    at[axis] = -1;
    return to(at);
  }
  friend constexpr VoxelStep operator+(const VoxelStep& s, const VoxelStep& t) {
    return {s.bytes + t.bytes, s.bits + t.bits};
  }
};

/// A look at one voxel.
struct NearLook {
  VoxelStep step;  // for the edge that begins voxels_below() after the first voxel; of an in_plane family to the voxel
                   // with the higher x_b of the two
  bool alone;      // if black, it hides the whole edge
  bool with_last;  // if this and that of the look before are black, they hide the whole edge
  Interval hides;  // of the edge [0, D], open
};

class NearLooks {
 public:
  /// Requires: the family is not end_on.
  explicit NearLooks(const EdgeFamily& family) {
    const bool general = family.mode == EdgeFamily::Mode::general;
    const std::int64_t time_b = std::abs(family.d_c), time_c = general ? std::abs(family.d_b) : 1;
    std::int64_t i = 0, j = 0, enter = 0;
    for (;;) {
      const std::int64_t leave = general ? std::min((i + 1) * time_b, (j + 1) * time_c) : (j + 1) * time_c;
      if (!add(family, family.d_b < 0 ? -1 - i : i, family.d_c < 0 ? -1 - j : j, enter, leave)) break;
      if (general && leave == (i + 1) * time_b) ++i;
      if (leave == (j + 1) * time_c) ++j;
      enter = leave;
    }
    assert(looks_.size() < kMostNearLooks);
    until_ = static_cast<double>(enter) / static_cast<double>(family.scale);
  }

  /// In the order in which rays meet the voxels.
  std::span<const NearLook> looks() const { return looks_; }
  /// The first of them, which decide most, and the others.
  std::span<const NearLook> first() const { return looks().first(std::min(looks_.size(), kFirst)); }
  std::span<const NearLook> others() const { return looks().subspan(first().size()); }
  /// What rays meet before they have gone so many times d is among the looks.
  double until() const { return until_; }

 private:
  static constexpr std::size_t kFirst = 16;

  static std::int64_t floor_ratio(std::int64_t n, std::int64_t d) { return n >= 0 ? n / d : -((d - 1 - n) / d); }

  // The looks at a cell; false iff one of them is out of reach.
  bool add(const EdgeFamily& f, std::int64_t b, std::int64_t c, std::int64_t enter, std::int64_t leave) {
    const std::int64_t low = std::min(enter * f.d_a, leave * f.d_a), high = std::max(enter * f.d_a, leave * f.d_a);
    const std::int64_t first = floor_ratio(low, f.scale), last = -floor_ratio(-high, f.scale);
    for (const std::int64_t offset : {b, c, first, last})
      if (std::abs(offset) > kNearReach) return false;
    for (std::int64_t m = first; m <= last; ++m) {
      std::array<int, 3> at{};
      at[f.a] = static_cast<int>(m) + voxels_below(f.d_a);
      at[f.b] = static_cast<int>(b) + voxels_below(f.d_b);
      at[f.c] = static_cast<int>(c) + voxels_below(f.d_c);
      NearLook look;
      look.step = VoxelStep::to(at);
      look.alone = low <= m * f.scale && m * f.scale <= high;
      look.with_last = m > first;
      look.hides = {m * f.scale - high, (m + 1) * f.scale - low};
      looks_.push_back(look);
    }
    return true;
  }

  std::vector<NearLook> looks_;
  double until_;
};

}  // namespace blackleaf::detail
