#include "core/device/device.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::core {
namespace {

const double kR = hal::epuck::kind().body.radius_m;

template <class Port>
Port read(const MadeWorld& world, std::size_t robot = 0) {
  const auto* port = world->space().port<Port>(world->space().robot(robot));
  EXPECT_NE(port, nullptr);
  return *port;
}

MadeWorld stepped(const Scene& scene, int steps = 2) {
  auto world = make(scene);
  EXPECT_TRUE(world.world) << world.all_problems();
  run(*world.world, steps);
  return world;
}

/// Distance along one ray by bisection of the closed forms of disc and rectangle: slow, plain, and sharing no code with
/// the kernel.
double marched(const Scene& scene, std::size_t self, const Space& space, double bearing) {
  const Pose me = space.pose(space.robot(self));
  const double angle = std::atan2(me.sin_h, me.cos_h) + bearing;
  for (double t = 0.0; t < 0.1; t += 1e-5) {
    const double x = me.x_m + (kR + t) * std::cos(angle);
    const double y = me.y_m + (kR + t) * std::sin(angle);
    for (std::size_t j = 0; j < space.robot_count(); ++j) {
      const Pose other = space.pose(space.robot(j));
      if (j != self && std::hypot(x - other.x_m, y - other.y_m) <= kR) return t;
    }
    for (const ObjectItem& o : scene.scenario.objects) {
      const double rx = x - o.placement.p_W[0];
      const double ry = y - o.placement.p_W[1];
      if (o.shape == ShapeKind::Cylinder) {
        if (std::hypot(rx, ry) <= o.size[0]) return t;
        continue;
      }
      const double yaw = o.placement.yaw_rad;
      const double lx = rx * std::cos(yaw) + ry * std::sin(yaw);
      const double ly = -rx * std::sin(yaw) + ry * std::cos(yaw);
      if (std::fabs(lx) <= o.size[0] / 2 && std::fabs(ly) <= o.size[1] / 2) return t;
    }
  }
  return 0.1;
}

TEST(ProximitySensor, ReadsTheDistanceToTheNearestThingOnEveryRay) {
  Scene scene(1.2, "everything");
  scene.walls().box(0.1, 0.1, 0.1, 0.05, 0.7).cylinder(-0.2, -0.1, 0.05).robots(40, 0.48);
  auto world = stepped(scene);
  int seen = 0;
  for (std::size_t i = 0; i < world->space().robot_count(); ++i) {
    const auto port = read<hal::Proximity>(world, i);
    ASSERT_EQ(port.count, 8U);
    EXPECT_EQ(port.validity, hal::Validity::Fresh);
    for (std::size_t k = 0; k < 8; ++k) {
      const double expected =
          marched(scene, i, world->space(), hal::epuck::kind().part<hal::ProximityPart>()->mounts[k].bearing_rad);
      EXPECT_NEAR(static_cast<double>(port.distance_m[k]), expected, 2.5e-5) << "robot " << i << " sensor " << k;
      if (expected < 0.1) ++seen;
    }
  }
  EXPECT_GT(seen, 60);
}

/// Pairs of an e-puck and a foot-bot, whose rim is 90 mm before one of the e-puck's sensors: the centre of a body may
/// be farther away than anything as wide as the e-puck would be. They stand anyhow in the cells of the index.
TEST(ProximitySensor, SeesRobotsThatAreWiderThanItself) {
  constexpr std::size_t kLine = 12, kPairs = kLine * kLine;
  constexpr double kGap_m = 0.09, kApart_m = 0.613;
  const std::vector<hal::Mount>& mounts = hal::epuck::kind().part<hal::ProximityPart>()->mounts;
  Scene scene(8.0, "everything");
  scene.scenario.controllers.push_back({});
  scene.scenario.controllers.back().id = "idle";
  scene.scenario.controllers.back().label = "drive";
  scene.scenario.controllers.back().library = "test_controllers";
  scene.scenario.controllers.back().actuators = {{"differential_steering", "default", {}}};
  for (std::size_t i = 0; i < kPairs; ++i) {
    const double x_m = kApart_m * (static_cast<double>(i % kLine) - 5.5);
    const double y_m = kApart_m * (static_cast<double>(i / kLine) - 5.5);
    const double towards_rad = 2.4 * static_cast<double>(i);
    const double apart_m = kR + kGap_m + hal::footbot::kind().body.radius_m;
    scene.robot("ep" + std::to_string(i), x_m, y_m, towards_rad - mounts[i % mounts.size()].bearing_rad);
    scene.robot("fb" + std::to_string(i), x_m + apart_m * std::cos(towards_rad), y_m + apart_m * std::sin(towards_rad));
    scene.scenario.robots.back().kind = "foot-bot";
    scene.scenario.robots.back().controller = 1;
    scene.wheels(0.0, 0.0);
  }
  const auto world = stepped(scene);
  for (std::size_t i = 0; i < kPairs; ++i)
    EXPECT_NEAR(static_cast<double>(read<hal::Proximity>(world, 2 * i).distance_m[i % mounts.size()]), kGap_m, 1e-5)
        << "pair " << i;
}

/// The wall is no farther from the sensors than they see, and farther from the robot than a sensor at its rim would
/// see.
TEST(ProximitySensor, SeesFromWhereItSitsAlsoOnABoom) {
  constexpr double kBoom_m = 0.5, kGap_m = 0.08;
  Scene scene(8.0, "everything");
  for (std::size_t i = 0; i < 20; ++i) {
    const double x_m = -3.0 + 0.313 * static_cast<double>(i), y_m = -0.117 * static_cast<double>(i);
    scene.robot("ep" + std::to_string(i), x_m, y_m, M_PI / 2.0).cylinder(x_m, y_m + kBoom_m + kGap_m + 0.03, 0.03);
  }
  scene.parts([&](hal::RobotKind& kind) {
    for (hal::Mount& mount : kind.part<hal::ProximityPart>()->mounts) mount = {0.0, kBoom_m, 0.0, mount.z_m};
  });
  const auto world = stepped(scene);
  for (std::size_t i = 0; i < 20; ++i)
    EXPECT_NEAR(static_cast<double>(read<hal::Proximity>(world, i).distance_m[0]), kGap_m, 1e-5) << "robot " << i;
}

TEST(ProximitySensor, DoesNotSeeWhatIsLowerThanItself) {
  auto world = stepped(Scene(4, "everything").box(0.1, 0, 0.05, 1.0, 0.0, 0.01).robot("a", 0, 0));
  EXPECT_EQ(read<hal::Proximity>(world).distance_m[0], 0.1F);
}

TEST(ProximitySensor, NoiseIsBoundedAndCentred) {
  Scene scene(4, "everything");
  scene.box(0.09 + kR, 0, 0.1, 3.0).robot("a", 0, 0);
  scene.scenario.controllers[0].sensors[0].implementation = "noisy";
  scene.scenario.controllers[0].sensors[0].options.attributes = {{"noise_level", "0.1", 0}};
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  const double exact = (0.04 + kR) / std::cos(17.0 * M_PI / 180) - kR;
  double sum = 0.0;
  double most = 0.0;
  for (int i = 0; i < 2000; ++i) {
    world->step();
    const double error = static_cast<double>(read<hal::Proximity>(world).distance_m[0]) - exact;
    sum += error;
    most = std::max(most, std::fabs(error));
  }
  EXPECT_LE(most, 0.0101);
  EXPECT_GT(most, 0.0095);
  EXPECT_NEAR(sum / 2000, 0.0, 0.0004);
}

/// Of an e-puck's motor; 0.05 m/s are 388.2 a second, at which it makes 400.
const double kStep_m = 2.0 * M_PI * hal::epuck::kind().drive()->wheel_radius_m / 1000.0;

TEST(WheelDevices, EncodersCountWhatTheWheelsRolled) {
  auto world = stepped(Scene(4, "everything").param("left", "0.02").param("right", "-0.03").robot("a", 0, 0), 11);
  const auto encoders = read<hal::WheelEncoders>(world);
  EXPECT_NEAR(encoders.left_m, 0.02, 1e-12);
  EXPECT_NEAR(encoders.right_m, -0.03, 1e-12);
  EXPECT_FLOAT_EQ(encoders.left_m_s, 0.02F);
}

TEST(WheelDevices, BiasAndFactorChangeTheDrivenSpeed) {
  Scene scene(4, "drive");
  scene.param("left", "0.05").param("right", "0.05").robot("a", 0, 0);
  DeviceChoice& wheels = scene.scenario.controllers[0].actuators[0];
  wheels.implementation = "default";
  wheels.options.attributes = {
      {"factor_left", "1.2", 0}, {"factor_right", "1.2", 0}, {"bias_left", "1", 0}, {"bias_right", "1", 0}};
  auto world = stepped(scene, 11);
  EXPECT_NEAR(world->space().pose(world->space().robot(0)).x_m, 1.2 * (400 * kStep_m + 0.01), 1e-12);
}

TEST(WheelDevices, NoisyWheelsScatterAroundTheCommand) {
  Scene scene(40, "drive");
  scene.param("left", "0.05").param("right", "0.05").robots(1000, 15.0);
  scene.scenario.controllers[0].actuators[0].implementation = "noisy";
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 2);
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < 1000; ++i) {
    // One tick of motion, from the rolled distances.
    const SpaceStores& s = world->space().stores();
    const double relative = s.bodies.left_m[i] / (40 * kStep_m) - 1.0;
    sum += relative;
    squares += relative * relative;
  }
  EXPECT_NEAR(sum / 1000, 0.0, 0.006);
  EXPECT_NEAR(std::sqrt(squares / 1000), 0.05, 0.005);
}

