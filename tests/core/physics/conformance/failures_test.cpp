// What every engine does about bodies that leave, go, come elsewhere, or stop being numbers.
#include <limits>

#include "tests/core/physics/conformance/engines.hpp"

namespace tandem::core {
namespace {

using Failures = EveryEngine;

TEST_P(Failures, ARobotThatLeavesTheArenaEndsTheRunByName) {
  auto world = make(scene(1.0).robot("runaway", 0.4, 0).wheels(0.1, 0.1).robot("calm", -0.2, 0).wheels(0, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 9);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  steps(world, 10);
  EXPECT_EQ(world->state(), RunState::Failed);
  EXPECT_NE(world->failure().find("'runaway' left the arena"), std::string::npos) << world->failure();
  EXPECT_EQ(world->incidents().bodies_escaped, 1U);
}

TEST_P(Failures, ARobotThatLeavesTheArenaIsStoppedAtItsEdgeWhenTheFileSaysSo) {
  Scene s = scene(1.0);
  s.scenario.escape = EscapePolicy::Stop;
  auto world = make(s.robot("a", 0.4, 0).wheels(0.1, 0.1));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 60);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  EXPECT_NEAR(pose_of(world, "a").x_m, 0.5, 1e-9);
  EXPECT_GT(world->incidents().bodies_escaped, 1U);
  EXPECT_NE(world->incidents().first().at(0).find("'a' left the arena"), std::string::npos);
}

TEST_P(Failures, ARobotThatLeavesTheArenaIsTakenOutWhenTheFileSaysSo) {
  Scene s = scene(1.0);
  s.scenario.escape = EscapePolicy::Remove;
  s.robot("a", 0.4, 0).wheels(0.1, 0.1).robot("b", -0.4, 0.2).wheels(0.1, 0.1);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 60);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  EXPECT_FALSE(world->space().find_robot("a").valid());
  EXPECT_EQ(world->space().robot_count(), 1U);
  EXPECT_NEAR(pose_of(world, "b").x_m, -0.4 + 0.59, 0.02);
  EXPECT_EQ(world->incidents().bodies_escaped, 1U);
}

TEST_P(Failures, APositionThatIsNoNumberEndsTheRunInThatTickByName) {
  const double nan = std::nan("");
  const double infinite = std::numeric_limits<double>::infinity();
  for (const Pose& bad : {Pose{nan, 0, 0, 1, 0}, Pose{0, nan, 0, 1, 0}, Pose{0.1, 0, 0, nan, 0},
                          Pose{0.1, 0, 0, 1, nan}, Pose{infinite, 0, 0, 1, 0}, Pose{0, -infinite, 0, 1, 0}}) {
    auto world = make(scene().robot("odd", 0, 0).wheels(0.05, 0.05).robot("calm", 1, 1).wheels(0.05, 0.04));
    ASSERT_TRUE(world.world) << world.all_problems();
    world->start();
    steps(world, 3);
    world->space().set_pose(world->space().find_robot("odd"), bad);
    world->step();
    EXPECT_EQ(world->state(), RunState::Failed) << bad.x_m << " " << bad.y_m << " " << bad.cos_h << " " << bad.sin_h;
    EXPECT_NE(world->failure().find("'odd'"), std::string::npos) << world->failure();
    EXPECT_NE(world->failure().find("tick 3"), std::string::npos) << world->failure();
  }
}

TEST_P(Failures, ARobotThatAHookRemovedIsGoneForPhysicsToo) {
  auto world = make(scene().robot("a", -0.3, 0).wheels(0.1, 0.1).robot("b", 0, 0).wheels(0, 0).box(0, 1, 0.2, 0.2));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 20);
  world->space().remove_robot(world->space().find_robot("b"));
  steps(world, 41);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  EXPECT_NEAR(pose_of(world, "a").x_m, 0.3, 0.02);  // drove through where the other stood
  EXPECT_NEAR(pose_of(world, "a").y_m, 0.0, 1e-3);
}

TEST_P(Failures, ARobotThatAHookMovedDrivesOnFromThere) {
  auto world = make(scene().robot("a", -1, 0).wheels(0.1, 0.1));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 20);
  const double heading_rad = 2.0;
  world->space().set_pose(world->space().find_robot("a"),
                          {0.5, 0.5, 0.0, std::cos(heading_rad), std::sin(heading_rad)});
  steps(world, 50);
  EXPECT_NEAR(pose_of(world, "a").x_m, 0.5 + 0.5 * std::cos(heading_rad), 0.02);
  EXPECT_NEAR(pose_of(world, "a").y_m, 0.5 + 0.5 * std::sin(heading_rad), 0.02);
  EXPECT_NEAR(pose_of(world, "a").heading_rad(), heading_rad, 0.02);
}

TEST_P(Failures, RobotsPutIntoOneAnotherPartWithoutBeingFlung) {
  for (const double apart_m : {0.0, 1e-6, 0.01, 0.05}) {
    auto world = make(scene().robot("a", -1, 0).wheels(0, 0).robot("b", 1, 0).wheels(0, 0));
    ASSERT_TRUE(world.world) << world.all_problems();
    steps(world, 3);
    world->space().set_pose(world->space().find_robot("a"), {0, 0, 0, 1, 0});
    world->space().set_pose(world->space().find_robot("b"), {apart_m, 0, 0, 1, 0});
    steps(world, 100);
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    const Pose a = pose_of(world, "a");
    const Pose b = pose_of(world, "b");
    EXPECT_LE(overlap_m(a, b), 2 * depth_m()) << apart_m;
    EXPECT_LT(std::hypot(a.x_m, a.y_m), 4 * kRobotRadius_m) << apart_m;
    EXPECT_LT(std::hypot(b.x_m, b.y_m), 4 * kRobotRadius_m) << apart_m;
  }
}

TEST_P(Failures, MoreRobotsThanFitAreALoadError) {
  auto world = make(scene(0.5).robots(500, 0.2));
  EXPECT_EQ(world.world, nullptr);
  EXPECT_NE(world.all_problems().find("error"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Physics, Failures, testing::ValuesIn(test::engine_kinds()), name_of_kind);

TEST(Failures, AnEngineKindThatDoesNotExistIsALoadErrorWithItsLine) {
  auto world = make(Scene().engine("dynamics4d").robot("a", 0, 0));
  EXPECT_EQ(world.world, nullptr);
  EXPECT_NE(world.all_problems().find("scene:100: error: unknown physics engine 'dynamics4d'"), std::string::npos)
      << world.all_problems();
}

TEST(Failures, AMovableObjectWhereNoEngineMovesObjectsIsALoadError) {
  Scene s;
  s.engine("kinematics2d").robot("a", 0, 0).box(1, 1, 0.2, 0.2).movable(0.5);
  s.scenario.objects[0].line = 42;
  auto world = make(s);
  EXPECT_EQ(world.world, nullptr);
  EXPECT_NE(world.all_problems().find("scene:42: error: movable box 'box0'"), std::string::npos)
      << world.all_problems();
}

}  // namespace
}  // namespace tandem::core
