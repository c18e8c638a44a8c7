#include "mixed_reality/eyebot/real_eyebot.hpp"

#include <gmock/gmock.h>

#include "hal/device/body_sensors.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::mixed_reality {
namespace {

using testing::HasSubstr;

core::RobotItem item_with(const std::string& link) {
  core::RobotItem item;
  item.kind = "eye-bot";
  item.id = "eb0";
  item.bridge = core::BridgeConfig{};
  item.bridge->link = link;
  return item;
}

const std::string kLink = "lcm:udpm://239.255.76.67:7667?ttl=0";

TEST(RealEyebotParts, AreWhatTheFileSays) {
  core::RobotItem item = item_with(kLink);
  item.bridge->timeout_s = 0.05;
  item.bridge->origin_m = {1.0, 2.0, 3.0};
  item.bridge->turn_rad = 0.5;
  item.bridge->land_at_end = false;
  auto parts = eyebot_parts(item, 10);
  ASSERT_TRUE(parts.ok());
  EXPECT_EQ(parts->url, "udpm://239.255.76.67:7667?ttl=0");
  EXPECT_EQ(parts->settings.driver.name, "eb0");
  EXPECT_EQ(parts->settings.driver.robot.tick_ns, 100 * hal::kNsPerMs);
  EXPECT_EQ(parts->settings.driver.command_timeout_ns, 200 * hal::kNsPerMs);  // two ticks at least
  EXPECT_EQ(parts->settings.driver.world.origin[2], 3.0);
  EXPECT_EQ(parts->settings.driver.world.turn_rad, 0.5);
  EXPECT_FALSE(parts->settings.farewell.land);
  item.bridge->name = "eb_lab";
  EXPECT_EQ(eyebot_parts(item, 10)->settings.driver.name, "eb_lab");
}

TEST(RealEyebotParts, AreRefusedWithAReason) {
  const auto error_of = [](const core::RobotItem& item) {
    const auto parts = eyebot_parts(item, 10);
    return parts.ok() ? std::string() : parts.error().message;
  };
  EXPECT_THAT(error_of(item_with("can:can0")), HasSubstr("write lcm:udpm://"));
  EXPECT_THAT(error_of(item_with("nonsense")), HasSubstr("has no scheme"));
  core::RobotItem item = item_with(kLink);
  item.id = "eb.0";
  EXPECT_THAT(error_of(item), HasSubstr("cannot be part of a channel"));
  item = item_with(kLink);
  item.bridge->firmware = "btcom";
  EXPECT_THAT(error_of(item), HasSubstr("leave firmware out"));
  item = item_with(kLink);
  item.kind = "foot-bot";
  EXPECT_THAT(error_of(item), HasSubstr("not an eye-bot"));
}

TEST(RealEyebot, HasItsDevicesButTheClockAndNoWheels) {
  auto parts = eyebot_parts(item_with(kLink), 10);
  ASSERT_TRUE(parts.ok());
  parts->opener = [] { return bridges::lcm_bus::LcmLink::open("memq://"); };
  RealEyebot robot(parts->settings, parts->opener, parts->url, {});
  EXPECT_NE(robot.reading(hal::port_type<hal::Positioning>()), nullptr);
  EXPECT_EQ(robot.reading(hal::port_type<hal::Clock>()), nullptr);
  EXPECT_EQ(robot.reading(hal::port_type<hal::WheelEncoders>()), nullptr);
  EXPECT_EQ(robot.reading(hal::port_type<hal::QuadrotorSpeed>()), nullptr);  // that is none
  const hal::WheelSpeeds wheels;
  EXPECT_FALSE(robot.command(hal::port_type<hal::WheelSpeeds>(), &wheels));
  const hal::QuadrotorSpeed speed;
  EXPECT_TRUE(robot.command(hal::port_type<hal::QuadrotorSpeed>(), &speed));
  EXPECT_EQ(robot.last_words().name, "eb0");
  EXPECT_EQ(robot.last_words().url, "udpm://239.255.76.67:7667?ttl=0");
}

TEST(RealEyebot, ConnectsAsLongAsItWasNeverHeardOf) {
  auto parts = eyebot_parts(item_with(kLink), 10);
  ASSERT_TRUE(parts.ok());
  RealEyebot robot(parts->settings, [] { return bridges::lcm_bus::LcmLink::open("memq://"); }, parts->url, {});
  robot.latch({0, bridges::lcm_bus::monotonic_ns()});
  EXPECT_EQ(robot.health(), LinkHealth::Connecting);
  EXPECT_THAT(robot.trouble(), HasSubstr("eyebot/eb0/heartbeat"));
  EXPECT_FALSE(robot.stopped());
}

}  // namespace
}  // namespace tandem::mixed_reality