/// How far a robot comes in a second.
double way_m(const std::string& kind, const std::string& implementation, double told_m_s) {
  Scene scene(4, "everything");
  scene.param("left", hal::format_number(told_m_s)).param("right", hal::format_number(told_m_s)).robot("a", 0, 0);
  scene.scenario.controllers[0].actuators.front().implementation = implementation;
  scene.scenario.robots[0].kind = kind;
  auto world = stepped(scene, 11);
  const double x_m = world->space().pose(world->space().robot(0)).x_m;
  EXPECT_NEAR(read<hal::WheelEncoders>(world).left_m, x_m, 1e-9) << told_m_s;
  return x_m;
}

/// Speeds in steps a second, as measured with the firmware of an e-puck: told, and turned.
TEST(Wheels, OfEpucksTurnInWholePeriodsOfTheirTimerAsRealOnesDo) {
  for (const auto& [told, turned] :
       {std::pair{900.0, 10000.0 / 11}, std::pair{700.0, 10000.0 / 14}, std::pair{600.0, 625.0},
        std::pair{667.0, 10000.0 / 14}, std::pair{1000.0, 1000.0}, std::pair{-388.0, -400.0}, std::pair{0.2, 0.0}}) {
    EXPECT_NEAR(way_m("e-puck", "default", told * kStep_m), turned * kStep_m, 1e-9) << told << " for 1 s";
    EXPECT_NEAR(way_m("e-puck", "ideal", told * kStep_m), told * kStep_m, 1e-9) << told;
    EXPECT_NEAR(way_m("e-puck2", "default", told * kStep_m), told * kStep_m, 1e-9) << told;
  }
}

