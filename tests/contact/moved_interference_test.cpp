// Interference with a moved solid: both meanings against slow twins, prepared and not, by every kernel.
#include <gtest/gtest.h>

#include "blackleaf/contact.h"
#include "blackleaf/error.h"
#include "blackleaf/implicit.h"
#include "blackleaf/move.h"
#include "blackleaf/set_operations.h"
#include "contact/contact_node.h"
#include "contact/exact_boxes.h"
#include "octree/simd_kernels.h"
#include "reference/dense_motion.h"
#include "reference/exact_contact.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
constexpr double kDegree = M_PI / 180;

// Asked of the octrees and of the prepared ones.
bool asked(const Octree& a, const Octree& b, const Motion& motion, Meaning meaning) {
  const bool plain = interferes(a, b, motion, meaning);
  EXPECT_EQ(interferes(PreparedSolid(a), PreparedSolid(b), motion, meaning), plain);
  return plain;
}
bool exactly(const Octree& a, const Octree& b, const Motion& motion) { return asked(a, b, motion, Meaning::exact); }
bool voxelised(const Octree& a, const Octree& b, const Motion& motion) {
  return asked(a, b, motion, Meaning::voxelised);
}

// Exact interference by the plainest descent, every pair of cubes decided in integers: for solids that are too large
// for pairs of all leaves.
bool descended(const detail::ExactBoxes& exact, const Node& a, const Cube& in_a, const Node& b, const Cube& in_b) {
  if (a.is_white() || b.is_white()) return false;
  const auto box_of = [](const Cube& c) {
    return detail::IntegerBox{{c.x, c.y, c.z}, {c.x + c.side(), c.y + c.side(), c.z + c.side()}};
  };
  if (exact.apart(box_of(in_a), box_of(in_b))) return false;
  if (a.is_black() && b.is_black()) return true;
  const bool split_a = a.is_gray() && (!b.is_gray() || in_a.level >= in_b.level);
  for (int octant = 0; octant < 8; ++octant)
    if (split_a ? descended(exact, a.child(octant), in_a.child(octant), b, in_b)
                : descended(exact, a, in_a, b.child(octant), in_b.child(octant)))
      return true;
  return false;
}
bool descended(const Octree& a, const Octree& b, const Motion& motion) {
  return descended(detail::ExactBoxes(FixedMotion(motion)), a.root(), a.universe(), b.root(), b.universe());
}

// A motion like `motion`, shifted along a random way to where two solids begin to interfere, up to `hair`.
template <class Ask>
std::pair<Motion, Motion> at_contact(const Motion& motion, int depth, double hair, std::mt19937& random,
                                     const Ask& ask) {
  std::normal_distribution<double> normal;
  const Eigen::Vector3d way = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
  double in = 0, out = 4.0 * (1 << depth);
  while (out - in > hair) {
    const double middle = (in + out) / 2;
    (ask(Motion::translation(middle * way) * motion) ? in : out) = middle;
  }
  return {Motion::translation(in * way) * motion, Motion::translation(out * way) * motion};
}

TEST(VoxelisedInterference, IsThatOfTheMovedOctree) {
  std::mt19937 random(84);
  int hits = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 5;
    const Octree a = reference::octree(reference::random_solid(depth, random));
    const Octree b = reference::octree(reference::random_solid(depth, random));
    Motion motion = reference::random_motion(depth, random);
    if (trial % 2 != 0)
      motion = at_contact(motion, depth, 1e-3, random, [&](const Motion& m) {
                 return interferes(a, b, m, Meaning::exact);
               }).first;
    const bool expected = interferes(a, move(b, motion, Leaving::clip));
    ASSERT_EQ(voxelised(a, b, motion), expected);
    hits += expected;
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LT(hits, 3000);
}

