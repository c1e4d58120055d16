#include "blackleaf/move.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "blackleaf/error.h"
#include "blackleaf/set_operations.h"
#include "motion/move_general.h"
#include "motion/move_producer.h"
#include "octree/produce.h"
#include "reference/dense_motion.h"
#include "reference/every_kernel.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
using reference::EveryKernel;
constexpr double kDegree = M_PI / 180;

TEST(Move, AgreesWithTheDenseGrid) {
  std::mt19937 random(1987);
  for (int trial = 0; trial < 1500; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 5, random);
    const Motion motion = reference::random_motion(grid.depth, random);
    const Octree moved = move(reference::octree(grid), motion, Leaving::clip);
    reference::expect_valid(moved);
    ASSERT_TRUE(moved == reference::octree(reference::move(grid, FixedMotion(motion))));
  }
}

TEST(Move, DepthSixAndThreads) {
  std::mt19937 random(36);
  for (int trial = 0; trial < 25; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(6, random);
    const Motion motion = reference::random_motion(6, random);
    const Octree octree = reference::octree(grid);
    const Octree moved = move(octree, motion, Leaving::clip, {.threads = 1, .progress = {}});
    ASSERT_TRUE(moved == reference::octree(reference::move(grid, FixedMotion(motion))));
    for (int threads : {2, 3, 7})
      ASSERT_TRUE(moved == move(octree, motion, Leaving::clip, {.threads = threads, .progress = {}}));
  }
}

TEST(Move, EveryKernelGivesTheSame) {
  const EveryKernel kernels;
  std::mt19937 random(77);
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 5;
    const DenseGrid grid = reference::random_solid(depth, random);
    const Octree octree = reference::octree(grid);
    const Motion motion = reference::random_motion(depth, random);
    const Octree expected = reference::octree(reference::move(grid, FixedMotion(motion)));
    kernels.run([&] { EXPECT_TRUE(detail::move_by_look_up(octree, motion, Leaving::clip) == expected); });
  }
}

// Rotations with rational entries and half-integer translations: whole planes of centres on faces, edges and corners.
TEST(Move, CentresOnFaces) {
  const EveryKernel kernels;
  std::vector<Eigen::Matrix3d> rotations(4, Eigen::Matrix3d::Identity());
  rotations[1] << 0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1;
  rotations[2] << 1, -2, 2, 2, -1, -2, 2, 2, 1;
  rotations[2] /= 3;
  rotations[3] << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  rotations.push_back(Motion::rotation(Eigen::Vector3d::UnitX(), 45 * kDegree).rotation());
  std::mt19937 random(3455);
  for (int depth = 1; depth <= 4; ++depth) {
    std::vector<DenseGrid> solids;  // eight single voxels in corners, the empty and the full solid, and one of noise
    const int last = (1 << depth) - 1;
    for (int corner = 0; corner < 8; ++corner) {
      solids.emplace_back(depth);
      solids.back().set(corner & 1 ? last : 0, corner & 2 ? last : 0, corner & 4 ? last : 0);
    }
    solids.emplace_back(depth);
    solids.emplace_back(depth).voxels.assign(std::size_t{1} << (3 * depth), 1);
    solids.emplace_back(depth);
    for (auto& voxel : solids.back().voxels) voxel = random() % 2;
    for (const Eigen::Matrix3d& rotation : rotations)
      for (int halves = 0; halves < 8; ++halves) {
        const Eigen::Vector3d by(0.5 * (halves & 1), -0.5 * (halves >> 1 & 1), 0.5 * (halves >> 2));
        const Motion motion = Motion(rotation, by).about(Eigen::Vector3d::Constant(1 << (depth - 1)));
        for (std::size_t i = 0; i < solids.size(); ++i) {
          SCOPED_TRACE(std::to_string(depth) + ' ' + std::to_string(halves) + ' ' + std::to_string(i));
          const Octree octree = reference::octree(solids[i]);
          const Octree expected = reference::octree(reference::move(solids[i], FixedMotion(motion)));
          kernels.run([&] { ASSERT_TRUE(detail::move_by_look_up(octree, motion, Leaving::clip) == expected); });
        }
      }
  }
}