TEST(LightSensor, FollowsTheSquareOfTheDistanceTheAngleAndTheShadow) {
  Scene scene(8, "everything");
  scene.robot("near", 0, 0).robot("shaded", 0, -2.0, M_PI / 2);
  scene.scenario.lights.push_back(
      {"lamp", {2.0, 0.0, hal::epuck::kind().part<hal::ProximityPart>()->mounts[0].z_m}, {255, 255, 255}, 1.0, {}, 0});
  scene.box(1.0, -1.0, 0.3, 0.3);
  auto world = stepped(scene);
  const auto light = read<hal::Light>(world);
  const hal::Mount mount = hal::epuck::kind().part<hal::LightPart>()->mounts[0];
  const double ahead_m = 2.0 - mount.x_m;
  const double off_rad = std::atan2(-mount.y_m, ahead_m) - mount.bearing_rad;
  EXPECT_NEAR(static_cast<double>(light.level[0]),
              1.0 / (ahead_m * ahead_m + mount.y_m * mount.y_m) * std::cos(off_rad), 1e-6);
  EXPECT_EQ(light.level[3], 0.0F);                                                    // looks away
  for (const float level : read<hal::Light>(world, 1).level) EXPECT_EQ(level, 0.0F);  // behind the box
}

TEST(LightSensor, MeasuresFromWhereItSits) {
  // At the distance of the lamp's intensity a sensor that faces it reads 1, be it ahead or behind.
  for (const std::size_t sensor : {std::size_t{0}, std::size_t{3}, std::size_t{5}}) {
    const hal::Mount mount = hal::epuck::kind().part<hal::LightPart>()->mounts[sensor];
    constexpr double kIntensity_m = 0.4;
    const double far_m = kIntensity_m * 1.0001;
    Scene scene(8, "everything");
    scene.robot("a", 0, 0);
    scene.scenario.lights.push_back(
        {"lamp",
         {mount.x_m + far_m * std::cos(mount.bearing_rad), mount.y_m + far_m * std::sin(mount.bearing_rad), mount.z_m},
         {255, 255, 255},
         kIntensity_m,
         {},
         0});
    auto world = stepped(scene, 1);
    EXPECT_NEAR(read<hal::Light>(world).level[sensor], 1.0F, 5e-4F) << sensor;
  }
}

