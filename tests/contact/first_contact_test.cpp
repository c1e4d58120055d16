// First contact, clear ways and clearances, against dense sampling and against what can be computed by hand.
#include "blackleaf/first_contact.h"

#include <gtest/gtest.h>

#include "blackleaf/distance.h"
#include "blackleaf/error.h"
#include "reference/box_distance.h"
#include "reference/dense_grid.h"
#include "reference/paths.h"

namespace blackleaf {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
constexpr double kDegree = M_PI / 180;
const Quaterniond kStill = Quaterniond::Identity();

Path straight(const Vector3d& to, double end = 1) { return Path({{0, Vector3d::Zero(), kStill}, {end, to, kStill}}); }
Quaterniond turn(const Vector3d& axis, double radians) {
  return Quaterniond(Eigen::AngleAxisd(radians, axis.normalized()));
}

// The pose as the twin needs it.
reference::WideMap map_at(const Path& path, double time) {
  const Pose pose = path.pose_at(time);
  const reference::WideMatrix r = pose.rotation.cast<long double>().normalized().toRotationMatrix();
  const reference::WideVector about = path.about().cast<long double>();
  return {r, about + pose.translation.cast<long double>() - r * about};
}

struct Twin {
  std::vector<Cube> a, b;
  Twin(const Octree& p, const Octree& q) : a(reference::cubes(p)), b(reference::cubes(q)) {}
  double at(const Path& path, double time, bool depth = false) const {
    return static_cast<double>(reference::distance(a, {}, b, map_at(path, time), depth));
  }
  double at(const Path& path_a, const Path& path_b, double time) const {
    return static_cast<double>(reference::distance(a, map_at(path_a, time), b, map_at(path_b, time)));
  }
};

TEST(FirstContact, AgreesWithDenseSampling) {
  std::mt19937 random(1996);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  int met = 0, missed = 0, later = 0;
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 2 + trial % 2;
    reference::DenseGrid grid_a = reference::random_solid(depth, random), grid_b = grid_a;
    // Small solids, so that some ways are clear.
    grid_a.voxels.assign(grid_a.voxels.size(), 0);
    grid_b = grid_a;
    const int n = grid_a.side();
    for (int i = pick(1, 4); i > 0; --i) grid_a.set(pick(0, n - 1), pick(0, n - 1), pick(0, n - 1));
    for (int i = pick(1, 4); i > 0; --i) grid_b.set(pick(0, n - 1), pick(0, n - 1), pick(0, n - 1));
    const Octree a = reference::octree(grid_a), b = reference::octree(grid_b);
    const PreparedSolid p(a), q(b);
    const Path path = reference::random_path(depth, random);
    ContactOptions options;
    options.tolerance = std::pow(10.0, -pick(1, 5));
    if (trial % 3 == 0) options.clearance = pick(1, 10) * 0.1;
    const auto contact = first_contact(p, q, path, options);
    const bool is_clear = clear(p, q, path, options);
    const Twin twin(a, b);
    const double end = contact ? contact->time : path.end();
    constexpr int kSamples = 30;
    for (int i = 0; i < kSamples; ++i) {
      const double time = path.begin() + (end - path.begin()) * i / kSamples;
      if (time >= end && contact) break;
      ASSERT_GT(twin.at(path, time), options.clearance) << time << " of " << end;
    }
    if (contact) {
      ++met;
      later += contact->time > path.begin();
      const double then = twin.at(path, contact->time);
      ASSERT_LE(then, options.clearance + options.tolerance);
      ASSERT_NEAR(std::max(0.0, contact->distance), then, 1e-9);
      ASSERT_NEAR((contact->on_a - contact->on_b).norm(), then, 1e-9);
      ASSERT_LE(closest(p, contact->on_a)->voxels, 1e-9);
      EXPECT_EQ(contact->pose_b.translation, path.pose_at(contact->time).translation);
    } else {
      ++missed;
      ASSERT_TRUE(is_clear);
    }
    if (!is_clear) {
      ASSERT_TRUE(contact);
    }
  }
  EXPECT_GT(met, 80);
  EXPECT_GT(later, 30);
  EXPECT_GT(missed, 80);
}

