// Robots that fly, in a whole world: commands, place, and what robots see and hear of one another at their heights.
#include "hal/device/flight.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "core/space/stores.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/eyebot.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::core {
namespace {

const double kRadius_m = hal::eyebot::kind().body.radius_m;
constexpr double kRing_m = 0.255;  // of the proximity sensors

/// An arena 8 m x 8 m x 6 m of particle3d alone, or with kinematics2d for robots on the ground.
Scene air(bool ground_engine = false, const std::string& controller = "drive") {
  Scene s(8.0, controller);
  s.scenario.arena_size[2] = 6.0;
  s.scenario.arena_center[2] = 3.0;
  s.engine("particle3d");
  if (ground_engine) s.engine("kinematics2d");
  return s;
}

MadeWorld made(const Scene& scene, const WorldOptions& options = {}) {
  auto world = make(scene, options);
  EXPECT_TRUE(world.world) << world.all_problems();
  return world;
}

Pose pose(const MadeWorld& world, const std::string& id) {
  const Space& space = world.world->space();
  return space.pose(space.find_robot(id));
}

template <class Port>
Port port(const MadeWorld& world, const std::string& id) {
  const Space& space = world.world->space();
  const auto* found = space.port<Port>(space.find_robot(id));
  EXPECT_NE(found, nullptr) << id;
  return *found;
}

void steps(const MadeWorld& world, int count) {
  for (int i = 0; i < count; ++i) world.world->step();
}

Element::Attribute value(const std::string& name, const std::string& text) {
  return {name, text, 0};
}

// --- commands ---

TEST(Flight, AroundASquareAndBack) {
  auto world = made(air().pilot("fly_square").flyer("e", -1, -1, 0));
  const double corners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  bool seen[4] = {};
  for (int tick = 0; tick < 300; ++tick) {
    world->step();
    const Pose at = pose(world, "e");
    for (int k = 0; k < 4; ++k) {
      if (std::hypot(at.x_m - corners[k][0], at.y_m - corners[k][1], at.z_m - 1.5) < 0.05 && (k == 0 || seen[k - 1]))
        seen[k] = true;
    }
    // A corner counts from 5 cm before it: it is cut while braking goes on, less than 5 cm behind it.
    ASSERT_LT(std::max(std::fabs(at.x_m), std::fabs(at.y_m)), 1.05) << "overshot in tick " << tick;
    ASSERT_LT(at.z_m, 1.55);
  }
  EXPECT_TRUE(seen[0] && seen[1] && seen[2] && seen[3]);
  const Pose end = pose(world, "e");
  EXPECT_NEAR(end.x_m, -1.0, 1e-3);
  EXPECT_NEAR(end.y_m, -1.0, 1e-3);
  EXPECT_NEAR(end.z_m, 1.5, 1e-3);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  const auto place = port<hal::Positioning>(world, "e");
  EXPECT_EQ(place.p_WB, (std::array<double, 3>{end.x_m, end.y_m, end.z_m}));
  EXPECT_EQ(place.validity, hal::Validity::Fresh);
}

TEST(Flight, APositionGoesBeforeASpeedAndWhatIsNoNumberHovers) {
  auto world = made(air().pilot("fly_both").flyer("e", 0, 0, 1));
  steps(world, 11);
  const Pose there = pose(world, "e");
  EXPECT_GT(there.x_m, 0.3);
  EXPECT_NEAR(there.y_m, 0.0, 1e-12);
  EXPECT_NEAR(there.heading_rad(), 0.5, 1e-9);
  steps(world, 10);  // on hold: the speed counts
  EXPECT_GT(pose(world, "e").y_m, 0.3);
  EXPECT_EQ(world->incidents().commands_not_finite, 1U);
  ASSERT_EQ(world->incidents().first().size(), 1U);
  EXPECT_EQ(
      world->incidents().first()[0],
      "controller of robot 'e' commanded a flight that is not a finite number at tick 20: it hovers for this tick");
  steps(world, 1);
  EXPECT_EQ(world->incidents().commands_not_finite, 2U);
  steps(world, 1);
  EXPECT_EQ(world->incidents().commands_clamped, 1U);
  const auto speed = port<hal::QuadrotorSpeed>(world, "e");
  EXPECT_NEAR(std::hypot(speed.velocity[1], speed.velocity[2]), hal::eyebot::kind().flight()->max_speed_m_s, 1e-12);
  EXPECT_EQ(speed.yaw_rad_s, hal::eyebot::kind().flight()->max_turn_rad_s);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST(Flight, APilotThatThrowsLeavesItsRobotHovering) {
  auto world = made(air()
                        .pilot("fly", {value("velocity", "0.5,0,0"), value("turn", "0.4"), value("throw_at", "9")})
                        .flyer("e", 0, 0, 2));
  steps(world, 30);
  EXPECT_EQ(world->incidents().controllers_thrown, 1U);
  const Pose at = pose(world, "e");
  EXPECT_NEAR(at.x_m, 0.42, 0.05);
  EXPECT_NEAR(at.z_m, 2.0, 1e-12);
  steps(world, 20);
  EXPECT_EQ(pose(world, "e").x_m, at.x_m);
  EXPECT_EQ(pose(world, "e").cos_h, at.cos_h);
}

TEST(Flight, NeedsAnEngineOfThreeDimensions) {
  Scene s(4.0);
  s.pilot("fly").flyer("e", 0, 0, 1);
  auto world = make(s);
  EXPECT_EQ(world.world, nullptr);
  EXPECT_NE(world.all_problems().find("robot 'e'"), std::string::npos) << world.all_problems();
  EXPECT_NE(world.all_problems().find("particle3d"), std::string::npos) << world.all_problems();
}

TEST(Flight, AWheeledRobotHasNoFlightDevices) {
  Scene s = air();
  s.pilot("fly");
  RobotItem item;
  item.kind = "e-puck";
  item.id = "a";
  item.controller = 1;
  s.scenario.robots.push_back(item);
  auto world = make(s);
  EXPECT_EQ(world.world, nullptr);
  EXPECT_NE(world.all_problems().find("'quadrotor_speed'"), std::string::npos) << world.all_problems();
}

TEST(Flight, NoisyDevicesScatterAroundTheTruth) {
  Scene s = air();
  s.pilot("fly", {value("velocity", "0,0,0")}, "noisy");
  for (int i = 0; i < 16; ++i) s.flyer("e" + std::to_string(i), -3 + 2 * (i % 4), -3 + 2 * (i / 4), 2);
  auto world = made(s);
  double place_m2 = 0.0;
  double speed_m2 = 0.0;
  double mean_m = 0.0;
  int count = 0;
  for (int tick = 0; tick < 100; ++tick) {
    world->step();
    for (int i = 0; i < 16; ++i) {
      const std::string id = "e" + std::to_string(i);
      const Pose at = pose(world, id);
      const auto place = port<hal::Positioning>(world, id);
      const double off[3] = {place.p_WB[0] - at.x_m, place.p_WB[1] - at.y_m, place.p_WB[2] - at.z_m};
      for (const double o : off) {
        ASSERT_LE(std::fabs(o), 0.01);
        place_m2 += o * o;
        mean_m += o;
      }
      const auto& q = place.q_WB;
      ASSERT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1.0, 1e-12);
      ASSERT_LE(2.0 * std::acos(std::min(1.0, q[0])), 0.0101);
      const SpaceStores& stores = world->space().stores();
      const auto& v = stores.bodies.motion[stores.row_of(world->space().find_robot(id))].v_m_s;
      speed_m2 += tick > 0 ? v[0] * v[0] + v[1] * v[1] + v[2] * v[2] : 0.0;
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(place_m2 / (3.0 * count)), 0.01 / std::sqrt(3.0), 2e-4);  // uniform
  EXPECT_NEAR(mean_m / (3.0 * count), 0.0, 3e-4);
  EXPECT_NEAR(std::sqrt(speed_m2 / (3.0 * count)), 0.02, 2e-3);  // the commanded error is reached within the tick
}

// --- sensing ---

TEST(FlightSensing, RaysMeetWhatStandsAtTheirHeight) {
  // All 0.8 m apart along x: rays of 7.5 degrees to the left and to the right of forward see a disc ahead.
  Scene s = air();
  s.pilot("fly");
  s.flyer("low", -2, 0, 1.0).flyer("low2", -1.2, 0, 1.1);  // each ring faces the other's body
  s.flyer("high", 1, 0, 1.0).flyer("high2", 1.8, 0, 2.5);  // one far above the other
  auto world = made(s);
  steps(world, 2);
  const auto low = port<hal::Proximity>(world, "low");
  const double angle = 7.5 / 180.0 * std::numbers::pi;
  // Law of cosines from the body's middle along a ray that starts at its rim.
  const double along =
      0.8 * std::cos(angle) - std::sqrt(kRadius_m * kRadius_m - std::pow(0.8 * std::sin(angle), 2)) - kRing_m;
  EXPECT_NEAR(static_cast<double>(low.distance_m[0]), along, 1e-5);
  EXPECT_NEAR(static_cast<double>(low.distance_m[23]), along, 1e-5);
  EXPECT_NEAR(static_cast<double>(port<hal::Proximity>(world, "low2").distance_m[11]), along, 1e-5);
  for (const std::size_t ray : {0U, 23U}) EXPECT_EQ(port<hal::Proximity>(world, "high").distance_m[ray], 3.0F);
  for (const std::size_t ray : {11U, 12U}) EXPECT_EQ(port<hal::Proximity>(world, "high2").distance_m[ray], 3.0F);
}

TEST(FlightSensing, RaysMeetObjectsAtTheirHeight) {
  Scene s = air();
  s.box(1.0, 0, 0.2, 2.0, 0.0, 1.0).pilot("fly").flyer("below", 0, 0, 0.5).flyer("above", 0, 0, 1.5);
  auto world = made(s);
  steps(world, 2);
  const double along = 0.9 / std::cos(7.5 / 180.0 * std::numbers::pi) - kRing_m;
  EXPECT_NEAR(static_cast<double>(port<hal::Proximity>(world, "below").distance_m[0]), along, 1e-5);
  EXPECT_EQ(port<hal::Proximity>(world, "above").distance_m[0], 3.0F);
}

TEST(FlightSensing, RobotsOnTheGroundSeeThoseThatStandThere) {
  for (const bool ground_engine : {false, true}) {
    Scene s = air(ground_engine, "everything");
    s.robot("a", -0.3, 0).robot("b", 1.7, 0).pilot("fly").flyer("lands", 0, 0, 0.0).flyer("flies", 2, 0, 0.2);
    auto world = made(s);
    steps(world, 2);
    EXPECT_LT(port<hal::Proximity>(world, "a").distance_m[0], 0.05F) << ground_engine;
    EXPECT_EQ(port<hal::Proximity>(world, "b").distance_m[0], 0.1F) << ground_engine;
    // Its rays pass high above robots on the ground.
    for (const float d : port<hal::Proximity>(world, "flies").distance_m) EXPECT_GT(d, 1.0F);
  }
}

TEST(FlightSensing, MessagesTellDistanceAndElevation) {
  Scene s = air();
  s.pilot("fly").flyer("e", 0, 0, 2, 0.5).flyer("up", 0.9, 0, 3.2).flyer("far", -2.5, 0, 4.0);
  auto world = made(s);
  steps(world, 3);
  const auto heard = port<hal::RangeAndBearing>(world, "e");
  ASSERT_EQ(heard.count, 1U);  // 3.2 m to the one far off, 2.5 m seen from above
  EXPECT_NEAR(static_cast<double>(heard.range_m[0]), 1.5, 1e-6);
  EXPECT_NEAR(static_cast<double>(heard.bearing_rad[0]), -0.5, 1e-6);
  EXPECT_NEAR(static_cast<double>(heard.elevation_rad[0]), std::atan2(1.2, 0.9), 1e-6);
  EXPECT_EQ(heard.message(0)[0], 42);
}

TEST(FlightSensing, RobotsOnTheGroundAndInTheAirHearOneAnother) {
  Scene s = air(true, "everything");
  s.robot("a", 0.3, 0)
      .pilot("fly")
      .flyer("e", 0, 0,
             0.4 - hal::eyebot::kind().part<hal::RangeAndBearingPart>()->height_m + hal::epuck::kind().body.height_m);
  auto world = made(s);
  steps(world, 3);
  const auto above = port<hal::RangeAndBearing>(world, "a");
  ASSERT_EQ(above.count, 1U);
  EXPECT_NEAR(static_cast<double>(above.range_m[0]), 0.5, 1e-6);
  EXPECT_NEAR(static_cast<double>(above.elevation_rad[0]), std::atan2(0.4, 0.3), 1e-6);
  const auto below = port<hal::RangeAndBearing>(world, "e");
  ASSERT_EQ(below.count, 1U);
  EXPECT_NEAR(static_cast<double>(below.elevation_rad[0]), -std::atan2(0.4, 0.3), 1e-6);
}

TEST(FlightSensing, LampsAreSeenFromWhereTheSensorIs) {
  Scene s = air();
  LightItem lamp;
  lamp.id = "lamp";
  lamp.p_W = {2.0, 0.0, 3.0};
  lamp.intensity = 1.0;
  s.scenario.lights.push_back(lamp);
  constexpr double kSensor_m = 0.1635;  // above the base; 25.5 cm from the axis, at 7.5 degrees [ARGoS 3]
  s.pilot("fly").flyer("near", 0, 0, 3.0 - kSensor_m).flyer("far", 0, 0, 1.0 - kSensor_m);
  auto world = made(s);
  steps(world, 2);
  const double bearing_rad = 7.5 / 180.0 * std::numbers::pi;
  const double ahead_m = 2.0 - 0.255 * std::cos(bearing_rad);
  const double aside_m = 0.255 * std::sin(bearing_rad);
  const double flat2_m2 = ahead_m * ahead_m + aside_m * aside_m;
  const double facing = std::cos(bearing_rad + std::atan(aside_m / ahead_m));
  EXPECT_NEAR(static_cast<double>(port<hal::Light>(world, "near").level[0]), facing / flat2_m2, 1e-5);
  EXPECT_NEAR(static_cast<double>(port<hal::Light>(world, "far").level[0]), facing / (flat2_m2 + 4.0), 1e-5);
}

TEST(FlightSensing, BatteriesRunDownWithTheWayFlown) {
  Scene s = air();
  s.pilot("fly", {value("velocity", "0.5,0,0"), value("turn", "0.4")}).flyer("e", -1, 0, 1);
  BatteryConfig& battery = s.scenario.robots.back().battery;
  battery.model = "motion";
  battery.pos_delta = 0.1;
  battery.orient_delta = 0.05;
  auto world = made(s);
  steps(world, 1);
  const double full = static_cast<double>(port<hal::Battery>(world, "e").charge);
  steps(world, 40);
  // 0.5 m/s but for the first ticks, 0.4 rad/s.
  EXPECT_NEAR(full - static_cast<double>(port<hal::Battery>(world, "e").charge), 0.1 * 0.5 * 4.0 + 0.05 * 0.4 * 4.0,
              0.006);
}

// --- beside others ---

TEST(Air, OverAGroundEngineLeavesRobotsOnTheGroundAlone) {
  auto with = made(air(true).robot("a", -0.5, 0).wheels(0.1, 0.1).pilot("fly").flyer("e", 0, 0, 0.5));
  auto without = made(air(true).robot("a", -0.5, 0).wheels(0.1, 0.1));
  for (int i = 0; i < 100; ++i) {
    with->step();
    without->step();
    ASSERT_EQ(pose(with, "a").x_m, pose(without, "a").x_m) << i;
  }
  EXPECT_GT(pose(with, "a").x_m, 0.45);
  EXPECT_EQ(pose(with, "e").z_m, 0.5);
}

TEST(Air, WhatStandsOnTheGroundIsInTheWayThere) {
  auto world = made(air(true).robot("a", -0.5, 0).wheels(0.1, 0.1).pilot("fly").flyer("e", 0, 0, 0.0));
  for (int i = 0; i < 100; ++i) {
    world->step();
    const Pose a = pose(world, "a");
    ASSERT_GT(std::hypot(a.x_m, a.y_m), kRadius_m + hal::epuck::kind().body.radius_m - 1e-3) << i;
  }
}

TEST(Air, GivesTheSameBitsForAnyNumberOfThreads) {
  std::uint64_t first = 0;
  for (const std::int64_t threads : {1, 2, 4}) {
    Scene s = air(true, "epuck_diffusion");
    s.scenario.controllers[0].library = "epuck_diffusion";
    s.scenario.engines[0].regions = "2x2";
    s.scenario.engines[0].options.attributes.push_back({"regions", "2x2", 100});
    s.walls().robots(60, 3.5).pilot("fly", {value("velocity", "0.3,0.2,0"), value("turn", "0.4")}, "noisy");
    for (int i = 0; i < 25; ++i)
      s.flyer("e" + std::to_string(i), -2 + (i % 5) * 0.8, -2 + (i / 5) * 0.8, 1.0 + 0.1 * i);
    WorldOptions options;
    options.threads = threads;
    auto world = made(s, options);
    steps(world, 60);
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    if (threads == 1) first = world->state_hash();
    EXPECT_EQ(world->state_hash(), first) << threads;
  }
}

}  // namespace
}  // namespace tandem::core
