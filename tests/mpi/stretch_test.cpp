// Stretches, cuts, parts and joins, in one process: what the ranks do between their meetings.
#include "mpi/stretch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "blackleaf/implicit.h"
#include "blackleaf/measures.h"
#include "blackleaf/move.h"
#include "blackleaf/set_operations.h"
#include "motion/move_plan.h"
#include "motion/move_producer.h"
#include "mpi/produce_part.h"

namespace blackleaf::mpi {
namespace {

constexpr unsigned kSeed = 1992;

Octree balls(int depth, unsigned seed) {
  std::mt19937 random(seed);
  const double side = std::exp2(depth);
  std::uniform_real_distribution<double> place(0.2 * side, 0.8 * side), radius(0.02 * side, 0.2 * side);
  std::vector<std::array<double, 4>> all(6);
  for (auto& ball : all) ball = {place(random), place(random), place(random), radius(random)};
  return octree_from_classifier(depth, [all](const Cube& cube) {
    const double half = 0.5 * cube.side();
    bool gray = false;
    for (const auto& [x, y, z, r] : all) {
      const double distance = std::hypot(cube.x + half - x, cube.y + half - y, cube.z + half - z);
      const double reach = cube.level == 0 ? 0 : half * std::sqrt(3.0);
      if (distance + reach <= r) return Colour::black;
      if (distance - reach <= r && cube.level > 0) gray = true;
    }
    return gray ? Colour::gray : Colour::white;
  });
}

// Cuts at random multiples of 8^level, some of them equal.
Cuts random_cuts(int depth, int level, int processes, std::mt19937& random) {
  Cuts cuts = uncut(depth, processes);
  std::uniform_int_distribution<std::uint64_t> unit(0, voxels_of(depth - level));
  for (std::size_t i = 1; i + 1 < cuts.size(); ++i) cuts[i] = unit(random) * voxels_of(level);
  std::sort(cuts.begin() + 1, cuts.end() - 1);
  return cuts;
}

TEST(Stretch, PartsAndTheirJoin) {
  std::mt19937 random(kSeed);
  for (const int depth : {3, 5, 6, 7})
    for (int round = 0; round < 12; ++round) {
      const Octree octree = balls(depth, static_cast<unsigned>(random()));
      const int processes = 1 + round % 7;
      const Cuts cuts = random_cuts(depth, 2, processes, random);
      std::vector<Octree> parts;
      std::uint64_t voxels = 0;
      for (int i = 0; i < processes; ++i) {
        const Stretch stretch = stretch_of(cuts, i);
        const Octree part = part_of(octree, stretch);
        EXPECT_EQ(validate(part), "");
        // The slow twin: voxel by voxel along the curve.
        if (depth <= 5)
          for (std::uint64_t number = 0; number < voxels_of(depth); ++number) {
            const curve::Voxel v = curve::voxel(depth, number);
            ASSERT_EQ(part.contains(v.x, v.y, v.z),
                      number >= stretch.first && number < stretch.last && octree.contains(v.x, v.y, v.z));
          }
        voxels += volume(part);
        parts.push_back(part);
      }
      EXPECT_EQ(voxels, volume(octree));
      std::shuffle(parts.begin(), parts.end(), random);
      const Octree joined = join(parts);
      EXPECT_EQ(validate(joined), "");
      EXPECT_TRUE(joined == octree);
    }
}

TEST(Stretch, BlackNodesThatAreCutCondenseAgain) {
  for (const int depth : {2, 4, 8}) {
    const Octree full(depth, Colour::black);
    for (std::uint64_t at = 64; at < voxels_of(depth); at += voxels_of(depth) / 8 + (depth > 2 ? 64 : 0)) {
      const std::array<Octree, 2> parts = {part_of(full, {0, at}), part_of(full, {at, voxels_of(depth)})};
      EXPECT_EQ(volume(parts[0]), at);
      EXPECT_TRUE(join(parts) == full);
    }
  }
}

TEST(Stretch, ProcessOfANumber) {
  const Cuts cuts = {0, 64, 64, 128, 512, 512};
  EXPECT_EQ(process_at(cuts, 0), 0);
  EXPECT_EQ(process_at(cuts, 63), 0);
  EXPECT_EQ(process_at(cuts, 64), 2);
  EXPECT_EQ(process_at(cuts, 127), 2);
  EXPECT_EQ(process_at(cuts, 511), 3);
}

TEST(Stretch, BoxesTileTheVolume) {
  std::mt19937 random(kSeed);
  constexpr int kDepth = 9;
  for (int round = 0; round < 40; ++round) {
    VoxelBox box;
    for (std::size_t i = 0; i < 3; ++i) {
      box.low[i] = static_cast<std::int64_t>(random() % 300);
      box.high[i] = box.low[i] + 1 + static_cast<std::int64_t>(random() % static_cast<unsigned>(512 - box.low[i]));
    }
    const int processes = 1 + static_cast<int>(random() % 9);
    const Cuts cuts =
        round % 2 ? cuts_by_voxels(kDepth, box, processes) : random_cuts(kDepth, kBlockLevel, processes, random);
    std::vector<VoxelBox> all;
    std::int64_t voxels = 0;
    for (int i = 0; i < processes; ++i) {
      const Stretch stretch = stretch_of(cuts, i);
      for (const VoxelBox& part : boxes_of(kDepth, stretch, box)) {
        voxels += part.voxels();
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_GE(part.low[axis], box.low[axis]);
          EXPECT_LT(part.low[axis], part.high[axis]);
          EXPECT_LE(part.high[axis], box.high[axis]);
        }
        for (const VoxelBox& other : all) {
          bool apart = false;
          for (std::size_t axis = 0; axis < 3; ++axis)
            apart = apart || part.high[axis] <= other.low[axis] || other.high[axis] <= part.low[axis];
          EXPECT_TRUE(apart);
        }
        all.push_back(part);
        // Its corners have numbers of the stretch.
        for (unsigned corner = 0; corner < 8; ++corner) {
          const auto at = [&](std::size_t axis) {
            return static_cast<std::int32_t>(corner >> axis & 1 ? part.high[axis] - 1 : part.low[axis]);
          };
          const std::uint64_t number = curve::number(kDepth, {at(0), at(1), at(2)});
          EXPECT_TRUE(number >= stretch.first && number < stretch.last);
        }
      }
    }
    EXPECT_EQ(voxels, box.voxels());
  }
}

TEST(Stretch, CutsByVoxelsAreEven) {
  const VoxelBox box{{0, 0, 0}, {1000, 700, 900}};
  for (const int processes : {1, 2, 3, 7, 64}) {
    const Cuts cuts = cuts_by_voxels(10, box, processes);
    for (int i = 0; i < processes; ++i) {
      std::int64_t voxels = 0;
      for (const VoxelBox& part : boxes_of(10, stretch_of(cuts, i), box)) voxels += part.voxels();
      EXPECT_LE(std::abs(voxels - box.voxels() / processes), std::int64_t{1} << (3 * kBlockLevel));
    }
  }
}

// Gray nodes of level 3 in a stretch: what moving costs.
std::uint64_t work_of(const Node& node, std::uint8_t table, std::uint64_t first, const Stretch& stretch) {
  if (!node.is_gray() || first + voxels_of(node.level()) <= stretch.first || first >= stretch.last) return 0;
  if (node.level() == 3) return 1;
  std::uint64_t work = 0;
  for (const curve::Step down : curve::kSteps[table]) {
    work += work_of(node.child(down.octant), down.table, first, stretch);
    first += voxels_of(node.level() - 1);
  }
  return work;
}

TEST(ProducePart, AnyCutsGiveTheWholeAndBalancedOnesAreEven) {
  std::mt19937 random(kSeed);
  for (const int depth : {6, 7, 9}) {
    const Octree source = balls(depth, kSeed + static_cast<unsigned>(depth));
    const double middle = std::exp2(depth - 1);
    const Motion motion = Motion::rotation_degrees({1, 2, 3}, 33).about({middle, middle, middle});
    const Octree target = move(source, motion, Leaving::clip);
    const detail::MovePlan plan = detail::plan_move(source, motion, Leaving::clip);
    const detail::MoveProducer producer(*plan.motion, source, depth);
    for (const int processes : {1, 2, 3, 4, 7, 16}) {
      const auto produced = [&](const Cuts& cuts) {
        std::vector<Octree> parts;
        for (int i = 0; i < processes; ++i) {
          parts.push_back(produce_part(producer, depth, plan.frame, stretch_of(cuts, i), {1 + i % 2, {}}));
          EXPECT_TRUE(parts.back() == part_of(target, stretch_of(cuts, i)));
        }
        return join(parts);
      };
      EXPECT_TRUE(produced(random_cuts(depth, 3, processes, random)) == target);
      // Every process weighs its share; together they are the weights of all.
      std::vector<std::vector<std::uint64_t>> shares;
      for (int i = 0; i < processes; ++i)
        balanced_cuts(producer, depth, processes, i, [&](auto& weights) { shares.push_back(weights); });
      const Cuts cuts = balanced_cuts(producer, depth, processes, 0, [&](auto& weights) {
        for (std::size_t i = 1; i < shares.size(); ++i)
          for (std::size_t unit = 0; unit < weights.size(); ++unit) weights[unit] += shares[i][unit];
      });
      EXPECT_TRUE(produced(cuts) == target);
      if (depth < 9) continue;
      std::uint64_t most = 0;
      for (int i = 0; i < processes; ++i) most = std::max(most, work_of(target.root(), 0, 0, stretch_of(cuts, i)));
      const auto all = static_cast<double>(work_of(target.root(), 0, 0, whole(depth)));
      EXPECT_LE(static_cast<double>(most), 1.2 * all / processes) << processes << " processes";
    }
  }
}

}  // namespace
}  // namespace blackleaf::mpi