// Larger solids with smooth surfaces and thin shells, against distance(), which has its own twin.
TEST(FirstContact, SmoothSolidsAgreeWithDistances) {
  std::mt19937 random(64);
  const auto real = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  const auto ball = [](double radius, double hollow) {
    return octree_from_classifier(6, [=](const Cube& c) {
      if (c.level > 0) return Colour::gray;
      const Vector3d x = Vector3d(c.x, c.y, c.z) + Vector3d::Constant(0.5 - 32);
      const double r = Vector3d(x[0], x[1], 1.5 * x[2]).norm();
      return r <= radius && r >= hollow ? Colour::black : Colour::white;
    });
  };
  // Inside a shell, out of it through its wall, and past it.
  const PreparedSolid shell(ball(30, 28)), small(ball(6, 0)), half(ball(14, 12));
  int met = 0, missed = 0;
  for (int trial = 0; trial < 120; ++trial) {
    SCOPED_TRACE(trial);
    const PreparedSolid &a = trial % 3 == 0 ? shell : half, &b = trial % 2 ? small : half;
    const auto anywhere = [&](double most) -> Vector3d {
      return Vector3d(real(-1, 1), real(-1, 1), real(-0.7, 0.7)) * most;
    };
    const double reach = trial % 3 == 0 ? 25 : 40;
    const Vector3d from = trial % 3 == 0 ? anywhere(8) : Vector3d(anywhere(1).normalized() * 33);
    const Path path({{0, from, turn({real(-1, 1), real(-1, 1), 1}, real(-3, 3))},
                     {1, from + anywhere(reach), turn({real(-1, 1), real(-1, 1), 1}, real(-3, 3))}},
                    Vector3d::Constant(32) + anywhere(4));
    const ContactOptions options{trial % 5 == 0 ? real(0, 2) : 0, 1e-4};
    const auto contact = first_contact(a, b, path, options);
    ASSERT_EQ(clear(a, b, path, options), !contact);
    const double end = contact ? contact->time : 1;
    for (int i = 0; i < 40; ++i) {
      ASSERT_TRUE(farther_than(options.clearance, a, b, path.motion_at(end * i / 40)) || contact->time == 0);
    }
    if (contact) {
      ASSERT_NEAR(distance(a, b, path.motion_at(end))->voxels, std::max(0.0, contact->distance), 1e-8);
      ASSERT_LE(contact->distance, options.clearance + options.tolerance);
    }
    (contact ? met : missed)++;
  }
  EXPECT_GT(met, 30);
  EXPECT_GT(missed, 20);
}

TEST(FirstContact, StraightAheadIsWhereItMustBe) {
  const PreparedSolid wall(box(7, {100, 0, 0}, {101, 128, 128})), ball(box(7, {10, 60, 60}, {12, 62, 62}));
  const auto contact = first_contact(wall, ball, straight({110, 0, 0}, 11));
  ASSERT_TRUE(contact);
  EXPECT_LE(contact->time, 8.8);
  EXPECT_GE(contact->time, 8.8 - 1e-4);
  EXPECT_LE(contact->distance, 1e-3);
  EXPECT_NEAR(contact->on_a[0], 100, 1e-9);
  EXPECT_NEAR(contact->on_b[0], 100, 1e-3);
  // With a clearance it is earlier, exactly by that.
  const auto before = first_contact(wall, ball, straight({110, 0, 0}, 11), {5, 1e-6});
  ASSERT_TRUE(before);
  EXPECT_NEAR(before->time, 8.3, 1e-6);
  EXPECT_FALSE(first_contact(wall, ball, straight({87.9, 0, 0})));
  EXPECT_TRUE(clear(wall, ball, straight({87.9, 0, 0})));
  EXPECT_FALSE(clear(wall, ball, straight({88.1, 0, 0})));
}

TEST(FirstContact, ThinWallsAreNotTunnelled) {
  // A voxel that flies millions of voxels a unit of time through a wall of one voxel, and through a hole in it.
  const PreparedSolid voxel(box(8, {0, 128, 128}, {1, 129, 129}));
  const PreparedSolid wall(box(8, {200, 0, 0}, {201, 256, 256}));
  for (const double far : {250.0, 1e4, 1e6}) {
    const auto contact = first_contact(wall, voxel, straight({far, 0.3, 0.1}));
    ASSERT_TRUE(contact) << far;
    EXPECT_NEAR(contact->time * far, 199, 2e-3);
    EXPECT_LE(contact->time * far, 199);
    EXPECT_FALSE(clear(wall, voxel, straight({far, 0.3, 0.1})));
  }
  const PreparedSolid hole(octree_from_classifier(8, [](const Cube& c) {
    if (c.level > 0) return c.x > 200 || c.x + c.side() <= 200 ? Colour::white : Colour::gray;
    return c.x == 200 && (c.y < 127 || c.y > 129 || c.z < 127 || c.z > 129) ? Colour::black : Colour::white;
  }));
  EXPECT_TRUE(clear(hole, voxel, straight({1e6, 0, 0})));
  EXPECT_TRUE(clear(hole, voxel, straight({1e4, 0, 0}), {0.99, 1e-3}));
  EXPECT_FALSE(clear(hole, voxel, straight({1e4, 0, 0}), {1, 1e-3}));
  EXPECT_FALSE(clear(hole, voxel, straight({300, 2.1, 0})));
}

