#include "blackleaf/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "plan/scenes.h"

namespace blackleaf::test {
namespace {

constexpr std::array kPlanners = {Planner::rrt_connect, Planner::rrt_star, Planner::prm_star, Planner::kpiece,
                                  Planner::bit_star};

TEST(Plan, StraightWhereNothingIsInTheWay) {
  const Octree nothing(5), object = box(5, {4, 4, 4}, {8, 6, 7});
  PlanOptions options;
  options.speed = 4;
  const Pose goal = at(20, 3, 4);
  const Plan found = plan(nothing, object, {}, goal, options);
  expect_sound(found, nothing, object, {}, goal, options);
  EXPECT_NEAR(found.length, goal.translation.norm(), 1e-3 * found.length);
  EXPECT_NEAR(found.path->end(), found.length / 4, 1e-9);
  EXPECT_EQ(found.clearance[0], std::numeric_limits<double>::infinity());
  // A turn where it stands.
  const Pose turned = at(0, 0, 0, {1, 2, 3}, 100);
  const Plan turn = plan(nothing, object, at(8, 8, 8), at(8, 8, 8, {1, 2, 3}, 100));
  ASSERT_TRUE(turn.path);
  EXPECT_NEAR(turn.length,
              turned.rotation.angularDistance(Eigen::Quaterniond::Identity()) * Eigen::Vector3d(2, 1, 1.5).norm(),
              1e-3 * turn.length);
  // Nothing to do.
  const Plan none = plan(nothing, object, goal, goal);
  ASSERT_TRUE(none.path);
  EXPECT_EQ(none.path->poses().size(), 1u);
  EXPECT_EQ(none.length, 0);
}

TEST(Plan, EveryPlannerTurnsTheBoardToPassTheSlot) {
  const Slot slot;
  for (const Planner planner : kPlanners) {
    SCOPED_TRACE(name_of(planner));
    PlanOptions options;
    options.planner = planner;
    options.refinement = 60;
    options.seed = 2;
    const Plan found = plan(slot.environment, slot.object, slot.start, slot.goal, options);
    expect_sound(found, slot.environment, slot.object, slot.start, slot.goal, options);
    const auto turned = [](const Pose& pose) {
      return pose.rotation.angularDistance(Eigen::Quaterniond::Identity()) > 0.5;
    };
    EXPECT_TRUE(std::any_of(found.path->poses().begin(), found.path->poses().end(), turned));
    EXPECT_GT(found.motions_tried, 0u);
    EXPECT_EQ(planner_of(name_of(planner)), planner);
  }
  EXPECT_EQ(planner_of("a-star"), std::nullopt);
}

TEST(Plan, SameSeedSamePath) {
  const Slot slot;
  for (const Planner planner : kPlanners) {
    SCOPED_TRACE(name_of(planner));
    PlanOptions options;
    options.planner = planner;
    options.refinement = 20;
    options.seed = 2;
    const Plan first = plan(slot.environment, slot.object, slot.start, slot.goal, options);
    Work one;
    one.threads = 1;
    const Plan again = plan(slot.environment, slot.object, slot.start, slot.goal, options, {}, one);
    ASSERT_TRUE(first.path && again.path);
    EXPECT_TRUE(same(*first.path, *again.path));
    EXPECT_EQ(first.clearance, again.clearance);
    EXPECT_EQ(first.motions_tried, again.motions_tried);
    if (planner != Planner::rrt_connect) continue;
    options.seed = 8;
    const Plan other = plan(slot.environment, slot.object, slot.start, slot.goal, options);
    EXPECT_FALSE(other.path && same(*first.path, *other.path));
  }
}

TEST(Plan, ShortensAndRoundsWhatIsFound) {
  const Slot slot;
  double as_found = 0, shortened = 0;
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    PlanOptions options;
    options.seed = seed;
    const Plan whole = plan(slot.environment, slot.object, slot.start, slot.goal, options);
    options.shorten = false;
    const Plan rough = plan(slot.environment, slot.object, slot.start, slot.goal, options);
    expect_sound(whole, slot.environment, slot.object, slot.start, slot.goal);
    expect_sound(rough, slot.environment, slot.object, slot.start, slot.goal);
    EXPECT_LE(whole.length, rough.length);
    as_found += rough.length;
    shortened += whole.length;
  }
  EXPECT_LT(shortened, 0.9 * as_found);
}

// However thin the wall and however long the motion.
TEST(Plan, NoWallIsThinEnoughToJump) {
  const Octree wall = box(6, {32, 0, 0}, {33, 64, 64}), object = box(6, {4, 30, 30}, {5, 31, 31});
  EXPECT_FALSE(path_is_clear(wall, object, Path({at(0, 0, 0), {1e-6, {50, 0, 0}, Eigen::Quaterniond::Identity()}})));
  EXPECT_TRUE(path_is_clear(wall, object, Path({at(0, 0, 0), {1e-6, {26, 0, 0}, Eigen::Quaterniond::Identity()}})));
  PlanOptions options;
  options.seconds = 0.3;
  for (const Planner planner : kPlanners) {
    SCOPED_TRACE(name_of(planner));
    options.planner = planner;
    const Plan none = plan(wall, object, {}, at(50, 0, 0), options);
    EXPECT_FALSE(none.path);
    ASSERT_FALSE(none.nearest.empty());
    EXPECT_TRUE(same(none.nearest.front(), at(0, 0, 0)));
    // It has come some of the way, not through.
    EXPECT_LT(none.nearest.back().translation.x(), 27);
    EXPECT_GT(none.missing, 22);
    EXPECT_LE(none.missing, 50);
    for (std::size_t i = 1; i < none.nearest.size(); ++i) {
      Pose from = none.nearest[i - 1], to = none.nearest[i];
      from.time = 0;
      to.time = 1;
      EXPECT_TRUE(path_is_clear(wall, object, Path({from, to}, *centroid(object))));
    }
  }
}

// The universe's walls cannot be gone around, nor reached through by a corner that swings out.
TEST(Plan, StaysInTheUniverse) {
  const Octree nothing(5), rod = box(5, {2, 1, 1}, {26, 2, 2});
  const auto clear = [&](const Pose& from, Pose to) {
    to.time = 1;
    return path_is_clear(nothing, rod, Path({from, to}, *centroid(rod)));
  };
  EXPECT_TRUE(clear({}, at(5, 0, 0)));
  EXPECT_FALSE(clear({}, at(6.5, 0, 0)));
  EXPECT_FALSE(clear({}, at(0, 0, 0, {0, 0, 1}, 20)));
  // Both ends are inside, the middle of the turn is not.
  EXPECT_TRUE(clear(at(0, 14, 0), at(0, 14, 0, {0, 0, 1}, 179)));
  EXPECT_FALSE(clear(at(0, 5, 0), at(0, 5, 0, {0, 0, 1}, 179)));
  const Pose goal = at(0, 29, 0, {0, 0, 1}, 180);
  const Plan found = plan(nothing, rod, {}, goal);
  expect_sound(found, nothing, rod, {}, goal);
}

TEST(Plan, ClearanceIsKept) {
  const Octree post = box(5, {14, 14, 0}, {18, 18, 32}), object = box(5, {4, 14, 14}, {8, 18, 18});
  const Pose goal = at(20, 0, 0);
  double length = 0;
  for (const double clearance : {0.0, 1.0, 3.0}) {
    SCOPED_TRACE(clearance);
    PlanOptions options;
    options.clearance = clearance;
    const Plan found = plan(post, object, {}, goal, options);
    expect_sound(found, post, object, {}, goal, options);
    EXPECT_GT(found.length, 0.9 * length) << "more clearance, longer way";
    length = found.length;
  }
  // What stands on a floor may begin where it touches if parts may overlap a little.
  const Octree floor = box(5, {0, 0, 0}, {32, 32, 14});
  EXPECT_NE(error_of([&] { plan(floor, object, {}, goal); }).find("touches"), std::string::npos);
  PlanOptions touching;
  touching.clearance = -0.05;
  const Plan found = plan(floor, object, {}, goal, touching);
  ASSERT_TRUE(found.path);
  EXPECT_TRUE(path_is_clear(floor, object, *found.path, -0.05));
  EXPECT_FALSE(path_is_clear(floor, object, *found.path));
  EXPECT_EQ(found.clearance.front(), 0);
}

TEST(Plan, PreferredClearanceIsWorthALongerWay) {
  const Octree post = box(5, {14, 14, 0}, {18, 18, 32}), object = box(5, {2, 14, 14}, {6, 18, 18});
  const Pose goal = at(24, 0, 0);
  for (const Planner planner : {Planner::rrt_connect, Planner::rrt_star}) {
    SCOPED_TRACE(name_of(planner));
    PlanOptions options;
    options.planner = planner;
    options.refinement = 50;
    const Plan shortest = plan(post, object, {}, goal, options);
    options.preferred_clearance = 4;
    const Plan clearest = plan(post, object, {}, goal, options);
    expect_sound(shortest, post, object, {}, goal);
    expect_sound(clearest, post, object, {}, goal);
    const auto least = [](const Plan& plan) { return *std::min_element(plan.clearance.begin(), plan.clearance.end()); };
    EXPECT_GT(least(clearest), 1.5);
    EXPECT_GT(least(clearest), least(shortest));
  }
}

TEST(Plan, SaysWhyItCannotBegin) {
  const Octree wall = box(5, {16, 0, 0}, {18, 32, 32}), object = box(5, {2, 4, 5}, {6, 8, 9});
  const auto refusal = [&](const Pose& start, const Pose& goal, const PlanOptions& options = {}) {
    return error_of([&] { plan(wall, object, start, goal, options); });
  };
  EXPECT_EQ(
      refusal(at(12, 0, 0), {}),
      "at the start the object interferes with the environment: 32 voxels overlap, from (16, 4, 5) to (18, 8, 9); "
      "choose another pose");
  EXPECT_NE(refusal({}, at(11, 0, 0)).find("at the goal the object interferes"), std::string::npos);
  EXPECT_NE(refusal({}, at(11, 0, 0)).find("16 voxels overlap"), std::string::npos);
  EXPECT_NE(refusal(at(10, 0, 0), {}).find("at the start the object touches the environment, at (16, "),
            std::string::npos)
      << refusal(at(10, 0, 0), {});
  EXPECT_NE(refusal(at(10.25, 0, 0), {}).find("by less than a voxel"), std::string::npos)
      << refusal(at(10.25, 0, 0), {});
  EXPECT_EQ(refusal(at(-2.5, 0, 25), {}),
            "at the start the object is outside the universe: 0.5 voxels below x = 0, 2 voxels beyond z = 32; choose "
            "another pose or a larger universe");
  PlanOptions options;
  options.clearance = 2;
  EXPECT_NE(refusal(at(9, 0, 0), {}, options).find("1 voxels from the environment, at (16, "), std::string::npos)
      << refusal(at(9, 0, 0), {}, options);
  EXPECT_NE(refusal(at(-1, 0, 0), {}, options).find("nearer to a wall of the universe"), std::string::npos);
  EXPECT_NE(error_of([&] { plan(Octree(6), object, {}, {}); }).find("depths 6 and 5"), std::string::npos);
  EXPECT_NE(error_of([&] { plan(wall, Octree(5), {}, {}); }).find("no black voxel"), std::string::npos);
  EXPECT_NE(error_of([&] { plan(Octree(20), Octree(20), {}, {}); }).find("depth 20"), std::string::npos);
  options = {};
  options.seconds = 0;
  EXPECT_NE(refusal({}, {}, options).find("time limit"), std::string::npos);
  options = {};
  options.speed = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal({}, {}, options).find("speed"), std::string::npos);
  EXPECT_NE(refusal({0, {0, 0, 0}, {2, 0, 0, 0}}, {}).find("length 2"), std::string::npos);
}

TEST(Plan, CanBeInterrupted) {
  const Octree wall = box(5, {16, 0, 0}, {18, 32, 32}), object = box(5, {2, 4, 5}, {6, 8, 9});
  int asked = 0;
  double last = 0;
  Work work;
  work.threads = 1;  // others may ask once more before they see that they are to stop
  work.progress = [&](double done) {
    EXPECT_GE(done, last);
    last = done;
    return ++asked < 3;
  };
  for (const Planner planner : kPlanners) {
    asked = 0;
    last = 0;
    PlanOptions options;
    options.planner = planner;
    try {
      plan(wall, object, {}, at(24, 0, 0), options, {}, work);
      FAIL() << name_of(planner);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
    }
    EXPECT_EQ(asked, 3);
  }
}

}  // namespace
}  // namespace blackleaf::test
