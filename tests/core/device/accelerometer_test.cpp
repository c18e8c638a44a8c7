// Accelerometers against closed forms, in every engine.
#include <cmath>
#include <gtest/gtest.h>

#include "hal/device/body_sensors.hpp"
#include "hal/device/flight.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/core/eyebots.hpp"
#include "tests/core/footbots.hpp"

namespace tandem::core {
namespace {

constexpr double kGravity_m_s2 = 9.81;

using Force = std::array<double, 3>;

Force force_on(const MadeWorld& world, const std::string& id = "fb") {
  const auto& port = reading<hal::Accelerometer>(world, id).force_m_s2;
  return {static_cast<double>(port[0]), static_cast<double>(port[1]), static_cast<double>(port[2])};
}

/// An e-puck where the engine lacks the joints that a foot-bot's gripper needs.
const hal::RobotKind& kind_in(const std::string& engine) {
  return test::engine_traits(engine).joints == 0 ? hal::epuck::kind() : hal::footbot::kind();
}

struct Wheels {
  double left_m_s, right_m_s;
};

/// A robot at (x, 0) that heads east and drives from its second tick on.
MadeWorld driven(const std::string& engine, std::int64_t per_second, Wheels wheels, double x_m = 0.0,
                 double wall_x_m = 0.0) {
  const bool footbot = &kind_in(engine) == &hal::footbot::kind();
  Scene scene = footbot ? footbot_scene(engine) : Scene(4.0, "everything");
  if (!footbot) scene.engine(engine);
  scene.scenario.ticks_per_second = per_second;
  if (wall_x_m > 0.0) scene.box(wall_x_m + 0.05, 0.0, 0.1, 2.0);
  scene.robot("fb", x_m, 0.0);
  if (footbot)
    scene.scenario.robots.back().kind = "foot-bot";
  else
    scene.wheels(wheels.left_m_s, wheels.right_m_s);
  MadeWorld world = make(scene);
  if (!world.world) throw std::runtime_error(world.all_problems());
  world->start();
  world->step();
  if (footbot) command<hal::WheelSpeeds>(world, "fb").set(wheels.left_m_s, wheels.right_m_s);
  return world;
}

class OnTheGround : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Accelerometer, OnTheGround, testing::Values("kinematics2d", "dynamics2d", "dynamics3d"));

TEST_P(OnTheGround, ReadsGravityAloneAtRestAndAtConstantSpeed) {
  for (const double speed_m_s : {0.0, 0.1}) {
    auto world = driven(GetParam(), 10, {speed_m_s, speed_m_s}, -1.0);
    steps(world, 20);
    const Force force = force_on(world);
    EXPECT_NEAR(force[0], 0.0, 1e-4) << speed_m_s;
    EXPECT_NEAR(force[1], 0.0, 1e-4) << speed_m_s;
    EXPECT_NEAR(force[2], kGravity_m_s2, 1e-4) << speed_m_s;
  }
}

TEST_P(OnTheGround, FeelsTheForceOfTheDriveAtAStart) {
  constexpr std::int64_t kPerSecond = 100;
  constexpr double kSpeed_m_s = 0.12;
  const hal::RobotKind& kind = kind_in(GetParam());
  const double acceleration_m_s2 = kind.drive()->force_N / kind.body.mass_kg;
  auto world = driven(GetParam(), kPerSecond, {kSpeed_m_s, kSpeed_m_s});
  double gained_m_s = 0.0;
  for (int i = 0; i < 100; ++i) {
    world->step();
    const double ahead = force_on(world)[0];
    gained_m_s += ahead / kPerSecond;
    const double by_force_m_s = acceleration_m_s2 * (i + 1) / kPerSecond;
    if (!test::engine_traits(GetParam()).forces || by_force_m_s > kSpeed_m_s) continue;
    ASSERT_NEAR(ahead, acceleration_m_s2, 0.01 * acceleration_m_s2) << i;
  }
  EXPECT_NEAR(gained_m_s, kSpeed_m_s, 1e-3 * kSpeed_m_s) << "what it feels adds up to its speed";
}

TEST_P(OnTheGround, FeelsAWallThatStopsIt) {
  for (const std::int64_t per_second : {10, 50}) {
    constexpr double kSpeed_m_s = 0.12;
    const double touch_m = 0.4 - kind_in(GetParam()).body.radius_m;
    auto world = driven(GetParam(), per_second, {kSpeed_m_s, kSpeed_m_s}, 0.0, 0.4);
    double lost_m_s = 0.0;
    double hardest_m_s2 = 0.0;
    for (int i = 0; i < 5 * per_second; ++i) {
      const bool near = pose_of(world, "fb").x_m > touch_m - 0.05;
      world->step();
      if (!near) continue;
      const double ahead = force_on(world)[0];
      lost_m_s -= ahead / static_cast<double>(per_second);
      hardest_m_s2 = std::min(hardest_m_s2, ahead);
    }
    EXPECT_NEAR(lost_m_s, kSpeed_m_s, 0.05 * kSpeed_m_s) << per_second;
    EXPECT_LT(hardest_m_s2, -0.45 * kSpeed_m_s * static_cast<double>(per_second)) << "within two ticks";
  }
}

TEST_P(OnTheGround, FeelsWhatKeepsItOnACircle) {
  for (const std::int64_t per_second : {10, 100}) {
    constexpr double kLeft_m_s = 0.04;
    constexpr double kRight_m_s = 0.12;
    auto world = driven(GetParam(), per_second, {kLeft_m_s, kRight_m_s});
    steps(world, static_cast<int>(3 * per_second));
    const double turn_rad_s = (kRight_m_s - kLeft_m_s) / kind_in(GetParam()).drive()->wheel_base_m;
    const double inward_m_s2 = 0.5 * (kLeft_m_s + kRight_m_s) * turn_rad_s;
    const Force force = force_on(world);
    EXPECT_NEAR(force[0], 0.0, 0.015 * inward_m_s2) << per_second;
    EXPECT_NEAR(force[1], inward_m_s2, 0.01 * inward_m_s2) << per_second;
    EXPECT_NEAR(force[2], kGravity_m_s2, 1e-4) << per_second;
  }
}

TEST_P(OnTheGround, ARobotThatIsLedByATrackerFeelsItsMotionToo) {
  auto world = driven(GetParam(), 10, {0.0, 0.0});
  Space& space = world->space();
  const RobotId robot = space.find_robot("fb");
  space.set_external(robot, true);
  constexpr double kAcceleration_m_s2 = 0.2;
  for (int i = 0; i <= 10; ++i) {
    const double t_s = 0.1 * i;
    space.set_pose(robot, {0.5 * kAcceleration_m_s2 * t_s * t_s, 0.0, 0.0, 1.0, 0.0});
    world->step();
    if (i < 3) continue;
    EXPECT_NEAR(force_on(world)[0], kAcceleration_m_s2, 1e-6) << i;
  }
}

TEST(Accelerometer, ReadsNothingInFreeFall) {
  for (const std::int64_t per_second : {10, 100}) {
    Scene scene = footbot_scene("dynamics3d");
    scene.scenario.ticks_per_second = per_second;
    add_footbot(scene, "fb", 0.0, 0.0, 0.5);
    scene.scenario.robots.back().placement.p_W[2] = 5.0;
    scene.scenario.arena_size[2] = 10.0;
    auto world = make(scene);
    ASSERT_TRUE(world.world) << world.all_problems();
    for (std::int64_t i = 0; i < per_second / 2; ++i) {
      world->step();
      for (const double axis : force_on(world)) ASSERT_NEAR(axis, 0.0, 1e-4) << i;
    }
    ASSERT_LT(pose_of(world, "fb").z_m, 4.0);
    steps(world, static_cast<int>(2 * per_second));
    EXPECT_NEAR(force_on(world)[2], kGravity_m_s2, 1e-4) << "on the floor";
  }
}

/// On the Moon: what it falls with is what it feels at rest.
TEST(Accelerometer, ReadsTheGravityOfItsEngine) {
  constexpr double kMoon_m_s2 = 1.62;
  Scene falling = Scene(4.0, "everything").engine("dynamics3d");
  Element gravity;
  gravity.name = "gravity";
  gravity.attributes = {{"g", "1.62", 0}};
  falling.scenario.engines.back().options.children.push_back(gravity);
  const Scene standing = Scene(4.0, "everything").engine("particle3d", "", {{"gravity", "1.62", 0}, {"drag", "0", 0}});
  for (Scene scene : {falling, standing}) {
    scene.robot("fb", 0.0, 0.0).wheels(0.0, 0.0);
    scene.scenario.robots.back().placement.p_W[2] = 1.0;
    auto world = make(scene);
    ASSERT_TRUE(world.world) << world.all_problems();
    steps(world, 5);
    EXPECT_NEAR(pose_of(world, "fb").z_m, 1.0 - 0.5 * kMoon_m_s2 * 0.25, 0.05) << "after half a second";
    for (const double axis : force_on(world)) EXPECT_NEAR(axis, 0.0, 1e-4) << "falling";
    steps(world, 30);
    EXPECT_NEAR(force_on(world)[2], kMoon_m_s2, 1e-4) << "on the floor";
  }
}

/// Rotors push along the body's axis alone, however it leans and speeds up.
TEST(Accelerometer, OfALeaningFlyerReadsItsThrustAlone) {
  Scene scene = eyebot_scene("dynamics3d_rotors");
  scene.scenario.ticks_per_second = 100;
  auto world = make(scene.flyer("e", 0, 0, 1.0, 0.7));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 20);
  command<hal::QuadrotorSpeed>(world, "e").set(0.8, 0.3, 0.0, 0.0);
  double most_lean = 0.0;
  for (int i = 0; i < 60; ++i) {
    world->step();
    const auto& q = world->space().stores().bodies.motion[0].q_WB;
    const double upright = 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]);
    most_lean = std::max(most_lean, std::acos(std::min(1.0, upright)));
    const Force force = force_on(world, "e");
    ASSERT_NEAR(force[0], 0.0, 0.03) << i;  // of up to 3 m/s^2 along the ground
    ASSERT_NEAR(force[1], 0.0, 0.03) << i;
    ASSERT_GT(force[2], 8.0) << i;
  }
  EXPECT_GT(most_lean, 0.1);
}

}  // namespace
}  // namespace tandem::core