// WA87's M, the most nodes held at once, is its I, the nodes of the result: what is made stays.
TEST(Move, NothingIsMadeThatDoesNotStay) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(6, random);
    const Motion motion = reference::random_motion(6, random);
    const Octree octree = reference::octree(grid);
    if (octree.is_empty()) continue;
    const detail::MoveProducer producer(FixedMotion(motion), octree, 6);
    detail::NodeArrays arrays;  // only ever appended to
    auto task = producer.root();
    const detail::Subtree root = detail::produce_node(producer, task, {0, 0, 0, 6}, 0, arrays);
    const std::size_t made = arrays.size() + (root.colour == Colour::gray ? 1 : 0);
    const Octree moved = arrays.finish(6, root, {});
    EXPECT_TRUE(moved == move(octree, motion, Leaving::clip));
    std::size_t stayed = 0;
    for (int level = 0; level <= 6; ++level) stayed += moved.words(level).size();
    EXPECT_EQ(made, stayed);
  }
}

// At depths that no dense grid reaches: thin solids, voxel by voxel around where the surface goes.
void expect_as_defined(const Octree& octree, const Motion& motion, const std::vector<Eigen::Vector3d>& places,
                       std::mt19937& random) {
  const FixedMotion fixed(motion);
  const Octree moved = move(octree, motion, Leaving::clip, {.threads = 1, .progress = {}});
  reference::expect_valid(moved);
  for (const int threads : {2, 7})
    EXPECT_TRUE(move(octree, motion, Leaving::clip, {.threads = threads, .progress = {}}) == moved) << threads;
  EveryKernel().run([&] { EXPECT_TRUE(detail::move_by_look_up(octree, motion, Leaving::clip) == moved); });
  std::uniform_int_distribution<int> near(-3, 3);
  int black = 0, white = 0;
  for (const Eigen::Vector3d& place : places) {
    const Eigen::Vector3d to = motion(place);
    std::array<std::int64_t, 3> at{};
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
      at[i] = static_cast<std::int64_t>(std::floor(to[static_cast<Eigen::Index>(i)])) + near(random);
      inside = inside && at[i] >= 0 && at[i] < octree.side();
    }
    bool expected = false;
    reference::for_each_touched(fixed, at, [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      expected = expected || octree.contains(x, y, z);
    });
    ASSERT_EQ(moved.contains(at[0], at[1], at[2]), inside && expected) << at[0] << ' ' << at[1] << ' ' << at[2];
    ++(inside && expected ? black : white);
  }
  EXPECT_GT(black, 100);
  EXPECT_GT(white, 100);
}

TEST(Move, DepthFourteenBySamples) {
  std::mt19937 random(14);
  std::uniform_real_distribution<double> part(0, 1);
  // A frame of three thin bars through a plate.
  const Octree solid =
      unite(unite(box(14, {4000, 8190, 8189}, {12001, 8193, 8191}), box(14, {8190, 5001, 8190}, {8192, 11000, 8193})),
            unite(box(14, {8191, 8189, 5000}, {8193, 8190, 11111}), box(14, {7000, 7000, 8000}, {7300, 7411, 8001})));
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < 3000; ++i) {
    places.emplace_back(4000 + 8001 * part(random), 8191.5, 8190);
    places.emplace_back(8191, 5001 + 5999 * part(random), 8191.5);
    places.emplace_back(8192, 8189.5, 5000 + 6111 * part(random));
    places.emplace_back(7000 + 300 * part(random), 7000 + 411 * part(random), 8000.5);
  }
  const Eigen::Vector3d centre = Eigen::Vector3d::Constant(8192);
  for (const Motion& motion :
       {(Motion::translation({5.3, -7.1, 2.9}) * Motion::rotation({1, 1, 1}, 30 * kDegree)).about(centre),
        (Motion::translation({0.5, 0, -0.5}) * Motion::rotation({0, 0, 1}, 45 * kDegree)).about(centre),
        Motion::translation({5000, 0.25, 1e-9})})
    expect_as_defined(solid, motion, places, random);
}

TEST(Move, DepthTwentyBySamples) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> part(0, 1);
  const std::int32_t middle = 1 << 19;
  const Octree solid =
      unite(box(20, {1048000, 3, 1047000}, {1048576, 9, 1047006}), box(20, {middle - 1, 0, 0}, {middle + 2, 400, 3}));
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < 2000; ++i) {
    places.emplace_back(1048000 + 576 * part(random), 6, 1047003);
    places.emplace_back(middle + 0.5, 400 * part(random), 1.5);
  }
  const Eigen::Vector3d centre = Eigen::Vector3d::Constant(middle);
  for (const Motion& motion :
       {Motion::rotation({1, 1, 1}, 1e-4).about(centre), Motion::rotation({0, 0, 1}, 180 * kDegree).about(centre),
        Motion::translation({-333.5, 5.25, 0})})
    expect_as_defined(solid, motion, places, random);
}

