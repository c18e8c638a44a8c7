// Files whose root is <argos-configuration>: what ARGoS ignores is a warning there, once each kind, and an error in
// Tandem's own files.
#include <algorithm>
#include <gmock/gmock.h>
#include <numbers>

#include "hal/device/cameras.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "tests/core/config/reading.hpp"

namespace tandem::core {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// With what ARGoS ignores: on lines 3, 5, 6, 7, 9, 10 and 12.
std::string file(const std::string& root) {
  return "<" + root + R"(>
<framework><experiment length="10" ticks_per_second="10" random_seed="1"/></framework>
<controllers colour="red">
  <wander id="w" library="wander">
    <sensors><proximity/><differential_steering/> stray <proximity noise_level="0.1"/></sensors>
    <actuators><differential_steering/><differential_steering implementation="ideal"/></actuators>
    <notes author="me"/>
  </wander></controllers>
<arena size="4,4,1"> here <e-puck id="a" weight="1"><body position="0,0,0"/><controller config="w"/></e-puck>
<e-puck id="b" weight="2"><body position="1,0,0"/><controller config="w"/></e-puck>
<distribute><position method="uniform" min="-1,-1,0" max="1,1,0"/>
<orientation method="constant" values="0,0,0" min="1,1,1"/><entity quantity="2"><e-puck id=""><controller config="w"/></e-puck></entity></distribute>
</arena>
</)" + root +
         ">\n";
}

std::vector<int> lines_of(const Problems& problems) {
  std::vector<int> lines;
  for (const Problem& p : problems) lines.push_back(p.line);
  return lines;
}

TEST(ArgosFiles, WarnOnceOfEachKindOfWhatNothingReads) {
  const Outcome out = read(file("argos-configuration"));
  const Scenario& s = out.good();
  Problems ignored;
  std::copy_if(out.problems.begin(), out.problems.end(), std::back_inserter(ignored),
               [](const Problem& p) { return p.ignored; });
  EXPECT_THAT(lines_of(ignored), ElementsAre(3, 5, 5, 6, 7, 9, 9, 12)) << out.text();
  EXPECT_TRUE(std::all_of(out.problems.begin(), out.problems.end(), [](const Problem& p) { return p.warning; }));
  EXPECT_THAT(out.text(), HasSubstr("file.xml:9: warning: <e-puck> has no attribute 'weight' (and 1 more such)"));
  EXPECT_THAT(out.text(), HasSubstr("file.xml:7: warning: <wander> cannot hold <notes>"));
  EXPECT_THAT(out.text(), HasSubstr("holds the text"));
  const ControllerConfig& c = s.controllers.at(0);
  EXPECT_EQ(*c.sensors.at(1).options.attribute("noise_level"), "0.1") << "of two devices the second is taken, as there";
  EXPECT_EQ(c.actuators.at(0).implementation, "ideal");
  EXPECT_EQ(s.robots.at(2).id, "") << "the robots are called 0 and 1";
}

TEST(ArgosFiles, AreRefusedForTheSameWhenAskedTo) {
  Outcome out = read(file("argos-configuration"));
  refuse_ignored(out.problems);
  EXPECT_TRUE(has_errors(out.problems));
  EXPECT_THAT(out.text(), HasSubstr("file.xml:9: error: <e-puck> has no attribute 'weight'"));
}

TEST(ArgosFiles, OfTandemsOwnRootGetErrors) {
  const Outcome out = read(file("tandem"));
  EXPECT_FALSE(out.scenario);
  const auto errors =
      std::count_if(out.problems.begin(), out.problems.end(), [](const Problem& p) { return !p.warning; });
  EXPECT_EQ(errors, 9) << out.text();
}

