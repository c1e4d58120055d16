// Ways among solids that move.
#include <vector>

#include "blackleaf/plan.h"
#include "plan/scenes.h"

namespace blackleaf::test {
namespace {

// Whatever is planned keeps clear of the movers at every time, and of each other.
void expect_apart(const Plan& plan, const Octree& object, const std::vector<Mover>& movers) {
  ASSERT_TRUE(plan.path);
  for (const Mover& mover : movers) EXPECT_FALSE(reference::meet(mover.octree, mover.path, object, *plan.path, 2000));
}

TEST(Traffic, WaitsOrGoesAround) {
  const Octree nothing(5), object = box(5, {2, 14, 14}, {6, 18, 18});
  // A slab as high and nearly as wide as the universe sweeps across the way and back.
  const Octree slab = box(5, {12, 2, 1}, {14, 31, 31});
  const std::vector<Mover> movers{{slab, Path({at(0, 0, 0), {30, {17, 0, 0}, Eigen::Quaterniond::Identity()}})}};
  PlanOptions options;
  options.speed = 1;
  const Pose goal = at(20, 0, 0);  // beyond where the slab is then
  const Plan alone = plan(nothing, object, {}, goal, options);
  EXPECT_TRUE(reference::meet(slab, movers[0].path, object, *alone.path, 2000));
  const Plan found = plan(nothing, object, {}, goal, options, movers);
  expect_sound(found, nothing, object, {}, goal, options);
  expect_apart(found, object, movers);
  EXPECT_TRUE(path_is_clear(nothing, object, *found.path, 0, movers));
  EXPECT_FALSE(path_is_clear(nothing, object, *alone.path, 0, movers));
  EXPECT_GT(found.path->end(), alone.path->end());
  const Plan again = plan(nothing, object, {}, goal, options, movers);
  EXPECT_TRUE(same(*again.path, *found.path)) << "same seed, same path";
}

TEST(Traffic, SaysWhoIsInTheWay) {
  const Octree nothing(5), object = box(5, {2, 14, 14}, {6, 18, 18}), block = box(5, {20, 12, 12}, {24, 20, 20});
  const std::vector<Mover> parked{{block, Path({at(0, 0, 0)})}};
  EXPECT_NE(error_of([&] {
              plan(nothing, object, {}, at(16, 0, 0), {}, parked);
            }).find("at the goal the object touches moving solid 1"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              plan(nothing, object, at(16, 0, 0), {}, {}, parked);
            }).find("at the start the object touches moving solid 1"),
            std::string::npos);
  // It comes to the goal later on, to stay.
  const std::vector<Mover> coming{{block, Path({at(0, 0, 8), {5, {0, 0, 0}, Eigen::Quaterniond::Identity()}})}};
  EXPECT_NE(error_of([&] { plan(nothing, object, {}, at(16, 0, 0), {}, coming); }).find("at the goal"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              plan(nothing, object, {}, at(4, 0, 0), {}, std::vector<Mover>{{Octree(6), Path({Pose{}})}});
            }).find("depth 6"),
            std::string::npos);
  // Something passes where the object is to stay: it goes out of the way and comes back.
  const std::vector<Mover> passing{{block, Path({at(0, 0, 0),
                                                 {20, {-19, 0, 0}, Eigen::Quaterniond::Identity()},
                                                 {40, {0, 0, 0}, Eigen::Quaterniond::Identity()}})}};
  const Plan found = plan(nothing, object, {}, {}, {}, passing);
  expect_sound(found, nothing, object, {}, {});
  expect_apart(found, object, passing);
  EXPECT_GT(found.path->poses().size(), 2u);
}

}  // namespace
}  // namespace blackleaf::test