TEST(Move, LeavesExactlyWhenACornerDoes) {
  std::mt19937 random(77);
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid = reference::random_solid(1 + trial % 4, random);
    const Motion motion = reference::random_motion(grid.depth, random);
    double outside = 0;
    grid.for_each([&](int x, int y, int z, bool black) {
      for (int corner = 0; black && corner < 8; ++corner) {
        const Eigen::Vector3d p = motion(Eigen::Vector3d(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2)));
        outside = std::max({outside, -p.minCoeff(), p.maxCoeff() - grid.side()});
      }
    });
    const Octree octree = reference::octree(grid);
    if (outside > 0x1p-15) {
      EXPECT_THROW(move(octree, motion), Error);
    } else if (outside < 0x1p-17) {
      EXPECT_TRUE(move(octree, motion) == move(octree, motion, Leaving::clip));
    }
    if (!octree.is_empty()) {
      const Octree grown = move(octree, motion, Leaving::grow);
      reference::expect_valid(grown);
      // World coordinates stay: every voxel centre of the old universe has the colour it has when clipping.
      const Octree clipped = move(octree, motion, Leaving::clip);
      const Eigen::Vector3d offset = -grown.frame().origin;
      for (int z = 0; z < grid.side(); ++z)
        for (int y = 0; y < grid.side(); ++y)
          for (int x = 0; x < grid.side(); ++x)
            ASSERT_EQ(
                clipped.contains(x, y, z),
                grown.contains(x + std::lround(offset.x()), y + std::lround(offset.y()), z + std::lround(offset.z())));
    }
  }
}

