#include "mixed_reality/settings/bridge_request.hpp"

#include <gmock/gmock.h>

#include "bridges/eyebot/bridge.hpp"
#include "bridges/eyebot/stop_body.hpp"
#include "bridges/link/link_text.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/element.hpp"
#include "hal/element_options.hpp"
#include "hal/robot/robots.hpp"
#include "mixed_reality/safety/battery_watch.hpp"
#include "tests/bridges/catalog.hpp"

namespace tandem::mixed_reality {
namespace {

using testing::HasSubstr;

core::Scenario one_robot(const std::string& kind, const std::string& id, const std::string& link) {
  core::Scenario scenario;
  core::RobotItem& item = scenario.robots.emplace_back();
  item.kind = kind;
  item.id = id;
  item.bridge = core::BridgeConfig{link, 0.5, {}, 1};
  scenario.controllers.emplace_back();
  return scenario;
}

bridges::BridgeRequest request_for(const core::Scenario& scenario) {
  return bridge_request(scenario, scenario.robots.at(0), 1);
}

bridges::MadeBridge made_for(const core::Scenario& scenario) {
  return make_bridge(test::bridges(), request_for(scenario), {});
}

/// The attributes of <bridge> that belong to that kind, as a file's reader gives them.
std::shared_ptr<const void> own(const std::string& kind, const std::vector<hal::Element::Attribute>& attributes,
                                hal::Problems& problems) {
  hal::Element element;
  element.name = "bridge";
  element.attributes = attributes;
  const auto* const options = test::bridges().find<hal::ElementOptions>("bridge of " + kind);
  EXPECT_NE(options, nullptr);
  hal::ElementReader reader(element, problems);
  auto read = options->read(reader);
  reader.finish();
  return read;
}

TEST(BridgeTypes, RefuseLinksAndKindsThatTheyCannotReach) {
  EXPECT_FALSE(made_for(one_robot("e-puck", "ep0", "can:can0")).ok());
  EXPECT_FALSE(made_for(one_robot("e-puck", "ep0", "nonsense")).ok());
  EXPECT_TRUE(made_for(one_robot("e-puck", "ep0", "serial:/dev/ttyUSB0")).ok());
  const auto made = made_for(one_robot("marsupial", "m0", "serial:/dev/ttyUSB0"));
  ASSERT_FALSE(made.ok());
  EXPECT_THAT(made.error().message, HasSubstr("'marsupial'; there is: e-puck, "));
}

TEST(BridgeTypes, KnowTheirOwnAttributesAndNoOthers) {
  hal::Problems problems;
  (void)own("e-puck", {{"firmware", "gctronic", 3}}, problems);
  (void)own("foot-bot", {{"map", "map.xml", 3}}, problems);
  EXPECT_TRUE(problems.empty());
  (void)own("eye-bot", {{"firmware", "btcom", 3}}, problems);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(problems[0].message, HasSubstr("<bridge> has no attribute 'firmware'"));
}

TEST(BridgeTypes, GiveTheGuardianALinkThatAProcessInAnotherFolderCanOpen) {
  auto made = made_for(one_robot("e-puck", "ep0", "serial:dev/ep0"));
  ASSERT_TRUE(made.ok());
  const bridges::StopMessages messages = (*made)->stop_messages();
  EXPECT_EQ(messages.robot, "ep0");
  EXPECT_EQ(messages.kind, "e-puck");
  EXPECT_THAT(messages.link, testing::MatchesRegex("serial:/.*/dev/ep0@115200"));
  EXPECT_EQ(messages.version, (*made)->stop_version());
}

TEST(BridgeTypes, LetMoreBeReadThanTheControllerListsButNotByTheController) {
  core::Scenario scenario = one_robot("e-puck", "ep0", "serial:/dev/ttyUSB0");
  scenario.controllers[0].actuators.emplace_back().device = "differential_steering";
  auto made = made_for(scenario);
  ASSERT_TRUE(made.ok());
  bridges::RobotBridge& bridge = **made;
  EXPECT_THROW((void)bridge.robot().sensor<hal::Proximity>(), hal::DeviceError);
  EXPECT_NE(bridge.port(hal::port_type<hal::WheelEncoders>()), nullptr);
  EXPECT_NE(bridge.port(hal::port_type<hal::Battery>()), nullptr);
  EXPECT_EQ(bridge.port(hal::port_type<hal::WheelSpeeds>()), &bridge.robot().actuator<hal::WheelSpeeds>());
  EXPECT_EQ(bridge.port(hal::port_type<hal::RangeAndBearing>()), nullptr);  // not over the serial link
}

const std::string kBus = "lcm:udpm://239.255.76.67:7667?ttl=0";

TEST(BridgeTypes, MakeAnEyebotAsTheFileSays) {
  core::Scenario scenario = one_robot("eye-bot", "eb0", kBus);
  scenario.robots[0].bridge->timeout_s = 0.05;
  hal::Problems problems;
  scenario.robots[0].bridge->own = own("eye-bot", {{"name", "eb_lab", 1}, {"at_end", "hover", 1}}, problems);
  EXPECT_EQ(request_for(scenario).lost_after_ns, 200 * hal::kNsPerMs);  // two ticks at least
  auto made = made_for(scenario);
  ASSERT_TRUE(made.ok()) << made.error().message;
  const bridges::StopMessages messages = (*made)->stop_messages();
  EXPECT_EQ(messages.link, kBus);
  EXPECT_EQ(messages.name, "eb_lab");
  const auto words = bridges::eyebot::from_stop_body(messages.body);
  ASSERT_TRUE(words);
  EXPECT_EQ(words->name, "eb_lab");
  EXPECT_FALSE(words->land);
  EXPECT_FALSE(bridges::eyebot::from_stop_body("eb0"));
  EXPECT_NE((*made)->port(hal::port_type<hal::Positioning>()), nullptr);
  EXPECT_NE((*made)->port(hal::port_type<hal::QuadrotorSpeed>()), nullptr);
  EXPECT_EQ((*made)->port(hal::port_type<hal::WheelEncoders>()), nullptr);
  EXPECT_EQ((*made)->port(hal::port_type<hal::WheelSpeeds>()), nullptr);
}

TEST(BridgeTypes, AnEyebotsWorldLiesWhereTheFileSays) {
  core::Scenario scenario = one_robot("eye-bot", "eb0", kBus);
  hal::Problems problems;
  scenario.robots[0].bridge->own = own("eye-bot", {{"origin", "1,2,3", 1}, {"turn", "90", 1}}, problems);
  const auto settings = bridges::eyebot::settings_for(request_for(scenario));
  ASSERT_TRUE(settings.ok()) << settings.error().message;
  EXPECT_EQ(settings.value().url, "udpm://239.255.76.67:7667?ttl=0");
  EXPECT_EQ(settings.value().driver.name, "eb0");
  EXPECT_EQ(settings.value().driver.world.origin, (std::array<double, 3>{1.0, 2.0, 3.0}));
  EXPECT_NEAR(settings.value().driver.world.turn_rad, 1.5707963267948966, 1e-12);
  EXPECT_TRUE(settings.value().shutdown.land);
}

TEST(BridgeTypes, RefuseAnEyebotWithAReason) {
  const auto error_of = [](const std::string& id, const std::string& link) {
    const hal::Status good = check_bridge(test::bridges(), request_for(one_robot("eye-bot", id, link)));
    return good.ok() ? std::string() : good.error().message;
  };
  EXPECT_EQ(error_of("eb0", kBus), "");
  EXPECT_THAT(error_of("eb0", "can:can0"), HasSubstr("write lcm:udpm://"));
  EXPECT_THAT(error_of("eb0", "nonsense"), HasSubstr("has no scheme"));
  EXPECT_THAT(error_of("eb.0", kBus), HasSubstr("cannot be part of a channel"));
}

TEST(BridgeTypes, AFootbotNeedsItsMap) {
  const auto made = made_for(one_robot("foot-bot", "fb0", "can:can0"));
  ASSERT_FALSE(made.ok());
  EXPECT_THAT(made.error().message, HasSubstr("names no map of its variables; write map="));
}

struct Charge {
  const char* kind;
  float supply_V, charge;
  bool low;
};

/// How a battery of this kind is after so long at that.
class BatteryOf : public testing::TestWithParam<Charge> {};

TEST_P(BatteryOf, IsLowWhereItsPartSaysSo) {
  hal::Catalog robots;
  ASSERT_TRUE(robots.add_from("tests", hal::register_robots).ok());
  const auto* const kind = robots.find<hal::RobotKind>(GetParam().kind);
  ASSERT_NE(kind, nullptr);
  BatteryWatch watch(*kind);
  hal::Battery battery;
  battery.validity = hal::Validity::Fresh;
  battery.supply_V = GetParam().supply_V;
  battery.charge = GetParam().charge;
  hal::TimeNs now = 100 * hal::kNsPerSecond;
  EXPECT_FALSE(watch.low(battery, now)) << "a motor that starts draws it down for a moment";
  now += 3 * hal::kNsPerSecond;
  EXPECT_EQ(watch.low(battery, now), GetParam().low);
  battery.validity = hal::Validity::Stale;
  EXPECT_FALSE(watch.low(battery, now));
}

INSTANTIATE_TEST_SUITE_P(Kinds, BatteryOf,
                         testing::Values(Charge{"e-puck", 3.41F, 0.0125F, false}, Charge{"e-puck", 3.4F, 0.0F, true},
                                         Charge{"e-puck", 3.2F, 0.0F, true}, Charge{"foot-bot", 3.41F, 0.0125F, false},
                                         Charge{"foot-bot", 3.4F, 0.0F, true},
                                         // A map may have no volts.
                                         Charge{"foot-bot", 0.0F, 0.1F, false}, Charge{"foot-bot", 0.0F, 0.0F, true},
                                         Charge{"eye-bot", 10.3F, 0.16F, false}, Charge{"eye-bot", 10.3F, 0.15F, true},
                                         Charge{"eye-bot", 12.0F, 0.1F, true}));

}  // namespace
}  // namespace tandem::mixed_reality
