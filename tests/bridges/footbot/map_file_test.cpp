// The file of a foot-bot's names: what it says, and every way to get it wrong.
#include "bridges/footbot/map_file.hpp"

#include <gmock/gmock.h>

#include "tests/checkout.hpp"

namespace tandem::bridges::footbot {
namespace {

using bridges::footbot::FootbotMap;
using bridges::footbot::Need;
using bridges::footbot::WordForm;
using testing::HasSubstr;

/// The problems of a map, one a line.
std::string problems_of(const std::string& text) {
  hal::Problems problems;
  const auto map = read_footbot_map_text(text, "m.xml", problems);
  EXPECT_EQ(map.has_value(), !hal::has_errors(problems));
  std::string all;
  for (const hal::Problem& p : problems) all += hal::to_text(p) + "\n";
  return all;
}

/// A map with one variable, whose children begin on line 4.
std::string with(const std::string& children, const std::string& variable = "names=\"x\" words=\"24\"") {
  return "<footbot_map>\n<node names=\"n\">\n<variable " + variable + ">\n" + children +
         "\n</variable>\n</node>\n</footbot_map>";
}

TEST(FootbotMapFile, IsReadAsItStands) {
  hal::Problems problems;
  const auto read = read_footbot_map_text(R"(<footbot_map profile="p" refresh="250 ms">
<node names=" left motor | wheel-left" id="7" needed="always">
<variable names="odo|odometer" words="4" period="2 s" optional="true">
<read port="wheel_encoders" field="left" form="int32_high_first" word="2" scale="0.5 cm" offset="1" min="-1 m" max="2" accumulate="true" rate="left_speed" fastest="60 cm"/>
</variable>
<variable names="speed" words="2" verify="true">
<write port="differential_steering" field="right" form="int32" scale="2 mm/s" least="-9" most="8" rest="-1"/>
</variable>
</node>
<node names="b" needed="never"><variable names="v" words="5">
<read port="light" field="level" word="4" word_step="-1" element="1" element_step="3"><knot raw="0" value="1"/><knot raw="9" value="0"/><special raw="-3" value="0.5"/></read>
</variable></node>
</footbot_map>)",
                                          "m.xml", problems);
  for (const hal::Problem& p : problems) ADD_FAILURE() << hal::to_text(p);
  ASSERT_TRUE(read);
  const FootbotMap& map = *read;
  EXPECT_EQ(map.profile, "p");
  EXPECT_EQ(map.refresh_ns, 250 * hal::kNsPerMs);
  ASSERT_EQ(map.nodes.size(), 2U);
  EXPECT_EQ(map.nodes[0].names, (std::vector<std::string>{"left motor", "wheel-left"}));
  EXPECT_EQ(map.nodes[0].id, 7);
  EXPECT_EQ(map.nodes[0].need, Need::Always);
  EXPECT_EQ(map.nodes[1].need, Need::Never);
  const auto& odo = map.nodes[0].variables.at(0);
  EXPECT_EQ(odo.words, 4U);
  EXPECT_EQ(odo.period_ns, 2 * hal::kNsPerSecond);
  EXPECT_TRUE(odo.optional);
  EXPECT_EQ(odo.line, 3);
  const auto& left = odo.reads.at(0);
  EXPECT_EQ(left.form, WordForm::Int32HighFirst);
  EXPECT_EQ(left.word, 2U);
  EXPECT_EQ(left.count, 1U);
  EXPECT_DOUBLE_EQ(left.scale, 0.005);
  EXPECT_DOUBLE_EQ(left.offset, 1.0);
  EXPECT_DOUBLE_EQ(left.min, -1.0);
  EXPECT_DOUBLE_EQ(left.max, 2.0);
  EXPECT_DOUBLE_EQ(left.fastest, 0.6);
  EXPECT_TRUE(left.accumulate);
  EXPECT_EQ(left.rate->name, "left_speed");
  const auto& speed = map.nodes[0].variables.at(1);
  EXPECT_TRUE(speed.verify);
  EXPECT_DOUBLE_EQ(speed.writes.at(0).scale, 0.002);
  EXPECT_EQ(speed.writes[0].least, -9);
  EXPECT_EQ(speed.writes[0].most, 8);
  EXPECT_EQ(speed.writes[0].rest, -1);
  const auto& light = map.nodes[1].variables.at(0).reads.at(0);
  EXPECT_EQ(light.count, 5U);  // as many as the variable holds
  EXPECT_EQ(light.word_step, -1);
  EXPECT_EQ(light.element_step, 3);
  ASSERT_EQ(light.curve.size(), 2U);
  EXPECT_EQ(light.curve[1].raw, 9.0);
  ASSERT_EQ(light.specials.size(), 1U);
  EXPECT_EQ(light.specials[0].value, 0.5);
}

TEST(FootbotMapFile, OfThisProjectHasNoProblem) {
  hal::Problems problems;
  const auto map = read_footbot_map((std::string(test::kSourceDir) + "/configs/footbot_map.xml"), problems);
  for (const hal::Problem& p : problems) ADD_FAILURE() << hal::to_text(p);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->nodes.size(), 9U);
}

