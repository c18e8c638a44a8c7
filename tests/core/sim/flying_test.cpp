// Robots that fly: what every engine of three dimensions promises of them, and how they get on with those below.
#include "hal/device/flight.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/robot/eyebot.hpp"
#include "tests/core/physics/conformance/engines.hpp"

namespace tandem::core {
namespace {

const double kHeight_m = hal::eyebot::kind().body.height_m;

Scene with_flyers(Scene s) {
  s.pilot("fly");
  return s;
}

/// A hall of `size_m` squared whose ceiling is 3 m high.
Scene hall(double size_m, const std::string& controller = "everything") {
  Scene s(size_m, controller);
  s.scenario.arena_size[2] = 3.0;
  s.scenario.arena_center[2] = 1.5;
  return s;
}

class Flying : public EveryEngine {
 protected:
  Scene air(double size_m = 8.0) const {
    Scene s = hall(size_m);
    return with_flyers(add_engine(s, GetParam()));
  }
};

TEST_P(Flying, ReachesTheCommandedVelocity) {
  for (const int per_second : {10, 50}) {
    for (const Vec3& v : {Vec3{0.5, 0, 0}, Vec3{-0.3, 0.4, 0.05}, Vec3{0, -0.2, 0.1}}) {
      Scene s = air().flyer("a", 0, 0, 1.0, 0.5).velocity(v, 0.3);
      s.scenario.ticks_per_second = per_second;
      auto world = make(s);
      ASSERT_TRUE(world.world) << world.all_problems();
      steps(world, 3 * per_second);
      const Pose before = pose_of(world, "a");
      steps(world, 3 * per_second);
      ASSERT_EQ(world->state(), RunState::Running) << world->failure();
      const Pose after = pose_of(world, "a");
      const double bar = 0.02 * 3.0 * std::hypot(v[0], v[1], v[2]);
      EXPECT_NEAR(after.x_m - before.x_m, 3.0 * v[0], bar) << per_second;
      EXPECT_NEAR(after.y_m - before.y_m, 3.0 * v[1], bar) << per_second;
      EXPECT_NEAR(after.z_m - before.z_m, 3.0 * v[2], bar) << per_second;
      EXPECT_NEAR(turned_rad(before.heading_rad(), after.heading_rad()), 0.9, 0.02 * 0.9) << per_second;
    }
  }
}

TEST_P(Flying, HoversWhereItIs) {
  auto world = make(air().flyer("a", 0.5, -0.3, 1.0, 1.0).velocity({0, 0, 0}));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 300);
  const Pose pose = pose_of(world, "a");
  EXPECT_NEAR(pose.x_m, 0.5, 1e-3);
  EXPECT_NEAR(pose.y_m, -0.3, 1e-3);
  EXPECT_NEAR(pose.z_m, 1.0, 0.02);
  EXPECT_NEAR(pose.heading_rad(), 1.0, 1e-3);
}

TEST_P(Flying, StaysBetweenGroundAndCeilingAndOutOfThings) {
  Scene s = air().flyer("up", -2, 0, 1.0).velocity({0, 0, 1.0}).flyer("down", 0, 2, 1.0).velocity({0, 0, -1.0});
  s.flyer("into", 0, -2, 0.5).velocity({1.0, 0, 0}).box(2, -2, 0.4, 2.0, 0.0, 1.5);
  s.flyer("over", 0, -2, 1.6).velocity({0.5, 0, 0});  // the box is 1.5 m high
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  for (int i = 0; i < 100; ++i) {
    world->step();
    ASSERT_EQ(world->state(), RunState::Running) << world->failure();
    ASSERT_LE(pose_of(world, "up").z_m + kHeight_m, 3.0 + 0.01) << i;
    ASSERT_GE(pose_of(world, "down").z_m, -0.01) << i;
    ASSERT_LE(pose_of(world, "into").x_m + hal::eyebot::kind().body.radius_m, 1.8 + 0.01) << i;
    if (i == 60) set_halted(world, "over");
  }
  EXPECT_GT(pose_of(world, "up").z_m + kHeight_m, 2.9);
  EXPECT_LT(pose_of(world, "down").z_m, 0.05);
  EXPECT_GT(pose_of(world, "into").x_m + hal::eyebot::kind().body.radius_m, 1.7);
  EXPECT_GT(pose_of(world, "over").x_m, 2.5);
}

TEST_P(Flying, CrossesBordersAsIfThereWereNone) {
  const auto start = [&](const char* split) {
    Scene s = hall(8.0);
    add_engine(s, GetParam()).split(split);
    return make(with_flyers(s).flyer("a", -2.5, -2.0, 1.0, 0.2).velocity({0.5, 0.4, 0.05}, 0.2));
  };
  auto whole = start("1x1");
  auto parts = start("4x4");
  ASSERT_TRUE(whole.world && parts.world) << parts.all_problems();
  for (int i = 0; i < 100; ++i) {
    whole->step();
    parts->step();
    ASSERT_EQ(parts->state(), RunState::Running) << parts->failure();
    const Pose a = pose_of(whole, "a");
    const Pose b = pose_of(parts, "a");
    ASSERT_NEAR(a.x_m, b.x_m, 1e-9) << i;
    ASSERT_NEAR(a.y_m, b.y_m, 1e-9) << i;
    ASSERT_NEAR(a.z_m, b.z_m, 1e-9) << i;
    ASSERT_NEAR(turned_rad(a.heading_rad(), b.heading_rad()), 0.0, 1e-9) << i;
  }
  EXPECT_GT(pose_of(parts, "a").x_m, 2.0);
}

TEST_P(Flying, PositioningTellsTheTruth) {
  auto world = make(air().flyer("a", 0.5, 0, 1.0, -0.4).velocity({0.2, 0.1, 0.05}, 0.1));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 30);
  const Space& space = world->space();
  const auto* told = space.port<hal::Positioning>(space.find_robot("a"));
  ASSERT_NE(told, nullptr);
  const Pose pose = pose_of(world, "a");
  EXPECT_NEAR(told->p_WB[0], pose.x_m, 1e-9);
  EXPECT_NEAR(told->p_WB[1], pose.y_m, 1e-9);
  EXPECT_NEAR(told->p_WB[2], pose.z_m, 1e-9);
  const auto& q = told->q_WB;
  const double yaw_rad = std::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
  EXPECT_NEAR(turned_rad(yaw_rad, pose.heading_rad()), 0.0, 1e-6);
}

