// What an e-puck2 has and an e-puck has not: gyroscope, time of flight, cliff sensors, selector.
#include "hal/robot/epuck2.hpp"

#include <cmath>
#include <gmock/gmock.h>

#include "hal/device/body_sensors.hpp"
#include "hal/device/cliff.hpp"
#include "hal/device/selector.hpp"
#include "hal/device/time_of_flight.hpp"
#include "hal/device/wheels.hpp"
#include "tests/core/footbots.hpp"

namespace tandem::core {
namespace {

using hal::Role;
using testing::HasSubstr;

const double kR = hal::epuck2::kind().body.radius_m;

void add_epuck2(Scene& scene, const std::string& id, double x_m, double y_m, double heading_rad = 0.0) {
  scene.robot(id, x_m, y_m, heading_rad);
  scene.scenario.robots.back().kind = "e-puck2";
}

Scene with_epuck2(const std::string& engine = "kinematics2d", double size_m = 10.0) {
  Scene scene(size_m, "epuck2_puppet");
  ControllerConfig& config = scene.scenario.controllers.back();
  config.sensors.clear();
  config.actuators = {{"differential_steering", "default", {}}};
  for (const char* name : {"gyroscope", "time_of_flight", "cliff", "selector"})
    config.sensors.push_back({name, "default", {}});
  scene.engine(engine);
  add_epuck2(scene, "ep", 0.0, 0.0);
  return scene;
}

MadeWorld made(const Scene& scene) {
  auto world = make(scene);
  EXPECT_TRUE(world.world) << world.all_problems();
  return world;
}

double ahead_m(const Scene& scene, const std::string& id = "ep") {
  const auto world = made(scene);
  steps(world, 2);
  const auto& port = reading<hal::TimeOfFlight>(world, id);
  EXPECT_EQ(port.validity, hal::Validity::Fresh);
  EXPECT_FLOAT_EQ(port.range_m, 2.0F);
  return static_cast<double>(port.distance_m);
}

TEST(TimeOfFlight, SeesRobotsWallsAndCylindersAheadInEveryEngine) {
  for (const std::string engine : {"kinematics2d", "dynamics2d", "dynamics3d"}) {
    Scene robot = with_epuck2(engine);
    add_epuck2(robot, "other", 1.0, 0.0);
    EXPECT_NEAR(ahead_m(robot), 1.0 - 2 * kR, 1e-3) << engine;
    EXPECT_NEAR(ahead_m(robot, "other"), 2.0, 1e-6) << "it looks away";
    EXPECT_NEAR(ahead_m(with_epuck2(engine).box(1.9, 0.0, 0.2, 4.0)), 1.8 - kR, 1e-3) << engine;
    EXPECT_NEAR(ahead_m(with_epuck2(engine).cylinder(0.5, 0.0, 0.1)), 0.4 - kR, 1e-3) << engine;
    EXPECT_NEAR(ahead_m(with_epuck2(engine)), 2.0, 1e-6) << engine;
  }
}

TEST(TimeOfFlight, SeesWhatIsInItsConeAndNothingBesideOrBeyond) {
  const double half_rad = 12.5 * std::acos(-1.0) / 180.0;
  const auto at = [](double bearing_rad, double distance_m) {
    Scene scene = with_epuck2();
    add_epuck2(scene, "other", kR + distance_m * std::cos(bearing_rad), distance_m * std::sin(bearing_rad));
    return ahead_m(scene);
  };
  for (int k = -10; k <= 10; ++k) EXPECT_NEAR(at(0.1 * k * half_rad, 1.9), 1.9 - kR, 0.02) << k;
  const double aside_rad = std::asin(kR / 1.0) + 0.01;
  EXPECT_LT(at(half_rad + aside_rad - 0.02, 1.0), 1.1);
  EXPECT_EQ(at(half_rad + aside_rad, 1.0), 2.0);
  EXPECT_EQ(at(-half_rad - aside_rad, 1.0), 2.0);
  EXPECT_EQ(at(0.0, 2.0 + kR + 0.01), 2.0);
}

TEST(TimeOfFlight, LooksOverWhatIsLow) {
  EXPECT_NEAR(ahead_m(with_epuck2().box(0.5, 0.0, 0.1, 0.1, 0.0, 0.03)), 2.0, 1e-6);
  EXPECT_NEAR(ahead_m(with_epuck2().box(0.5, 0.0, 0.1, 0.1, 0.0, 0.04)), 0.45 - kR, 1e-3);
}

TEST(TimeOfFlight, NoiseIsAsLargeAsAskedAndStaysInRange) {
  Scene scene = with_epuck2();
  choose(scene, "time_of_flight", Role::Sensor, "noisy", {{"noise_level", "0.1", 11}});
  scene.box(1.035 + 0.1, 0.0, 0.2, 4.0);
  const auto world = made(scene);
  double squares = 0.0;
  for (int i = 0; i < 2000; ++i) {
    world.world->step();
    const double error = static_cast<double>(reading<hal::TimeOfFlight>(world, "ep").distance_m) - 1.0;
    squares += error * error;
  }
  EXPECT_NEAR(std::sqrt(squares / 2000), 0.1, 0.005);
}

TEST(CliffSensors, SeeTheFloorAndItsEdge) {
  Scene scene = with_epuck2("kinematics2d", 2.0);
  add_epuck2(scene, "edge", 0.99, 0.0);
  add_epuck2(scene, "side", 0.0, 0.99);  // its left sensor is over the edge, the right one is not
  const auto world = made(scene);
  steps(world, 2);
  const auto& inside = reading<hal::Cliff>(world, "ep");
  EXPECT_EQ(inside.count, 2U);
  EXPECT_EQ(inside.validity, hal::Validity::Fresh);
  EXPECT_FLOAT_EQ(inside.reflectance[0], 0.5F) << "even grey";
  EXPECT_EQ(reading<hal::Cliff>(world, "edge").reflectance[0], 0.0F);
  EXPECT_EQ(reading<hal::Cliff>(world, "edge").reflectance[1], 0.0F);
  EXPECT_FLOAT_EQ(reading<hal::Cliff>(world, "side").reflectance[0], 0.5F) << "right";
  EXPECT_EQ(reading<hal::Cliff>(world, "side").reflectance[1], 0.0F) << "left";
}

TEST(Selector, StandsWhereTheRobotsElementSays) {
  Scene scene = with_epuck2();
  add_epuck2(scene, "other", 1.0, 0.0);
  auto own = std::make_shared<hal::RobotKind>(hal::epuck2::kind());
  own->part<hal::SelectorPart>()->position = 11;
  scene.scenario.robots.back().own_kind = own;
  const auto world = made(scene);
  steps(world, 2);
  EXPECT_EQ(reading<hal::Selector>(world, "ep").position, 0U);
  EXPECT_EQ(reading<hal::Selector>(world, "other").position, 11U);
}

TEST(Epuck2Gyroscope, FeelsTurnsInEveryEngine) {
  for (const std::string engine : {"kinematics2d", "dynamics2d", "dynamics3d"}) {
    const auto world = made(with_epuck2(engine));
    command<hal::WheelSpeeds>(world, "ep").set(0.04, 0.06);
    steps(world, 30);
    const double turn = 0.02 / hal::epuck2::kind().drive()->wheel_base_m;
    const auto& gyroscope = reading<hal::Gyroscope>(world, "ep");
    EXPECT_NEAR(static_cast<double>(gyroscope.rate_rad_s[2]), turn, 0.02 * turn) << engine;
    EXPECT_NEAR(static_cast<double>(gyroscope.rate_rad_s[0]), 0.0, 0.02) << engine;
  }
}

TEST(Epuck2Gyroscope, HasABiasOfItsOwnThatStays) {
  Scene scene = with_epuck2();
  add_epuck2(scene, "other", 1.0, 1.0);
  choose(scene, "gyroscope", Role::Sensor, "default", {{"bias", "0.1", 11}});
  const auto world = made(scene);
  steps(world, 2);
  const auto first = reading<hal::Gyroscope>(world, "ep").rate_rad_s;
  steps(world, 50);
  const auto later = reading<hal::Gyroscope>(world, "ep").rate_rad_s;
  const auto others = reading<hal::Gyroscope>(world, "other").rate_rad_s;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(first[k], later[k]);
    EXPECT_NE(first[k], others[k]);
    EXPECT_NE(first[k], 0.0F);
    EXPECT_LE(std::fabs(first[k]), 0.1F);
  }
}

TEST(Epuck2, HasWhatAnEpuckHasNot) {
  Scene scene = with_epuck2();
  scene.scenario.robots.back().kind = "e-puck";
  scene.scenario.controllers[0].line = 7;
  const auto world = make(scene);
  EXPECT_FALSE(world.world);
  for (const char* device : {"gyroscope", "time_of_flight", "cliff", "selector"}) {
    EXPECT_THAT(world.all_problems(),
                HasSubstr("scene:7: error: the robot 'e-puck' has no device '" + std::string(device) + "'"));
  }
}

}  // namespace
}  // namespace tandem::core