TEST(Move, LessThanAVoxelOutIsStillOut) {
  const Octree full(3, Colour::black);
  try {
    move(full, Motion::translation({0.25, 0, 0}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::out_of_universe);
    EXPECT_NE(std::string(error.what()).find("0.25 voxels beyond x = 8"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(move(full, Motion::translation({0.25, 0, 0}), Leaving::clip) == full);
}

TEST(Move, SingleVoxelsAtCornersLeaveByLittle) {
  // Out on each side that the corner has, by less than a voxel: an error that names the side, from beyond 2^-16 on.
  for (int depth = 1; depth <= 4; ++depth)
    for (int corner = 0; corner < 8; ++corner) {
      const std::int32_t last = (1 << depth) - 1;
      std::array<std::int32_t, 3> low{}, high{};
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = corner >> i & 1 ? last : 0;
        high[i] = low[i] + 1;
      }
      const Octree speck = box(depth, low, high);
      for (int axis = 0; axis < 3; ++axis) {
        const bool up = (corner >> axis & 1) != 0;
        const std::string side =
            (up ? "beyond " : "below ") + std::string(1, "xyz"[axis]) + " = " + std::to_string(up ? last + 1 : 0);
        for (const double by : {0.75, 0.5, 0.25, 0x1p-15, 0x1p-17}) {
          SCOPED_TRACE(testing::Message() << depth << ' ' << corner << ' ' << side << ' ' << by);
          const Motion motion = Motion::translation((up ? by : -by) * Eigen::Vector3d::Unit(axis));
          const Octree clipped = move(speck, motion, Leaving::clip), grown = move(speck, motion, Leaving::grow);
          EXPECT_EQ(clipped.is_empty(), by > 0.5);
          EXPECT_EQ(grown.depth(), by > 0x1p-16 ? depth + 1 : depth);
          EXPECT_EQ(volume(grown), by == 0.5 ? 2u : 1u) << "a centre on a face is in both voxels";
          try {
            EXPECT_TRUE(move(speck, motion) == speck);
            EXPECT_LT(by, 0x1p-16);
          } catch (const Error& error) {
            EXPECT_GT(by, 0x1p-16);
            EXPECT_EQ(error.code(), ErrorCode::out_of_universe);
            EXPECT_NE(std::string(error.what()).find(side), std::string::npos) << error.what();
          }
        }
      }
    }
  // Turned by 45 degrees a full universe leaves on four sides alike.
  for (int depth = 1; depth <= 4; ++depth) {
    const double half = 1 << (depth - 1);
    try {
      move(Octree(depth, Colour::black),
           Motion::rotation_degrees({0, 0, 1}, 45).about(Eigen::Vector3d::Constant(half)));
      FAIL();
    } catch (const Error& error) {
      std::array<char, 16> out{};
      std::snprintf(out.data(), out.size(), "%.6f", (std::sqrt(2) - 1) * half);
      for (const std::string side : {" below x = 0", " beyond x = ", " below y = 0", " beyond y = "})
        EXPECT_NE(std::string(error.what()).find(out.data() + (" voxels" + side)), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find("z ="), std::string::npos) << error.what();
    }
  }
}

TEST(Move, QuarterTurnsAreLosslessAndFormAGroup) {
  std::mt19937 random(24);
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 5;
    const Octree octree = reference::octree(reference::random_solid(depth, random));
    const Eigen::Vector3d centre = Eigen::Vector3d::Constant((1 << depth) / 2.0);
    const auto turn = [&](int axis, int quarters) {
      return Motion::rotation(Eigen::Vector3d::Unit(axis), quarters * 90 * kDegree).about(centre);
    };
    for (int axis = 0; axis < 3; ++axis) {
      const Octree once = move(octree, turn(axis, 1));
      EXPECT_EQ(measure(once).black_leaves_by_level, measure(octree).black_leaves_by_level);
      EXPECT_TRUE(move(once, turn(axis, 3)) == octree);
      EXPECT_TRUE(move(move(once, turn(axis, 1)), turn(axis, 2)) == octree);
      EXPECT_TRUE(move(once, turn((axis + 1) % 3, 1)) == move(octree, turn((axis + 1) % 3, 1) * turn(axis, 1)));
    }
  }
}

TEST(Move, IntegerTranslationsAreThoseOfTranslate) {
  std::mt19937 random(13);
  std::uniform_int_distribution<int> shift(-9, 9);
  for (int trial = 0; trial < 200; ++trial) {
    const Octree octree = reference::octree(reference::random_solid(1 + trial % 4, random));
    const std::array<std::int64_t, 3> by = {shift(random), shift(random), shift(random)};
    const Motion motion =
        Motion::translation({static_cast<double>(by[0]), static_cast<double>(by[1]), static_cast<double>(by[2])});
    EXPECT_TRUE(move(octree, motion, Leaving::clip) == translate(octree, by, Leaving::clip));
  }
}

TEST(Move, DoesNotMakeHoles) {
  // WA87, section 3: a voxel wholly inside the moved solid is black, one wholly outside is white.
  std::mt19937 random(2);
  for (int trial = 0; trial < 30; ++trial) {
    SCOPED_TRACE(trial);
    const Motion motion = reference::random_motion(6, random);
    const Octree moved = move(ball(6, {32, 32, 32}, 20), motion, Leaving::clip);
    const Eigen::Vector3d centre = motion(Eigen::Vector3d(32, 32, 32));
    for (int z = 0; z < 64; ++z)
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
          const double radius = (Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5) - centre).norm();
          if (radius < 19 || radius > 21) {
            ASSERT_EQ(moved.contains(x, y, z), radius < 20);
          }
        }
  }
}

TEST(Move, DepthTwenty) {
  const Octree speck = box(20, {524288, 524288, 524288}, {524300, 524291, 524289});
  const Octree turned = move(speck, Motion::rotation({0, 0, 1}, 90 * kDegree).about(Eigen::Vector3d::Constant(524288)));
  EXPECT_EQ(*bounding_box(turned), (Box{{524285, 524288, 524288}, {524288, 524300, 524289}}));
  EXPECT_EQ(volume(turned), volume(speck));
}

TEST(Move, FarAwayIsOutOfEveryUniverse) {
  const Octree speck = box(5, {1, 1, 1}, {2, 2, 2});
  const Motion far = Motion::translation({1e9, 0, 0});
  EXPECT_TRUE(move(speck, far, Leaving::clip).is_empty());
  EXPECT_THROW(move(speck, far), Error);
  EXPECT_THROW(move(speck, far, Leaving::grow), Error);
}

}  // namespace
}  // namespace blackleaf