TEST(FootbotMapFile, TellsAllProblemsAtOnce) {
  const std::string all = problems_of(R"(<footbot_map refresch="1 s">
<node names="a" id="300" needed="sometimes">
<variable words="2"><read port="proximitty" field="distance"/></variable>
<variable names="v" words="0"><read port="proximity" field="distanse"/></variable>
<variabel names="w"/>
</node>
<node names="a"/>
</footbot_map>)");
  EXPECT_THAT(all, HasSubstr("m.xml:1: error: "));
  EXPECT_THAT(all, HasSubstr("refresch"));
  EXPECT_THAT(all, HasSubstr("Did you mean 'refresh'?"));
  EXPECT_THAT(all, HasSubstr("m.xml:2: error: <node id>"));
  EXPECT_THAT(all, HasSubstr("m.xml:2: error: <node needed>"));
  EXPECT_THAT(all, HasSubstr("m.xml:3: error: <variable names>: missing"));
  EXPECT_THAT(all, HasSubstr("m.xml:3: error: <read port>: 'proximitty' is no port that a foot-bot reads"));
  EXPECT_THAT(all, HasSubstr("Did you mean 'proximity'?"));
  EXPECT_THAT(all, HasSubstr("m.xml:4: error: <variable words>"));
  EXPECT_THAT(all, HasSubstr("m.xml:4: error: <read field>: 'distanse' is no field of the port 'proximity'"));
  EXPECT_THAT(all, HasSubstr("m.xml:5: error: <node> has no <variabel>"));
  EXPECT_THAT(all, HasSubstr("m.xml:7: error: <node names>: 'a' is the name of the node on line 2"));
  EXPECT_THAT(all, HasSubstr("m.xml:7: error: has neither a <variable> nor an <event>"));
}

struct Mistake {
  const char* name;
  std::string text;
  const char* problem;
};

class FootbotMapMistake : public testing::TestWithParam<Mistake> {};

TEST_P(FootbotMapMistake, IsTold) {
  EXPECT_THAT(problems_of(GetParam().text), HasSubstr(GetParam().problem));
}

const std::string kEvent = "<footbot_map><node names=\"n\">\n";
const std::string kEventEnd = "\n</node></footbot_map>";

