#include <gmock/gmock.h>
#include <numbers>

#include "hal/device/range_and_bearing.hpp"
#include "hal/device/selector.hpp"
#include "tests/core/config/reading.hpp"

namespace tandem::core {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

TEST(Reader, TakesEverythingThatAnArgosFileSays) {
  const Outcome out = read(R"(<?xml version="1.0" ?>
<argos-configuration>
  <framework>
    <system threads="4" method="balance_length"/>
    <experiment length="120" ticks_per_second="5" random_seed="124"/>
    <profiling file="p.txt" format="table" truncate_file="true"/>
  </framework>
  <controllers>
    <epuck_diffusion id="ed" library="build/controllers/libepuck_diffusion.so">
      <actuators>
        <differential_steering implementation="default" noise_std_dev="0.1"/>
        <epuck_leds implementation="default" medium="leds"/>
        <range_and_bearing implementation="default"/>
      </actuators>
      <sensors>
        <epuck_proximity implementation="default" show_rays="true" noise_level="0.05"/>
        <differential_steering implementation="default" vel_noise_range="-0.1:0.2"/>
        <epuck_light implementation="rot_z_only"/>
        <range_and_bearing implementation="medium" medium="rab" packet_drop_prob="0.1"/>
      </sensors>
      <params alpha="7.5" delta="0.1" velocity="5"><extra deep="1"/></params>
    </epuck_diffusion>
  </controllers>
  <loop_functions library="liblf" label="lf" radius="3"><goal x="1"/></loop_functions>
  <arena size="4, 5, 1" center="0.5,0,0.5" positional_grid_size="10,10,1">
    <floor id="floor" source="image" path="floor.png" pixels_per_meter="50"/>
    <box id="wall" size="4,0.1,0.5" movable="false" mass="2"><body position="0,2,0" orientation="90,20,10"/></box>
    <cylinder id="post" radius="0.1" height="0.5" movable="false"><body position="1,1,0" orientation="0,0,0"/></cylinder>
    <light id="lamp" position="1,2,0.5" orientation="0,0,0" color="10,20,30" intensity="3" medium="leds"/>
    <e-puck id="first" rab_range="0.6" rab_data_size="4">
      <body position="-1,0,0" orientation="45,0,0"/>
      <controller config="ed"/>
      <battery model="time_motion" full_charge="2" start_charge="1.5" time_factor="0.1" pos_factor="0.2" orient_factor="0.3"/>
    </e-puck>
    <distribute>
      <position method="gaussian" mean="0,0,0" std_dev="0.5,0.5,0"/>
      <orientation method="uniform" min="0,0,0" max="360,0,0"/>
      <entity quantity="20" max_trials="50" base_num="7"><e-puck id="ep"><controller config="ed"/></e-puck></entity>
    </distribute>
  </arena>
  <physics_engines><kinematics2d id="kin2d"/></physics_engines>
  <media><led id="leds" grid_size="1,1,1"/><range_and_bearing id="rab"/></media>
  <visualization><qt-opengl><camera><placements><placement index="0" position="0,0,3" look_at="0,0,0"/></placements></camera></qt-opengl></visualization>
</argos-configuration>)");
  const Scenario& s = out.good();
  EXPECT_EQ(s.name, "file");
  EXPECT_EQ(s.length_s, 120.0);
  EXPECT_EQ(s.ticks_per_second, 5);
  EXPECT_EQ(s.seed, 124U);
  EXPECT_EQ(s.threads, 4);
  EXPECT_EQ(s.assignment, Assignment::Dynamic);
  EXPECT_EQ(s.time_mode, TimeMode::Fast);

  ASSERT_EQ(s.controllers.size(), 1U);
  const ControllerConfig& c = s.controllers[0];
  EXPECT_EQ(c.id, "ed");
  EXPECT_EQ(c.label, "epuck_diffusion");
  EXPECT_EQ(c.library, "build/controllers/libepuck_diffusion.so");
  EXPECT_EQ(c.line, 9);
  ASSERT_EQ(c.sensors.size(), 5U) << "and range-and-bearing with more room";
  EXPECT_EQ(c.sensors[0].device, "proximity");
  EXPECT_EQ(c.sensors[0].implementation, "default");
  EXPECT_EQ(*c.sensors[0].options.attribute("noise_level"), "0.05");
  EXPECT_EQ(c.sensors[0].options.line, 16);
  EXPECT_EQ(c.sensors[1].device, "wheel_encoders");
  EXPECT_EQ(c.sensors[2].device, "light");
  EXPECT_EQ(c.sensors[2].implementation, "rot_z_only");
  ASSERT_EQ(c.actuators.size(), 4U);
  EXPECT_EQ(c.actuators[0].device, "differential_steering");
  EXPECT_EQ(c.actuators[1].device, "leds");
  EXPECT_EQ(*c.params.attribute("velocity"), "5");
  EXPECT_EQ(*c.params.child("extra")->attribute("deep"), "1");

  EXPECT_EQ(s.arena_size, (Vec3{4, 5, 1}));
  EXPECT_EQ(s.arena_center, (Vec3{0.5, 0, 0.5}));
  EXPECT_EQ(s.escape, EscapePolicy::Error);
  ASSERT_EQ(s.fields.size(), 1U);
  EXPECT_EQ(s.fields[0].name, "floor");
  EXPECT_EQ(*s.fields[0].attribute("source"), "image");
  EXPECT_EQ(*s.fields[0].attribute("pixels_per_meter"), "50");
  ASSERT_EQ(s.objects.size(), 2U);
  EXPECT_EQ(s.objects[0].shape, ShapeKind::Box);
  EXPECT_EQ(s.objects[0].size, (Vec3{4, 0.1, 0.5}));
  EXPECT_EQ(s.objects[0].mass_kg, 2.0);
  EXPECT_DOUBLE_EQ(s.objects[0].placement.yaw_rad, 90 * kDeg);
  EXPECT_DOUBLE_EQ(s.objects[0].placement.pitch_rad, 20 * kDeg);
  EXPECT_DOUBLE_EQ(s.objects[0].placement.roll_rad, 10 * kDeg);
  EXPECT_EQ(s.objects[1].shape, ShapeKind::Cylinder);
  EXPECT_EQ(s.objects[1].size, (Vec3{0.1, 0.1, 0.5}));
  ASSERT_EQ(s.lights.size(), 1U);
  EXPECT_EQ(s.lights[0].rgb, (std::array<std::uint8_t, 3>{10, 20, 30}));
  EXPECT_EQ(s.lights[0].intensity, 3.0);

  ASSERT_EQ(s.robots.size(), 2U);
  const RobotItem& first = s.robots[0];
  EXPECT_EQ(first.kind, "e-puck");
  ASSERT_NE(first.own_kind, nullptr);
  EXPECT_EQ(first.own_kind->part<hal::RangeAndBearingPart>()->range_m, 0.6);
  EXPECT_EQ(first.own_kind->part<hal::RangeAndBearingPart>()->payload, 4);
  EXPECT_EQ(first.placement.p_W, (Vec3{-1, 0, 0}));
  EXPECT_DOUBLE_EQ(first.placement.yaw_rad, 45 * kDeg);
  EXPECT_EQ(first.battery.model, "time_motion");
  EXPECT_EQ(first.battery.start_charge, 1.5);
  EXPECT_EQ(first.battery.delta, 0.1);
  EXPECT_EQ(first.battery.pos_delta, 0.2);
  EXPECT_EQ(first.battery.orient_delta, 0.3);
  const RobotItem& many = s.robots[1];
  ASSERT_TRUE(many.distribute.has_value());
  EXPECT_EQ(many.distribute->quantity, 20);
  EXPECT_EQ(many.distribute->max_trials, 50);
  EXPECT_EQ(many.distribute->base_num, 7);
  EXPECT_EQ(many.distribute->position.method, Distribution::Method::Gaussian);
  EXPECT_EQ(many.distribute->position.std_dev, (Vec3{0.5, 0.5, 0}));
  EXPECT_DOUBLE_EQ(many.distribute->orientation.max[0], 360 * kDeg);

  ASSERT_EQ(s.hooks.size(), 1U);
  EXPECT_EQ(s.hooks[0].label, "lf");
  EXPECT_EQ(*s.hooks[0].options.child("goal")->attribute("x"), "1");
  ASSERT_EQ(s.engines.size(), 1U);
  EXPECT_EQ(s.engines[0].id, "kin2d");
  ASSERT_EQ(s.media.size(), 2U);
  EXPECT_EQ(s.media[1].kind, "range_and_bearing");
  EXPECT_EQ(s.camera.name, "camera");

  ASSERT_EQ(out.problems.size(), 3U) << out.text();
  EXPECT_EQ(to_text(out.problems[0]), "file.xml:6: warning: <profiling> is left out; times are in --report");
  EXPECT_EQ(out.problems[1].line, 30) << "no limit of wheels";
  EXPECT_EQ(out.problems[2].line, 43);
  for (const Problem& problem : out.problems) EXPECT_TRUE(problem.warning && !problem.ignored);
}

TEST(Reader, LooksForAControllerWithoutLibraryInTheOneOfItsName) {
  const Outcome out = read(R"(<tandem>
<framework><experiment length="1" ticks_per_second="10"/></framework>
<controllers><lua_controller id="l"/></controllers><arena size="4,4,1"/></tandem>)");
  EXPECT_EQ(out.good().controllers.at(0).library, "lua_controller");
}

TEST(Reader, FillsInWhatIsLeftOut) {
  Parts parts;
  parts.framework = "<framework><experiment/></framework>";
  parts.engines = "";
  const Outcome out = read(parts.text());
  EXPECT_TRUE(out.problems.empty()) << out.text();
  const Scenario& s = out.good();
  EXPECT_EQ(s.length_s, 0.0);
  EXPECT_EQ(s.ticks_per_second, 10);
  EXPECT_FALSE(s.seed.has_value());
  EXPECT_EQ(s.threads, 0);
  EXPECT_EQ(s.assignment, Assignment::Static);
  ASSERT_EQ(s.engines.size(), 1U);
  EXPECT_EQ(s.engines[0].kind, "kinematics2d");
  EXPECT_EQ(*s.fields.at(0).attribute("source"), "none") << "what files leave out is written down";
  EXPECT_EQ(s.robots[0].own_kind, nullptr) << "as the catalog has it";
  EXPECT_EQ(s.controllers[0].sensors[0].implementation, "default");
  EXPECT_EQ(s.controllers[0].params.name, "params");
}

TEST(Reader, TakesUnitsEverywhere) {
  Parts parts;
  parts.framework = R"(<framework><experiment length="2 min" ticks_per_second="+10" random_seed=" 5 "/></framework>)";
  parts.arena = R"(<arena size="400 cm,4000mm, 1" center="10 cm,0,0">)";
  parts.things =
      R"(<box id="b" size="10 cm,2 m,0.3" mass="500 g"><body position="1,0,0" orientation="1.5 rad,0,0"/></box>
<distribute><position method="grid" center="0,0,0" distances="50 cm,1,1" layout="2,1,1"/><orientation method="constant" values="1 rad,0,0"/>
<entity quantity="2"><e-puck id="ep" rab_range="80 cm"><controller config="w"/></e-puck></entity></distribute>)";
  const Scenario s = read(parts.text()).good();
  EXPECT_EQ(s.length_s, 120.0);
  EXPECT_EQ(s.seed, 5U);
  EXPECT_DOUBLE_EQ(s.arena_size[0], 4.0);
  EXPECT_DOUBLE_EQ(s.arena_size[1], 4.0);
  EXPECT_DOUBLE_EQ(s.arena_center[0], 0.1);
  ASSERT_EQ(s.objects.size(), 1U);
  EXPECT_EQ(s.objects[0].size, (Vec3{0.1, 2, 0.3}));
  EXPECT_DOUBLE_EQ(s.objects[0].mass_kg, 0.5);
  EXPECT_EQ(s.objects[0].placement.yaw_rad, 1.5);
  ASSERT_EQ(s.robots.size(), 1U);
  EXPECT_EQ(s.robots[0].distribute->position.distances, (Vec3{0.5, 1, 1}));
  EXPECT_EQ(s.robots[0].distribute->orientation.values[0], 1.0);
  EXPECT_EQ(s.robots[0].own_kind, nullptr) << "it says what all of its kind have";
}

