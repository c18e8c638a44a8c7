// What an eye-bot's flight commands do, in every way in which an engine flies robots: places, leans, and tasks.
#include <cmath>
#include <gtest/gtest.h>

#include "hal/device/body_sensors.hpp"
#include "tests/core/eyebots.hpp"

namespace tandem::core {
namespace {

using hal::FlightOrder;
using hal::FlightPhase;

const double kHeight_m = hal::eyebot::kind().body.height_m;
constexpr double kGravity_m_s2 = 9.81;

class EyeBotFlight : public testing::TestWithParam<std::string> {
 protected:
  static MadeWorld made(const Scene& scene, const WorldOptions& options = {}) {
    auto world = make(scene, options);
    EXPECT_TRUE(world.world) << world.all_problems();
    if (world.world) world->start();
    return world;
  }
  MadeWorld one(double z_m, double heading_rad = 0.0) const {
    return made(eyebot_scene(GetParam()).flyer("e", 0.0, 0.0, z_m, heading_rad));
  }
  bool exact() const { return GetParam().ends_with("exact"); }
};

FlightPhase phase(const MadeWorld& world) {
  return reading<hal::FlightState>(world, "e").phase;
}
void order(const MadeWorld& world, FlightOrder what, double speed_m_s = 0.0) {
  command<hal::FlightTask>(world, "e") = {{}, what, speed_m_s};
}
/// Steps until the robot is in this phase. @returns the seconds that it took; negative: more than `most_s`.
double until(const MadeWorld& world, FlightPhase wanted, double most_s) {
  for (int i = 1; i <= static_cast<int>(50.0 * most_s); ++i) {
    world->step();
    if (phase(world) == wanted) return i / 50.0;
  }
  return -1.0;
}

TEST_P(EyeBotFlight, ReachesAPlaceAndStaysThere) {
  auto world = one(1.0, 0.3);
  command<hal::QuadrotorPosition>(world, "e").set(2.0, -1.0, 1.6, -1.2);
  double farthest_m = 0.0;
  for (int i = 0; i < 500; ++i) {
    world->step();
    const Pose at = pose_of(world, "e");
    farthest_m = std::max(farthest_m, (2.0 * at.x_m - at.y_m) / std::sqrt(5.0));
  }
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  EXPECT_LT(farthest_m, std::sqrt(5.0) + 0.1) << "overshot";
  for (int i = 0; i < 100; ++i) {
    world->step();
    const Pose at = pose_of(world, "e");
    ASSERT_NEAR(at.x_m, 2.0, 0.01);
    ASSERT_NEAR(at.y_m, -1.0, 0.01);
    ASSERT_NEAR(at.z_m, 1.6, 0.01);
    ASSERT_NEAR(at.heading_rad(), -1.2, 0.01);
  }
  EXPECT_EQ(phase(world), FlightPhase::Flying);
}

TEST_P(EyeBotFlight, AThrustOfItsWeightHoversAndALeanAccelerates) {
  auto world = one(1.5, 0.6);
  command<hal::QuadrotorAttitude>(world, "e").set(0.0, 0.0, 0.0, 1.0);
  steps(world, 50);
  EXPECT_NEAR(pose_of(world, "e").z_m, 1.5, 1e-6);
  // Leaning forward by 0.1: ahead by tan(0.1) of gravity while the thrust holds the height.
  command<hal::QuadrotorAttitude>(world, "e").set(0.0, 0.1, 0.0, 1.0 / std::cos(0.1));
  steps(world, 25);
  const Pose at = pose_of(world, "e");
  const double ahead_m = std::cos(0.6) * at.x_m + std::sin(0.6) * at.y_m;
  const double closed_m = 0.5 * kGravity_m_s2 * std::tan(0.1) * 0.5 * 0.5;
  // Drag takes up to a tenth; rotors need a tenth of a second to lean.
  EXPECT_GT(ahead_m, GetParam() == "dynamics3d_rotors" ? 0.4 * closed_m : 0.85 * closed_m);
  EXPECT_LT(ahead_m, 1.1 * closed_m);
  EXPECT_NEAR(-std::sin(0.6) * at.x_m + std::cos(0.6) * at.y_m, 0.0, 1e-3);
  EXPECT_NEAR(at.z_m, 1.5, 0.01);
  // To the right it moves to the right, and turns as told.
  command<hal::QuadrotorAttitude>(world, "e").release();
  steps(world, 150);
  const Pose before = pose_of(world, "e");
  command<hal::QuadrotorAttitude>(world, "e").set(0.1, 0.0, 0.5, 1.0 / std::cos(0.1));
  steps(world, 15);
  const Pose after = pose_of(world, "e");
  EXPECT_LT(-before.sin_h * (after.x_m - before.x_m) + before.cos_h * (after.y_m - before.y_m), -0.003);
  steps(world, 10);
  EXPECT_NEAR(reading<hal::FlightState>(world, "e").yaw_rad_s, 0.5, 0.05);
}

TEST_P(EyeBotFlight, TheStrongestThrustRises) {
  auto world = one(0.2);
  command<hal::QuadrotorAttitude>(world, "e").set(0.0, 0.0, 0.0, 5.0);  // it has 2
  steps(world, 15);
  EXPECT_EQ(world->incidents().commands_clamped, 1U);
  EXPECT_EQ(command<hal::QuadrotorAttitude>(world, "e").thrust, hal::eyebot::kind().flight()->max_thrust);
  const double most_m = 0.5 * kGravity_m_s2 * 0.3 * 0.3;
  EXPECT_GT(pose_of(world, "e").z_m - 0.2, 0.4 * most_m);
  EXPECT_LT(pose_of(world, "e").z_m - 0.2, 1.1 * most_m);
}

TEST_P(EyeBotFlight, StandsUntilItIsToTakeOff) {
  auto world = one(0.0);
  command<hal::QuadrotorSpeed>(world, "e").set(0.5, 0.0, 0.5, 0.0);
  steps(world, 50);
  EXPECT_EQ(phase(world), FlightPhase::Landed);
  EXPECT_NEAR(pose_of(world, "e").x_m, 0.0, 1e-3);
  EXPECT_NEAR(pose_of(world, "e").z_m, 0.0, 1e-3);
}

TEST_P(EyeBotFlight, TakesOffHoversFliesAndLands) {
  auto world = one(0.0, 0.4);
  order(world, FlightOrder::TakeOff);
  world->step();
  EXPECT_EQ(phase(world), FlightPhase::TakingOff);
  const double rise_s = until(world, FlightPhase::Hovering, 5.0);
  EXPECT_GT(rise_s, 1.0 / hal::eyebot::kind().flight()->climb_m_s - 0.1);
  EXPECT_LT(rise_s, 1.0 / hal::eyebot::kind().flight()->climb_m_s + 1.2);
  steps(world, 100);
  EXPECT_NEAR(pose_of(world, "e").z_m, 1.0, 0.03);
  EXPECT_NEAR(pose_of(world, "e").x_m, 0.0, 0.02);
  EXPECT_NEAR(pose_of(world, "e").heading_rad(), 0.4, 0.02);
  // The order stands: other commands do not count.
  command<hal::QuadrotorSpeed>(world, "e").set(0.5, 0.0, 0.0, 0.0);
  steps(world, 50);
  EXPECT_NEAR(pose_of(world, "e").x_m, 0.0, 0.02);
  order(world, FlightOrder::Fly);
  steps(world, 50);
  EXPECT_EQ(phase(world), FlightPhase::Flying);
  EXPECT_GT(pose_of(world, "e").x_m, 0.2);
  order(world, FlightOrder::Land, 0.5);
  world->step();
  EXPECT_EQ(phase(world), FlightPhase::Landing);
  const double sink_s = until(world, FlightPhase::Landed, 8.0);
  EXPECT_GT(sink_s, 1.8);
  EXPECT_LT(sink_s, 4.5);
  steps(world, 25);
  const Pose down = pose_of(world, "e");
  EXPECT_NEAR(down.z_m, 0.0, 2e-3);
  order(world, FlightOrder::Fly);  // on the ground: stays there
  steps(world, 50);
  EXPECT_EQ(phase(world), FlightPhase::Landed);
  EXPECT_NEAR(pose_of(world, "e").x_m, down.x_m, 1e-3);
  order(world, FlightOrder::TakeOff);
  EXPECT_GT(until(world, FlightPhase::Hovering, 5.0), 0.0);
}

TEST_P(EyeBotFlight, LandsOnWhatIsBeneath) {
  Scene scene = eyebot_scene(GetParam());
  scene.box(0.0, 0.0, 1.0, 1.0, 0.0, 0.4).flyer("e", 0.0, 0.0, 1.0);
  auto world = made(scene);
  world->step();
  EXPECT_EQ(phase(world), FlightPhase::Hovering);
  order(world, FlightOrder::Land);
  ASSERT_GT(until(world, FlightPhase::Landed, 6.0), 0.0);
  steps(world, 50);
  EXPECT_NEAR(pose_of(world, "e").z_m, 0.4, 3e-3);
  EXPECT_EQ(phase(world), FlightPhase::Landed);
  order(world, FlightOrder::TakeOff);
  ASSERT_GT(until(world, FlightPhase::Hovering, 6.0), 0.0);
  EXPECT_NEAR(pose_of(world, "e").z_m, 1.4, 0.05);
}

TEST_P(EyeBotFlight, HoldsOnToTheCeilingAndLetsGo) {
  auto world = one(1.0, 0.7);
  command<hal::QuadrotorSpeed>(world, "e").set(0.3, 0.0, 0.0, 0.0);
  steps(world, 5);
  order(world, FlightOrder::Attach);
  world->step();
  EXPECT_EQ(phase(world), FlightPhase::Attaching);
  ASSERT_GT(until(world, FlightPhase::Attached, 6.0), 0.0);
  steps(world, 2);
  const Pose there = pose_of(world, "e");
  EXPECT_NEAR(there.z_m + kHeight_m, 3.0, 0.021);
  EXPECT_LE(reading<hal::Altimeter>(world, "e").ceiling_m, 0.021F);
  // It stays, whatever it is told, until it is to let go.
  for (const FlightOrder other : {FlightOrder::Fly, FlightOrder::Land, FlightOrder::TakeOff}) {
    order(world, other);
    steps(world, 25);
    EXPECT_EQ(phase(world), FlightPhase::Attached);
    EXPECT_EQ(pose_of(world, "e").x_m, there.x_m);
    EXPECT_EQ(pose_of(world, "e").z_m, there.z_m);
  }
  EXPECT_EQ(reading<hal::FlightState>(world, "e").velocity, (std::array<double, 3>{}));
  order(world, FlightOrder::Detach);
  world->step();
  EXPECT_EQ(phase(world), FlightPhase::Detaching);
  ASSERT_GT(until(world, FlightPhase::Hovering, 6.0), 0.0);
  steps(world, 100);
  EXPECT_NEAR(pose_of(world, "e").z_m, there.z_m - 0.3, 0.03);
}

TEST_P(EyeBotFlight, WithoutACeilingItHovers) {
  Scene scene = eyebot_scene(GetParam());
  scene.scenario.arena_size[2] = 0.0;
  auto world = made(scene.flyer("e", 0.0, 0.0, 1.0));
  order(world, FlightOrder::Attach);
  steps(world, 100);
  EXPECT_EQ(phase(world), FlightPhase::Hovering);
  EXPECT_NEAR(pose_of(world, "e").z_m, 1.0, 0.01);
  EXPECT_LT(reading<hal::Altimeter>(world, "e").ceiling_m, 0.0F);
  EXPECT_NEAR(static_cast<double>(reading<hal::Altimeter>(world, "e").ground_m), 1.0, 0.02);
}

TEST_P(EyeBotFlight, WhatHangsAtTheCeilingIsNotPushed) {
  Scene scene = eyebot_scene(GetParam());
  scene.flyer("e", 0.0, 0.0, 3.0 - kHeight_m - 0.1).flyer("other", -1.0, 0.1, 2.2);
  auto world = made(scene);
  order(world, FlightOrder::Attach);
  ASSERT_GT(until(world, FlightPhase::Attached, 4.0), 0.0);
  const Pose there = pose_of(world, "e");
  command<hal::QuadrotorSpeed>(world, "other").set(0.5, 0.0, 0.0, 0.0);
  for (int i = 0; i < 200; ++i) {
    world->step();
    ASSERT_EQ(pose_of(world, "e").x_m, there.x_m);
    const Pose other = pose_of(world, "other");
    ASSERT_GT(std::hypot(other.x_m - there.x_m, other.y_m - there.y_m), 0.48) << i;
  }
  EXPECT_GT(pose_of(world, "other").x_m, -0.6) << "it came near";
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST_P(EyeBotFlight, GoesOnAlikeFromASnapshotOfATask) {
  for (const FlightOrder what : {FlightOrder::TakeOff, FlightOrder::Attach}) {
    auto world = one(what == FlightOrder::TakeOff ? 0.0 : 1.5);
    command<hal::PanTiltDrive>(world, "e").tilt_rad = 1.0;
    order(world, what);
    steps(world, 30);
    auto moment = world->snapshot();
    ASSERT_TRUE(moment.ok()) << moment.error().message;
    steps(world, 200);
    const std::uint64_t first = world->state_hash();
    ASSERT_TRUE(world->restore(moment.value()).ok());
    steps(world, 200);
    EXPECT_EQ(world->state_hash(), first);
    EXPECT_EQ(phase(world), what == FlightOrder::TakeOff ? FlightPhase::Hovering : FlightPhase::Attached);
  }
}

TEST_P(EyeBotFlight, AHaltedRobotHoversOrStays) {
  auto world = one(0.0);
  Space& space = world->space();
  order(world, FlightOrder::TakeOff);
  steps(world, 50);
  const double z_m = pose_of(world, "e").z_m;
  space.set_halted(space.find_robot("e"), true);
  steps(world, 100);
  EXPECT_EQ(phase(world), FlightPhase::Hovering);
  EXPECT_NEAR(pose_of(world, "e").z_m, z_m, 0.25);
  EXPECT_GT(pose_of(world, "e").z_m, 0.2);
  space.set_halted(space.find_robot("e"), false);
  order(world, FlightOrder::Land);
  ASSERT_GT(until(world, FlightPhase::Landed, 6.0), 0.0);
  space.set_halted(space.find_robot("e"), true);
  steps(world, 50);
  EXPECT_EQ(phase(world), FlightPhase::Landed);
}

INSTANTIATE_TEST_SUITE_P(Ways, EyeBotFlight, testing::ValuesIn(ways_to_fly()),
                         [](const auto& way) { return way.param; });

TEST(EyeBotFlightRotors, LeansWhereItIsToGo) {
  Scene scene = eyebot_scene("dynamics3d_rotors");
  auto world = make(scene.flyer("e", 0.0, 0.0, 1.0));
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  command<hal::QuadrotorSpeed>(world, "e").set(1.0, 0.0, 0.0, 0.0);
  double most = 0.0;
  for (int i = 0; i < 100; ++i) {
    world->step();
    const auto& q = reading<hal::Positioning>(world, "e").q_WB;
    most = std::max(most, 2.0 * (q[0] * q[2] - q[3] * q[1]));  // sine of the pitch
  }
  // 3 m/s^2 at the most: atan(3 / 9.81), and a little more on the way there.
  EXPECT_GT(most, 0.2);
  EXPECT_LT(most, 0.4);
  const auto& q = reading<hal::Positioning>(world, "e").q_WB;
  EXPECT_NEAR(2.0 * (q[0] * q[2] - q[3] * q[1]), 0.0, 0.02) << "level again at full speed";
  // At rest the gauge reads gravity upwards.
  command<hal::QuadrotorSpeed>(world, "e").set(0.0, 0.0, 0.0, 0.0);
  steps(world, 200);
  const auto& force = reading<hal::Accelerometer>(world, "e").force_m_s2;
  EXPECT_NEAR(force[0], 0.0F, 0.05F);
  EXPECT_NEAR(force[2], 9.81F, 0.05F);
}

}  // namespace
}  // namespace tandem::core
