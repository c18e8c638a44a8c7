// Kinds of robots that files give: in an experiment, in files of their own, and every way to get them wrong.
#include "core/config/kinds.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <unistd.h>

#include "core/config/upgrade.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/xml/xml.hpp"
#include "tests/core/config/reading.hpp"

namespace tandem::core {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr std::string_view kBody = R"(<body radius="0.1" height="5 cm" mass="1.5"/>)";
constexpr std::string_view kWheels =
    R"(<differential_drive wheel_radius="0.02" wheel_base="0.15" max_speed="0.4" force="2" torque="0.1"/>)";

/// An experiment with these kinds, on line 9.
std::string with(const std::string& kinds, const std::string& things = {}) {
  Parts parts;
  if (!things.empty()) parts.things = things;
  parts.rest = kinds;
  return parts.text();
}

/// With one kind "crab" of these parts, in one line.
std::string crab(const std::string& parts, const std::string& attributes = {}) {
  return with("<kinds><kind name=\"crab\" " + attributes + ">" + parts + "</kind></kinds>");
}

std::string standing(const std::string& kind, const std::string& more = {}) {
  return "<" + kind + " id=\"c0\" " + more + "><body position=\"0,0,0\"/><controller config=\"w\"/></" + kind + ">";
}

/// Files that vanish with the test.
class Files : public testing::Test {
 protected:
  Files() : folder_(fs::temp_directory_path() / ("tandem_kinds_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_ / "deep");
  }
  ~Files() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  Outcome read_file(const std::string& path) const {
    Outcome out;
    out.scenario = read_experiment(path, {}, known_names(), out.problems);
    return out;
  }
  const fs::path folder_;
};

TEST(Kinds, AreReadWithTheirPartsAsTheseDescribeThemselves) {
  const Outcome out = read(crab(
      std::string(kBody) + std::string(kWheels) +
          R"(<proximity range="20 cm" source="a ruler"><mount bearing="90" x="0.01" z="0.02"/><mount radius="0.1" count="3"/></proximity>
<battery full="8.4" empty="6"/>)",
      R"(summary="It walks sideways.")"));
  const Scenario& scenario = out.good();
  ASSERT_EQ(scenario.kinds.size(), 1U);
  const hal::RobotKind& kind = *scenario.kinds[0].kind;
  EXPECT_EQ(kind.name, "crab");
  EXPECT_EQ(kind.summary, "It walks sideways.");
  EXPECT_EQ(kind.body.radius_m, 0.1);
  EXPECT_EQ(kind.body.height_m, 0.05);
  ASSERT_NE(kind.drive(), nullptr);
  EXPECT_EQ(kind.drive()->max_speed_m_s, 0.4);
  const auto* const proximity = kind.part<hal::ProximityPart>();
  ASSERT_NE(proximity, nullptr);
  EXPECT_EQ(proximity->range_m, 0.2);
  EXPECT_EQ(proximity->mounts.size(), 4U);
  EXPECT_EQ(proximity->source, "a ruler");
  ASSERT_NE(kind.part<hal::BatteryPart>(), nullptr);
  EXPECT_EQ(kind.part<hal::BatteryPart>()->low_charge, 0.05) << "the default of its class";
  EXPECT_EQ(kind.part<hal::LedsPart>(), nullptr);
  EXPECT_EQ(scenario.kinds[0].file, "file.xml");
  EXPECT_EQ(scenario.kinds[0].line, 8);
}

TEST(Kinds, AreElementsOfTheArenaLikeThoseOfTheProgram) {
  const std::string kinds = R"(<kinds><kind name="crab" like="e-puck"/></kinds>)";
  const Outcome one = read(with(kinds, standing("crab", R"(rab_range="2")")));
  ASSERT_EQ(one.good().robots.size(), 1U);
  EXPECT_EQ(one.good().robots[0].kind, "crab");
  ASSERT_NE(one.good().robots[0].own_kind, nullptr);
  EXPECT_EQ(one.good().robots[0].own_kind->name, "crab");
  EXPECT_EQ(one.good().robots[0].own_kind->part<hal::RangeAndBearingPart>()->range_m, 2.0);
  const Outcome many = read(with(kinds, R"(<distribute><position method="uniform" min="-1,-1,0" max="1,1,0"/>
<orientation method="constant" values="0,0,0"/><entity quantity="3"><crab id="c"><controller config="w"/></crab></entity></distribute>)"));
  EXPECT_EQ(many.good().robots.size(), 1U);
}

TEST(Kinds, BeginFromAnotherKindAndSayWhatIsDifferent) {
  const Outcome out = read(with(R"(<kinds>
<kind name="lobster" like="crab" without="differential_drive light"><leds><mount radius="0.1" count="5"/></leds></kind>
<kind name="crab" like="e-puck" summary="Wide."><body radius="0.1"/></kind></kinds>)"));
  const Scenario& scenario = out.good();
  const hal::RobotKind& epuck = *known_names().find<hal::RobotKind>("e-puck");
  ASSERT_EQ(scenario.kinds.size(), 2U);
  const hal::RobotKind& lobster = *scenario.kinds[0].kind;
  const hal::RobotKind& crab = *scenario.kinds[1].kind;
  EXPECT_EQ(crab.body.radius_m, 0.1);
  EXPECT_EQ(crab.body.height_m, epuck.body.height_m);
  EXPECT_EQ(crab.parts().size(), epuck.parts().size());
  EXPECT_EQ(crab.part<hal::LedsPart>()->mounts.size(), 8U);
  EXPECT_EQ(lobster.body.radius_m, 0.1);
  EXPECT_EQ(lobster.drive(), nullptr);
  EXPECT_EQ(lobster.part<hal::LightPart>(), nullptr);
  EXPECT_EQ(lobster.part<hal::LedsPart>()->mounts.size(), 5U);
  EXPECT_EQ(lobster.summary, "Wide.");
  EXPECT_EQ(scenario.kinds[0].bridge, "e-puck");
}

/// The kind under another name, given by a file, with what was read of it.
const hal::RobotKind& written_and_read(const hal::RobotKind& kind, Outcome& out) {
  hal::RobotKind other = kind;
  other.name = "other";
  std::string file = kinds_file({element_of(other)});
  out = read(with(file));
  return *out.good().kinds.at(0).kind;
}

class BuiltIn : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, BuiltIn, testing::ValuesIn(known_names().names(hal::RobotKind::kCategory)),
                         [](const auto& name) {
                           std::string letters = name.param;
                           std::erase(letters, '-');
                           return letters;
                         });

TEST_P(BuiltIn, KindCouldBeWrittenSoFactByFact) {
  const hal::RobotKind& kind = *known_names().find<hal::RobotKind>(GetParam());
  Outcome out;
  hal::RobotKind read_back = written_and_read(kind, out);
  EXPECT_EQ(out.text(), "");
  read_back.name = kind.name;
  // Numbers are written so that they read back as the same bits.
  EXPECT_EQ(hal::to_xml(element_of(read_back)), hal::to_xml(element_of(kind)));
  EXPECT_EQ(read_back.parts().size(), kind.parts().size());
  const auto attributes = [](hal::RobotKind some) {
    hal::ManualWriter manual;
    some.attributes(manual);
    return manual.text();
  };
  EXPECT_EQ(attributes(read_back), attributes(kind));
}

TEST(Kinds, AreWrittenOutInTheEffectiveSettings) {
  const Outcome out = read(with(
      R"(<kinds><kind name="crab" like="e-puck" without="leds"><body mass="2"/></kind></kinds>)", standing("crab")));
  const std::string saved = effective_settings(out.good());
  EXPECT_THAT(saved,
              AllOf(HasSubstr("wheel_base=\"0.053 m\""), HasSubstr("mass=\"2 kg\""), HasSubstr("bridge=\"e-puck\"")));
  EXPECT_THAT(saved, AllOf(Not(HasSubstr("like=")), Not(HasSubstr("without="))));
  const Outcome again = read(saved);
  EXPECT_EQ(effective_settings(again.good()), saved);
  EXPECT_EQ(again.good().kinds[0].kind->part<hal::LedsPart>(), nullptr);
}

TEST(Kinds, AreChangedBySetLikeAnythingElse) {
  const Outcome out = read(crab(std::string(kBody) + std::string(kWheels)),
                           {"kinds.kind[crab].body.radius=0.2", "kinds.kind[0].differential_drive.max_speed=1"});
  EXPECT_EQ(out.good().kinds[0].kind->body.radius_m, 0.2);
  EXPECT_EQ(out.good().kinds[0].kind->drive()->max_speed_m_s, 1.0);
}

TEST(Kinds, OfAnyNameLeaveTheNamesOfDevicesAlone) {
  // ARGoS writes a robot's name before that of a device: <epuck_proximity> is <proximity>.
  Parts parts;
  parts.controllers =
      R"(<controllers><w id="w" library="w"><sensors><base_ground/><crab_light/></sensors></w></controllers>)";
  parts.rest = R"(<kinds><kind name="base" like="e-puck"/><kind name="crab" like="e-puck"/></kinds>)";
  const Outcome out = read(parts.text());
  ASSERT_EQ(out.good().controllers[0].sensors.size(), 2U);
  EXPECT_EQ(out.good().controllers[0].sensors[0].device, "base_ground");
  EXPECT_EQ(out.good().controllers[0].sensors[1].device, "light");
}

// --- files of kinds ---

TEST_F(Files, OfKindsAreLookedForBesideTheFileThatNamesThem) {
  write("deep/crab.xml", R"(<kinds version="1"><kind name="crab" like="e-puck"/><kinds file="lobster.xml"/></kinds>)");
  write("deep/lobster.xml", "<kinds>\n<kind name=\"lobster\" like=\"crab\"/></kinds>");
  const std::string path = write("run.xml", with("<kinds file=\"deep/crab.xml\"/>", standing("lobster")));
  const Outcome out = read_file(path);
  ASSERT_EQ(out.good().kinds.size(), 2U) << out.text();
  EXPECT_EQ(out.good().kinds[1].file, (folder_ / "deep/lobster.xml").string());
  EXPECT_EQ(out.good().kinds[1].line, 2);
  EXPECT_THAT(effective_settings(out.good()), Not(HasSubstr("file=")));
}

TEST_F(Files, OfKindsThatAreNamedTwiceCountOnce) {
  write("crab.xml", R"(<kinds><kind name="crab" like="e-puck"/></kinds>)");
  write("more.xml", R"(<kinds><kinds file="crab.xml"/><kind name="lobster" like="crab"/></kinds>)");
  const Outcome out = read_file(write("run.xml", with(R"(<kinds file="crab.xml"/><kinds file="more.xml"/>)")));
  EXPECT_EQ(out.good().kinds.size(), 2U);
}

TEST_F(Files, OfKindsAreJudgedByThemselves) {
  const std::string good = write("crab.xml", R"(<kinds><kind name="crab" like="e-puck"/></kinds>)");
  Problems problems;
  const auto kinds = read_kinds_file(good, known_names(), problems);
  ASSERT_TRUE(kinds);
  EXPECT_EQ(kinds->size(), 1U);
  const std::string bad = write("bad.xml", "<kinds>\n<kind name=\"crab\"/></kinds>");
  EXPECT_FALSE(read_kinds_file(bad, known_names(), problems));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(to_text(problems[0]), bad +
                                      ":2: error: the kind 'crab' has no body; give it a <body radius=\"…\" "
                                      "height=\"…\" mass=\"…\"/>");
}

TEST_F(Files, OfKindsNeedNoUpgradeYet) {
  const std::string text = R"(<kinds><kind name="crab" like="e-puck"/></kinds>)";
  const auto same = upgraded(text, "crab.xml", known_names());
  ASSERT_TRUE(same.ok()) << same.error().message;
  EXPECT_EQ(same.value().text, text);
  EXPECT_TRUE(same.value().changes.empty());
  EXPECT_FALSE(upgraded("<kinds version=\"99\"/>", "crab.xml", known_names()).ok());
}

TEST_F(Files, OfKindsAreNoExperiments) {
  const Outcome out = read_file(write("crab.xml", R"(<kinds><kind name="crab" like="e-puck"/></kinds>)"));
  EXPECT_FALSE(out.scenario);
  EXPECT_THAT(out.text(), HasSubstr("crab.xml:1: error: this is a file of kinds of robots; an experiment takes it with "
                                    "<kinds file=\"crab.xml\"/>"));
}

TEST_F(Files, ThatIncludeThemselvesAreRefused) {
  const std::string own = write("own.xml", "<kinds>\n<kinds file=\"own.xml\"/></kinds>");
  const Outcome directly = read_file(write("run.xml", with(R"(<kinds file="own.xml"/>)")));
  EXPECT_FALSE(directly.scenario);
  EXPECT_THAT(directly.text(), AllOf(HasSubstr(own + ":2: error: <kinds file>: the file includes itself: " + own +
                                               " -> " + own + "; leave this out")));
  const std::string a = write("a.xml", R"(<kinds><kinds file="deep/b.xml"/></kinds>)");
  const std::string b = write("deep/b.xml", R"(<kinds><kinds file="../a.xml"/></kinds>)");
  const Outcome indirectly = read_file(write("run.xml", with(R"(<kinds file="a.xml"/>)")));
  EXPECT_FALSE(indirectly.scenario);
  EXPECT_THAT(indirectly.text(), AllOf(HasSubstr(b + ":1: error: "), HasSubstr(a + " -> " + b + " -> ")));
}

TEST_F(Files, OfKindsThatCannotBeReadAreNamedWhereTheyAreIncluded) {
  const std::string run = (folder_ / "run.xml").string();
  const auto text_with = [&](const std::string& name) {
    return read_file(write("run.xml", with("<kinds file=\"" + name + "\"/>"))).text();
  };
  EXPECT_THAT(text_with("nowhere.xml"), HasSubstr(run + ":8: error: <kinds file>: '" +
                                                  (folder_ / "nowhere.xml").string() + "': there is no such file"));
  EXPECT_THAT(text_with("deep"), HasSubstr("run.xml:8: error: "));
  EXPECT_THAT(text_with(""), HasSubstr("run.xml:8: error: <kinds file>: must not be empty"));
  const std::string broken = write("broken.xml", "<kinds>\n<kind\n");
  EXPECT_THAT(text_with("broken.xml"), HasSubstr(broken + ":2: error: not well-formed XML"));
  const std::string other = write("other.xml", "<tandem/>");
  EXPECT_THAT(text_with("other.xml"), HasSubstr(other + ":1: error: the root element is <tandem>; a file of kinds of "
                                                        "robots starts with <kinds>"));
  const std::string late = write("late.xml", "<kinds version=\"99\"/>");
  EXPECT_THAT(text_with("late.xml"), HasSubstr(late + ":1: error: <kinds version>: the file is of version 99"));
}

TEST_F(Files, OfKindsWithErrorsAreNamedWithTheirOwnLines) {
  const std::string path =
      write("crab.xml", "<kinds>\n<kind name=\"crab\" like=\"e-puck\">\n<body mass=\"-1\"/></kind></kinds>");
  const Outcome out =
      read_file(write("run.xml", with(R"(<kinds file="crab.xml"/>)", standing("crab", "colour=\"red\""))));
  EXPECT_FALSE(out.scenario);
  ASSERT_EQ(out.problems.size(), 2U) << out.text();
  EXPECT_THAT(to_text(out.problems[0]), HasSubstr(path + ":3: error: <body mass>: '-1' is out of range"));
  EXPECT_THAT(to_text(out.problems[1]), HasSubstr("run.xml:6: error: <crab> has no attribute 'colour'"));
}

// --- mistakes ---

struct Mistake {
  const char* name;
  std::string file;
  std::string message;
};

class Mistakes : public testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, AreNamedWithWhatToDo) {
  const Outcome out = read(GetParam().file);
  EXPECT_FALSE(out.scenario);
  EXPECT_EQ(out.problems.size(), 1U) << out.text();
  EXPECT_THAT(out.text(), HasSubstr("file.xml:8: error: " + GetParam().message));
}

const std::string kCrab = std::string(kBody) + std::string(kWheels);

INSTANTIATE_TEST_SUITE_P(
    Each, Mistakes,
    testing::Values(
        Mistake{"NoName", with("<kinds><kind>" + kCrab + "</kind></kinds>"), "<kind> needs the attribute 'name'"},
        Mistake{"BadName", with("<kinds><kind name=\"my crab\">" + kCrab + "</kind></kinds>"),
                "<kind name>: 'my crab' cannot be the name of an element; use at most 64 letters"},
        Mistake{"NameOfAnotherElement", with("<kinds><kind name=\"box\">" + kCrab + "</kind></kinds>"),
                "<kind name>: 'box' is another element of experiment files; choose another name"},
        Mistake{"NameOfAnEngine", with("<kinds><kind name=\"dynamics2d\">" + kCrab + "</kind></kinds>"),
                "<kind name>: 'dynamics2d' is another element"},
        Mistake{"NameOfARobot", with("<kinds><kind name=\"e-puck\">" + kCrab + "</kind></kinds>"),
                "<kind name>: there is a robot 'e-puck' already, from tests; give yours another name, and "
                "like=\"e-puck\" to begin from that one"},
        Mistake{"TwiceTheSameName",
                with("<kinds><kind name=\"crab\">" + kCrab + "</kind><kind name=\"crab\">" + kCrab + "</kind></kinds>"),
                "a second kind 'crab'; the first is on line 8; give one of them another name"},
        Mistake{"NoBody", crab(std::string(kWheels)), "the kind 'crab' has no body; give it a <body radius="},
        Mistake{"HalfABody", crab("<body radius=\"0.1\" mass=\"1\"/>"), "<body> needs the attribute 'height'"},
        Mistake{"HalfADrive",
                crab(std::string(kBody) +
                     R"(<differential_drive wheel_radius="0.02" wheel_base="0.1" force="1" torque="1"/>)"),
                "<differential_drive> needs the attribute 'max_speed': Of a wheel, at its rim."},
        Mistake{"HalfAPart", crab(kCrab + "<proximity><mount/></proximity>"),
                "<proximity> needs the attribute 'range'"},
        Mistake{"NegativeSize", crab(R"(<body radius="-0.1" height="1" mass="1"/>)"),
                "<body radius>: '-0.1' is out of range; it may be from 0.001 m to 100 m"},
        Mistake{"NoNumber", crab(R"(<body radius="nan" height="1" mass="1"/>)"),
                "<body radius>: 'nan' is not a number"},
        Mistake{"Infinite", crab(R"(<body radius="0.1" height="inf" mass="1"/>)"),
                "<body height>: 'inf' is not a number"},
        Mistake{"Overflow", crab(R"(<body radius="0.1" height="1e999" mass="1"/>)"), "<body height>: '1e999' is not"},
        Mistake{"AnotherUnit", crab(R"(<body radius="3 kg" height="1" mass="1"/>)"),
                "<body radius>: '3 kg': unit 'kg' does not fit"},
        Mistake{"UnknownAttribute", crab(kCrab, "colour=\"red\""), "<kind> has no attribute 'colour'"},
        Mistake{"MisspeltAttribute", crab(R"(<body radius="0.1" height="1" mas="2" mass="1"/>)"),
                "<body> has no attribute 'mas'. Did you mean 'mass'?"},
        Mistake{"UnknownPart", crab(kCrab + "<proximty range=\"1\"/>"),
                "<kind> cannot hold <proximty>: it is no body, no drive that engines know (differential_drive, "
                "quadrotor) and no part (proximity, light,"},
        Mistake{"UnknownDrive", crab(std::string(kBody) + "<omni_drive wheels=\"3\"/>"),
                "<kind> cannot hold <omni_drive>: it is no body, no drive that engines know (differential_drive, "
                "quadrotor) and no part"},
        Mistake{"TwoDrives", crab(kCrab + "<quadrotor/>"),
                "a second drive <quadrotor>; the first is <differential_drive> on line 8"},
        Mistake{"APartTwice", crab(kCrab + R"(<light><mount/></light><light><mount/></light>)"),
                "a second <light>; the first is on line 8"},
        Mistake{"TwoBodies", crab(kCrab + std::string(kBody)), "a second <body>; the first is on line 8"},
        Mistake{"MoreSensorsThanAReadingHolds", crab(kCrab + R"(<light><mount count="25"/></light>)"),
                "<light> has 25 mounts, where a reading or command holds 24; leave some out"},
        Mistake{"NoSensors", crab(kCrab + "<light/>"), "<light> has no mounts; give it at least one"},
        Mistake{"ARingOfNone", crab(kCrab + R"(<light><mount/><mount count="0"/></light>)"),
                "<mount count>: '0' is out of range; it may be from 1 to 1000"},
        Mistake{"LikeNobody", crab("", "like=\"e-pock\""),
                "<kind like>: there is no robot 'e-pock'; there are: e-puck, "},
        Mistake{"LikeItself", crab("", "like=\"crab\""),
                "<kind like>: 'crab' cannot begin from itself: 'crab' is like 'crab'; leave one of them out"},
        Mistake{"LikeInACircle",
                with("<kinds><kind name=\"a\" like=\"b\">" + kCrab + "</kind><kind name=\"b\" like=\"c\">" + kCrab +
                     "</kind><kind name=\"c\" like=\"a\">" + kCrab + "</kind></kinds>"),
                "<kind like>: 'c' cannot begin from itself: 'a' is like 'b', which is like 'c', which is like 'a'; "
                "leave one of them out"},
        Mistake{"WithoutWhatThereIsNot", crab("", "like=\"e-puck\" without=\"turret\""),
                "<kind without>: there is no 'turret' to leave out; there is: differential_drive, proximity"},
        Mistake{"BridgeOfNobody", crab(kCrab, "bridge=\"lobster\""),
                "<kind bridge>: there is no robot 'lobster'; there are: e-puck, "},
        Mistake{"AttributesThatCannotBeWritten",
                crab("<perspective_camera attributes=\"my eye\"/>", "like=\"foot-bot\""),
                "the kind 'crab' lets its robots say 'my eye_front', which is no name of an attribute"},
        Mistake{"AttributesThatCannotBeToldApart",
                crab("<perspective_camera attributes=\"rab\"/>", "like=\"foot-bot\""),
                "the kind 'crab' has two parts that let its robots say 'rab_range'; leave one of them out"},
        Mistake{"AnotherElement", with("<kinds><crab/></kinds>"),
                "<kinds> cannot hold <crab>; it may hold: kind, kinds"}),
    [](const auto& mistake) { return mistake.param.name; });

TEST(Kinds, WithMistakesDoNotHideThoseOfTheRest) {
  const Outcome out =
      read(with(R"(<kinds><kind name="crab"><body radius="0"/><leds><mount count="17"/></leds></kind></kinds>)",
                standing("crab", "colour=\"red\"")));
  EXPECT_FALSE(out.scenario);
  EXPECT_THAT(out.text(), AllOf(HasSubstr("<crab> has no attribute 'colour'"), HasSubstr("<body radius>"),
                                HasSubstr("<leds> has 17 mounts"), Not(HasSubstr("cannot hold"))));
}

}  // namespace
}  // namespace tandem::core
