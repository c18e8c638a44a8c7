#include "controllers/obstacle_avoidance/obstacle_avoidance.hpp"

#include <vector>

#include "hal/device/ring_sensors.hpp"
#include "hal/plugin_loader.hpp"
#include "tests/checkout.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem {
namespace {

using controllers::ObstacleAvoidance;
using test::Room;
using test::TestRobot;

constexpr std::size_t kFrontRight = 0, kHalfRight = 1, kRearRight = 3, kRearLeft = 4, kHalfLeft = 6, kFrontLeft = 7;

struct Avoidance : ::testing::Test {
  TestRobot robot;
  ObstacleAvoidance controller{robot, {}};
};

TEST_F(Avoidance, CruisesOnFreeGround) {
  controller.step();
  EXPECT_DOUBLE_EQ(robot.wheels.left_m_s, 0.08);
  EXPECT_DOUBLE_EQ(robot.wheels.right_m_s, 0.08);
}

TEST_F(Avoidance, BearsAwayFromTheNearerSideAndMoreSoTheNearerItIs) {
  robot.see(kHalfLeft, 0.2);
  controller.step();
  const double gently = robot.wheels.left_m_s - robot.wheels.right_m_s;
  EXPECT_GT(gently, 0.0);
  robot.see(kHalfLeft, 0.4);
  controller.step();
  EXPECT_GT(robot.wheels.left_m_s - robot.wheels.right_m_s, gently);
  robot.clear();
  robot.see(kHalfRight, 0.2);
  controller.step();
  EXPECT_DOUBLE_EQ(robot.wheels.right_m_s - robot.wheels.left_m_s, gently);
}

TEST_F(Avoidance, SlowsDownBeforeWhatIsAhead) {
  robot.see(kFrontLeft, 0.4);
  robot.see(kFrontRight, 0.4);
  controller.step();
  EXPECT_LT(robot.wheels.left_m_s + robot.wheels.right_m_s, 0.16);
  EXPECT_GT(robot.wheels.left_m_s + robot.wheels.right_m_s, 0.0);
}

TEST_F(Avoidance, TurnsOnTheSpotBeforeContactAndKeepsToOneSide) {
  robot.see(kFrontLeft, 0.9);
  robot.see(kFrontRight, 0.8);
  controller.step();
  EXPECT_GT(robot.wheels.left_m_s, 0.0);
  EXPECT_DOUBLE_EQ(robot.wheels.left_m_s, -robot.wheels.right_m_s);
  const double left_m_s = robot.wheels.left_m_s;
  robot.see(kFrontLeft, 0.8);
  robot.see(kFrontRight, 0.9);
  controller.step();
  EXPECT_DOUBLE_EQ(robot.wheels.left_m_s, left_m_s) << "dithers in a corner";
}

TEST_F(Avoidance, CaresNothingForWhatIsBehind) {
  robot.see(kRearLeft, 1.0);
  robot.see(kRearRight, 0.5);
  controller.step();
  EXPECT_DOUBLE_EQ(robot.wheels.left_m_s, 0.08);
  EXPECT_DOUBLE_EQ(robot.wheels.right_m_s, 0.08);
}

TEST_F(Avoidance, StandsStillWhenBlind) {
  robot.wheels.set(1.0, 1.0);
  robot.proximity.validity = hal::Validity::Stale;
  controller.step();
  EXPECT_EQ(robot.wheels.left_m_s, 0.0);
  EXPECT_EQ(robot.wheels.right_m_s, 0.0);
}

TEST(AvoidanceDrive, NeverTouchesTheWallsOfARoom) {
  for (int degrees = 0; degrees < 360; degrees += 3) {
    TestRobot robot;
    ObstacleAvoidance controller(robot, {});
    Room room{.walls = {{1, 0, 0.4}, {-1, 0, 0.4}, {0, 1, 0.4}, {0, -1, 0.4}},
              .heading_rad = degrees * std::numbers::pi / 180.0};
    EXPECT_GT(test::smallest_clearance(controller, robot, room, 2000), hal::epuck::kind().body.radius_m) << degrees;
  }
}

TEST(AvoidanceDrive, WorksWithAnyRing) {
  std::vector<hal::Mount> ring;  // 24 sensors, as on larger robots
  for (int i = 0; i < 24; ++i) {
    const double bearing_rad = (i + 0.5) * std::numbers::pi / 12.0;
    ring.push_back({bearing_rad, 0.085 * std::cos(bearing_rad), 0.085 * std::sin(bearing_rad), 0.05});
  }
  hal::RobotKind kind;
  kind.name = "large";
  kind.body.radius_m = 0.085;
  kind.locomotion = hal::DifferentialDrive{.wheel_base_m = 0.14, .max_speed_m_s = 0.3};
  kind.add(hal::ProximityPart{.range_m = 0.1, .mounts = ring});
  for (int degrees = 0; degrees < 360; degrees += 10) {
    TestRobot robot(kind);
    ObstacleAvoidance controller(robot, {});
    Room room{.walls = {{1, 0, 0.6}, {-1, 0, 0.6}, {0, 1, 0.6}, {0, -1, 0.6}},
              .heading_rad = degrees * std::numbers::pi / 180.0};
    EXPECT_GT(test::smallest_clearance(controller, robot, room, 2000), kind.body.radius_m) << degrees;
  }
}

TEST(AvoidanceParams, AreDescribedWithDefaultsInRange) {
  ObstacleAvoidance::Params params;
  test::NumberNotes notes;
  params.describe(notes);
  ASSERT_EQ(notes.notes.size(), 3U);
  EXPECT_EQ(notes.notes[0].name, "cruise");
  EXPECT_EQ(notes.notes[0].bare, "cm/s");
  for (const auto& n : notes.notes) EXPECT_TRUE(n.range.min <= n.value_si && n.value_si <= n.range.max) << n.name;
}

TEST(AvoidancePlugin, Loads) {
  hal::PluginLoader loader({std::string(test::kBuildDir) + "/lib"});
  const auto type = loader.controller("obstacle_avoidance", "");
  ASSERT_TRUE(type.ok()) << type.error().message;
  EXPECT_EQ(type.value()->name, "obstacle_avoidance");
}

TEST(AvoidancePlugin, SeesNoWorld) {
  test::expect_no_world_in(std::string(test::kBuildDir) + "/lib/libobstacle_avoidance.so");
}

}  // namespace
}  // namespace tandem
