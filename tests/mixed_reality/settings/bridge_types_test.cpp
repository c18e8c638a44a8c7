#include "mixed_reality/settings/bridge_types.hpp"

#include <gmock/gmock.h>

#include "bridges/link/link_text.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::mixed_reality {
namespace {

using testing::HasSubstr;

core::RobotItem epuck_on(const std::string& link) {
  core::RobotItem item;
  item.kind = "e-puck";
  item.id = "ep0";
  item.bridge = core::BridgeConfig{link, "auto", 0.5, {}, 1};
  return item;
}

TEST(BridgeTypes, RefuseLinksAndKindsThatTheyCannotReach) {
  core::RobotItem item = epuck_on("can:can0");
  const core::ControllerConfig controller;
  EXPECT_FALSE(make_bridge({item, controller}, {}).ok());
  item.bridge->link = "nonsense";
  EXPECT_FALSE(make_bridge({item, controller}, {}).ok());
  item.bridge->link = "serial:/dev/ttyUSB0";
  EXPECT_TRUE(make_bridge({item, controller}, {}).ok());
  item.kind = "marsupial";
  auto made = make_bridge({item, controller}, {});
  ASSERT_FALSE(made.ok());
  EXPECT_THAT(made.error().message, HasSubstr("'marsupial'; there is: e-puck, foot-bot, eye-bot"));
}

TEST(BridgeTypes, GiveTheGuardianALinkThatAProcessInAnotherFolderCanOpen) {
  const core::RobotItem item = epuck_on("serial:dev/ep0");
  auto made = make_bridge({item, {}}, {});
  ASSERT_TRUE(made.ok());
  const bridges::StopMessages messages = (*made)->stop_messages();
  EXPECT_EQ(messages.robot, "ep0");
  EXPECT_EQ(messages.kind, "e-puck");
  EXPECT_THAT(messages.link, testing::MatchesRegex("serial:/.*/dev/ep0@115200"));
  EXPECT_EQ(messages.version, (*made)->stop_version());
}

TEST(BridgeTypes, LetMoreBeReadThanTheControllerListsButNotByTheController) {
  const core::RobotItem item = epuck_on("serial:/dev/ttyUSB0");
  core::ControllerConfig controller;
  controller.actuators.emplace_back().device = "differential_steering";
  auto made = make_bridge({item, controller}, {});
  ASSERT_TRUE(made.ok());
  bridges::RobotBridge& bridge = **made;
  EXPECT_THROW((void)bridge.robot().sensor<hal::Proximity>(), hal::DeviceError);
  EXPECT_NE(bridge.port(hal::port_type<hal::WheelEncoders>()), nullptr);
  EXPECT_NE(bridge.port(hal::port_type<hal::Battery>()), nullptr);
  EXPECT_EQ(bridge.port(hal::port_type<hal::WheelSpeeds>()), &bridge.robot().actuator<hal::WheelSpeeds>());
  EXPECT_EQ(bridge.port(hal::port_type<hal::RangeAndBearing>()), nullptr);  // not over the serial link
}

struct Charge {
  const char* kind;
  float supply_V, charge;
  bool low;
};

/// How a battery of this kind is after so long at that.
class BatteryOf : public testing::TestWithParam<Charge> {};

TEST_P(BatteryOf, IsLowWhereItsDataSheetSaysSo) {
  BatteryWatch watch(battery_limit(GetParam().kind));
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