TEST(ArgosFiles, StillHaveErrorsWhereArgosHasThem) {
  std::string text = file("argos-configuration");
  text.replace(text.find("<e-puck id=\"a\""), 14,
               "<kilobot id=\"k\"><body position=\"0,1,0\"/></kilobot><e-puck id=\"a\"");
  text.replace(text.find("<proximity/>"), 12, "<rab_camera/>");
  text.replace(text.find("length=\"10\""), 11, "length=\"long\"");
  const Outcome out = read(text);
  EXPECT_FALSE(out.scenario);
  EXPECT_THAT(out.text(), HasSubstr("error: <arena> cannot hold <kilobot>"));
  EXPECT_THAT(out.text(), HasSubstr("error: unknown sensor <rab_camera>"));
  EXPECT_THAT(out.text(), HasSubstr("'long' is not a number"));
}

TEST(ArgosFiles, TakeWhatIsSetBesideThemAtItsWord) {
  const Outcome out = read(file("argos-configuration"), {"framework.experiment.lenght=5"});
  EXPECT_FALSE(out.scenario);
  EXPECT_THAT(out.text(), HasSubstr("--set framework.experiment.lenght=5: error: <experiment> has no attribute"));
}

TEST(ArgosFiles, LimitNoWheelsButThoseOfRealRobots) {
  std::string text = file("argos-configuration");
  text.replace(text.find("<body position=\"1,0,0\"/>"), 24, "<body position=\"1,0,0\"/><bridge link=\"serial:ep0\"/>");
  const Outcome out = read(text);
  const Scenario& s = out.good();
  ASSERT_NE(s.robots.at(0).own_kind, nullptr);
  EXPECT_FALSE(s.robots[0].own_kind->drive()->limited());
  EXPECT_TRUE(s.robots.at(1).own_kind == nullptr || s.robots[1].own_kind->drive()->limited());
  EXPECT_THAT(out.text(),
              HasSubstr("the wheels of <e-puck> have no limit, as in ARGoS; those of a real one turn with"));
  text.replace(text.find("<e-puck id=\"a\""), 14, "<e-puck id=\"a\" max_speed=\"5 cm/s\"");
  EXPECT_DOUBLE_EQ(read(text).good().robots.at(0).own_kind->drive()->max_speed_m_s, 0.05);
}

TEST(ArgosFiles, GiveSimulatedRobotsRoomForAllMessagesAndBlobs) {
  std::string text = file("argos-configuration");
  text.replace(text.find("<proximity/>"), 12, "<range_and_bearing/><epuck_omnidirectional_camera/>");
  const Scenario s = read(text).good();
  const auto* const camera = s.robots.at(0).own_kind->part<hal::OmniCameraPart>();
  ASSERT_NE(camera, nullptr) << "as the e-pucks of the separate plug-in";
  EXPECT_DOUBLE_EQ(camera->aperture_rad, 70 * std::numbers::pi / 180.0);
  const auto listed = [&](bool real) {
    std::vector<std::string> names;
    for (const hal::ListedDevice& device : listed_devices(s.controllers.at(0), known_names(), real))
      names.emplace_back(device.port->name);
    return names;
  };
  EXPECT_THAT(listed(false), ElementsAre("range_and_bearing_many", "omnidirectional_camera_many", "wheel_encoders",
                                         "proximity", "differential_steering"));
  EXPECT_THAT(listed(true), ElementsAre("range_and_bearing", "omnidirectional_camera", "wheel_encoders", "proximity",
                                        "differential_steering"));
  std::string own = file("tandem");
  own.replace(own.find("<proximity/>"), 12, "<range_and_bearing/>");
  for (const Problem& p : read(own).problems) EXPECT_EQ(p.message.find("many"), std::string::npos) << p.message;
}

