#include "controllers/footbot_diffusion/footbot_diffusion.hpp"

#include "hal/plugin_loader.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/checkout.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem {
namespace {

using controllers::FootbotDiffusion;
using test::Room;
using test::TestRobot;

// Counter-clockwise from 7.5 degrees, every 15.
constexpr std::size_t kFrontLeft = 0, kLeft = 5, kRearLeft = 11, kRearRight = 12, kRight = 18, kFrontRight = 23;

struct FootbotDiffusionSteps : ::testing::Test {
  TestRobot robot{hal::footbot::kind()};
  FootbotDiffusion controller{robot, {}};

  void expect_wheels(double left_m_s, double right_m_s) {
    robot.wheels.set(9.0, 9.0);
    controller.step();
    EXPECT_DOUBLE_EQ(robot.wheels.left_m_s, left_m_s);
    EXPECT_DOUBLE_EQ(robot.wheels.right_m_s, right_m_s);
  }
};

TEST_F(FootbotDiffusionSteps, DriveStraightOnFreeGround) {
  expect_wheels(0.05, 0.05);
}

TEST_F(FootbotDiffusionSteps, TurnAwayFromTheSideOfTheObstacle) {
  robot.see(kLeft, 0.5);
  expect_wheels(0.05, -0.05);
  robot.clear();
  controller.step();
  robot.see(kRight, 0.5);
  expect_wheels(-0.05, 0.05);
  robot.clear();
  controller.step();
  robot.see(kFrontLeft, 0.5);
  expect_wheels(0.05, -0.05);
  robot.clear();
  controller.step();
  robot.see(kFrontRight, 0.5);
  expect_wheels(-0.05, 0.05);
}

TEST_F(FootbotDiffusionSteps, GoOnWhenTheAverageIsNotLongerThanDelta) {
  robot.see(kLeft, 24 * 0.01 * 0.98);
  expect_wheels(0.05, 0.05);
  robot.see(kLeft, 24 * 0.01 * 1.02);
  expect_wheels(0.05, -0.05);
}

TEST_F(FootbotDiffusionSteps, GoOnWithSomethingStraightBehindOrBetweenTwoThings) {
  robot.see(kRearLeft, 0.8);
  robot.see(kRearRight, 0.8);
  expect_wheels(0.05, 0.05);
  robot.clear();
  robot.see(kLeft, 0.8);
  robot.see(kRight, 0.8);
  robot.see(6, 0.8);   // 97.5 degrees: with 82.5 the left is balanced, too
  robot.see(17, 0.8);  // and with -97.5 the right
  expect_wheels(0.05, 0.05);
}

TEST_F(FootbotDiffusionSteps, TurnOnToTheSameSideUntilTheWayIsFree) {
  robot.see(kLeft, 0.5);
  expect_wheels(0.05, -0.05);
  robot.clear();
  robot.see(kRight, 0.5);  // a corner
  expect_wheels(0.05, -0.05);
  robot.clear();
  expect_wheels(0.05, 0.05);
  robot.see(kRight, 0.5);
  expect_wheels(-0.05, 0.05);
}

TEST_F(FootbotDiffusionSteps, StandStillWhenBlind) {
  robot.proximity.validity = hal::Validity::Stale;
  expect_wheels(0.0, 0.0);
}

TEST(FootbotDiffusionParams, AreObeyed) {
  TestRobot robot(hal::footbot::kind());
  FootbotDiffusion controller(robot, {.alpha_rad = 0.6, .delta = 0.1, .velocity_m_s = 0.2});
  robot.see(kLeft, 1.0);  // an average of 1/24
  controller.step();
  EXPECT_DOUBLE_EQ(robot.wheels.left_m_s, 0.2);
  EXPECT_DOUBLE_EQ(robot.wheels.right_m_s, 0.2);
}

TEST(FootbotDiffusionDrive, NeverTouchesTheWallsOfARoomAndKeepsMoving) {
  for (int degrees = 0; degrees < 360; degrees += 5) {
    TestRobot robot(hal::footbot::kind());
    FootbotDiffusion controller(robot, {});
    Room room{.walls = {{1, 0, 0.6}, {-1, 0, 0.6}, {0, 1, 0.6}, {0, -1, 0.6}},
              .heading_rad = degrees * std::numbers::pi / 180.0};
    EXPECT_GT(test::smallest_clearance(controller, robot, room, 3000), hal::footbot::kind().body.radius_m) << degrees;
    const double x_m = room.x_m;
    const double y_m = room.y_m;
    double farthest_m = 0.0;
    for (int k = 0; k < 200; ++k) {
      test::smallest_clearance(controller, robot, room, 1);
      farthest_m = std::max(farthest_m, std::hypot(room.x_m - x_m, room.y_m - y_m));
    }
    EXPECT_GT(farthest_m, 0.1) << "stuck after starting at " << degrees;
  }
}

TEST(FootbotDiffusionPlugin, LoadsAndFitsACacheLine) {
  hal::PluginLoader loader({std::string(test::kBuildDir) + "/lib"});
  const auto type = loader.controller("footbot_diffusion", "footbot_diffusion");
  ASSERT_TRUE(type.ok()) << type.error().message;
  test::NumberNotes visitor;
  (void)type.value()->read_params(visitor);
  EXPECT_EQ(visitor.notes.size(), 3U);
  EXPECT_LE(type.value()->size, 64U);
}

TEST(FootbotDiffusionPlugin, SeesNoWorld) {
  test::expect_no_world_in(std::string(test::kBuildDir) + "/lib/libfootbot_diffusion.so");
}

}  // namespace
}  // namespace tandem