TEST(Reader, SetsTheSelectorOfARobot) {
  Parts parts;
  parts.things = R"(<e-puck2 id="ep" selector="11"><body position="0,0,0"/><controller config="w"/></e-puck2>)";
  const Scenario s = read(parts.text()).good();
  ASSERT_NE(s.robots[0].own_kind, nullptr);
  EXPECT_EQ(s.robots[0].own_kind->part<hal::SelectorPart>()->position, 11);
}

TEST(Reader, SaysWhereAPriorityHasNoEffect) {
  Parts parts;
  parts.framework = R"(<framework><experiment length="1"/><time mode="realtime" priority="40"/></framework>)";
  EXPECT_THAT(read(parts.text()).text(),
              testing::HasSubstr("warning: 'priority' has no effect: no robot has a <bridge>"));
}

TEST(Reader, KnowsTandemsOwnElements) {
  Parts parts;
  parts.framework = R"(<framework><experiment length="1"/><time mode="realtime" priority="40"/></framework>)";
  parts.arena = R"(<arena size="4,4,1" escape="remove">)";
  parts.things = R"(<sound id="bell" position="1,2,0" level="0.5"/>
<e-puck id="real"><body position="0,0,0"/><controller config="w"/>
<bridge link="serial:/dev/ttyUSB0@115200" firmware="gctronic" timeout="200 ms" rearm="operator" settle_after="300 ms"
        missing="wait" connect_timeout="1 min" stop_timeout="5 s"/>
<tracker source="odometry"/></e-puck>)";
  parts.rest = R"(<record><trajectory path="out.csv" entities="ep*, real" every="3"/></record>)";
  const Scenario s = read(parts.text()).good();
  EXPECT_EQ(s.time_mode, TimeMode::Realtime);
  EXPECT_EQ(s.priority, 40);
  EXPECT_EQ(s.escape, EscapePolicy::Remove);
  ASSERT_EQ(s.sounds.size(), 1U);
  EXPECT_EQ(s.sounds[0].level, 0.5);
  ASSERT_TRUE(s.robots[0].bridge.has_value());
  EXPECT_EQ(s.robots[0].bridge->link, "serial:/dev/ttyUSB0@115200");
  ASSERT_NE(s.robots[0].bridge->own, nullptr);
  EXPECT_DOUBLE_EQ(s.robots[0].bridge->timeout_s, 0.2);
  EXPECT_EQ(s.robots[0].bridge->rearm, "operator");
  EXPECT_DOUBLE_EQ(s.robots[0].bridge->settle_s, 0.3);
  EXPECT_EQ(s.robots[0].bridge->if_missing, IfMissing::Wait);
  EXPECT_DOUBLE_EQ(s.robots[0].bridge->connect_s, 60.0);
  EXPECT_DOUBLE_EQ(s.robots[0].bridge->stop_s, 5.0);
  EXPECT_EQ(s.robots[0].bridge->line, 8);
  ASSERT_TRUE(s.robots[0].tracker.has_value());
  ASSERT_TRUE(s.trajectory.has_value());
  EXPECT_EQ(s.trajectory->path, "out.csv");
  EXPECT_EQ(s.trajectory->entities, (std::vector<std::string>{"ep*", "real"}));
  EXPECT_EQ(s.trajectory->every, 3);
}