INSTANTIATE_TEST_SUITE_P(
    All, FootbotMapMistake,
    testing::Values(
        Mistake{"NotXml", "<footbot_map>", "m.xml:1: error: "},
        Mistake{"Empty", "<footbot_map/>", "there is no <node>"},
        Mistake{"OtherRoot", "<map><node names=\"a\"/></map>", "not <footbot_map>"},
        Mistake{"NoPort", with("<read field=\"distance\"/>"), "m.xml:4: error: <read port>: missing"},
        Mistake{"NoField", with("<read port=\"proximity\"/>"), "m.xml:4: error: <read field>: missing"},
        Mistake{"SensorWritten", with("<write port=\"proximity\" field=\"distance\"/>"),
                "'proximity' is no port that a foot-bot writes"},
        Mistake{"Stamp", with("<read port=\"proximity\" field=\"validity\"/>"), "'validity' is no field"},
        Mistake{"ScaleZero", with("<read port=\"light\" field=\"level\" scale=\"0\"/>"), "may not be 0"},
        Mistake{"WrongUnit", with("<read port=\"proximity\" field=\"distance\" scale=\"1 s\"/>"),
                "m.xml:4: error: <read scale>"},
        Mistake{"NotANumber", with("<read port=\"light\" field=\"level\" word=\"two\"/>"),
                "'two' is not a whole number"},
        Mistake{"BeyondVariable", with("<read port=\"light\" field=\"level\" word=\"20\" count=\"5\"/>"),
                "reaches from word 20 to 24 of a variable of 24 words"},
        Mistake{"BeforeVariable",
                with("<read port=\"light\" field=\"level\" word=\"2\" word_step=\"-1\" count=\"4\"/>"),
                "reaches from word -1 to 2"},
        Mistake{"BeyondField", with("<read port=\"light\" field=\"level\" element=\"20\" count=\"5\"/>"),
                "reaches from element 20 to 24 of the field 'level' of 24"},
        Mistake{"StepZero", with("<read port=\"light\" field=\"level\" word_step=\"0\" count=\"5\"/>"), "a step of 0"},
        Mistake{"OneKnot", with("<read port=\"light\" field=\"level\"><knot raw=\"1\" value=\"1\"/></read>"),
                "a curve has two <knot> at least"},
        Mistake{"KnotsDescend",
                with("<read port=\"light\" field=\"level\"><knot raw=\"1\" value=\"1\"/>\n<knot raw=\"1\" "
                     "value=\"2\"/></read>"),
                "m.xml:5: error: <knot raw>: knots must ascend"},
        Mistake{"KnotWithoutValue",
                with("<read port=\"light\" field=\"level\"><knot raw=\"1\"/><knot raw=\"2\" value=\"2\"/></read>"),
                "<knot value>: missing"},
        Mistake{"CurveAndScale",
                with("<read port=\"light\" field=\"level\" scale=\"2\"><knot raw=\"1\" value=\"1\"/><knot raw=\"2\" "
                     "value=\"2\"/></read>"),
                "both a curve"},
        Mistake{"CurveOnWrite", with("<write port=\"leds\" field=\"rgb\"><knot raw=\"1\" value=\"1\"/></write>"),
                "<write> has no <knot>"},
        Mistake{"MinAboveMax", with("<read port=\"light\" field=\"level\" min=\"1\" max=\"0\"/>"), "larger than max"},
        Mistake{"RateUnknown", with("<read port=\"turret_encoder\" field=\"angle\" rate=\"sped\"/>"),
                "<read rate>: 'sped' is no field"},
        Mistake{"WhenNoFlag", with("<write port=\"range_and_bearing\" field=\"payload\" when=\"size\"/>"),
                "is no flag"},
        Mistake{"LeastAboveMost", with("<write port=\"leds\" field=\"rgb\" least=\"3\" most=\"2\"/>"),
                "larger than most"},
        Mistake{"RestTooLarge", with("<write port=\"leds\" field=\"rgb\" rest=\"40000\"/>"), "no number of this form"},
        Mistake{"WordNotWritten", with("<write port=\"leds\" field=\"rgb\" count=\"23\"/>"),
                "no <write> says what is to be in word 23"},
        Mistake{"HalfWordNotWritten",
                with("<write port=\"range_and_bearing\" field=\"payload\" form=\"bytes\" count=\"9\"/>",
                     "names=\"x\" words=\"5\""),
                "no <write> says what is to be in word 4"},
        Mistake{"WordWrittenTwice",
                with("<write port=\"leds\" field=\"rgb\"/><write port=\"leds\" field=\"rgb\" count=\"1\"/>"),
                "write the same word"},
        Mistake{"ReadTwice",
                with("<read port=\"light\" field=\"level\"/>\n<read port=\"light\" field=\"level\" word=\"1\"/>"),
                "m.xml:5: error: element 0 of 'level' of the port 'light' is read on line 4 already"},
        Mistake{"VerifyNothing",
                with("<read port=\"light\" field=\"level\"/>", "names=\"x\" words=\"24\" verify=\"1\""),
                "<variable verify>: nothing is written"},
        Mistake{"NoUse", with(""), "nobody needs it"},
        Mistake{"SameVariableTwice",
                "<footbot_map><node names=\"n\">\n<variable names=\"x\" words=\"1\"><read port=\"gyroscope\" "
                "field=\"rate\"/></variable>\n<variable names=\"y|x\" words=\"1\"><read port=\"gripper\" "
                "field=\"busy\"/></variable></node></footbot_map>",
                "m.xml:3: error: <variable names>: 'x' is the name of the variable on line 2"},
        Mistake{"EventWithoutNumber", kEvent + "<event words=\"8\" port=\"range_and_bearing\"/>" + kEventEnd,
                "m.xml:2: error: <event number>: missing"},
        Mistake{"EventOfOtherPort", kEvent + "<event number=\"1\" words=\"8\" port=\"battery\"/>" + kEventEnd,
                "messages of 'range_and_bearing' alone"},
        Mistake{"EventWithoutPayload",
                kEvent + "<event number=\"1\" words=\"8\" port=\"range_and_bearing\"/>" + kEventEnd,
                "where the field 'payload' is"},
        Mistake{"EventOfOtherField",
                kEvent + "<event number=\"1\" words=\"8\" port=\"range_and_bearing\"><value field=\"count\"/></event>" +
                    kEventEnd,
                "tells range, bearing, elevation and payload"},
        Mistake{"EventNumberTaken",
                kEvent +
                    "<event number=\"1\" words=\"8\" port=\"range_and_bearing\"/>\n<event number=\"1\" words=\"8\" "
                    "port=\"range_and_bearing\"/>" +
                    kEventEnd,
                "m.xml:3: error: <event number>: is taken by the event on line 2"},
        Mistake{"EventNumberOfCommand",
                kEvent + "<event number=\"32768\" words=\"8\" port=\"range_and_bearing\"/>" + kEventEnd,
                "m.xml:2: error: <event number>: '32768' is out of range"}),
    [](const auto& instance) { return instance.param.name; });

TEST(FootbotMapFile, NamesAFileThatIsNotThere) {
  hal::Problems problems;
  EXPECT_FALSE(read_footbot_map("/no/such/map.xml", problems));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(hal::to_text(problems[0]), "/no/such/map.xml: error: there is no such file");
}

}  // namespace
}  // namespace tandem::bridges::footbot