TEST(ArgosFiles, NameDevicesAsTheEpucksPluginDoes) {
  EXPECT_EQ(device_name("epuck_wheels", hal::Role::Actuator, known_names()), "differential_steering");
  EXPECT_EQ(device_name("epuck_wheels", hal::Role::Sensor, known_names()), "wheel_encoders");
  EXPECT_EQ(device_name("epuck_rgb_leds", hal::Role::Actuator, known_names()), "leds");
  EXPECT_EQ(device_name("epuck_base_leds", hal::Role::Actuator, known_names()), "leds");
  EXPECT_EQ(device_name("epuck_range_and_bearing", hal::Role::Actuator, known_names()), "range_and_bearing");
  EXPECT_EQ(device_name("epuck_omnidirectional_camera", hal::Role::Sensor, known_names()), "omnidirectional_camera");
}

TEST(ArgosFiles, MaySendLongerMessages) {
  const auto with_size = [](const std::string& root, const std::string& size, const std::string& bridge = "") {
    std::string text = "<" + root + R"(><framework><experiment/></framework>
<controllers><wander id="w" library="wander"/></controllers>
<arena size="4,4,1"><e-puck id="a" rab_data_size=")" +
                       size + R"("><body position="0,0,0"/><controller config="w"/>)" + bridge + "</e-puck></arena></" +
                       root + ">";
    return read(text);
  };
  EXPECT_EQ(
      with_size("argos-configuration", "30").good().robots.at(0).own_kind->part<hal::RangeAndBearingPart>()->payload,
      30);
  EXPECT_THAT(with_size("argos-configuration", "65").text(), HasSubstr("out of range"));
  EXPECT_THAT(with_size("argos-configuration", "11", "<bridge link=\"serial:a\"/>").text(),
              HasSubstr("<e-puck rab_data_size>: real robots send messages of 10 bytes at most"));
  with_size("argos-configuration", "10", "<bridge link=\"serial:a\"/>").good();
  EXPECT_THAT(with_size("tandem", "30").text(), HasSubstr("out of range"));
}

TEST(ArgosFiles, TakeARobotsParametersInsteadOfItsConfigurations) {
  for (const std::string root : {"argos-configuration", "tandem"}) {
    const Outcome out = read("<" + root + R"(><framework><experiment/></framework>
<controllers><wander id="w" library="wander"><params a="1" b="2"/></wander></controllers>
<arena size="4,4,1"><e-puck id="a"><body position="0,0,0"/><controller config="w"><params a="3"/></controller></e-puck>
</arena></)" + root + ">");
    const Element& params = out.good().robots.at(0).params.value();
    EXPECT_EQ(*params.attribute("a"), "3");
    EXPECT_EQ(params.attribute("b") == nullptr, root == "argos-configuration") << root;
  }
}

TEST(ArgosFiles, GiveTheEpucksPluginItsPackets) {
  std::string text = file("argos-configuration");
  const auto payload = [&] {
    return read(text).good().robots.at(0).own_kind->part<hal::RangeAndBearingPart>()->payload;
  };
  EXPECT_EQ(payload(), 2);
  text.replace(text.find("<proximity/>"), 12, "<epuck_range_and_bearing data_size=\"4\"/>");
  EXPECT_EQ(payload(), 4);
  text.replace(text.find("<e-puck id=\"a\""), 14, "<e-puck id=\"a\" rab_data_size=\"3\"");
  EXPECT_EQ(payload(), 3) << "what the robot says itself counts";
}

TEST(Override, SetsAnAttributeOfEveryElementOfAName) {
  const Outcome out = read(file("argos-configuration"), {"arena.e-puck[*].rab_range=0.5", "arena.box[*].mass=2"});
  EXPECT_THAT(out.text(), HasSubstr("--set arena.box[*].mass=2: error: <arena> has no box"));
  const Outcome good = read(file("argos-configuration"), {"arena.e-puck[*].rab_range=0.5"});
  for (const std::size_t i : {0U, 1U})
    EXPECT_EQ(good.good().robots.at(i).own_kind->part<hal::RangeAndBearingPart>()->range_m, 0.5);
}

}  // namespace
}  // namespace tandem::core