TEST(ExactInterference, IsThatOfAllPairsOfLeaves) {
  std::mt19937 random(1985);
  int hits = 0, trials = 0;
  for (int trial = 0; trial < 600; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 3;
    const Octree a = reference::octree(reference::random_solid(depth, random));
    const Octree b = reference::octree(reference::random_solid(depth, random));
    const Motion motion = reference::random_motion(depth, random);
    std::vector<Motion> motions = {motion};
    if (trial % 3 != 0) {
      const auto [in, out] =
          at_contact(motion, depth, 1e-11, random, [&](const Motion& m) { return exactly(a, b, m); });
      motions = {in, out};
    }
    for (const Motion& m : motions) {
      const bool expected = reference::interfere_exactly(a, b, FixedMotion(m));
      ASSERT_EQ(exactly(a, b, m), expected);
      ASSERT_EQ(descended(a, b, m), expected);
      hits += expected;
      ++trials;
    }
  }
  EXPECT_GT(hits, trials / 4);
  EXPECT_LT(hits, 3 * trials / 4);
}

TEST(Overlap, IsTheIntersectionWithTheMovedOctree) {
  std::mt19937 random(86);
  int hits = 0;
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 6;
    const Octree a = reference::octree(reference::random_solid(depth, random));
    const Octree b = reference::octree(reference::random_solid(depth, random));
    const Motion motion = reference::random_motion(depth, random);
    const Octree expected = intersect(a, move(b, motion, Leaving::clip));
    const Octree found = overlap(a, b, motion, {1 + trial % 2, {}});
    ASSERT_EQ(found, expected);
    reference::expect_valid(found);
    ASSERT_EQ(!found.is_empty(), interferes(a, b, motion, Meaning::voxelised));
    hits += !found.is_empty();
  }
  EXPECT_GT(hits, 100);
  EXPECT_TRUE(overlap(Octree(4, Colour::black), Octree(4, Colour::black), Motion::translation({1e9, 0, 0})).is_empty());
  EXPECT_THROW(overlap(Octree(3), Octree(4), Motion()), Error);
}

TEST(Interference, OfManyMotionsIsThatOfEach) {
  std::mt19937 random(87);
  const PreparedSolid a(ball(6, {30, 33, 31}, 14.7)), b(box(6, {20, 20, 20}, {31, 40, 44}));
  std::vector<Motion> motions = {Motion::translation({1e9, 0, 0})};
  for (int i = 0; i < 300; ++i) motions.push_back(reference::random_motion(6, random));
  for (const Meaning meaning : {Meaning::exact, Meaning::voxelised})
    for (const int threads : {1, 2}) {
      const std::vector<bool> answers = interferes(a, b, motions, meaning, {threads, {}});
      ASSERT_EQ(answers.size(), motions.size());
      for (std::size_t i = 0; i < motions.size(); ++i)
        ASSERT_EQ(answers[i], interferes(a, b, motions[i], meaning)) << i;
    }
  EXPECT_TRUE(interferes(a, b, std::vector<Motion>{}, Meaning::exact).empty());
  const Work refusing{1, [](double) { return false; }};
  EXPECT_THROW(interferes(a, b, motions, Meaning::exact, refusing), Error);
  EXPECT_THROW(interferes(a, PreparedSolid(Octree(5)), motions, Meaning::exact), Error);
}

// Large enough for bounds in units of several voxels, and for planes to matter.
TEST(Interference, OfLargeSolidsAtContact) {
  std::mt19937 random(20);
  const std::vector<Octree> solids = {ball(9, {250, 260, 255}, 101.3), box(9, {100, 200, 37}, {131, 222, 300}),
                                      box(9, {0, 0, 0}, {512, 512, 512}), ball(9, {400.5, 300.25, 61}, 20)};
  std::vector<PreparedSolid> trees(solids.begin(), solids.end());
  int differences = 0;
  for (int trial = 0; trial < 48; ++trial) {
    SCOPED_TRACE(trial);
    const auto i = static_cast<std::size_t>(trial % 4), j = static_cast<std::size_t>(trial / 4 % 4);
    const Motion motion = reference::random_motion(9, random);
    const auto [in, out] = at_contact(
        motion, 9, 1e-6, random, [&](const Motion& m) { return interferes(trees[i], trees[j], m, Meaning::exact); });
    for (const Motion& m : {in, out}) {
      ASSERT_EQ(interferes(trees[i], trees[j], m, Meaning::exact), descended(solids[i], solids[j], m));
      const bool expected = interferes(solids[i], move(solids[j], m, Leaving::clip));
      ASSERT_EQ(interferes(trees[i], trees[j], m, Meaning::voxelised), expected);
      ASSERT_EQ(interferes(solids[i], solids[j], m, Meaning::voxelised), expected);
    }
    differences +=
        interferes(trees[i], trees[j], out, Meaning::exact) != interferes(trees[i], trees[j], in, Meaning::exact);
  }
  EXPECT_GT(differences, 20);
}