TEST(GroundSensor, ReadsTheFloorThatAHookPaints) {
  Scene scene(4, "everything");
  scene.robot("east", 1, 0).robot("west", -1, 0).robot("edge", -0.03, 0);
  scene.field("floor", {{"source", "loop_functions", 5}});
  HookConfig hook;
  hook.library = "test_hooks";
  hook.label = "diary";
  hook.options.attributes = {{"path", "/dev/null", 0}};
  scene.scenario.hooks.push_back(hook);
  auto world = stepped(scene);
  EXPECT_EQ(read<hal::Ground>(world, 0).reflectance[1], 1.0F);
  EXPECT_EQ(read<hal::Ground>(world, 1).reflectance[1], 0.0F);
  EXPECT_EQ(read<hal::Ground>(world, 0).count, 3U);
}

TEST(BodySensors, ReadAccelerationSoundBatteryAndTime) {
  Scene scene(4, "everything");
  scene.param("left", "0.05").param("right", "0.05").robot("a", 0, 0);
  scene.scenario.sounds.push_back({"horn", {0.0, 0.1, 0.04}, 0.8, 0});
  scene.scenario.robots[0].battery.delta = 0.01;
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  world->step();
  EXPECT_NEAR(read<hal::Accelerometer>(world).force_m_s2[0], 0.0F, 1e-6F);
  world->step();
  EXPECT_NEAR(static_cast<double>(read<hal::Accelerometer>(world).force_m_s2[0]), 0.5,
              1e-6);  // 5 cm/s within a tenth of a second
  EXPECT_NEAR(static_cast<double>(read<hal::Accelerometer>(world).force_m_s2[2]), 9.81, 1e-6);
  world->step();
  EXPECT_NEAR(read<hal::Accelerometer>(world).force_m_s2[0], 0.0F, 1e-6F);
  const auto microphones = read<hal::Microphones>(world);
  EXPECT_GT(microphones.level[1], microphones.level[0]);  // the left one is nearer
  EXPECT_NEAR(static_cast<double>(read<hal::Battery>(world).charge), 0.97, 1e-6);
  EXPECT_EQ(read<hal::Clock>(world).tick, 2);
  EXPECT_EQ(read<hal::Clock>(world).now_ns, 200'000'000);
}