TEST(Reader, KnowsHowARealEyeBotIsReached) {
  Parts parts;
  parts.things = R"(<eye-bot id="eb"><body position="0,0,0"/><controller config="w"/>
<bridge link="lcm:udpm://239.255.76.67:7667?ttl=1" name="eb_7" at_end="hover" origin="1,2,3" turn="90"/>
<tracker source="positioning"/></eye-bot>)";
  const Scenario s = read(parts.text()).good();
  ASSERT_TRUE(s.robots[0].bridge.has_value());
  EXPECT_NE(s.robots[0].bridge->own, nullptr);
  EXPECT_EQ(s.robots[0].tracker->source, "positioning");
}

TEST(Reader, KnowsByWhichNamesTrackersKnowARobot) {
  Parts parts;
  parts.things =
      R"(<e-puck id="ep"><body position="0,0,0"/><controller config="w"/><bridge link="serial:/dev/ttyUSB0@115200"/>
<tracker id="12 red" turn="90" lost_above="5 cm" offset="0.02,-0.01,0" height="12 cm"/></e-puck>)";
  const Scenario s = read(parts.text()).good();
  ASSERT_TRUE(s.robots[0].tracker.has_value());
  EXPECT_EQ(s.robots[0].tracker->source, "auto");
  EXPECT_EQ(s.robots[0].tracker->names, (std::vector<std::string>{"12", "red"}));
  EXPECT_NEAR(s.robots[0].tracker->turn_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_DOUBLE_EQ(s.robots[0].tracker->lost_m, 0.05);
  EXPECT_EQ(s.robots[0].tracker->p_BT, (Vec3{0.02, -0.01, 0.0}));
  EXPECT_DOUBLE_EQ(s.robots[0].tracker->tag_m.value_or(0.0), 0.12);
}