TEST(FirstContact, BladesThatTurnAreNotTunnelled) {
  // A blade of 100 voxels and one voxel thick turns by nearly half a turn past a post.
  const PreparedSolid blade(box(8, {128, 128, 128}, {228, 129, 129}));
  for (const double degrees : {30.0, 89.0, 91.0, 150.0, 175.0}) {
    const double angle = degrees * kDegree;
    const std::array<std::int32_t, 3> at = {static_cast<std::int32_t>(128.5 + 80 * std::cos(angle)),
                                            static_cast<std::int32_t>(128.5 + 80 * std::sin(angle)), 0};
    const PreparedSolid post(box(8, at, {at[0] + 1, at[1] + 1, 256}));
    const Path path({{0, Vector3d::Zero(), kStill}, {1, Vector3d::Zero(), turn({0, 0, 1}, 179 * kDegree)}},
                    {128.5, 128.5, 128.5});
    const auto contact = first_contact(post, blade, path);
    ASSERT_TRUE(contact) << degrees;
    EXPECT_NEAR(contact->time * 179, degrees, 1.5);
    EXPECT_LT(contact->time * 179, degrees);
    EXPECT_FALSE(clear(post, blade, path));
    // The other way round the way is clear.
    const Path back({{0, Vector3d::Zero(), kStill}, {1, Vector3d::Zero(), turn({0, 0, 1}, -179 * kDegree)}},
                    {128.5, 128.5, 128.5});
    EXPECT_TRUE(clear(post, blade, back));
  }
}

TEST(FirstContact, SlidingAndNearMisses) {
  const PreparedSolid floor(box(8, {0, 0, 0}, {256, 256, 10}));
  const PreparedSolid block(box(8, {10, 10, 10}, {20, 20, 20}));
  // Resting on the floor is contact from the start, unless contact may touch.
  const auto contact = first_contact(floor, block, straight({200, 0, 0}));
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->time, 0);
  EXPECT_EQ(contact->distance, 0);
  EXPECT_FALSE(clear(floor, block, straight({200, 0, 0})));
  EXPECT_TRUE(clear(floor, block, straight({200, 100, 0}), {-1e-3, 5e-4}));
  EXPECT_FALSE(clear(floor, block, straight({200, 100, -2e-3}), {-1e-3, 5e-4}));
  const auto deep = first_contact(floor, block, straight({0, 0, -1}), {-0.25, 1e-4});
  ASSERT_TRUE(deep);
  EXPECT_NEAR(deep->time, 0.25, 1e-4);
  EXPECT_NEAR(deep->distance, -0.25, 1e-4);
  // A thousandth of a voxel above the floor, sliding and turning about the vertical.
  const Path slide({{0, {0, 0, 1e-3}, kStill}, {1, {200, 100, 1e-3}, turn({0, 0, 1}, 170 * kDegree)}}, {15, 15, 15});
  EXPECT_TRUE(clear(floor, block, slide, {0, 1e-4}));
  EXPECT_FALSE(first_contact(floor, block, slide, {9e-4, 5e-5}));
  EXPECT_TRUE(first_contact(floor, block, slide, {1.1e-3, 1e-5}));
  // It only leaves the floor.
  const auto start = first_contact(floor, block, straight({0, 0, 5}));
  ASSERT_TRUE(start);
  EXPECT_EQ(start->time, 0);
  // It only arrives on it: what is told is where the distance falls to the tolerance.
  const Path land({{0, {0, 0, 8}, kStill}, {1, {0, 0, 0}, kStill}}, {15, 15, 15});
  const auto end = first_contact(floor, block, land, {0, 1e-2});
  ASSERT_TRUE(end);
  EXPECT_GE(end->time, 1 - 1e-2 / 8);
  EXPECT_LE(end->time, 1);
  EXPECT_TRUE(clear(floor, block, land, {-1e-3, 5e-4}));
}

