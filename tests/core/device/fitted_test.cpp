// Robots whose parameters were fitted: they roll and read as measured, and pseudo-realities are drawn from that.
#include "hal/device/fitted.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::core {
namespace {

template <class Part>
Scene fitted(const Part& part, Scene scene) {
  if constexpr (std::is_same_v<Part, hal::FittedWheels>)
    scene.scenario.controllers[0].actuators.front().implementation = "default";  // ideal ones are not as measured
  return scene.parts([&](hal::RobotKind& kind) { kind.add(part); });
}

MadeWorld stepped(const Scene& scene, int steps) {
  auto world = make(scene);
  EXPECT_TRUE(world.world) << world.all_problems();
  run(*world.world, steps);
  return world;
}

Pose pose(const MadeWorld& world, std::size_t robot = 0) {
  return world->space().pose(world->space().robot(robot));
}

Scene driving(double left, double right) {
  return Scene(4, "everything")
      .param("left", hal::format_number(left))
      .param("right", hal::format_number(right))
      .robot("a", 0, 0);
}

TEST(FittedWheels, RollAndTurnAsMeasuredAndEncodersCountWhatTheyCount) {
  hal::FittedWheels part;
  part.mean.of = {0.9, 0.9, 1.0, 0.95, 1.0, 0.0, 0.0};
  auto straight = stepped(fitted(part, driving(0.1, 0.1)), 11);  // the first tick has no command yet
  EXPECT_NEAR(pose(straight).x_m, 0.09, 1e-12);
  const auto* encoders = straight->space().port<hal::WheelEncoders>(straight->space().robot(0));
  EXPECT_NEAR(encoders->left_m, 0.095, 1e-12);
  EXPECT_NEAR(encoders->right_m, 0.1, 1e-12);

  part.mean.of = {1.0, 1.0, 1.25, 1.0, 1.0, 0.0, 0.0};
  auto turning = stepped(fitted(part, driving(-0.02, 0.02)), 11);
  const double turned = std::atan2(pose(turning).sin_h, pose(turning).cos_h);
  EXPECT_NEAR(turned, 0.04 / (1.25 * 0.053), 1e-9);
}

TEST(FittedWheels, ObeyLate) {
  hal::FittedWheels part;
  part.mean.of.delay_s = 0.25;
  auto world = stepped(fitted(part, driving(0.1, 0.1)), 11);
  EXPECT_NEAR(pose(world).x_m, 0.1 * (1.0 - 0.25), 1e-9);
  part.mean.of.delay_s = 9.0;
  EXPECT_FALSE(make(fitted(part, driving(0.1, 0.1))).world);
}

TEST(FittedWheels, NoiseGrowsWithTheRootOfTheWay) {
  hal::FittedWheels part;
  part.mean.of.noise_sqrt_m = 0.002;
  Scene scene = Scene(20).param("left", "0.1").param("right", "0.1");
  for (int i = 0; i < 200; ++i) scene.robot("a" + std::to_string(i), -3.0, -8.0 + 0.08 * i);
  auto world = stepped(fitted(part, scene), 26);  // 0.25 m
  double squares = 0.0;
  for (std::size_t i = 0; i < 200; ++i) squares += std::pow(pose(world, i).x_m + 3.0 - 0.25, 2.0);
  // Each wheel 0.002 * sqrt(0.25); half of the sum of two.
  EXPECT_NEAR(std::sqrt(squares / 200), 0.001 / std::sqrt(2.0), 0.00012);
}

TEST(FittedWheels, ARobotThatWasMeasuredHasItsOwnValuesAndRealitiesDrawThem) {
  hal::FittedWheels part;
  part.spread.of.left = part.spread.of.right = 0.05;
  part.robots.push_back({"a1", {}, {}});
  part.robots.back().value.of.left = part.robots.back().value.of.right = 0.5;
  const auto ways = [&](std::int64_t reality, std::uint64_t seed) {
    part.reality = reality;
    Scene scene = Scene(4).param("left", "0.1").param("right", "0.1");
    for (int i = 0; i < 12; ++i) scene.robot("a" + std::to_string(i), 0, -1.0 + 0.2 * i);
    scene.scenario.seed = seed;
    auto world = stepped(fitted(part, scene), 11);
    std::vector<double> all;
    for (std::size_t i = 0; i < 12; ++i)
      all.push_back(world->space().pose(world->space().find_robot("a" + std::to_string(i))).x_m);
    return all;
  };
  const auto measured = ways(0, 1);
  EXPECT_NEAR(measured[0], 0.1, 1e-9);
  EXPECT_NEAR(measured[1], 0.05, 1e-9);
  EXPECT_NEAR(measured[11], 0.1, 1e-9);  // "a1" is not the beginning of its name
  const auto drawn = ways(3, 1);
  EXPECT_NE(drawn[0], drawn[2]);
  EXPECT_NEAR(drawn[1], 0.05, 1e-9);  // its value has no error
  for (const double way : drawn) EXPECT_NEAR(way, 0.1, 0.06);
  EXPECT_EQ(drawn, ways(3, 2));  // whatever the run's seed
  EXPECT_NE(drawn, ways(4, 1));
}

TEST(FittedProximity, ReadsByTheCurveLateAndWithNoise) {
  hal::FittedProximity part;
  part.mean.of = {0.9, 1.5, 0.002, 0.0, 0.0};
  // Straight ahead of the sensor at the robot's left side.
  Scene scene = Scene(4, "everything").box(0.0, 0.035 + 0.05 + 0.1, 1.0, 0.2).robot("a", 0, 0);
  auto world = stepped(fitted(part, scene), 2);
  const auto* port = world->space().port<hal::Proximity>(world->space().robot(0));
  EXPECT_NEAR(static_cast<double>(port->distance_m[5]), 0.1 * 0.9 * std::pow(0.5, 1.5) + 0.002, 1e-6);
  EXPECT_EQ(port->distance_m[2], 0.1F);  // nothing there

  part.mean.of = {1.0, 1.0, 0.0, 0.0, 0.15};
  Scene away = Scene(4, "everything").param("left", "0.02").param("right", "0.02");
  away.box(0.035 + 0.09, 0.0, 0.1, 3.0).robot("a", 0, 0);
  auto late = stepped(fitted(part, away), 6), now = stepped(away.parts([](hal::RobotKind&) {}), 6);
  const auto ahead = [](const MadeWorld& w) {
    return w->space().port<hal::Proximity>(w->space().robot(0))->distance_m[0];
  };
  // 1.5 ticks of 2 mm, seen at 17 degrees.
  EXPECT_NEAR(static_cast<double>(ahead(late) - ahead(now)), 0.003 / std::cos(17.0 * M_PI / 180), 2e-5);
}

}  // namespace
}  // namespace tandem::core
