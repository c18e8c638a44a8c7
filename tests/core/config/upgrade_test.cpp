// Files of earlier versions, and ARGoS', are brought to Tandem's own vocabulary.
#include "core/config/upgrade.hpp"

#include <gmock/gmock.h>

#include "tests/core/config/reading.hpp"

namespace tandem::core {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kOld = R"(<?xml version="1.0" ?>
<!-- <argos-configuration> in a comment stays -->
<argos-configuration>
  <framework>
    <experiment length="10"
                ticks_per_second="10" random_seed="1" />
  </framework>

  <controllers>
    <!-- the first: <epuck_proximity> -->
    <walk id='w' library="test">
      <actuators>
        <differential_steering implementation="default" />
        <epuck_leds implementation="default"/>
      </actuators>
      <sensors>
        <epuck_proximity implementation="default"
                         noise_level="0.1"></epuck_proximity>
        <differential_steering implementation="default" />
      </sensors>
      <params note="a > b, 'epuck_proximity'" />
    </walk>
  </controllers>

  <arena size="4, 4, 1">
  </arena>
</argos-configuration>
)";

std::string replaced(std::string text, const std::string& from, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += by.size())
    text.replace(at, from.size(), by);
  return text;
}

TEST(Upgrade, GivesArgosFilesOurNamesAndLeavesTheRestAsItStands) {
  const auto made = upgraded(kOld, "old.xml", known_names());
  ASSERT_TRUE(made.ok()) << made.error().message;
  std::string expected = kOld;
  expected = replaced(expected, "\n<argos-configuration>", "\n<tandem version=\"1\">");
  expected = replaced(expected, "</argos-configuration>", "</tandem>");
  expected = replaced(expected, "<epuck_leds ", "<leds ");
  expected = replaced(expected, "<epuck_proximity implementation", "<proximity implementation");
  expected = replaced(expected, "</epuck_proximity>", "</proximity>");
  const std::size_t sensors = expected.find("<sensors>");
  expected.replace(expected.find("<differential_steering", sensors), 22, "<wheel_encoders");
  EXPECT_EQ(made.value().text, expected);
  EXPECT_THAT(
      made.value().changes,
      ElementsAre("line 3: <argos-configuration> is now <tandem>, whose defaults are others: see docs/from-argos.md",
                  "line 3: it says that it is of version 1", "line 14: <epuck_leds> is now <leds>",
                  "line 17: <epuck_proximity> is now <proximity>",
                  "line 19: <differential_steering> is now <wheel_encoders>"));
}

TEST(Upgrade, ChangesNothingASecondTime) {
  const auto once = upgraded(kOld, "old.xml", known_names());
  ASSERT_TRUE(once.ok());
  const auto twice = upgraded(once.value().text, "old.xml", known_names());
  ASSERT_TRUE(twice.ok());
  EXPECT_EQ(twice.value().text, once.value().text);
  EXPECT_THAT(twice.value().changes, testing::IsEmpty());
}

TEST(Upgrade, ReadsAsTheSameExperiment) {
  const auto made = upgraded(kOld, "old.xml", known_names());
  ASSERT_TRUE(made.ok());
  const Scenario before = read(kOld).good();
  const Scenario after = read(made.value().text).good();
  ASSERT_EQ(after.controllers.size(), 1U);
  for (const auto list : {&ControllerConfig::sensors, &ControllerConfig::actuators}) {
    const auto& was = before.controllers[0].*list;
    const auto& is = after.controllers[0].*list;
    ASSERT_EQ(is.size(), was.size());
    for (std::size_t i = 0; i < is.size(); ++i) EXPECT_EQ(is[i].device, was[i].device);
  }
  EXPECT_EQ(after.length_s, before.length_s);
}

TEST(Upgrade, AVersionThatIsSaidIsReplaced) {
  const auto made = upgraded("<tandem version = '0'\n  a=\"1\"/>", "x", known_names());
  ASSERT_TRUE(made.ok());
  EXPECT_EQ(made.value().text, "<tandem version = '1'\n  a=\"1\"/>");
}

TEST(Upgrade, RefusesWhatItDoesNotKnow) {
  EXPECT_THAT(upgraded("<tandem version=\"7\"/>", "new.xml", known_names()).error().message,
              HasSubstr("new.xml: the file is of version 7, and this program knows files up to version 1"));
  EXPECT_THAT(upgraded("<footbot_map/>", "map.xml", known_names()).error().message, HasSubstr("no experiment"));
  EXPECT_THAT(upgraded("<tandem>", "half.xml", known_names()).error().message, HasSubstr("half.xml:1"));
}

TEST(Version, OfAFileIsJudgedBeforeAnythingElseOfIt) {
  Parts parts;
  std::string text = parts.text();
  const std::size_t at = text.find("<tandem") + 7;
  EXPECT_NO_FATAL_FAILURE((void)read(std::string(text).insert(at, " version=\"1\"")).good());
  const Outcome later = read(std::string(text).insert(at, " version=\"2\" novelty=\"1\""));
  EXPECT_THAT(later.text(), HasSubstr("is of version 2, and this program knows files up to version 1"));
}

}  // namespace
}  // namespace tandem::core
