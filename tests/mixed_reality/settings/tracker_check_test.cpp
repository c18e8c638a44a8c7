#include "mixed_reality/settings/tracker_check.hpp"

#include <gmock/gmock.h>

#include "bridges/trackers/register.hpp"
#include "bridges/trackers/udp_tracker.hpp"
#include "hal/check.hpp"

namespace tandem::mixed_reality {
namespace {

using testing::HasSubstr;

const hal::Catalog& catalog() {
  static const hal::Catalog all = [] {
    hal::Catalog made;
    const hal::Status good = made.add_from("tests", bridges::trackers::register_trackers);
    TANDEM_CHECK(good.ok(), good.error().message.c_str());
    return made;
  }();
  return all;
}

core::RobotItem robot(const std::string& id, int line, std::vector<std::string> names = {}) {
  core::RobotItem item;
  item.id = id;
  item.line = line;
  item.bridge = core::BridgeConfig{};
  item.tracker = core::TrackerConfig{"auto", {}, line + 1, std::move(names)};
  return item;
}

core::TrackerItem tracker(const std::string& kind, const std::string& id, int line) {
  core::TrackerItem item;
  item.kind = kind;
  item.id = id;
  item.line = line;
  return item;
}

std::string problems_of(const core::Scenario& scenario) {
  core::Problems problems;
  check_trackers(scenario, catalog(), problems);
  std::string text;
  for (const core::Problem& p : problems) text += core::to_text(p) + "\n";
  return text;
}

core::Scenario good() {
  core::Scenario scenario;
  scenario.file = "e.xml";
  scenario.robots = {robot("fb0", 5), robot("fb1", 7, {"12", "13"})};
  scenario.trackers = {tracker("udp", "ceiling", 10), tracker("lcm", "wall", 11)};
  return scenario;
}

TEST(TrackerCheck, HasNothingToSayOfWhatIsGood) {
  EXPECT_EQ(problems_of(good()), "");
}

TEST(TrackerCheck, NamesWhatMakesNoSenseWithItsLine) {
  core::Scenario scenario = good();
  auto options = std::make_shared<bridges::trackers::UdpOptions>();
  options->address = "the ceiling";
  scenario.trackers[0].own = options;
  EXPECT_THAT(problems_of(scenario), HasSubstr("e.xml:10: error: tracker 'ceiling': 'the ceiling' is no address"));

  scenario = good();
  for (int i = 0; i < 3; ++i) scenario.trackers.push_back(tracker("udp", "u" + std::to_string(i), 20 + i));
  EXPECT_THAT(problems_of(scenario), HasSubstr("e.xml:22: error: more than 4 trackers"));
}

TEST(TrackerCheck, TwoRobotsCannotHaveOneName) {
  core::Scenario scenario = good();
  scenario.robots.push_back(robot("fb2", 15, {"13"}));
  EXPECT_THAT(problems_of(scenario), HasSubstr("robot 'fb2': trackers know 'fb1' on line 7 as '13', too"));
}

TEST(TrackerCheck, AFusedPoseNeedsTrackers) {
  core::Scenario scenario = good();
  scenario.trackers.clear();
  EXPECT_EQ(problems_of(scenario), "");
  scenario.robots[0].tracker->source = "fused";
  EXPECT_THAT(problems_of(scenario), HasSubstr("the file has no <trackers>"));
}

TEST(TrackerCheck, SaysWhichKindsThereAre) {
  const auto made = make_tracker(catalog(), {"radar", "r"}, {});
  ASSERT_FALSE(made.ok());
  EXPECT_THAT(made.error().message, HasSubstr("there is no tracker 'radar'; there are: "));
  EXPECT_TRUE(make_tracker(catalog(), {"udp", "u"}, {}).ok());
}

}  // namespace
}  // namespace tandem::mixed_reality
