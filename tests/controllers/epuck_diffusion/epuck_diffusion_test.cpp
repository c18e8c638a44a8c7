#include "controllers/epuck_diffusion/epuck_diffusion.hpp"

#include <new>

#include "hal/plugin_loader.hpp"
#include "tests/checkout.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem {
namespace {

using controllers::EpuckDiffusion;
using test::Room;
using test::TestRobot;

// Sensors of the real robot: 0 front right, clockwise; 7 front left.
constexpr std::size_t kFrontRight = 0, kRight = 2, kRearRight = 3, kRearLeft = 4, kLeft = 5, kFrontLeft = 7;

struct Diffusion : ::testing::Test {
  TestRobot robot;
  EpuckDiffusion controller{robot, {}};

  void expect_wheels(double left_m_s, double right_m_s) {
    robot.wheels.set(9.0, 9.0);
    controller.step();
    EXPECT_DOUBLE_EQ(robot.wheels.left_m_s, left_m_s);
    EXPECT_DOUBLE_EQ(robot.wheels.right_m_s, right_m_s);
  }
};

TEST_F(Diffusion, DrivesStraightAtFiveCentimetresPerSecondOnFreeGround) {
  expect_wheels(0.05, 0.05);
}

TEST_F(Diffusion, TurnsRightWithAnObstacleOnTheLeft) {
  robot.see(kLeft, 0.5);
  expect_wheels(0.05, 0.0);
}

TEST_F(Diffusion, TurnsLeftWithAnObstacleOnTheRight) {
  robot.see(kRight, 0.5);
  expect_wheels(0.0, 0.05);
}

TEST_F(Diffusion, IgnoresSumsNotLongerThanDelta) {
  robot.see(kLeft, 0.09);
  expect_wheels(0.05, 0.05);
  robot.see(kLeft, 0.11);
  expect_wheels(0.05, 0.0);
}

TEST_F(Diffusion, DrivesOnBetweenObstaclesThatBalance) {
  robot.see(kLeft, 0.8);
  robot.see(kRight, 0.8);
  expect_wheels(0.05, 0.05);
}

TEST_F(Diffusion, DrivesAwayFromWhatIsRightBehind) {
  robot.see(kRearLeft, 0.8);
  robot.see(kRearRight, 0.8);
  expect_wheels(0.05, 0.05);
}

TEST_F(Diffusion, TurnsWhenTheFreeDirectionIsMoreThanAlphaFromAhead) {
  robot.see(kRearLeft, 0.8);  // bearing 150: the way away from it is 30 degrees to the right
  expect_wheels(0.05, 0.0);
}

TEST_F(Diffusion, TurnsAwayFromAWallDeadAhead) {
  robot.see(kFrontLeft, 0.7);
  robot.see(kFrontRight, 0.7);
  controller.step();
  EXPECT_NE(robot.wheels.left_m_s, robot.wheels.right_m_s);
}

TEST_F(Diffusion, StandsStillWhenBlind) {
  robot.proximity.validity = hal::Validity::Stale;
  expect_wheels(0.0, 0.0);
  robot.proximity.validity = hal::Validity::Absent;
  expect_wheels(0.0, 0.0);
}

TEST(DiffusionParams, AreObeyed) {
  TestRobot robot;
  EpuckDiffusion controller(robot, {.alpha_rad = 0.6, .delta = 0.5, .velocity_m_s = 0.1});
  robot.see(kLeft, 0.4);
  controller.step();
  EXPECT_DOUBLE_EQ(robot.wheels.left_m_s, 0.1);
  EXPECT_DOUBLE_EQ(robot.wheels.right_m_s, 0.1);
  robot.clear();
  robot.see(kRearLeft, 0.9);  // 30 degrees are within 0.6 rad
  controller.step();
  EXPECT_DOUBLE_EQ(robot.wheels.left_m_s, robot.wheels.right_m_s);
}

TEST(DiffusionParams, DeltaZeroStillMeansFreeGroundIsFree) {
  TestRobot robot;
  EpuckDiffusion controller(robot, {.delta = 0.0});
  controller.step();
  EXPECT_DOUBLE_EQ(robot.wheels.left_m_s, robot.wheels.right_m_s);
}

TEST(DiffusionParams, HaveTheNamesAndUnitsOfTheBenchmark) {
  EpuckDiffusion::Params params;
  test::NumberNotes notes;
  params.describe(notes);
  ASSERT_EQ(notes.notes.size(), 3U);
  EXPECT_EQ(notes.notes[0].name, "alpha");
  EXPECT_EQ(notes.notes[0].bare, "deg");
  EXPECT_NEAR(notes.notes[0].value_si, 7.5 * std::numbers::pi / 180.0, 1e-15);
  EXPECT_EQ(notes.notes[1].name, "delta");
  EXPECT_EQ(notes.notes[1].value_si, 0.1);
  EXPECT_EQ(notes.notes[2].name, "velocity");
  EXPECT_EQ(notes.notes[2].bare, "cm/s");
  EXPECT_EQ(notes.notes[2].value_si, 0.05);
  for (const auto& n : notes.notes) EXPECT_TRUE(n.range.min <= n.value_si && n.value_si <= n.range.max) << n.name;
}

TEST(DiffusionDrive, NeverTouchesAWallWhateverTheAngle) {
  for (int degrees = -90; degrees <= 90; ++degrees) {
    TestRobot robot;
    EpuckDiffusion controller(robot, {});
    Room room{.walls = {{1.0, 0.0, 0.3}}, .heading_rad = degrees * std::numbers::pi / 180.0};
    EXPECT_GT(test::smallest_clearance(controller, robot, room, 600), hal::epuck::kind().body.radius_m) << degrees;
  }
}

TEST(DiffusionDrive, NeverTouchesTheWallsOfARoomAndKeepsMoving) {
  for (int degrees = 0; degrees < 360; degrees += 5) {
    TestRobot robot;
    EpuckDiffusion controller(robot, {});
    Room room{.walls = {{1, 0, 0.4}, {-1, 0, 0.4}, {0, 1, 0.4}, {0, -1, 0.4}},
              .heading_rad = degrees * std::numbers::pi / 180.0};
    EXPECT_GT(test::smallest_clearance(controller, robot, room, 3000), hal::epuck::kind().body.radius_m) << degrees;
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

TEST(DiffusionPlugin, LoadsAndSteersThroughItsTable) {
  hal::PluginLoader loader({std::string(test::kBuildDir) + "/lib"});
  const auto type = loader.controller("epuck_diffusion", "epuck_diffusion");
  ASSERT_TRUE(type.ok()) << type.error().message;
  test::NumberNotes visitor;
  const auto params = type.value()->read_params(visitor);
  EXPECT_EQ(visitor.notes.size(), 3U);
  EXPECT_LE(type.value()->size, 64U) << "a robot's controller fits one cache line";

  TestRobot robot;
  void* memory = ::operator new (type.value()->size, std::align_val_t{type.value()->align});
  type.value()->construct(memory, robot, params.get());
  robot.see(kLeft, 0.5);
  const std::uint8_t running = 0;
  hal::StepFault fault;
  EXPECT_EQ(type.value()->step_row(static_cast<std::byte*>(memory), type.value()->size, 0, 1, &running, fault), 1U);
  EXPECT_EQ(robot.wheels.left_m_s, 0.05);
  EXPECT_EQ(robot.wheels.right_m_s, 0.0);
  type.value()->destroy(memory);
  ::operator delete (memory, std::align_val_t{type.value()->align});
}

TEST(DiffusionPlugin, RefusesARobotWithoutWheels) {
  TestRobot robot(hal::epuck::kind(), false);
  EXPECT_THROW(EpuckDiffusion(robot, {}), hal::DeviceError);
}

TEST(DiffusionPlugin, SeesNoWorld) {
  test::expect_no_world_in(std::string(test::kBuildDir) + "/lib/libepuck_diffusion.so");
}

}  // namespace
}  // namespace tandem
