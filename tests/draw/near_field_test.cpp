// What draw() finds for many edges at once (near_field.h) and among few nodes (beam.h), beside one edge at a time and
// the whole tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "blackleaf/drawing.h"
#include "blackleaf/implicit.h"
#include "directions.h"
#include "draw/feature_edges.h"
#include "draw/near_looks.h"
#include "draw/strokes.h"
#include "draw/visibility.h"
#include "reference/dense_grid.h"
#include "reference/every_kernel.h"
#include "reference/sorted_strokes.h"
#include "stroke_laws.h"

namespace blackleaf {
namespace {

using detail::EdgeFamily;
using detail::Interval;
using detail::NearLook;
using detail::NearLooks;
using detail::Piece;

// The drawing, every run of a brick searched on its own.
class OneByOne {
 public:
  static std::vector<Stroke> strokes(const Octree& octree, const View& view) {
    OneByOne all(octree, view.direction());
    detail::FeatureEdges<OneByOne> edges(all.families_, all);
    detail::corner_walk(octree, edges);
    std::vector<Stroke> strokes;
    for (unsigned line_class = 0; line_class < 3; ++line_class) {
      for (const EdgeFamily& family : all.families_)
        if (family.mode != EdgeFamily::Mode::end_on && family.line_class == line_class) {
          reference::append_strokes(all.pieces_[line_class], detail::PictureLines(family, view), strokes);
          break;
        }
    }
    return strokes;
  }

  void operator()(unsigned axis, std::int32_t a0, std::int32_t a1, std::int32_t b, std::int32_t c) {
    const EdgeFamily& family = families_[axis];
    for (const Interval& visible : walks_[axis].visible({a0 * family.scale, a1 * family.scale}, b, c))
      pieces_[family.line_class].push_back(family.piece(visible, b, c));
  }

 private:
  OneByOne(const Octree& octree, const detail::Direction& d)
      : families_{EdgeFamily(0, d), EdgeFamily(1, d), EdgeFamily(2, d)} {
    for (const EdgeFamily& family : families_) {
      const bool drawn = family.mode != EdgeFamily::Mode::end_on;
      walks_.emplace_back(octree, drawn ? family : families_[(family.a + 1) % 3]);
    }
  }

  std::array<EdgeFamily, 3> families_;
  std::vector<detail::VisibilityWalk> walks_;
  std::array<std::vector<Piece>, 3> pieces_;
};

void expect_like_one_by_one(const Octree& octree, const Eigen::Vector3d& direction) {
  SCOPED_TRACE("view " + show(direction));
  const View view(direction);
  const std::vector<Stroke> expected = OneByOne::strokes(octree, view);
  reference::EveryKernel().run([&] { expect_same(draw(octree, view).strokes, expected); });
}

TEST(NearField, RandomSolids) {
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 40000);
    const int depth = seed % 8 == 0 ? 6 : seed % 4 == 0 ? 5 : 4;
    expect_like_one_by_one(reference::octree(reference::random_solid(depth, random)), random_direction(random));
  }
}

// Walls, rods and voxels that stand before a wall at every distance about the looks' reach.
TEST(NearField, BlockersAboutTheReach) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 41000);
    const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
    reference::DenseGrid grid(6);
    const int axis = pick(0, 2), wall = pick(20, 24);
    const auto set = [&](int a, int b, int c) {
      std::array<int, 3> at{};
      const auto place = [&](int offset) { return static_cast<std::size_t>((axis + offset) % 3); };
      at[place(0)] = a, at[place(1)] = b, at[place(2)] = c;
      grid.set(at[0], at[1], at[2]);
    };
    for (int b = 8; b < 56; ++b)
      for (int c = 8; c < 56; ++c) set(wall + (pick(0, 9) == 0 ? 1 : 0), b, c);
    for (int k = 0; k < 60; ++k) {
      const int a = wall + pick(2, 30), b = pick(8, 55), c = pick(8, 55), length = pick(1, 8);
      for (int i = 0; i < length; ++i) seed % 2 ? set(a, std::min(63, b + i), c) : set(a, b, std::min(63, c + i));
    }
    Eigen::Vector3d d = random_direction(random);
    if (seed % 3 != 0) d[axis] = 1.5 * d.cwiseAbs().maxCoeff();
    expect_like_one_by_one(reference::octree(grid), d);
    expect_like_one_by_one(reference::octree(grid), -d);
  }
}

