#include "mixed_reality/settings/bridge_check.hpp"

#include <gmock/gmock.h>

#include "hal/device/ring_sensors.hpp"
#include "hal/element_options.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/robots.hpp"
#include "tests/bridges/catalog.hpp"

namespace tandem::mixed_reality {
namespace {

using testing::HasSubstr;

core::RobotItem robot(const std::string& kind, const std::string& id, const std::string& link, int line) {
  core::RobotItem item;
  item.kind = kind;
  item.id = id;
  item.line = line;
  item.bridge = core::BridgeConfig{};
  item.bridge->link = link;
  item.bridge->line = line + 1;
  return item;
}

std::string problems_of(const std::vector<core::RobotItem>& robots) {
  core::Scenario scenario;
  scenario.file = "e.xml";
  scenario.robots = robots;
  scenario.controllers.emplace_back();
  core::Problems problems;
  check_bridges(scenario, test::bridges(), problems);
  std::string text;
  for (const core::Problem& p : problems) text += core::to_text(p) + "\n";
  return text;
}

const std::string kBus = "lcm:udpm://239.255.76.67:7667?ttl=0";

TEST(BridgeCheck, FindsNothingWrongWithRobotsThatHaveALinkOrANameEach) {
  EXPECT_EQ(
      problems_of({robot("e-puck", "ep0", "serial:/dev/ttyUSB0", 1), robot("e-puck", "ep1", "serial:/dev/ttyUSB1", 3),
                   robot("eye-bot", "eb0", kBus, 5), robot("eye-bot", "eb1", kBus, 7)}),
      "");
}

TEST(BridgeCheck, NamesTheSecondRobotBehindALink) {
  EXPECT_THAT(problems_of({robot("e-puck", "ep0", "serial:/dev/ttyUSB0", 1),
                           robot("e-puck", "ep1", "serial:/dev/ttyUSB0@115200", 3)}),
              HasSubstr("e.xml:4: error: robot 'ep1': a second robot behind the link serial:/dev/ttyUSB0@115200; the "
                        "first is 'ep0' on line 1"));
  auto other = robot("eye-bot", "eb1", kBus, 3);
  hal::Element bridge;
  bridge.attributes = {{"name", "eb0", 4}};
  hal::Problems none;
  hal::ElementReader reader(bridge, none);
  other.bridge->own = test::bridges().find<hal::ElementOptions>("bridge of eye-bot")->read(reader);
  EXPECT_THAT(problems_of({robot("eye-bot", "eb0", kBus, 1), other}), HasSubstr("as 'eb0'; the first is 'eb0'"));
}

TEST(BridgeCheck, SaysWhatCannotBeReadWithItsLine) {
  auto item = robot("e-puck", "ep0", "serial:/dev/ttyUSB0@57600", 1);
  item.bridge->rearm = "soon";
  const std::string text =
      problems_of({item, robot("e-puck", "ep1", "cereal:x", 3), robot("marsupial", "m0", "can:can0", 5)});
  EXPECT_THAT(text, HasSubstr("e.xml:2: error: robot 'ep0': 'soon' is no way to re-arm; there are: proved, operator"));
  EXPECT_THAT(text,
              HasSubstr("e.xml:2: error: robot 'ep0': an e-puck's firmware talks with 115200 baud, not with 57600"));
  EXPECT_THAT(text, HasSubstr("e.xml:4: error: robot 'ep1': link 'cereal:x': unknown scheme"));
  EXPECT_THAT(text, HasSubstr("e.xml:6: error: robot 'm0': there is no bridge to robots of the kind 'marsupial'"));
}

/// The catalog of bridges, with the robots that these were written for.
const hal::Catalog& bridges_and_robots() {
  static const hal::Catalog all = [] {
    hal::Catalog made = test::bridges();
    EXPECT_TRUE(made.add_from("robots", hal::register_robots).ok());
    return made;
  }();
  return all;
}

/// What is wrong with a real crab, which a file gives as an e-puck that `change` changes.
template <class Change>
std::string problems_of_crab(const std::string& bridge, const Change& change) {
  auto crab = std::make_shared<hal::RobotKind>(hal::epuck::kind());
  crab->name = "crab";
  change(*crab);
  core::Scenario scenario;
  scenario.file = "e.xml";
  scenario.kinds.push_back({crab, bridge, "e.xml", 2});
  scenario.robots = {robot("crab", "c0", "serial:/dev/ttyUSB0", 5)};
  scenario.controllers.emplace_back();
  core::Problems problems;
  check_bridges(scenario, bridges_and_robots(), problems);
  std::string text;
  for (const core::Problem& p : problems) text += core::to_text(p) + "\n";
  return text;
}

TEST(BridgeCheck, LetsABridgeDriveAKindFromAFileThatIsBuiltAsItsRobots) {
  EXPECT_EQ(problems_of_crab("e-puck",
                             [](hal::RobotKind& crab) {
                               std::get<hal::DifferentialDrive>(crab.locomotion).wheel_base_m = 0.06;
                               crab.part<hal::ProximityPart>()->response.resize(4);
                               crab.remove("leds");
                             }),
            "");
}

TEST(BridgeCheck, NamesAKindThatNoBridgeDrives) {
  EXPECT_THAT(
      problems_of_crab("", [](hal::RobotKind&) {}),
      HasSubstr("e.xml:6: error: robot 'c0': there is no bridge to robots of the kind 'crab'; there is: e-puck"));
}

TEST(BridgeCheck, NamesAKindWithoutTheDriveOfItsBridge) {
  EXPECT_THAT(problems_of_crab("e-puck", [](hal::RobotKind& crab) { crab.locomotion = {}; }),
              HasSubstr("e.xml:6: error: robot 'c0': the kind 'crab' has no drive, and the bridge to 'e-puck' drives a "
                        "differential_drive; give the kind that, or leave its <bridge> out"));
  EXPECT_THAT(problems_of_crab("e-puck", [](hal::RobotKind& crab) { crab.locomotion = hal::Quadrotor{}; }),
              HasSubstr("the kind 'crab' has quadrotor, and the bridge to 'e-puck' drives a differential_drive"));
}

TEST(BridgeCheck, NamesAKindWithOtherNumbersOfSensorsThanItsBridgeHears) {
  EXPECT_THAT(
      problems_of_crab("e-puck", [](hal::RobotKind& crab) { crab.part<hal::ProximityPart>()->mounts.resize(12); }),
      HasSubstr("e.xml:6: error: robot 'c0': the kind 'crab' has 12 in its <proximity>, where a real 'e-puck' has 8; "
                "give it as many, or leave the part or its <bridge> out"));
}

}  // namespace
}  // namespace tandem::mixed_reality
