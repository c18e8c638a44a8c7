// One line for each cause of incidents, with the number of robots that met it.
#include "core/sim/incidents.hpp"

#include <gmock/gmock.h>

#include "tests/core/scenes.hpp"

namespace tandem::core {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Lines that were logged.
struct Lines {
  std::vector<std::string> all;
  hal::Log log() {
    return hal::Log([this](hal::Severity, std::string_view text) { all.emplace_back(text); });
  }
};

TEST(Incidents, HaveTheSameCauseWhereNumbersAloneDiffer) {
  EXPECT_EQ(cause_of("left at (-0.25, 1e-05) at tick 12"), cause_of("left at (1.5, -3) at tick 7"));
  EXPECT_EQ(cause_of("'ep3' threw: 5 is too much"), cause_of("'ep12' threw: 66 is too much"));
  EXPECT_NE(cause_of("walk.lua:12: nil"), cause_of("walk.lua:13: nil"));
  EXPECT_NE(cause_of("line 12"), cause_of("line 13"));
  EXPECT_EQ(cause_of("at 1:2: x"), "at #:2: x");
  EXPECT_EQ(cause_of(""), "");
}

TEST(Incidents, OfOneCauseAreOneLineWithTheNumberOfOthers) {
  Incidents incidents;
  Lines lines;
  for (const std::uint32_t robot : {4U, 2U, 4U, 9U})
    incidents.note(robot, "robot 'ep" + std::to_string(robot) + "'", " left at tick 3");
  incidents.tell(lines.log(), false);
  EXPECT_THAT(lines.all, ElementsAre("robot 'ep4' (and 2 more) left at tick 3"));
  incidents.note(2, "robot 'ep2'", " left at tick 5");
  incidents.note(7, "robot 'ep7'", " left at tick 5");
  incidents.note(7, "robot 'ep7'", " fell");
  incidents.tell(lines.log(), false);
  EXPECT_THAT(incidents.first(), ElementsAre("robot 'ep4' (and 3 more) left at tick 3", "robot 'ep7' fell"));
  EXPECT_THAT(lines.all, ElementsAre("robot 'ep4' (and 2 more) left at tick 3", "robot 'ep7' fell"));
  incidents.tell(lines.log(), true);
  incidents.tell(lines.log(), true);
  EXPECT_EQ(lines.all.size(), 3U);
  EXPECT_EQ(lines.all.back(), "by the end: robot 'ep4' (and 3 more) left at tick 3");
}

TEST(Incidents, BeyondTheFirstCausesAreNotNamed) {
  Incidents incidents;
  for (char c = 'a'; c <= 'z'; ++c) incidents.note(1, "robot 'r'", std::string(" did ") + c);
  EXPECT_EQ(incidents.first().size(), Incidents::kCauses);
}

TEST(Incidents, OfAWorldNameTheFirstRobotAndPlacesInMillimetres) {
  Scene scene(2.0, "thrower");
  for (int i = 0; i < 5; ++i) scene.robot("r" + std::to_string(i), -0.8 + 0.4 * i, 0);
  WorldOptions options;
  Lines lines;
  options.log = lines.log();
  auto world = make(scene, options);
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 10);
  ASSERT_EQ(lines.all.size(), 1U);
  EXPECT_THAT(lines.all[0], HasSubstr("controller of robot 'r0' (and 4 more) threw at tick 3: lost my way"));
  EXPECT_EQ(world->incidents().first(), lines.all);
  EXPECT_EQ(world->incidents().controllers_thrown, 5U);

  Scene leaving(1.0);
  leaving.param("left", "0.1").param("right", "0.1").robot("a", 0.4, -0.1234567).robot("b", 0.4, 0.2);
  leaving.scenario.escape = EscapePolicy::Stop;
  auto left = make(leaving);
  ASSERT_TRUE(left.world) << left.all_problems();
  run(*left.world, 40);
  ASSERT_EQ(left->incidents().first().size(), 1U);
  EXPECT_THAT(left->incidents().first()[0],
              testing::MatchesRegex("robot 'a' \\(and 1 more\\) left the arena at \\(0\\.5[0-9]*, -0\\.123\\) at tick "
                                    "[0-9]+: stopped at the edge"));
}

}  // namespace
}  // namespace tandem::core