TEST(NearField, LargeSolids) {
  for (const Eigen::Vector3d& d :
       {Eigen::Vector3d(12, -16, 15), Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0, 3, -1), Eigen::Vector3d(0, 0, -1),
        Eigen::Vector3d(-100, 3, 1), Eigen::Vector3d(1048575, -1048576, 1048573)}) {
    expect_like_one_by_one(ball(7, {64, 64, 64}, 63.5), d);
    std::mt19937 random(43000);
    for (int i = 0; i < 2; ++i) expect_like_one_by_one(reference::octree(reference::random_solid(7, random)), d);
  }
}

// Every voxel that the rays of an edge meet within the looks' time is looked at, with what it hides; found by trying
// all.
TEST(NearLooks, AreAllThereAre) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed + 42000);
    const detail::Direction d = View(random_direction(random)).direction();
    for (unsigned axis = 0; axis < 3; ++axis) {
      const EdgeFamily family(axis, d);
      if (family.mode == EdgeFamily::Mode::end_on) continue;
      const NearLooks looks(family);
      const auto until = static_cast<std::int64_t>(std::llround(looks.until() * static_cast<double>(family.scale)));
      ASSERT_LT(looks.looks().size(), detail::kMostNearLooks);
      std::size_t found = 0;
      const bool general = family.mode == EdgeFamily::Mode::general;
      const auto times = [&](std::int64_t at, std::int64_t direction, std::int64_t pace) {
        const std::int64_t enter = (direction < 0 ? -1 - at : at) * pace;
        return Interval{std::max<std::int64_t>(0, enter), std::min(until, enter + pace)};
      };
      for (int c = -13; c <= 13; ++c)
        for (int b = general ? -13 : 0; b <= (general ? 13 : 0); ++b) {
          Interval in_c = times(c, family.d_c, general ? std::abs(family.d_b) : 1);
          if (general) {
            const Interval in_b = times(b, family.d_b, std::abs(family.d_c));
            in_c = {std::max(in_b.low, in_c.low), std::min(in_b.high, in_c.high)};
          }
          if (in_c.low >= in_c.high) continue;
          for (int a = -13; a <= 13; ++a) {
            const std::int64_t shift = std::min(in_c.low * family.d_a, in_c.high * family.d_a),
                               most = std::max(in_c.low * family.d_a, in_c.high * family.d_a);
            const Interval hides{a * family.scale - most, (a + 1) * family.scale - shift};
            if (hides.high <= 0 || hides.low >= family.scale) continue;
            std::array<int, 3> at{};
            at[family.a] = a + detail::voxels_below(family.d_a);
            at[family.b] = b + detail::voxels_below(family.d_b);
            at[family.c] = c + detail::voxels_below(family.d_c);
            const auto step = detail::VoxelStep::to(at);
            const auto all = looks.looks();
            EXPECT_EQ(std::count_if(all.begin(), all.end(),
                                    [&](const NearLook& look) {
                                      return look.step.bytes == step.bytes && look.step.bits == step.bits &&
                                             look.hides.low == hides.low && look.hides.high == hides.high &&
                                             look.alone == (hides.low <= 0 && hides.high >= family.scale);
                                    }),
                      1);
            ++found;
          }
        }
      EXPECT_EQ(found, looks.looks().size());
    }
  }
}

}  // namespace
}  // namespace blackleaf