TEST(FirstContact, RolesMayBeExchanged) {
  std::mt19937 random(77);
  std::uniform_real_distribution<double> real(-1, 1);
  int met = 0;
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const PreparedSolid a(box(5, {4, 4, 4}, {9, 6, 20})), b(box(5, {20, 9, 8}, {24, 22, 10}));
    const Vector3d about(16, 15, 14), by = Vector3d(real(random), real(random), real(random)) * (trial % 2 ? 0 : 30);
    const Quaterniond q = turn({real(random), real(random), real(random)}, trial % 2 ? 3 * real(random) : 0);
    const Path path({{0, Vector3d::Zero(), kStill}, {1, by, q}}, about),
        back({{0, Vector3d::Zero(), kStill}, {1, -by, q.conjugate()}}, about);
    const Path rest({{0, Vector3d::Zero(), kStill}});
    const auto one = first_contact(a, b, path, {0, 1e-5}), other = first_contact(b, a, back, {0, 1e-5});
    ASSERT_EQ(one.has_value(), other.has_value());
    ASSERT_EQ(clear(a, b, path), !one);
    const auto both = first_contact(a, rest, b, path, {0, 1e-5}), swapped = first_contact(b, path, a, rest, {0, 1e-5});
    ASSERT_EQ(both.has_value(), one.has_value());
    ASSERT_EQ(swapped.has_value(), one.has_value());
    if (!one) continue;
    ++met;
    EXPECT_NEAR(one->time, other->time, 2e-5);
    EXPECT_EQ(both->time, one->time);
    EXPECT_NEAR(swapped->time, one->time, 2e-5);
    EXPECT_NEAR((swapped->on_a - one->on_b).norm(), 0, 5);
  }
  EXPECT_GT(met, 1);
}

TEST(FirstContact, TwoThatMove) {
  std::mt19937 random(2);
  int met = 0, missed = 0;
  for (int trial = 0; trial < 150; ++trial) {
    SCOPED_TRACE(trial);
    const Octree a = box(3, {1, 1, 1}, {3, 2, 4}), b = box(3, {5, 4, 4}, {6, 7, 6});
    const Path path_a = reference::random_path(3, random), path_b = reference::random_path(3, random);
    const auto contact = first_contact(PreparedSolid(a), path_a, PreparedSolid(b), path_b, {0, 1e-4});
    const Twin twin(a, b);
    const double begin = std::min(path_a.begin(), path_b.begin()), last = std::max(path_a.end(), path_b.end());
    const double end = contact ? contact->time : last;
    for (int i = 0; i < 20 && begin + (end - begin) * i / 20 < end; ++i)
      ASSERT_GT(twin.at(path_a, path_b, begin + (end - begin) * i / 20), 0);
    if (contact) {
      ASSERT_LE(twin.at(path_a, path_b, contact->time), 1e-4 + 1e-9);
    }
    (contact ? met : missed)++;
    ASSERT_EQ(clear(PreparedSolid(a), path_a, PreparedSolid(b), path_b, {0, 1e-4}), !contact);
  }
  EXPECT_GT(met, 10);
  EXPECT_GT(missed, 20);
  // In company they never meet.
  const PreparedSolid p(box(3, {1, 1, 1}, {3, 2, 4})), q(box(3, {3, 2, 4}, {5, 6, 7}));
  const Path path({{0, {0, 0, 0}, kStill}, {1, {50, -20, 3}, turn({1, 2, 3}, 2)}, {2, {5, 5, 5}, turn({3, 2, 3}, -2)}},
                  {1, 2, 3});
  const Path along({{0, {0.01, 0.01, 0.01}, kStill}, {1, {50.01, -19.99, 3.01}, kStill}});
  const Path company({{0, {0, 0, 0}, kStill}, {1, {50, -20, 3}, kStill}});
  EXPECT_TRUE(clear(p, company, q, along));
  EXPECT_EQ(first_contact(p, path, q, path)->time, 0);  // they touch
}