TEST(RangeAndBearing, TellsFromWhereAMessageCame) {
  Scene scene(8, "everything");
  scene.robot("a", 0, 0, M_PI / 2).robot("b", 0.5, 0).robot("far", 0.9, 1.0).robot("hidden", -0.5, 0);
  scene.box(-0.25, 0, 0.05, 0.3);
  auto world = stepped(scene);
  const auto heard = read<hal::RangeAndBearing>(world);
  ASSERT_EQ(heard.count, 1U);
  EXPECT_NEAR(static_cast<double>(heard.range_m[0]), 0.5, 1e-6);
  EXPECT_NEAR(static_cast<double>(heard.bearing_rad[0]), -M_PI / 2, 1e-6);  // on its right
  EXPECT_EQ(heard.size[0], 2U);                                             // the e-puck's board
  EXPECT_EQ(heard.message(0)[1], 2U);
}

TEST(RangeAndBearing, LosesTheAskedPartOfTheMessages) {
  Scene scene(8, "everything");
  scene.robot("a", 0, 0).robot("b", 0.5, 0);
  for (DeviceChoice& c : scene.scenario.controllers[0].sensors) {
    if (c.device == "range_and_bearing") c.options.attributes = {{"packet_drop_prob", "0.3", 0}};
  }
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  int heard = 0;
  for (int i = 0; i < 2001; ++i) {
    world->step();
    heard += static_cast<int>(read<hal::RangeAndBearing>(world).count);
  }
  EXPECT_NEAR(heard / 2000.0, 0.7, 0.04);
}

TEST(NoisyDevices, SendersFailAndClocksJitterAsAsked) {
  Scene scene(8, "everything");
  scene.robot("a", 0, 0).robot("b", 0.5, 0);
  scene.scenario.controllers[0].actuators.back().options.attributes = {{"failure_prob", "0.25", 0}};
  for (DeviceChoice& c : scene.scenario.controllers[0].sensors) {
    if (c.device == "clock") c.implementation = "noisy";
  }
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  int heard = 0;
  double squares = 0.0;
  for (int i = 0; i < 2001; ++i) {
    world->step();
    heard += static_cast<int>(read<hal::RangeAndBearing>(world).count);
    const auto clock = read<hal::Clock>(world);
    EXPECT_EQ(clock.tick, i);
    const double error_s = static_cast<double>(clock.now_ns - clock.taken_ns) * 1e-9;
    squares += error_s * error_s;
  }
  EXPECT_NEAR(heard / 2000.0, 0.75, 0.04);
  EXPECT_NEAR(std::sqrt(squares / 2001), 0.001, 0.0001);
}

TEST(Devices, EveryImplementationIsDocumentedAndStartsWithDefault) {
  std::string last;
  for (const DeviceType* type : test::catalog().all<DeviceType>()) {
    EXPECT_FALSE(type->summary.empty()) << type->device;
    EXPECT_NE(type->describe, nullptr);
    EXPECT_TRUE((type->make_sensor != nullptr) != (type->make_actuator != nullptr));
    EXPECT_NE(find_device(test::catalog(), type->device, type->role, "default"), nullptr) << type->device;
    EXPECT_NE(find_device(test::catalog(), type->device, type->role, "ideal"), nullptr) << type->device;
    ManualWriter manual;
    type->describe(manual);
  }
}

}  // namespace
}  // namespace tandem::core