TEST(Reader, PacesByRealTimeWhenArgosFilesAskForIt) {
  Parts parts;
  parts.framework = R"(<framework><experiment length="1" real_time="true"/></framework>)";
  EXPECT_EQ(read(parts.text()).good().time_mode, TimeMode::Realtime);
}

TEST(Reader, PutsARobotsOwnParametersInPlaceOfItsConfigurations) {
  Parts parts;
  parts.controllers =
      R"(<controllers><wander id="w" library="wander"><params speed="1" gain="2"><path a="1"/><rule b="2"/></params></wander></controllers>)";
  parts.things =
      R"(<e-puck id="ep"><body position="0,0,0"/><controller config="w"><params gain="5"><rule b="9"/></params></controller></e-puck>)";
  const Scenario s = read(parts.text()).good();
  ASSERT_TRUE(s.robots[0].params.has_value());
  const Element& params = *s.robots[0].params;
  EXPECT_EQ(*params.attribute("gain"), "5");
  EXPECT_EQ(*params.attribute("speed"), "1");
  EXPECT_EQ(*params.child("rule")->attribute("b"), "9");
  EXPECT_EQ(*params.child("path")->attribute("a"), "1");
  EXPECT_EQ(*s.controllers[0].params.attribute("gain"), "2");
}

