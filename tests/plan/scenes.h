// Small scenes to plan in.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "blackleaf/error.h"
#include "blackleaf/implicit.h"
#include "blackleaf/plan.h"
#include "blackleaf/set_operations.h"
#include "reference/dense_path.h"

namespace blackleaf::test {

/// A universe of 32^3 with a wall two voxels thick across it that has a slot 20 wide and 5 high, and a board 16 x 2 x
/// 12 that stands on edge before it: it passes lying down only.
struct Slot {
  Octree environment = subtract(box(5, {15, 0, 0}, {17, 32, 32}), box(5, {15, 6, 13}, {17, 26, 18}));
  Octree object = box(5, {3, 15, 8}, {9, 17, 24});
  Pose start, goal{0, {20, 0, 0}, Eigen::Quaterniond::Identity()};
};

inline Pose at(double x, double y, double z) { return {0, {x, y, z}, Eigen::Quaterniond::Identity()}; }
inline Pose at(double x, double y, double z, const Eigen::Vector3d& axis, double degrees) {
  return {0, {x, y, z}, Eigen::Quaterniond(Eigen::AngleAxisd(degrees * M_PI / 180, axis.normalized()))};
}

inline bool same(const Pose& a, const Pose& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs();
}
inline bool same(const Path& a, const Path& b) {
  bool equal = a.poses().size() == b.poses().size() && a.about() == b.about();
  for (std::size_t i = 0; equal && i < a.poses().size(); ++i)
    equal = same(a.poses()[i], b.poses()[i]) && a.poses()[i].time == b.poses()[i].time;
  return equal;
}

/// What `call` throws, as text; empty if it does not.
template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// Everything that must hold of a path that was found.
inline void expect_sound(const Plan& plan, const Octree& environment, const Octree& object, const Pose& start,
                         const Pose& goal, const PlanOptions& options = {}) {
  ASSERT_TRUE(plan.path.has_value()) << "missing " << plan.missing;
  const Path& path = *plan.path;
  EXPECT_EQ(path.poses().front().time, 0);
  EXPECT_TRUE(same(path.poses().front(), start));
  EXPECT_TRUE(path.poses().back().translation == goal.translation);
  EXPECT_NEAR(path.poses().back().rotation.angularDistance(goal.rotation), 0, 1e-7);
  EXPECT_LT((path.about() - *centroid(object)).norm(), 1e-12);
  EXPECT_TRUE(path_is_clear(environment, object, path, options.clearance));
  EXPECT_FALSE(reference::hits(environment, object, path, 0.1));
  EXPECT_FALSE(reference::leaves(object, path, 0.1));
  ASSERT_EQ(plan.clearance.size(), path.poses().size());
  for (const double clearance : plan.clearance) EXPECT_GT(clearance, options.clearance);
  // No point is faster than the speed.
  const Box box = *bounding_box(object);
  for (std::size_t i = 1; i < path.poses().size(); ++i) {
    const double from = path.poses()[i - 1].time, to = path.poses()[i].time;
    EXPECT_LE(path.motion_bound(from, to, box), options.speed * (to - from) * (1 + 1e-9) + 1e-3);
  }
}

}  // namespace blackleaf::test