TEST_P(Flying, LeavingTheArenaIsNoticed) {
  for (const EscapePolicy policy : {EscapePolicy::Error, EscapePolicy::Stop, EscapePolicy::Remove}) {
    Scene s = air(4.0).flyer("a", 1.0, 0, 1.0).velocity({1.0, 0, 0}).flyer("b", -1, 0, 1.0).velocity({0, 0, 0});
    s.scenario.escape = policy;
    auto world = make(s);
    ASSERT_TRUE(world.world) << world.all_problems();
    steps(world, 40);
    EXPECT_EQ(world->state(), policy == EscapePolicy::Error ? RunState::Failed : RunState::Running);
    if (policy == EscapePolicy::Error) {
      EXPECT_NE(world->failure().find("'a' left the arena"), std::string::npos) << world->failure();
    }
    EXPECT_GE(world->incidents().bodies_escaped, 1U);
    EXPECT_EQ(world->space().find_robot("a").valid(), policy != EscapePolicy::Remove);
    if (policy == EscapePolicy::Stop) {
      EXPECT_LE(pose_of(world, "a").x_m, 2.0 + 1e-9);
    }
  }
}

TEST_P(Flying, TheSameBitsForAnyNumberOfThreads) {
  const auto hash_of = [&](std::int64_t threads, Assignment assignment) {
    Scene s = hall(8.0);
    add_engine(s, GetParam()).split("2x2");
    s = with_flyers(s);
    for (int i = 0; i < 36; ++i) {
      s.flyer("f" + std::to_string(i), i % 6 - 2.5, i / 6 - 2.5, 0.5 + 0.05 * (i % 5), i);
      s.velocity({0.3 * std::cos(i), 0.3 * std::sin(i), 0.02 * (i % 3 - 1)}, 0.1 * (i % 7 - 3));
    }
    WorldOptions options;
    options.threads = threads;
    options.assignment = assignment;
    auto world = make(s, options);
    EXPECT_TRUE(world.world) << world.all_problems();
    if (!world.world) return std::uint64_t{0};
    run(*world.world, 40);
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    return world->state_hash();
  };
  const std::uint64_t alone = hash_of(1, Assignment::Static);
  for (const std::int64_t threads : {2, 3, 8}) {
    EXPECT_EQ(hash_of(threads, Assignment::Static), alone) << threads;
    EXPECT_EQ(hash_of(threads, Assignment::Dynamic), alone) << threads;
  }
}