TEST(Reader, TakesRegionsWithWallsAndGates) {
  Parts parts;
  parts.engines =
      R"(<physics_engines><kinematics2d id="left" regions="2x3"><boundaries><top height="1"/><bottom height="-1"/><sides>
<vertex point="-2,-2"/><vertex point="0,-2" gate="right"/><vertex point="0 cm,200 cm"/><vertex point="-2,2"/></sides></boundaries></kinematics2d>
<kinematics2d id="right"/></physics_engines>)";
  const Scenario s = read(parts.text()).good();
  ASSERT_EQ(s.engines.size(), 2U);
  const EngineConfig& e = s.engines[0];
  EXPECT_EQ(e.regions, "2x3");
  EXPECT_EQ(e.top_m, 1.0);
  EXPECT_EQ(e.bottom_m, -1.0);
  ASSERT_EQ(e.sides.size(), 4U);
  EXPECT_EQ(e.sides[1].gate, "right");
  EXPECT_EQ(e.sides[2].y_m, 2.0);
  EXPECT_EQ(e.sides[3].gate, "");
}

TEST(Reader, NumbersDistributesInTheOrderOfTheFile) {
  Parts parts;
  const auto distribute = [](const std::string& thing) {
    return R"(<distribute><position method="constant" values="1,0,0"/><orientation method="constant" values="0,0,0"/><entity quantity="1">)" +
           thing + "</entity></distribute>";
  };
  parts.things = distribute(R"(<e-puck id="a"><controller config="w"/></e-puck>)") +
                 distribute(R"(<box id="b" size="1,1,1"/>)") + distribute(R"(<light id="c"/>)") +
                 distribute(R"(<e-puck id="d"><controller config="w"/></e-puck>)");
  const Scenario s = read(parts.text()).good();
  EXPECT_EQ(s.robots[0].distribute->order, 0);
  EXPECT_EQ(s.objects[0].distribute->order, 1);
  EXPECT_EQ(s.lights[0].distribute->order, 2);
  EXPECT_EQ(s.robots[1].distribute->order, 3);
}

