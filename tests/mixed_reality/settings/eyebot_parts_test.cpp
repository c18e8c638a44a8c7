#include "mixed_reality/settings/eyebot_parts.hpp"

#include <gmock/gmock.h>

#include "bridges/eyebot/stop_body.hpp"
#include "bridges/lcm/lcm_link.hpp"
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
  EXPECT_EQ(parts->settings.url, "udpm://239.255.76.67:7667?ttl=0");
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

TEST(RealEyebot, HasItsDevicesAndNoWheels) {
  auto parts = eyebot_parts(item_with(kLink), 10);
  ASSERT_TRUE(parts.ok());
  bridges::eyebot::EyebotBridge robot(parts->settings, [] { return bridges::lcm_bus::LcmLink::open("memq://"); });
  EXPECT_NE(robot.port(hal::port_type<hal::Positioning>()), nullptr);
  EXPECT_EQ(robot.port(hal::port_type<hal::WheelEncoders>()), nullptr);
  EXPECT_EQ(robot.port(hal::port_type<hal::WheelSpeeds>()), nullptr);
  EXPECT_NE(robot.port(hal::port_type<hal::QuadrotorSpeed>()), nullptr);
  const bridges::StopMessages messages = robot.stop_messages();
  EXPECT_EQ(messages.link, kLink);
  const auto words = bridges::eyebot::from_stop_body(messages.body);
  ASSERT_TRUE(words);
  EXPECT_EQ(words->name, "eb0");
  EXPECT_EQ(words->session, robot.stop_details().session);
  EXPECT_EQ(words->hub, robot.stop_details().hub);
  EXPECT_TRUE(words->land);
  EXPECT_FALSE(bridges::eyebot::from_stop_body("eb0"));
}

TEST(RealEyebot, ConnectsAsLongAsItWasNeverHeardOf) {
  auto parts = eyebot_parts(item_with(kLink), 10);
  ASSERT_TRUE(parts.ok());
  bridges::eyebot::EyebotBridge robot(parts->settings, [] { return bridges::lcm_bus::LcmLink::open("memq://"); });
  robot.start();
  robot.latch(0, bridges::lcm_bus::monotonic_ns());
  EXPECT_EQ(robot.health(), bridges::LinkHealth::Connecting);
  EXPECT_THAT(robot.trouble(), HasSubstr("eyebot/eb0/heartbeat"));
  EXPECT_EQ(robot.identity(), "");
  EXPECT_FALSE(robot.at_rest());
}

}  // namespace
}  // namespace tandem::mixed_reality
