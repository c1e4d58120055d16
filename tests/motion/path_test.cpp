#include "blackleaf/path.h"

#include <gtest/gtest.h>

#include <limits>

#include "blackleaf/error.h"
#include "reference/paths.h"

namespace blackleaf {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond turn(double degrees, const Vector3d& axis = Vector3d::UnitZ()) {
  return Quaterniond(AngleAxisd(degrees * M_PI / 180, axis));
}

void expect_refused(const std::vector<Pose>& poses, const std::string& part, const Vector3d& about = Vector3d::Zero()) {
  try {
    const Path path(poses, about);
    FAIL() << "taken, instead of: " << part;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Path, RefusesWhatIsNoPath) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused({}, "no pose");
  expect_refused({{nan, {0, 0, 0}, turn(0)}}, "poses[0].time is out of range");
  expect_refused({{2e9, {0, 0, 0}, turn(0)}}, "poses[0].time is out of range");
  expect_refused({{0, {0, nan, 0}, turn(0)}}, "poses[0].translation");
  expect_refused({{0, {0, 0, -2e9}, turn(0)}}, "poses[0].translation");
  expect_refused({{0, {0, 0, 0}, Quaterniond(1, 0, 0, nan)}}, "poses[0].rotation is out of range");
  expect_refused({{0, {0, 0, 0}, Quaterniond(0, 0, 0, 0)}}, "length 0.0");
  expect_refused({{0, {0, 0, 0}, Quaterniond(1, 1, 0, 0)}}, "length 1.41");
  expect_refused({{0, {0, 0, 0}, turn(0)}, {0, {1, 0, 0}, turn(0)}}, "poses[1].time is not after that of poses[0]");
  expect_refused({{0, {0, 0, 0}, turn(0)}, {1, {0, 0, 0}, turn(0)}, {0.5, {1, 0, 0}, turn(0)}}, "poses[2].time");
  expect_refused({{0, {0, 0, 0}, turn(0)}}, "about", {0, nan, 0});
}

TEST(Path, IsAtItsPosesWhenTheySaySo) {
  std::mt19937 random(60);
  for (int trial = 0; trial < 100; ++trial) {
    SCOPED_TRACE(trial);
    const Path path = reference::random_path(5, random);
    for (const Pose& pose : path.poses()) {
      const Pose at = path.pose_at(pose.time);
      EXPECT_EQ(at.translation, pose.translation);
      EXPECT_EQ(at.rotation.coeffs(), pose.rotation.coeffs());
      // X' = R (X - about) + about + T.
      const Vector3d x(3, -7, 11);
      EXPECT_TRUE(path.motion_at(pose.time)(x).isApprox(
          pose.rotation * (x - path.about()) + path.about() + pose.translation, 1e-12));
    }
    EXPECT_EQ(path.pose_at(path.begin() - 5).translation, path.poses().front().translation);
    EXPECT_EQ(path.pose_at(path.end() + 5).rotation.coeffs(), path.poses().back().rotation.coeffs());
  }
}

TEST(Path, IsStraightAndTurnsEvenlyTheShorterWay) {
  // The second quaternion is that of 90 degrees with the other sign: no long way round.
  Quaterniond negated = turn(90);
  negated.coeffs() = -negated.coeffs();
  const Path path({{10, {0, 0, 0}, turn(0)}, {14, {8, -4, 2}, negated}}, {1, 2, 3});
  const Pose quarter = path.pose_at(11);
  EXPECT_TRUE(quarter.translation.isApprox(Vector3d(2, -1, 0.5)));
  EXPECT_LT(quarter.rotation.angularDistance(turn(22.5)), 1e-14);
  EXPECT_TRUE(path.motion_at(11)({1, 2, 3}).isApprox(Vector3d(3, 1, 3.5)));
  EXPECT_TRUE(path.motion_at(12)({2, 2, 3}).isApprox(Vector3d(1, 2, 3) + Vector3d(4, -2, 1) +
                                                     Vector3d(std::sqrt(0.5), std::sqrt(0.5), 0)));
}

TEST(Path, WholeTurnsAndShiftsAreExact) {
  const Path path({{0, {0, 0, 0}, turn(0)}, {1, {3, 4, 5}, turn(90)}, {2, {3, 4, 9}, turn(180)}}, {16, 16, 16});
  for (const double time : {0.0, 1.0, 2.0})
    EXPECT_TRUE(FixedMotion(path.motion_at(time)).is_lattice_symmetry()) << time;
  const Path shift({{0, {0, 0, 0}, turn(0)}, {4, {8, 4, -4}, turn(0)}});
  for (double time = 0; time <= 4; ++time)
    EXPECT_TRUE(FixedMotion(shift.motion_at(time)).is_lattice_symmetry()) << time;
}

TEST(Path, QuaternionsOfFewDigitsAreTaken) {
  const Path path({{0, {0, 0, 0}, Quaterniond(0.7071, 0, 0, 0.7071)}});
  EXPECT_NEAR(path.poses()[0].rotation.norm(), 1, 1e-15);
}

// The law of the bound: the way along the path, measured as a polygon of many corners, is never longer; for the
// farthest corner of a box about an axis it is nearly as long.
TEST(Path, MotionBoundHoldsTheWayOfEveryPoint) {
  std::mt19937 random(61);
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const Path path = reference::random_path(5, random);
    const Box box{{3, 9, 5}, {12, 20, 31}};
    std::uniform_real_distribution<double> time(path.begin() - 0.1, path.end() + 0.1);
    const double from = time(random), to = time(random);
    const double bound = path.motion_bound(from, to, box);
    EXPECT_EQ(bound, path.motion_bound(to, from, box));
    EXPECT_LE(bound, path.motion_bound(path.begin(), path.end(), box) * (1 + 1e-9));
    for (int k = 0; k < 10; ++k) {
      const auto place = [&](std::size_t i) {
        if (k < 8) return double((k >> i & 1 ? box.max : box.min)[i]);
        return std::uniform_real_distribution<double>(box.min[i], box.max[i])(random);
      };
      const Vector3d x(place(0), place(1), place(2));
      double way = 0;
      Vector3d last = path.motion_at(from)(x);
      constexpr int kPieces = 200;
      for (int i = 1; i <= kPieces; ++i) {
        const Vector3d next = path.motion_at(from + (to - from) * i / kPieces)(x);
        way += (next - last).norm();
        last = next;
      }
      EXPECT_LE(way, bound + 1e-9);
    }
  }
}