TEST(Reader, ResolvesTheFloorsPictureBesideTheFile) {
  Parts parts;
  parts.things += R"(<floor source="image" path="no_such_floor.png"/>)";
  Problems problems;
  const auto s = read_experiment_text(parts.text(), "/some/where/x.xml", {}, known_names(), problems);
  ASSERT_TRUE(s.has_value());
  EXPECT_EQ(*s->fields.at(0).attribute("path"), "/some/where/no_such_floor.png");
  EXPECT_EQ(s->name, "x");
}

TEST(DeviceName, MapsArgosNamesToPorts) {
  EXPECT_EQ(device_name("epuck_proximity", hal::Role::Sensor, known_names()), "proximity");
  EXPECT_EQ(device_name("footbot_proximity", hal::Role::Sensor, known_names()), "proximity");
  EXPECT_EQ(device_name("eyebot_light", hal::Role::Sensor, known_names()), "light");
  EXPECT_EQ(device_name("footbot_base_ground", hal::Role::Sensor, known_names()), "base_ground");
  EXPECT_EQ(device_name("footbot_motor_ground", hal::Role::Sensor, known_names()), "motor_ground");
  EXPECT_EQ(device_name("epuck_ground", hal::Role::Sensor, known_names()), "ground");
  EXPECT_EQ(device_name("differential_steering", hal::Role::Sensor, known_names()), "wheel_encoders");
  EXPECT_EQ(device_name("differential_steering", hal::Role::Actuator, known_names()), "differential_steering");
  EXPECT_EQ(device_name("epuck_leds", hal::Role::Actuator, known_names()), "leds");
  EXPECT_EQ(device_name("footbot_gripper", hal::Role::Actuator, known_names()), "gripper");
  EXPECT_EQ(device_name("footbot_turret", hal::Role::Actuator, known_names()), "turret");
  EXPECT_EQ(device_name("footbot_turret_encoder", hal::Role::Sensor, known_names()), "turret_encoder");
  EXPECT_EQ(device_name("footbot_distance_scanner", hal::Role::Sensor, known_names()), "distance_scanner");
  EXPECT_EQ(device_name("footbot_tail", hal::Role::Actuator, known_names()), "footbot_tail");
  EXPECT_EQ(device_name("epuck_range_and_bearing", hal::Role::Sensor, known_names()), "range_and_bearing");
  EXPECT_EQ(device_name("footbot_encoder", hal::Role::Sensor, known_names()), "wheel_encoders");
  EXPECT_EQ(device_name("pipuck_proximity", hal::Role::Sensor, known_names()), "pipuck_proximity");
}

}  // namespace
}  // namespace tandem::core