TEST(FirstContact, ThreadsDoNotMatterAndWorkIsToldAndStopped) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 40; ++trial) {
    const PreparedSolid a(box(4, {1, 2, 3}, {5, 6, 4})), b(box(4, {9, 9, 9}, {11, 12, 13}));
    const Path path = reference::random_path(4, random);
    const auto one = first_contact(a, b, path, {}, {1, {}}), two = first_contact(a, b, path, {}, {2, {}});
    ASSERT_EQ(one.has_value(), two.has_value());
    if (one) {
      EXPECT_EQ(one->time, two->time);
      EXPECT_EQ(one->on_a, two->on_a);
    }
    double told = 0;
    const auto again = first_contact(a, b, path, {}, {1, [&](double done) {
                                                        EXPECT_GE(done, told);
                                                        told = done;
                                                        return true;
                                                      }});
    EXPECT_LE(told, 1);
    if (!again) {
      EXPECT_EQ(told, 1);
    }
  }
  const PreparedSolid a(box(4, {1, 2, 3}, {5, 6, 4})), b(box(4, {9, 9, 9}, {11, 12, 13}));
  EXPECT_THROW(clear(a, b, straight({0, 0, 1}), {}, {1, [](double) { return false; }}), Error);
}

TEST(FirstContact, Refusals) {
  const PreparedSolid a(box(4, {1, 2, 3}, {5, 6, 4})), deep(box(5, {1, 2, 3}, {5, 6, 4})), empty{Octree(4)};
  const Path path = straight({1, 1, 1});
  EXPECT_THROW(first_contact(a, deep, path), Error);
  EXPECT_THROW(clear(a, a, path, {0, 0}), Error);
  EXPECT_THROW(clear(a, a, path, {0, 1e-14}), Error);
  EXPECT_THROW(clear(a, a, path, {NAN, 1e-3}), Error);
  EXPECT_THROW(clear(a, a, path, {0, NAN}), Error);
  EXPECT_THROW(clearance_along(a, a, path, {0}), Error);
  EXPECT_THROW(clearance_along(a, a, path, {0, 1, 1}), Error);
  EXPECT_FALSE(first_contact(a, empty, path));
  EXPECT_TRUE(clear(empty, a, path));
  EXPECT_FALSE(clearance(empty, a, path));
  EXPECT_TRUE(clearance_along(empty, a, path, {0, 1}).empty());
}

TEST(Clearance, AgreesWithDenseSampling) {
  std::mt19937 random(11);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  int apart = 0;
  for (int trial = 0; trial < 150; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 3, n = 8;
    reference::DenseGrid grid_a(depth), grid_b(depth);
    for (int i = pick(1, 3); i > 0; --i) grid_a.set(pick(0, n - 1), pick(0, n - 1), pick(0, 1));
    for (int i = pick(1, 3); i > 0; --i) grid_b.set(pick(0, n - 1), pick(0, n - 1), pick(6, 7));
    const Octree a = reference::octree(grid_a), b = reference::octree(grid_b);
    const PreparedSolid p(a), q(b);
    const Path path = reference::random_path(depth, random);
    const double precision = std::pow(10.0, -pick(1, 4));
    const auto found = clearance(p, q, path, precision);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->begin, path.begin());
    EXPECT_EQ(found->end, path.end());
    ASSERT_GE(found->at_least, 0);
    ASSERT_LE(found->at_most - found->at_least, precision + 1e-12);
    const Twin twin(a, b);
    ASSERT_NEAR(twin.at(path, found->time), found->at_most, 1e-8);
    for (int i = 0; i <= 30; ++i)
      ASSERT_GE(twin.at(path, path.begin() + (path.end() - path.begin()) * i / 30), found->at_least);
    apart += found->at_least > 0;
    if (path.end() > path.begin()) {
      std::vector<double> times;
      for (int i = 0; i <= 5; ++i) times.push_back(path.begin() + (path.end() - path.begin()) * i / 5);
      const auto along = clearance_along(p, q, path, times, precision);
      ASSERT_EQ(along.size(), 5u);
      double least = 1e300;
      for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(along[i].begin, times[i]);
        EXPECT_LE(along[i].begin, along[i].time);
        EXPECT_LE(along[i].time, along[i].end);
        least = std::min(least, along[i].at_most);
      }
      EXPECT_NEAR(least, found->at_most, precision);
      if (least > 3 * precision) {
        EXPECT_TRUE(clear(p, q, path, {least - 3 * precision, precision}));
        EXPECT_FALSE(clear(p, q, path, {least, precision}));
      }
    }
  }
  EXPECT_GT(apart, 50);
}

}  // namespace
}  // namespace blackleaf