TEST(Path, MotionBoundIsTight) {
  const Box box{{10, 12, 0}, {20, 30, 5}};
  const Path straight({{0, {0, 0, 0}, turn(0)}, {1, {3, 4, 0}, turn(0)}});
  EXPECT_NEAR(straight.motion_bound(0, 1, box), 5, 1e-9);
  EXPECT_NEAR(straight.motion_bound(0.25, 0.75, box), 2.5, 1e-9);
  EXPECT_EQ(straight.motion_bound(1, 5, box), 0);
  // About z through (0,0): the farthest corner is (20,30), whatever its z.
  const Path turning({{0, {0, 0, 0}, turn(0)}, {1, {0, 0, 0}, turn(90)}});
  EXPECT_NEAR(turning.motion_bound(0, 1, box), M_PI / 2 * std::hypot(20, 30), 1e-3);
  const Path rest({{0, {7, 0, 0}, turn(30)}, {1, {7, 0, 0}, turn(30)}});
  EXPECT_NEAR(rest.motion_bound(0, 1, box), 0, 1e-9);
}

TEST(Path, TimesAreCloseEnoughAndHoldAllPoses) {
  std::mt19937 random(62);
  for (int trial = 0; trial < 100; ++trial) {
    SCOPED_TRACE(trial);
    const Path path = reference::random_path(5, random);
    const Box box{{3, 9, 5}, {12, 20, 31}};
    const double step = std::array{1.0, 0.3, 5.0}[static_cast<std::size_t>(trial % 3)];
    const std::vector<double> times = path.times(box, step);
    EXPECT_EQ(times.front(), path.begin());
    EXPECT_EQ(times.back(), path.end());
    for (std::size_t i = 1; i < times.size(); ++i) {
      EXPECT_LT(times[i - 1], times[i]);
      EXPECT_LT(path.motion_bound(times[i - 1], times[i], box), step * (1 + 1e-9));
    }
    for (const Pose& pose : path.poses())
      EXPECT_NE(std::find(times.begin(), times.end(), pose.time), times.end()) << pose.time;
    // No more than needed: one more a segment than the bound asks for.
    EXPECT_LE(static_cast<double>(times.size()), path.motion_bound(path.begin(), path.end(), box) / step * (1 + 1e-9) +
                                                     static_cast<double>(path.poses().size()));
  }
}

TEST(Path, TimesAreNotWithoutNumber) {
  const Path far({{0, {0, 0, 0}, turn(0)}, {1, {1e6, 0, 0}, turn(0)}});
  const Box box{{0, 0, 0}, {4, 4, 4}};
  EXPECT_EQ(far.times(box).size(), 1000002u);
  EXPECT_THROW(far.times(box, 0.1), Error);
  EXPECT_THROW(far.times(box, 0), Error);
  EXPECT_THROW(far.times(box, -1), Error);
  EXPECT_THROW(far.times(box, std::numeric_limits<double>::quiet_NaN()), Error);
}

}  // namespace
}  // namespace blackleaf
