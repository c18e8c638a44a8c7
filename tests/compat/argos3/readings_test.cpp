// Devices as ARGoS' controllers have them: units, orders, curves.
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/hook/hook.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/leds.hpp"
#include "tests/compat/argos3/world.hpp"

namespace tandem::test {
namespace {

using ::testing::HasSubstr;

/// The numbers of the last line that begins with this word, whatever stands between them.
std::vector<double> last_numbers(const std::string& said, const std::string& word) {
  const std::size_t at = said.rfind(": " + word + " ");
  EXPECT_NE(at, std::string::npos) << word << " in\n" << said;
  std::vector<double> all;
  if (at == std::string::npos) return all;
  std::string line = said.substr(at + word.size() + 3, said.find('\n', at) - at - word.size() - 3);
  for (char& c : line) {
    if (std::string("=,@{}<>").find(c) != std::string::npos) c = ' ';
  }
  std::istringstream in(line);
  for (std::string part; in >> part;) {
    char* end = nullptr;
    const double value = std::strtod(part.c_str(), &end);
    if (end != part.c_str()) all.push_back(value);
  }
  return all;
}

class ArgosReadings : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Of, ArgosReadings, roots(), root_name);

TEST_P(ArgosReadings, AreAFootBotsRing) {
  ArgosWorld world({.label = "readings",
                    .robot = "foot-bot",
                    .sensors = "<footbot_proximity/><footbot_light/><footbot_base_ground/><footbot_motor_ground/>",
                    .more = "<light id=\"l\" position=\"0,3,1\" orientation=\"0,0,0\" color=\"yellow\" intensity=\"5\" "
                            "medium=\"leds\"/><box id=\"b\" size=\"0.1,1,0.5\" movable=\"false\"><body "
                            "position=\"0.185,0,0\" orientation=\"0,0,0\"/></box>",
                    .root = GetParam()});
  world.run(2);
  const std::vector<double> proximity = last_numbers(world.said, "footbot_proximity");
  ASSERT_EQ(proximity.size(), 48U);
  EXPECT_NEAR(proximity[0], 7.5, 1e-4);
  EXPECT_NEAR(proximity[2], 22.5, 1e-4);
  EXPECT_NEAR(proximity[46], -7.5, 1e-4);
  EXPECT_GT(proximity[1], 0.1) << "the box is in front";
  EXPECT_NEAR(proximity[1], proximity[47], 1e-3) << "and to both sides of the axis";
  EXPECT_EQ(proximity[25], 0.0) << "nothing is behind";
  const std::vector<double> light = last_numbers(world.said, "footbot_light");
  ASSERT_EQ(light.size(), 48U);
  std::size_t brightest = 0;
  for (std::size_t i = 0; i < 24; ++i) {
    if (light[2 * i + 1] > light[2 * brightest + 1]) brightest = i;
  }
  EXPECT_NEAR(light[2 * brightest], 90.0, 8.0) << "the light is to the left";
  EXPECT_EQ(last_numbers(world.said, "footbot_base_ground").size(), 24U);
  const std::vector<double> motor = last_numbers(world.said, "footbot_motor_ground");
  ASSERT_EQ(motor.size(), 12U);
  EXPECT_GT(std::fabs(motor[0]), 1.0) << "offsets are in cm";
}

TEST_P(ArgosReadings, CountAnEpucksSensorsCounterClockwiseByItsOwnCurve) {
  ArgosWorld world({.label = "readings",
                    .sensors = "<epuck_proximity/><ground/>",
                    .more = "<box id=\"b\" size=\"0.1,1,0.5\" movable=\"false\"><body position=\"0,0.105,0\" "
                            "orientation=\"90,0,0\"/></box>",
                    .root = GetParam()});
  world.run(2);
  const std::vector<double> proximity = last_numbers(world.said, "epuck_proximity");
  ASSERT_EQ(proximity.size(), 16U);
  EXPECT_NEAR(proximity[0], 17.0, 0.1);
  EXPECT_NEAR(proximity[4], 90.0, 0.1);
  EXPECT_NEAR(proximity[14], -17.0, 0.1);
  EXPECT_NEAR(proximity[5], 0.4637, 0.005) << "20 mm: 298.7 d^2 - 36.9 d + 1.08";
  EXPECT_EQ(proximity[11], 0.0) << "nothing is to the right";
  EXPECT_EQ(last_numbers(world.said, "ground").size(), 3U);
}

TEST_P(ArgosReadings, AreCentimetresOfWheels) {
  ArgosWorld world({.label = "readings",
                    .robot = "foot-bot",
                    .sensors = "<differential_steering/><positioning/><proximity/>",
                    .params = "<params left=\"10\" right=\"10\" from=\"10\"/>",
                    .root = GetParam()});
  world.run(11);
  const std::vector<double> wheels = last_numbers(world.said, "wheels");
  ASSERT_EQ(wheels.size(), 3U);
  EXPECT_NEAR(wheels[0], 10.0, 1e-6) << "cm/s";
  EXPECT_NEAR(wheels[1], 1.0, 1e-6) << "cm in a tick of 0.1 s";
  EXPECT_NEAR(wheels[2], 14.0, 0.5) << "cm between the wheels";
  const std::vector<double> place = last_numbers(world.said, "place");
  ASSERT_EQ(place.size(), 6U);
  EXPECT_NEAR(place[0], 0.1, 1e-6) << "m";
  EXPECT_NEAR(place[3], 0.0, 1e-6);
  EXPECT_EQ(last_numbers(world.said, "proximity").size(), 24U);
}

TEST_P(ArgosReadings, AreMessagesInCentimetres) {
  ArgosWorld world({.label = "readings",
                    .robot = "foot-bot",
                    .sensors = "<range_and_bearing medium=\"rab\"/>",
                    .actuators = "<range_and_bearing/>",
                    .robots = 2,
                    .root = GetParam()});
  world.run(3);
  const std::vector<double> heard = last_numbers(world.said, "heard");
  ASSERT_EQ(heard.size(), 12U);
  EXPECT_NEAR(heard[0], 50.0, 1e-3);
  EXPECT_EQ(heard[2], 200.0) << "the first byte";
  EXPECT_EQ(heard[11], 5.0) << "the last";
}

TEST_P(ArgosReadings, AreBlobsOfWhatOthersShow) {
  ArgosWorld world({.label = "readings",
                    .robot = "foot-bot",
                    .sensors = "<colored_blob_omnidirectional_camera medium=\"leds\"/>",
                    .actuators = "<leds medium=\"leds\"/>",
                    .robots = 2,
                    .root = GetParam()});
  world.run(3);
  EXPECT_THAT(world.said, HasSubstr("red@"));
  const std::vector<double> blobs = last_numbers(world.said, "blobs");
  ASSERT_GT(blobs.size(), 1U);
  EXPECT_NEAR(blobs[1], 42.0, 10.0) << "cm to the nearest LED";
}

TEST_P(ArgosReadings, GoOnWhenTheRunBeginsAgain) {
  ArgosWorld world({.label = "readings",
                    .robot = "foot-bot",
                    .sensors = "<colored_blob_omnidirectional_camera medium=\"leds\"/><footbot_distance_scanner/>",
                    .actuators = "<leds medium=\"leds\"/><footbot_distance_scanner/>",
                    .more =
                        "<light id=\"l\" position=\"0.5,0.5,0.2\" orientation=\"0,0,0\" color=\"blue\" intensity=\"5\" "
                        "medium=\"leds\"/>",
                    .root = GetParam()});
  world.run(3);
  ASSERT_TRUE(world.world->reset(5).ok());
  world.said.clear();
  world.run(3);
  EXPECT_EQ(last_numbers(world.said, "blobs").at(0), 1.0) << "Init enabled the camera, and runs once";
  EXPECT_GT(last_numbers(world.said, "scanner").at(0), 0.0) << "the scanner, too";
}

TEST(ArgosPackets, HaveFourBytes) {
  ArgosWorld world({.label = "readings",
                    .sensors = "<epuck_range_and_bearing medium=\"rab\" data_size=\"4\"/>",
                    .actuators = "<epuck_range_and_bearing medium=\"rab\" data_size=\"4\"/>",
                    .robots = 2,
                    .root = "argos-configuration"});
  world.run(3);
  const std::vector<double> packet = last_numbers(world.said, "packet");
  ASSERT_EQ(packet.size(), 6U) << world.said;
  EXPECT_NEAR(packet[0], 50.0, 1e-3);
  EXPECT_EQ(packet[2], 7.0);
  EXPECT_EQ(packet[5], 10.0) << "the fourth byte";
}

TEST_P(ArgosReadings, AreTurretAndScanner) {
  ArgosWorld world({.label = "readings",
                    .robot = "foot-bot",
                    .sensors = "<footbot_turret_encoder/><footbot_distance_scanner/><battery/>",
                    .actuators = "<footbot_turret/><footbot_distance_scanner/><footbot_gripper/>",
                    .params = "<params from=\"39\"/>",
                    .engine = "dynamics2d",
                    .root = GetParam()});
  world.run(40);
  EXPECT_NEAR(last_numbers(world.said, "turret").at(0), 1.5708, 0.01);
  const std::vector<double> scanner = last_numbers(world.said, "scanner");
  ASSERT_EQ(scanner.size(), 3U);
  EXPECT_GT(scanner[0], 0.0);
  EXPECT_EQ(scanner[2], scanner[0] + scanner[1]);
}

TEST_P(ArgosReadings, FlyAnEyeBot) {
  for (const char* engine : {"particle3d", "dynamics3d"}) {
    ArgosWorld world({.label = "readings",
                      .robot = "eye-bot",
                      .sensors = "<eyebot_proximity/><eyebot_light/><positioning/>",
                      .actuators = "<quadrotor_position/>",
                      .params = "<params from=\"99\"/>",
                      .engine = engine,
                      .root = GetParam()});
    world.run(100);
    EXPECT_NEAR(last_numbers(world.said, "place").at(2), 1.5, 0.1) << engine;
    EXPECT_EQ(last_numbers(world.said, "eyebot_proximity").size(), 48U);
  }
}

}  // namespace
}  // namespace tandem::test