TEST(Interference, IsTheSameByEveryKernel) {
  std::mt19937 random(6);
  const PreparedSolid a(ball(6, {30, 33, 31}, 14.7)), b(box(6, {20, 20, 20}, {31, 40, 44}));
  std::vector<Motion> motions;
  for (int i = 0; i < 60; ++i) motions.push_back(reference::random_motion(6, random));
  for (const Meaning meaning : {Meaning::exact, Meaning::voxelised}) {
    std::vector<bool> expected;
    for (const std::string& kernel : detail::simd_kernels()) {
      detail::use_simd_kernel(kernel);
      std::vector<bool> answers;
      for (const Motion& motion : motions) answers.push_back(interferes(a, b, motion, meaning));
      if (expected.empty()) expected = answers;
      EXPECT_EQ(answers, expected) << kernel;
    }
    detail::use_simd_kernel("");
  }
}

TEST(PreparedSolid, BoundsHoldAllThatIsBlack) {
  std::mt19937 random(7);
  std::vector<Octree> solids = {ball(9, {250, 260, 255}, 140.3), box(9, {101, 200, 37}, {133, 223, 300}),
                                Octree(3, Colour::black), Octree(4)};
  for (int i = 0; i < 200; ++i) solids.push_back(reference::octree(reference::random_solid(1 + i % 6, random)));
  int planes = 0, tight = 0;
  for (const Octree& octree : solids) {
    const PreparedSolid tree(octree);
    const detail::ContactNodes nodes(tree);
    ASSERT_EQ(nodes.is_empty(), octree.is_empty());
    if (octree.is_empty()) continue;
    // Every node's bounds against every black leaf below it.
    std::vector<detail::ContactNode> above;
    const auto visit = [&](const auto& self, const detail::ContactNode& node, const Node& witness) -> void {
      ASSERT_EQ(node.black, witness.is_black());
      ASSERT_FALSE(witness.is_white());
      above.push_back(node);
      planes += node.reach != 0;
      if (node.black) {
        for (const detail::ContactNode& n : above) {
          float most = 0;
          const detail::IntegerBox box = n.box();
          for (std::size_t axis = 0; axis < 3; ++axis) {
            ASSERT_GE(node.corner[axis], box.low[axis]);
            ASSERT_LE(node.corner[axis] + node.side(), box.high[axis]);
            const std::int32_t farthest = node.corner[axis] - n.corner[axis] + (n.normal[axis] > 0 ? node.side() : 0);
            most += n.normal[axis] * static_cast<float>(farthest);
          }
          ASSERT_LE(most, n.reach);
          tight += n.reach != 0 && most == n.reach;
        }
      } else {
        unsigned filled = 0;
        for (int octant = 0; octant < 8; ++octant) filled |= (witness.child(octant).is_white() ? 0u : 1u) << octant;
        ASSERT_EQ(node.filled(), filled);
        const detail::ChildBoxes boxes = nodes.boxes(node);
        for (std::size_t octant = 0; octant < 8; ++octant)
          if ((filled >> octant & 1) != 0)
            self(self, nodes.child(node, boxes, octant), witness.child(static_cast<int>(octant)));
      }
      above.pop_back();
    };
    const Node root =
        octree.depth() > 1 ? octree.root() : Node::from_brick(octree.root().is_black() ? 0xFF : octree.root().word());
    visit(visit, nodes.root(), root);
  }
  EXPECT_GT(planes, 1000);
  EXPECT_GT(tight, 1000);
}