INSTANTIATE_TEST_SUITE_P(Physics, Flying, testing::ValuesIn(ways_to_fly()), name_of_kind);

/// particle3d over an engine for the ground.
using Above = EveryEngine;

TEST_P(Above, RobotsOnTheGroundAndInTheAirHearButDoNotTouchOrSeeOneAnother) {
  Scene s = hall(4.0);
  s.engine(GetParam(), "ground").engine("particle3d", "air");
  s.robot("below", -0.5, 0).wheels(0.1, 0.1).robot("still", 0.0, 0.0).wheels(0, 0);
  s = with_flyers(s).flyer("hover", 0.05, 0.0, 0.5).velocity({0, 0, 0});
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  const Space& space = world->space();
  const SpaceStores& stores = space.stores();
  EXPECT_EQ(stores.regions[stores.bodies.region[stores.row_of(space.find_robot("hover"))]].name, "air");
  EXPECT_EQ(stores.regions[stores.bodies.region[stores.row_of(space.find_robot("still"))]].name, "ground");
  for (int i = 0; i < 31; ++i) {
    const double last_m = pose_of(world, "below").x_m;
    world->step();
    ASSERT_EQ(world->state(), RunState::Running) << world->failure();
    if (i > 2) {
      ASSERT_NEAR(pose_of(world, "below").x_m - last_m, 0.01, 2e-4) << i;  // on its way in below the other
    }
  }
  EXPECT_NEAR(pose_of(world, "still").x_m, 0.0, 1e-4);
  EXPECT_NEAR(pose_of(world, "hover").z_m, 0.5, 0.02);
  EXPECT_NEAR(pose_of(world, "hover").x_m, 0.05, 1e-3);
  const auto* seen = space.port<hal::Proximity>(space.find_robot("still"));
  ASSERT_NE(seen, nullptr);
  for (std::size_t i = 0; i < seen->count; ++i) EXPECT_EQ(seen->distance_m[i], seen->range_m) << i;
  const auto* above = space.port<hal::Proximity>(space.find_robot("hover"));
  ASSERT_NE(above, nullptr);
  for (std::size_t i = 0; i < above->count; ++i) EXPECT_EQ(above->distance_m[i], above->range_m) << i;
  // Between the boards: 5 cm aside, 0.5 m + 0.1635 m - 0.086 m up.
  const auto* heard = space.port<hal::RangeAndBearing>(space.find_robot("still"));
  ASSERT_NE(heard, nullptr);
  bool from_above = false;
  for (std::size_t i = 0; i < heard->count; ++i) {
    if (heard->message(i)[0] != 42) continue;
    from_above = true;
    const double up_m = pose_of(world, "hover").z_m + hal::eyebot::kind().part<hal::RangeAndBearingPart>()->height_m -
                        hal::epuck::kind().body.height_m;
    EXPECT_NEAR(heard->range_m[i], std::hypot(0.05, up_m), 2e-3);
    EXPECT_NEAR(heard->elevation_rad[i], std::atan2(up_m, 0.05), 5e-3);
  }
  EXPECT_TRUE(from_above);
  const auto* heard_above = space.port<hal::RangeAndBearing>(space.find_robot("hover"));
  ASSERT_NE(heard_above, nullptr);
  EXPECT_EQ(heard_above->count, 2U);
}

TEST_P(Above, AnEngineOfThePlaneCannotCarryRobotsThatFly) {
  if (!test::engine_traits(GetParam()).plane) return;
  Scene s = hall(4.0);
  s.engine(GetParam());
  s = with_flyers(s).flyer("icarus", 0, 0, 1.0).velocity({0, 0, 0});
  s.scenario.robots.back().line = 42;
  auto world = make(s);
  EXPECT_EQ(world.world, nullptr);
  EXPECT_NE(world.all_problems().find("scene:42: error: robot 'icarus'"), std::string::npos) << world.all_problems();
  EXPECT_NE(world.all_problems().find("flies"), std::string::npos) << world.all_problems();
}

std::vector<std::string> ground_kinds() {
  std::vector<std::string> kinds = test::engine_kinds();
  std::erase(kinds, "particle3d");
  return kinds;
}
INSTANTIATE_TEST_SUITE_P(Physics, Above, testing::ValuesIn(ground_kinds()), name_of_kind);

}  // namespace
}  // namespace tandem::core
