// Scripts in Lua, from the command line: on a robot, in the manual, in the benchmark.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "controllers/lua_controller/api/manual.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::app {
namespace {

using scenarios::eventually;
using scenarios::Folder;
using scenarios::Tandem;
using ::testing::HasSubstr;

class Scripts : public testing::Test {
 protected:
  void SetUp() override { ::setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1); }
  void write(const std::string& script) const {
    folder_.write("walk.lua", script);
    folder_.write("e.xml", R"(<tandem><framework><experiment length="0" ticks_per_second="10"/></framework><controllers>
<lua_controller id="walk"><actuators><differential_steering/></actuators><sensors><epuck_proximity/></sensors>
<params script="walk.lua" speed="5"/></lua_controller></controllers><arena size="4,4,1"><e-puck id="ep0">
<body position="0,0,0"/><controller config="walk"/><bridge link="serial:ep0"/></e-puck></arena></tandem>)");
  }
  void write_simulated(const std::string& name, const std::string& script) const {
    folder_.write(name, script);
    folder_.write("e.xml", R"(<tandem><framework><experiment length="1" ticks_per_second="10"/></framework><controllers>
<lua_controller id="walk"><actuators><differential_steering/></actuators>
<params script=")" + name + R"("/></lua_controller></controllers><arena size="4,4,1"><e-puck id="ep0">
<body position="0,0,0"/><controller config="walk"/></e-puck></arena></tandem>)");
  }
  Folder folder_;
};

