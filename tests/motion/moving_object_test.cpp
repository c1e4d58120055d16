#include "blackleaf/moving_object.h"

#include <gtest/gtest.h>

#include <vector>

#include "blackleaf/implicit.h"
#include "reference/dense_motion.h"

namespace blackleaf {
namespace {

constexpr double kDegree = M_PI / 180;

class Random {
 public:
  explicit Random(unsigned seed) : random_(seed) {}
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Eigen::Vector3d vector(double size) { return {real(-size, size), real(-size, size), real(-size, size)}; }
  Motion motion(double size) {
    return (Motion::translation(vector(size / 4)) * Motion::rotation(vector(1), real(-3, 3)))
        .about(vector(size / 2) + Eigen::Vector3d::Constant(size / 2));
  }

 private:
  std::mt19937 random_;
};

// A solid without symmetry, thin in places, from the universe's middle so that it has room to turn.
Octree odd_solid(int depth) {
  const double n = 1 << depth;
  return octree_from_classifier(depth, [&](const Cube& cube) {
    const Eigen::Vector3d low = Eigen::Vector3d(cube.x, cube.y, cube.z) / n, high = low.array() + cube.side() / n;
    const Eigen::Vector3d nearest = Eigen::Vector3d(0.52, 0.47, 0.5).cwiseMax(low).cwiseMin(high);
    if ((nearest - Eigen::Vector3d(0.52, 0.47, 0.5)).norm() > 0.15) return Colour::white;
    if (cube.level > 0) return Colour::gray;
    const Eigen::Vector3d c = (low + high) / 2;
    const bool shell = (c - Eigen::Vector3d(0.52, 0.47, 0.5)).norm() > 0.145;
    return shell || c.x() + 2 * c.y() < 1.4 ? Colour::black : Colour::white;
  });
}

TEST(MovingObject, ThirtySixTurnsOfTenDegrees) {
  const Octree source = ball(6, {30, 33, 31}, 17);
  MovingObject object(source);
  const Motion step = Motion::rotation({1, 2, 3}, 10 * kDegree).about({32, 32, 32});
  for (int i = 0; i < 36; ++i) object = object.moved(step);
  EXPECT_TRUE(object.octree() == source);
  const Motion odd =
      (Motion::translation({1.5, -2.25, 0.125}) * Motion::rotation({3, -1, 2}, 0.777)).about({32, 32, 32});
  EXPECT_TRUE(object.moved(odd).moved(odd.inverse()).octree() == source);
  EXPECT_TRUE(object.at(odd) == move(source, odd));
  // Moving trees instead of motions does lose.
  EXPECT_FALSE(move(move(source, odd), odd.inverse()) == source);
  EXPECT_TRUE(object.source() == source);
}

TEST(MovingObject, ThreeThousandSixHundredStepsOfATenthOfADegree) {
  Random random(3600);
  const Octree source = odd_solid(10);
  for (int trial = 0; trial < 12; ++trial) {
    SCOPED_TRACE(trial);
    const Eigen::Vector3d axis = trial < 3 ? Eigen::Vector3d::Unit(trial) : random.vector(1);
    const Eigen::Vector3d centre = Eigen::Vector3d::Constant(512) + random.vector(trial % 4 == 0 ? 0 : 512);
    const Motion step =
        (trial % 2 == 0 ? Motion::rotation_degrees(axis, 0.1) : Motion::rotation(axis, 0.1 * kDegree)).about(centre);
    MovingObject object(source);
    for (int i = 0; i < 3600; ++i) object = object.moved(step);
    EXPECT_LT((object.motion().rotation() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_TRUE(object.octree() == source);
  }
}

TEST(MovingObject, FullTurnsComeBackToAnyPose) {
  // In degrees the steps of a full turn add up to it in all 106 bits: the rounded motion itself is the same again.
  Random random(8);
  for (const double degrees : {0.5, 10.0, 22.5, 45.0, 72.0, 120.0, 0.0625}) {
    for (int trial = 0; trial < 8; ++trial) {
      SCOPED_TRACE(testing::Message() << degrees << " degrees, trial " << trial);
      const Motion pose = random.motion(1024);
      const Motion step = Motion::rotation_degrees(random.vector(1), -degrees).about(random.vector(1024));
      Motion motion = pose;
      for (int i = 0; i < 360 / degrees; ++i) motion = step * motion;
      EXPECT_TRUE(FixedMotion(motion) == FixedMotion(pose));
    }
  }
}

TEST(MovingObject, AnyMotionFollowedByItsInverse) {
  Random random(17);
  std::mt19937 seed(18);
  for (int trial = 0; trial < 3000; ++trial) {
    SCOPED_TRACE(trial);
    // Nasty ones too: translations in the middle between two grid points, quarter turns, 45 degrees.
    Motion pose = trial % 2 ? random.motion(1 << 20) : reference::random_motion(10, seed);
    if (trial % 5 == 0) pose = Motion::translation(Eigen::Vector3d(1, 3, -5) * 0x1p-39) * pose;
    const Motion further = trial % 3 ? random.motion(1 << 20) : reference::random_motion(10, seed);
    EXPECT_TRUE(FixedMotion(further.inverse() * (further * pose)) == FixedMotion(pose));
    EXPECT_TRUE(FixedMotion(further * (further.inverse() * pose)) == FixedMotion(pose));
    EXPECT_TRUE(FixedMotion(pose.inverse() * pose) == FixedMotion(Motion()));
  }
}

TEST(MovingObject, LongWalksUndoneStepByStep) {
  Random random(77);
  const Octree source = odd_solid(9);
  for (int trial = 0; trial < 10; ++trial) {
    SCOPED_TRACE(trial);
    const Motion pose = Motion::rotation(random.vector(1), random.real(-3, 3)).about({256, 256, 256});
    const Octree there = move(source, pose);
    MovingObject object(source, pose);
    std::vector<Motion> steps;
    for (int i = 0; i < 5000; ++i) steps.push_back(random.motion(512));
    for (const Motion& step : steps) object = object.moved(step);
    EXPECT_FALSE(FixedMotion(object.motion()) == FixedMotion(pose));
    for (auto step = steps.rbegin(); step != steps.rend(); ++step) object = object.moved(step->inverse());
    EXPECT_TRUE(FixedMotion(object.motion()) == FixedMotion(pose));
    EXPECT_TRUE(object.octree() == there);
  }
}

}  // namespace
}  // namespace blackleaf
