// What is wrong in a file is said once, with its line, and together with everything else that is wrong.
#include <gmock/gmock.h>

#include "tests/core/config/reading.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;

struct Case {
  std::string name;
  void (*spoil)(Parts&);
  int line;
  std::string message;  // a part of it
};

std::string name_of(const testing::TestParamInfo<Case>& info) {
  return info.param.name;
}
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

const std::string kRobot = R"(<e-puck id="ep"><body position="0,0,0"/><controller config="w"/></e-puck>)";

std::string distribute(const std::string& position, const std::string& entity, const std::string& thing) {
  return "<distribute><position " + position + "/><orientation method=\"constant\" values=\"0,0,0\"/><entity " +
         entity + ">" + thing + "</entity></distribute>";
}

const std::string kUniform = R"(method="uniform" min="0,0,0" max="1,1,0")";
const std::string kMany = R"(<e-puck id="ep"><controller config="w"/></e-puck>)";

class OneProblem : public testing::TestWithParam<Case> {};

TEST_P(OneProblem, IsSaidOnceWithItsLine) {
  Parts parts;
  GetParam().spoil(parts);
  const Outcome out = read(parts.text());
  EXPECT_FALSE(out.scenario.has_value());
  ASSERT_EQ(out.problems.size(), 1U) << out.text();
  EXPECT_EQ(out.problems[0].line, GetParam().line) << out.text();
  EXPECT_EQ(out.problems[0].file, "file.xml");
  EXPECT_FALSE(out.problems[0].warning);
  EXPECT_THAT(out.problems[0].message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Framework, OneProblem,
    testing::Values(
        Case{"missing", [](Parts& p) { p.framework = ""; }, 1, "there is no <framework>"},
        Case{"no_experiment", [](Parts& p) { p.framework = "<framework/>"; }, 2, "<framework> needs an <experiment>"},
        Case{"misspelt_attribute", [](Parts& p) { p.framework = R"(<framework><experiment lenght="5"/></framework>)"; },
             2, "<experiment> has no attribute 'lenght'. Did you mean 'length'?"},
        Case{"negative_length", [](Parts& p) { p.framework = R"(<framework><experiment length="-1"/></framework>)"; },
             2, "<experiment length>: '-1' is out of range; it may be from 0 s"},
        Case{"wrong_unit", [](Parts& p) { p.framework = R"(<framework><experiment length="5 cm"/></framework>)"; }, 2,
             "unit 'cm' does not fit"},
        Case{"nan", [](Parts& p) { p.framework = R"(<framework><experiment length="nan"/></framework>)"; }, 2,
             "'nan' is not a number"},
        Case{"infinite", [](Parts& p) { p.framework = R"(<framework><experiment length="inf"/></framework>)"; }, 2,
             "'inf' is not a number"},
        Case{"no_ticks", [](Parts& p) { p.framework = R"(<framework><experiment ticks_per_second="0"/></framework>)"; },
             2, "<experiment ticks_per_second>: '0' is out of range"},
        Case{"broken_ticks",
             [](Parts& p) { p.framework = R"(<framework><experiment ticks_per_second="2.5"/></framework>)"; }, 2,
             "'2.5' is not a whole number"},
        Case{"negative_seed",
             [](Parts& p) { p.framework = R"(<framework><experiment random_seed="-3"/></framework>)"; }, 2,
             "out of range"},
        Case{"huge_seed",
             [](Parts& p) {
               p.framework = R"(<framework><experiment random_seed="99999999999999999999"/></framework>)";
             },
             2, "too large"},
        Case{"bad_flag", [](Parts& p) { p.framework = R"(<framework><experiment real_time="yes"/></framework>)"; }, 2,
             "neither \"true\" nor \"false\""},
        Case{"bad_choice",
             [](Parts& p) { p.framework = R"(<framework><experiment/><time mode="realtme"/></framework>)"; }, 2,
             "'realtme' is not one of: fast, realtime, lockstep. Did you mean 'realtime'?"},
        Case{"lockstep",
             [](Parts& p) { p.framework = R"(<framework><experiment/><time mode="lockstep"/></framework>)"; }, 2,
             "'lockstep' has nobody to wait for: give a robot a <peer/>, or use fast"},
        Case{"contradiction",
             [](Parts& p) {
               p.framework = R"(<framework><experiment real_time="true"/><time mode="fast"/></framework>)";
             },
             2, "contradicts"},
        Case{"twice", [](Parts& p) { p.framework += "<framework><experiment/></framework>"; }, 2,
             "a second <framework>; the first is on line 2"},
        Case{"attribute_twice",
             [](Parts& p) { p.framework = R"(<framework><experiment length="1" length="2"/></framework>)"; }, 2,
             "only once"}),
    &name_of);

INSTANTIATE_TEST_SUITE_P(
    Controllers, OneProblem,
    testing::Values(
        Case{"no_id",
             [](Parts& p) {
               p.things = "";
               p.controllers = R"(<controllers><wander library="l"/></controllers>)";
             },
             3, "<wander> needs the attribute 'id'"},
        Case{"empty_id",
             [](Parts& p) {
               p.things = "";
               p.controllers = R"(<controllers><wander id="" library="l"/></controllers>)";
             },
             3, "<wander id>: must not be empty"},
        Case{"second_id",
             [](Parts& p) {
               p.controllers = R"(<controllers><wander id="w" library="l"/><other id="w" library="l"/></controllers>)";
             },
             3, "a second controller 'w'; the first is on line 3"},
        Case{"unknown_child",
             [](Parts& p) {
               p.controllers = R"(<controllers><wander id="w" library="l"><sensor/></wander></controllers>)";
             },
             3, "<wander> cannot hold <sensor>; it may hold: actuators, sensors, params. Did you mean 'sensors'?"},
        Case{
            "misspelt_sensor",
            [](Parts& p) {
              p.controllers =
                  R"(<controllers><wander id="w" library="l"><sensors><epuck_proximty/></sensors></wander></controllers>)";
            },
            3, "known: wheel_encoders, proximity, light"},
        Case{
            "unknown_actuator",
            [](Parts& p) {
              p.controllers =
                  R"(<controllers><wander id="w" library="l"><actuators><magnets/></actuators></wander></controllers>)";
            },
            3, "unknown actuator <magnets>; known: differential_steering, leds, body_led"},
        Case{
            "sensor_as_actuator",
            [](Parts& p) {
              p.controllers =
                  R"(<controllers><wander id="w" library="l"><actuators><proximity/></actuators></wander></controllers>)";
            },
            3, "unknown actuator <proximity>"},
        Case{
            "device_twice",
            [](Parts& p) {
              p.controllers =
                  R"(<controllers><wander id="w" library="l"><sensors><proximity/><epuck_proximity/></sensors></wander></controllers>)";
            },
            3, "the device 'proximity' is already on line 3"}),
    &name_of);

INSTANTIATE_TEST_SUITE_P(
    Engines, OneProblem,
    testing::Values(
        Case{"unknown", [](Parts& p) { p.engines = R"(<physics_engines><dynamics4d id="d"/></physics_engines>)"; }, 4,
             "unknown physics engine <dynamics4d>; known: kinematics2d, dynamics2d, dynamics3d, particle3d"},
        Case{"no_id", [](Parts& p) { p.engines = "<physics_engines><kinematics2d/></physics_engines>"; }, 4,
             "needs the attribute 'id'"},
        Case{"second_id",
             [](Parts& p) {
               p.engines = R"(<physics_engines><kinematics2d id="k"/><kinematics2d id="k"/></physics_engines>)";
             },
             4, "a second engine 'k'"},
        Case{"regions",
             [](Parts& p) { p.engines = R"(<physics_engines><kinematics2d id="k" regions="4x"/></physics_engines>)"; },
             4, "must be like \"4x4\""},
        Case{
            "two_vertices",
            [](Parts& p) {
              p.engines =
                  R"(<physics_engines><kinematics2d id="k"><boundaries><sides><vertex point="0,0"/><vertex point="1,0"/></sides></boundaries></kinematics2d></physics_engines>)";
            },
            4, "at least three vertices"},
        Case{
            "bad_vertex",
            [](Parts& p) {
              p.engines =
                  R"(<physics_engines><kinematics2d id="k"><boundaries><sides><vertex point="0;0"/><vertex point="1,0"/><vertex point="1,1"/></sides></boundaries></kinematics2d></physics_engines>)";
            },
            4, "<vertex point>: '0;0' must be two lengths"},
        Case{
            "no_area",
            [](Parts& p) {
              p.engines =
                  R"(<physics_engines><kinematics2d id="k"><boundaries><sides><vertex point="0,0"/><vertex point="1,0"/><vertex point="2,0"/></sides></boundaries></kinematics2d></physics_engines>)";
            },
            4, "no area"},
        Case{
            "crossing",
            [](Parts& p) {
              p.engines =
                  R"(<physics_engines><kinematics2d id="k"><boundaries><sides><vertex point="0,0"/><vertex point="1,1"/><vertex point="3,0"/><vertex point="0,1"/></sides></boundaries></kinematics2d></physics_engines>)";
            },
            4, "cross"},
        Case{
            "touching",
            [](Parts& p) {
              p.engines =
                  R"(<physics_engines><kinematics2d id="k"><boundaries><sides><vertex point="0,0"/><vertex point="3,0"/><vertex point="3,2"/><vertex point="1,0"/><vertex point="0,2"/></sides></boundaries></kinematics2d></physics_engines>)";
            },
            4, "cross or touch"},
        Case{
            "pinched",
            [](Parts& p) {
              p.engines =
                  R"(<physics_engines><kinematics2d id="k"><boundaries><sides><vertex point="0,0"/><vertex point="1,1"/><vertex point="2,0"/><vertex point="2,3"/><vertex point="1,1"/><vertex point="0,2"/></sides></boundaries></kinematics2d></physics_engines>)";
            },
            4, "cross or touch"},
        Case{
            "spike",
            [](Parts& p) {
              p.engines =
                  R"(<physics_engines><kinematics2d id="k"><boundaries><sides><vertex point="0,0"/><vertex point="2,0"/><vertex point="1,0"/><vertex point="1,1"/><vertex point="0,1"/></sides></boundaries></kinematics2d></physics_engines>)";
            },
            4, "goes back along the one before it"},
        Case{
            "gate_to_nowhere",
            [](Parts& p) {
              p.engines =
                  R"(<physics_engines><kinematics2d id="left"><boundaries><sides><vertex point="0,0" gate="rihgt"/><vertex point="1,0"/><vertex point="1,1"/></sides></boundaries></kinematics2d><kinematics2d id="right"/></physics_engines>)";
            },
            4, "<vertex gate>: there is no engine with id 'rihgt'; there are: left, right. Did you mean 'right'?"},
        Case{
            "gate_to_itself",
            [](Parts& p) {
              p.engines =
                  R"(<physics_engines><kinematics2d id="k"><boundaries><sides><vertex point="0,0" gate="k"/><vertex point="1,0"/><vertex point="1,1"/></sides></boundaries></kinematics2d></physics_engines>)";
            },
            4, "leads back into its own engine"},
        Case{
            "upside_down",
            [](Parts& p) {
              p.engines =
                  R"(<physics_engines><kinematics2d id="k"><boundaries><top height="0"/><bottom height="1"/></boundaries></kinematics2d></physics_engines>)";
            },
            4, "<top> is not above <bottom>"}),
    &name_of);

INSTANTIATE_TEST_SUITE_P(
    Arena, OneProblem,
    testing::Values(
        Case{"no_size", [](Parts& p) { p.arena = "<arena>"; }, 5, "<arena> needs the attribute 'size'"},
        Case{"two_numbers", [](Parts& p) { p.arena = R"(<arena size="4,4">)"; }, 5, "must be three numbers"},
        Case{"flat", [](Parts& p) { p.arena = R"(<arena size="4,0,1">)"; }, 5,
             "<arena size>: '4,0,1': every length must be above 0"},
        Case{"negative", [](Parts& p) { p.arena = R"(<arena size="4,4,-1">)"; }, 5, "every length must be above 0"},
        Case{"huge", [](Parts& p) { p.arena = R"(<arena size="4,4,1e7">)"; }, 5, "within 1000 km of 0"},
        Case{"far_arena", [](Parts& p) { p.arena = R"(<arena size="4,4,1" center="1e15,0,0">)"; }, 5,
             "<arena center>: '1e15,0,0': every number must be within 1000 km of 0"},
        Case{"far_box", [](Parts& p) { p.things = R"(<box id="b" size="1,1,1"><body position="1e308,0,0"/></box>)"; },
             6, "<body position>: '1e308,0,0': every number must be within 1000 km of 0"},
        Case{"far_light", [](Parts& p) { p.things = R"(<light id="l" position="0,1e300,2"/>)"; }, 6,
             "within 1000 km of 0"},
        Case{"unknown_robot", [](Parts& p) { p.things = R"(<hand-bot id="hb"/>)"; }, 6,
             "<arena> cannot hold <hand-bot>; it may hold: floor, box, cylinder, light, sound, distribute, e-puck"},
        Case{"misspelt_thing", [](Parts& p) { p.things = R"(<e-pukc id="ep"/>)"; }, 6, "Did you mean 'e-puck'?"},
        Case{"text", [](Parts& p) { p.things = kRobot + "oops"; }, 6, "<arena> holds the text 'oops"},
        Case{"flat_box", [](Parts& p) { p.things = R"(<box id="b" size="1,0,1"><body position="0,0,0"/></box>)"; }, 6,
             "<box size>: '1,0,1': every length must be above 0"},
        Case{"massless_box",
             [](Parts& p) { p.things = R"(<box id="b" size="1,1,1" mass="0"><body position="0,0,0"/></box>)"; }, 6,
             "<box mass>: '0' is out of range"},
        Case{"movable_box",
             [](Parts& p) { p.things = R"(<box id="b" size="1,1,1" movable="true"><body position="0,0,0"/></box>)"; },
             6, "<box movable>: kinematics2d moves no objects; use one of the engines that do"},
        Case{"thin_cylinder",
             [](Parts& p) {
               p.things = R"(<cylinder id="c" radius="-1" height="1"><body position="0,0,0"/></cylinder>)";
             },
             6, "<cylinder radius>: '-1' is out of range"},
        Case{"no_radius",
             [](Parts& p) { p.things = R"(<cylinder id="c" height="1"><body position="0,0,0"/></cylinder>)"; }, 6,
             "needs the attribute 'radius'"},
        Case{"no_body", [](Parts& p) { p.things = R"(<box id="b" size="1,1,1"/>)"; }, 6, "<box> needs a <body"},
        Case{"no_position", [](Parts& p) { p.things = R"(<box id="b" size="1,1,1"><body/></box>)"; }, 6,
             "<body> needs the attribute 'position'"},
        Case{"dark_light", [](Parts& p) { p.things = R"(<light id="l" position="0,0,1" color="mauve"/>)"; }, 6,
             "'mauve' is neither a colour's name"},
        Case{"bright_light", [](Parts& p) { p.things = R"(<light id="l" position="0,0,1" color="1,2,300"/>)"; }, 6,
             "'1,2,300' is neither"},
        Case{"light_nowhere", [](Parts& p) { p.things = R"(<light id="l"/>)"; }, 6,
             "<light> needs the attribute 'position'"},
        Case{"floor_of_another_field", [](Parts& p) { p.things = R"(<floor height="1"/>)"; }, 6,
             "has no attribute 'height'"},
        Case{"same_id", [](Parts& p) { p.things = kRobot + "\n" + kRobot; }, 7,
             "the id 'ep' is taken twice: also on line 6"},
        Case{"same_id_of_box_and_light",
             [](Parts& p) {
               p.things = R"(<box id="x" size="1,1,1"><body position="0,0,0"/></box><light id="x" position="0,0,0"/>)";
             },
             6, "the id 'x' is taken twice"}),
    &name_of);

INSTANTIATE_TEST_SUITE_P(
    Robots, OneProblem,
    testing::Values(
        Case{"no_controller", [](Parts& p) { p.things = R"(<e-puck id="ep"><body position="0,0,0"/></e-puck>)"; }, 6,
             "<e-puck> needs a <controller config"},
        Case{
            "unknown_controller",
            [](Parts& p) { p.things = R"(<e-puck id="ep"><body position="0,0,0"/><controller config="v"/></e-puck>)"; },
            6, "there is no controller with id 'v'; there are: w. Did you mean 'w'?"},
        Case{"no_id",
             [](Parts& p) { p.things = R"(<e-puck><body position="0,0,0"/><controller config="w"/></e-puck>)"; }, 6,
             "<e-puck> needs the attribute 'id'"},
        Case{"bridge_without_link",
             [](Parts& p) {
               p.things = R"(<e-puck id="ep"><body position="0,0,0"/><controller config="w"/><bridge/></e-puck>)";
             },
             6, "<bridge> needs the attribute 'link'"},
        Case{
            "full_battery",
            [](Parts& p) {
              p.things =
                  R"(<e-puck id="ep"><body position="0,0,0"/><controller config="w"/><battery start_charge="2"/></e-puck>)";
            },
            6, "<battery start_charge>: above full_charge"},
        Case{"message_too_long",
             [](Parts& p) {
               p.things =
                   R"(<e-puck id="ep" rab_data_size="11"><body position="0,0,0"/><controller config="w"/></e-puck>)";
             },
             6, "<e-puck rab_data_size>: '11' is out of range"},
        Case{"no_such_selector_position",
             [](Parts& p) {
               p.things =
                   R"(<e-puck2 id="ep" selector="16"><body position="0,0,0"/><controller config="w"/></e-puck2>)";
             },
             6, "<e-puck2 selector>: '16' is out of range"}),
    &name_of);

INSTANTIATE_TEST_SUITE_P(
    Distributes, OneProblem,
    testing::Values(
        Case{"no_entity",
             [](Parts& p) {
               p.things = "<distribute><position " + kUniform +
                          R"(/><orientation method="constant" values="0,0,0"/></distribute>)";
             },
             6, "<distribute> needs <entity>"},
        Case{"no_method",
             [](Parts& p) { p.things = distribute(R"(min="0,0,0" max="1,1,1")", R"(quantity="1")", kMany); }, 6,
             "<position> needs the attribute 'method'"},
        Case{"unknown_method",
             [](Parts& p) {
               p.things = distribute(R"(method="unifrom" min="0,0,0" max="1,1,1")", R"(quantity="1")", kMany);
             },
             6, "Did you mean 'uniform'?"},
        Case{"no_max",
             [](Parts& p) { p.things = distribute(R"(method="uniform" min="0,0,0")", R"(quantity="1")", kMany); }, 6,
             "<position method=\"uniform\"> needs the attribute 'max'"},
        Case{"another_methods_attribute",
             [](Parts& p) { p.things = distribute(kUniform + R"( mean="0,0,0")", R"(quantity="1")", kMany); }, 6,
             "<position mean>: method=\"uniform\" has no such attribute; it takes: min, max"},
        Case{"min_above_max",
             [](Parts& p) {
               p.things = distribute(R"(method="uniform" min="0,2,0" max="1,1,0")", R"(quantity="1")", kMany);
             },
             6, "<position min>: above max in its second number"},
        Case{"negative_deviation",
             [](Parts& p) {
               p.things = distribute(R"(method="gaussian" mean="0,0,0" std_dev="1,1,-1")", R"(quantity="1")", kMany);
             },
             6, "<position std_dev>: negative in its third number"},
        Case{"half_a_row",
             [](Parts& p) {
               p.things = distribute(R"(method="grid" center="0,0,0" distances="1,1,1" layout="2,1.5,1")",
                                     R"(quantity="1")", kMany);
             },
             6, "<position layout>: its second number must be whole"},
        Case{"small_grid",
             [](Parts& p) {
               p.things = distribute(R"(method="grid" center="0,0,0" distances="1,1,1" layout="2,3,1")",
                                     R"(quantity="7")", kMany);
             },
             6, "<entity quantity>: the grid has only 6 places"},
        Case{"no_quantity", [](Parts& p) { p.things = distribute(kUniform, "", kMany); }, 6,
             "<entity> needs the attribute 'quantity'"},
        Case{"absurd_quantity", [](Parts& p) { p.things = distribute(kUniform, R"(quantity="100000001")", kMany); }, 6,
             "'100000001' is out of range"},
        Case{"negative_quantity", [](Parts& p) { p.things = distribute(kUniform, R"(quantity="-1")", kMany); }, 6,
             "'-1' is out of range"},
        Case{"too_many_in_all",
             [](Parts& p) {
               p.things =
                   distribute(kUniform, R"(quantity="100000000")", kMany) +
                   distribute(kUniform, R"(quantity="1")", R"(<e-puck id="other"><controller config="w"/></e-puck>)");
             },
             5, "100000001 robots in all"},
        Case{"two_things",
             [](Parts& p) {
               p.things = distribute(kUniform, R"(quantity="1")", kMany + R"(<box id="b" size="1,1,1"/>)");
             },
             6, "exactly one robot, box, cylinder or light inside; it has 2"},
        Case{"nested", [](Parts& p) { p.things = distribute(kUniform, R"(quantity="1")", "<distribute/>"); }, 6,
             "<entity> cannot hold <distribute>"},
        Case{"bridged",
             [](Parts& p) {
               p.things = distribute(kUniform, R"(quantity="1")",
                                     R"(<e-puck id="ep"><controller config="w"/><bridge link="l"/></e-puck>)");
             },
             6, "it cannot be distributed"},
        Case{"id_in_a_range",
             [](Parts& p) {
               p.things = distribute(kUniform, R"(quantity="5" base_num="10")", kMany) +
                          "\n"
                          R"(<e-puck id="ep14"><body position="0,0,0"/><controller config="w"/></e-puck>)";
             },
             7, "the id 'ep14' is taken twice: also on line 6"},
        Case{"ranges_overlap",
             [](Parts& p) {
               p.things = distribute(kUniform, R"(quantity="5")", kMany) + "\n" +
                          distribute(kUniform, R"(quantity="5" base_num="4")", kMany);
             },
             7, "the id 'ep4' is taken twice: also on line 6"},
        Case{"prefix_with_digits",
             [](Parts& p) {
               p.things =
                   distribute(kUniform, R"(quantity="20")", kMany) + "\n" +
                   distribute(kUniform, R"(quantity="3")", R"(<e-puck id="ep1"><controller config="w"/></e-puck>)");
             },
             7, "the id 'ep10' is taken twice: also on line 6"}),
    &name_of);

INSTANTIATE_TEST_SUITE_P(
    Rest, OneProblem,
    testing::Values(Case{"unknown_part", [](Parts& p) { p.rest = "<recrod/>"; }, 8, "<tandem> cannot hold <recrod>"},
                    Case{"media_twice", [](Parts& p) { p.rest = R"(<media><led id="a"/><led id="a"/></media>)"; }, 8,
                         "a second medium 'a'"},
                    Case{"unknown_medium", [](Parts& p) { p.rest = R"(<media><radio id="a"/></media>)"; }, 8,
                         "<media> cannot hold <radio>; it may hold: range_and_bearing, led"},
                    Case{"of_another_medium",
                         [](Parts& p) { p.rest = R"(<media><led id="a" check_occlusions="true"/></media>)"; }, 8,
                         "has no attribute 'check_occlusions'"},
                    Case{"hook_without_library", [](Parts& p) { p.rest = R"(<loop_functions label="x"/>)"; }, 8,
                         "<loop_functions> needs the attribute 'library'"},
                    Case{"trajectory_without_path", [](Parts& p) { p.rest = "<record><trajectory/></record>"; }, 8,
                         "<trajectory> needs the attribute 'path'"},
                    Case{"trajectory_of_nobody",
                         [](Parts& p) { p.rest = R"(<record><trajectory path="t.csv" entities="a,,b"/></record>)"; }, 8,
                         "must be ids separated by commas"}),
    &name_of);

TEST(Problems, AreAllCollectedInTheOrderOfTheFile) {
  const Outcome out = read(R"(<tandem>
  <framework><experiment lenght="5" ticks_per_second="0"/></framework>
  <arena size="4,4,1">
    <box id="a" size="1,1,-1"><body position="x,0,0"/></box>
    <e-puck id="ep" colour="red"><body position="0,0,0"/><controller config="none"/></e-puck>
  </arena>
  <physics_engines><bullet id="b"/></physics_engines>
</tandem>)");
  EXPECT_FALSE(out.scenario.has_value());
  std::vector<int> lines;
  for (const Problem& p : out.problems) lines.push_back(p.line);
  EXPECT_EQ(lines, (std::vector<int>{2, 2, 4, 4, 5, 5, 7})) << out.text();
}

TEST(Problems, DistributedRangesOfOnePrefixMayStandSideBySide) {
  Parts parts;
  parts.things = distribute(kUniform, R"(quantity="5")", kMany) +
                 distribute(kUniform, R"(quantity="5" base_num="5")", kMany) +
                 R"(<e-puck id="ep10"><body position="0,0,0"/><controller config="w"/></e-puck>)" +
                 R"(<e-puck id="ep04"><body position="0,0,0"/><controller config="w"/></e-puck>)";
  EXPECT_TRUE(read(parts.text()).problems.empty()) << read(parts.text()).text();
}

TEST(Problems, ABodyInsideADistributeIsAWarning) {
  Parts parts;
  parts.things = distribute(kUniform, R"(quantity="5")",
                            R"(<e-puck id="ep"><body position="0,0,0"/><controller config="w"/></e-puck>)");
  const Outcome out = read(parts.text());
  EXPECT_TRUE(out.scenario.has_value());
  ASSERT_EQ(out.problems.size(), 1U) << out.text();
  EXPECT_TRUE(out.problems[0].warning);
}

TEST(Problems, MovableThingsArePushedByDynamics) {
  Parts parts;
  parts.things = R"(<box id="b" size="1,1,1" movable="true"><body position="0,0,0"/></box>)";
  const Outcome kinematic = read(parts.text(), {});
  ASSERT_EQ(kinematic.problems.size(), 1U) << kinematic.text();
  EXPECT_THAT(kinematic.problems[0].message, HasSubstr("(dynamics2d, dynamics3d)"));
  parts.engines = R"(<physics_engines><dynamics2d id="d" iterations="20"/></physics_engines>)";
  EXPECT_TRUE(read(parts.text(), {}).good().objects[0].movable);
}

}  // namespace
}  // namespace tandem::core