TEST_F(Scripts, DriveARobotThatIsNotSimulated) {
  scenarios::EmulatedEpuck epuck(folder_);
  write(R"(
    function init() log("drives ", robot.id) speed = tonumber(robot.params.speed) end
    function step() assert(#robot.proximity == 8) robot.wheels.set_velocity(speed, speed) end)");
  Tandem run({"robot", "e.xml", "--seconds", "2"}, folder_.path());
  EXPECT_EQ(run.wait(60), 0) << run.errors();
  EXPECT_THAT(run.errors(), HasSubstr("drives ep0"));
  EXPECT_TRUE(epuck.has_moved());
  EXPECT_TRUE(eventually([&] { return !epuck.moves(); }, 20)) << epuck.log();
}

TEST_F(Scripts, StopARobotThatIsNotSimulatedByAnError) {
  scenarios::EmulatedEpuck epuck(folder_);
  write(R"(
    n = 0
    function step() n = n + 1 robot.wheels.set_velocity(5, 5)
      if n == 10 then error("enough") end end)");
  Tandem run({"robot", "e.xml"}, folder_.path());
  EXPECT_EQ(run.wait(60), 3);
  EXPECT_THAT(run.errors(), HasSubstr("of robot 'ep0' threw at tick 9"));
  EXPECT_THAT(run.errors(), HasSubstr("walk.lua:4: enough"));
  EXPECT_TRUE(eventually([&] { return !epuck.moves(); }, 20)) << epuck.log();
}

TEST_F(Scripts, AnErrorAtTheEndIsAFailure) {
  write_simulated("end.lua", "function step() end\nfunction destroy() error('cannot end') end");
  Tandem run({"run", "e.xml", "--log", "run.log"}, folder_.path());
  EXPECT_EQ(run.wait(60), 3);
  EXPECT_THAT(run.errors(), HasSubstr("in destroy(): end.lua:2: cannot end"));
  EXPECT_THAT(run.errors(), HasSubstr("failed at its end"));
  EXPECT_THAT(scenarios::text_of(folder_.path() / "run.log"), HasSubstr("in destroy()"));
}

/// A run of five robots with the script.
class Swarms : public Scripts {
 protected:
  void run(const std::string& script, int code) {
    folder_.write("walk.lua", script);
    folder_.write("e.xml", R"(<tandem><framework><experiment length="2" ticks_per_second="10"/></framework><controllers>
<lua_controller id="walk"><actuators><differential_steering/></actuators><params script="walk.lua"/></lua_controller>
</controllers><arena size="4,4,1"><distribute><position method="grid" center="0,0,0" distances="0.3,0.3,0" layout="5,1,1"/>
<orientation method="constant" values="0,0,0"/><entity quantity="5" max_trials="1"><e-puck id="ep"><controller config="walk"/></e-puck></entity></distribute></arena>
</tandem>)");
    Tandem program({"run", "e.xml", "--quiet"}, folder_.path());
    EXPECT_EQ(program.wait(60), code) << program.errors();
    errors_ = program.errors();
  }
  std::size_t lines_with(const std::string& part) const {
    std::istringstream in(errors_);
    std::size_t found = 0;
    for (std::string line; std::getline(in, line);) found += line.find(part) != std::string::npos ? 1U : 0U;
    return found;
  }
  std::string errors_;
};

TEST_F(Swarms, AnErrorOfAllIsOneLine) {
  run("n = 0\nfunction step() n = n + 1\nif n == 4 then error('enough') end end", 3);
  EXPECT_THAT(errors_, HasSubstr("controller of robot 'ep0' (and 4 more) threw at tick 3: walk.lua:3: enough"));
  EXPECT_EQ(lines_with("enough"), 1U) << errors_;
}

TEST_F(Swarms, AnErrorThatComesToOneAfterTheOtherIsToldAtItsFirstAndAtTheEnd) {
  run("n = 0\nfunction step() n = n + 1\nif robot.id == 'ep' .. n then error('turn ' .. n) end end", 3);
  EXPECT_THAT(errors_,
              HasSubstr("controller of robot 'ep1' threw at tick 0: walk.lua:3: turn 1; the robot is stopped"));
  EXPECT_THAT(errors_, HasSubstr("by the end: controller of robot 'ep1' (and 3 more) threw at tick 0"));
  EXPECT_EQ(lines_with("turn"), 2U) << errors_;
}

TEST_F(Swarms, AnErrorAtTheEndOfAllIsOneLine) {
  run("function step() end\nfunction destroy() error('cannot end') end", 3);
  EXPECT_THAT(errors_, HasSubstr("robot 'ep0' (and 4 more) at tick 20: in destroy(): walk.lua:2: cannot end"));
  EXPECT_EQ(lines_with("cannot end"), 1U) << errors_;
}

TEST_F(Swarms, ASyntaxErrorIsCalledSoOnceWithItsPlace) {
  run("function step()\n  x = = 1\nend", 1);
  EXPECT_THAT(errors_, HasSubstr("of robot 'ep0' cannot run its script: walk.lua:2: syntax error: unexpected symbol"));
  EXPECT_EQ(lines_with("syntax error"), 1U) << errors_;
  folder_.write("tools.lua", "function f(\n");
  run("require 'tools'\nfunction step() end", 1);
  EXPECT_THAT(errors_, HasSubstr("tools.lua:2: syntax error: "));
  EXPECT_EQ(lines_with("syntax error"), 1U) << errors_;
}

TEST_F(Scripts, WhatTheySayNeitherCommandsATerminalNorForgesALineOfTheLog) {
  write_simulated("say.lua", R"(function step() log("a\27[2Jb\0c\u{202e}d\nerror: the arena burns") end)");
  Tandem run({"run", "e.xml", "--log", "run.log"}, folder_.path());
  EXPECT_EQ(run.wait(60), 0) << run.errors();
  for (const std::string& text : {run.errors(), scenarios::text_of(folder_.path() / "run.log")}) {
    EXPECT_THAT(text, HasSubstr("error: the arena burns"));
    for (const std::string& bad :
         {std::string("\033"), std::string(1, '\0'), std::string("\u202E"), std::string("\nerror: the arena burns")})
      EXPECT_EQ(text.find(bad), std::string::npos) << text;
  }
}

TEST_F(Scripts, AreDescribedNameByName) {
  Tandem manual({"describe", "lua"}, folder_.path());
  ASSERT_EQ(manual.wait(), 0) << manual.errors();
  for (const controllers::lua::ApiName& name : controllers::lua::api_names())
    EXPECT_THAT(manual.output(), HasSubstr(std::string(name.name)));
  EXPECT_THAT(manual.output(), HasSubstr("robot.sensors.accelerometer"));
  EXPECT_THAT(manual.output(), HasSubstr("robot.actuators.speaker"));
}

TEST_F(Scripts, AreMeasured) {
  Tandem bench({"bench", "lua", "--robots", "300", "--ticks", "5"}, folder_.path());
  ASSERT_EQ(bench.wait(60), 0) << bench.errors();
  EXPECT_THAT(bench.output(), HasSubstr("\"lua\""));
}

}  // namespace
}  // namespace tandem::app