TEST(ExactInterference, LatticeMotionsAgreeWithMoving) {
  std::mt19937 random(90);
  int hits = 0;
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 3;
    const Octree a = reference::octree(reference::random_solid(depth, random));
    const Octree b = reference::octree(reference::random_solid(depth, random));
    std::uniform_int_distribution<int> small(-3, 3);
    const Motion motion = (Motion::translation({static_cast<double>(small(random)), static_cast<double>(small(random)),
                                                static_cast<double>(small(random))}) *
                           Motion::rotation(Eigen::Vector3d::Unit(trial % 3), small(random) * 90 * kDegree))
                              .about(Eigen::Vector3d::Constant((1 << depth) / 2.0));
    const bool expected = interferes(a, move(b, motion, Leaving::clip));
    ASSERT_EQ(exactly(a, b, motion), expected);
    ASSERT_EQ(voxelised(a, b, motion), expected);
    // These motions are represented without rounding.
    ASSERT_EQ(exactly(b, a, motion.inverse()), expected);
    hits += expected;
  }
  EXPECT_GT(hits, 50);
  EXPECT_LT(hits, 390);
}

TEST(ExactInterference, TiltedCubesAtTheThreshold) {
  const Octree a = box(4, {7, 7, 7}, {8, 8, 8}), b = a;
  const auto at = [&](const Eigen::Vector3d& axis, double degrees, const Eigen::Vector3d& shift) {
    return exactly(a, b,
                   (Motion::translation(shift) * Motion::rotation(axis, degrees * kDegree)).about({7.5, 7.5, 7.5}));
  };
  // Touching faces do not interfere, a hair closer does.
  EXPECT_FALSE(at({0, 0, 1}, 0, {1, 0, 0}));
  EXPECT_TRUE(at({0, 0, 1}, 0, {1 - 1e-9, 0, 0}));
  // An edge of a cube turned by 45 degrees reaches sqrt(1/2) from its centre.
  const double edge = 0.5 + std::sqrt(0.5);
  EXPECT_TRUE(at({0, 0, 1}, 45, {edge - 1e-9, 0, 0}));
  EXPECT_FALSE(at({0, 0, 1}, 45, {edge + 1e-9, 0, 0}));
  // Edge against edge, separated by a crossed axis alone: turned 45 degrees about x and about y.
  const double cross = std::sqrt(0.5) * 2;
  const Octree c = box(4, {7, 7, 7}, {8, 8, 8});
  const Motion about_x = Motion::rotation({1, 0, 0}, 45 * kDegree), about_z = Motion::rotation({0, 0, 1}, 45 * kDegree);
  for (const double hair : {-1e-9, 1e-9}) {
    // Seen from a cube turned about x: its upper edge runs along x; the other's lower edge runs along y.
    const Motion other = Motion::translation({0, 0, cross + hair}) * Motion::rotation({0, 1, 0}, 45 * kDegree);
    EXPECT_EQ(exactly(a, c, (about_x.inverse() * other).about({7.5, 7.5, 7.5})), hair < 0);
  }
  EXPECT_TRUE(exactly(a, c, about_z.about({7.5, 7.5, 7.5})));
  EXPECT_FALSE(exactly(a, c, Motion::translation({1e9, 0, 0})));
}

TEST(ExactInterference, NoSampledPointIsMissedAndItIsSymmetric) {
  std::mt19937 random(31);
  std::uniform_real_distribution<double> real(0, 1);
  int hits = 0;
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    const DenseGrid grid_a = reference::random_solid(3, random), grid_b = reference::random_solid(3, random);
    const Octree a = reference::octree(grid_a), b = reference::octree(grid_b);
    const Motion motion = reference::random_motion(3, random);
    const bool found = exactly(a, b, motion);
    hits += found;
    const Motion back = motion.inverse();
    int sampled = 0;
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d p = Eigen::Vector3d(real(random), real(random), real(random)) * 8, q = back(p);
      if (!grid_a.at(std::lround(std::floor(p.x())), std::lround(std::floor(p.y())), std::lround(std::floor(p.z()))))
        continue;
      sampled +=
          grid_b.at(std::lround(std::floor(q.x())), std::lround(std::floor(q.y())), std::lround(std::floor(q.z())));
    }
    ASSERT_TRUE(found || sampled == 0) << sampled;
    if (trial % 2) {
      // With a generic motion no two cubes touch without interfering, so rounding cannot tell the two ways apart.
      const Motion generic = Motion::rotation({1, 0.3, -0.7}, real(random) * 6).about({4.1, 3.3, 4.7});
      EXPECT_EQ(exactly(a, b, generic), exactly(b, a, generic.inverse()));
    }
  }
  EXPECT_GT(hits, 50);
  EXPECT_LT(hits, 300);
}

}  // namespace
}  // namespace blackleaf
