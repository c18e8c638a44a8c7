// Scripts that go wrong: what is said, and who is stopped.
#include <gmock/gmock.h>

#include "tests/controllers/lua_controller/scripted.hpp"

namespace tandem::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(LuaErrors, NameTheLineOfASyntaxError) {
  Scripted world({.text = "function step()\n  x = = 1\nend"});
  EXPECT_THAT(world.problems,
              AllOf(HasSubstr("script.lua:2: syntax error: "), HasSubstr("near '='"), HasSubstr("controller 'c'")));
}

TEST(LuaErrors, NameAMissingStep) {
  EXPECT_THAT(Scripted({.text = "function stp() end"}).problems, HasSubstr("has no function step()"));
}

TEST(LuaErrors, NameAMissingScript) {
  EXPECT_THAT(Scripted({.text = "", .file = "absent.lua"}).problems, HasSubstr("absent.lua"));
}

TEST(LuaErrors, StopTheRobotWithScriptLineRobotAndTick) {
  Scripted world({.text = R"(
    function init() n = 0 end
    function step()
      n = n + 1
      robot.wheels.set_velocity(5, 5)
      if robot.id == "r1" and n == 3 then
        local x = nothing.here
      end
    end)",
                  .robots = 3});
  const std::string said = world.incident(6);
  EXPECT_THAT(said, AllOf(HasSubstr("script.lua:7:"), HasSubstr("robot 'r1'"), HasSubstr("tick 2"),
                          HasSubstr("global 'nothing'"), HasSubstr("the robot is stopped")));
  EXPECT_EQ(world.world->incidents().controllers_thrown, 1U);
  const core::Space& space = world.world->space();
  EXPECT_GT(space.pose(space.find_robot("r2")).x_m, -4.0 + 0.02);
  EXPECT_LT(space.pose(space.find_robot("r1")).x_m, -4.5 + 0.02);
}

TEST(LuaErrors, NameTheFunctionThatGotAWrongArgument) {
  EXPECT_THAT(Scripted({.text = "function step() robot.wheels.set_velocity('fast', 1) end"}).incident(),
              AllOf(HasSubstr("set_velocity"), HasSubstr("number expected, got string"), HasSubstr("script.lua:1:")));
  EXPECT_THAT(Scripted({.text = "function step() robot.wheels.set_velocity(1) end"}).incident(),
              HasSubstr("robot.wheels.set_velocity(left, right) expects 2 arguments, and got 1"));
  EXPECT_THAT(Scripted({.text = "function step() robot.wheels:set_velocity(1, 1) end"}).incident(),
              HasSubstr("with a dot, not with a colon"));
}

TEST(LuaErrors, NameWhatAMisspeltNameIsLike) {
  EXPECT_THAT(Scripted({.text = "function step() robot.wheels.set_velociti(1, 1) end"}).incident(),
              HasSubstr("(field 'set_velociti'); there is 'set_velocity'"));
  EXPECT_THAT(Scripted({.text = "function step() robot.sensors.proximty.count = 1 end"}).incident(),
              HasSubstr("there is 'proximity'"));
  EXPECT_THAT(Scripted({.text = "function step() math.sqroot(2) end"}).incident(), HasSubstr("there is 'sqrt'"));
  EXPECT_THAT(
      Scripted({.text = "function step() math.rep('a', 2) end"}).incident(),
      AllOf(HasSubstr("(field 'rep'); there is such a name, but in another table"), Not(HasSubstr("there is 'rep'"))));
}

TEST(LuaErrors, SayWhichDeviceIsNotListed) {
  EXPECT_THAT(Scripted({.text = "function step() robot.leds.set_all_colors('red') end"}).incident(),
              HasSubstr("the configuration lists no device for robot.leds"));
}

TEST(LuaErrors, NameAGlobalThatWasNeverAssignedWhereTheFileAsks) {
  EXPECT_THAT(
      Scripted({.text = "function step()\n  if spped then return end end", .params = R"(strict="true")"}).incident(),
      AllOf(HasSubstr("script.lua:2:"), HasSubstr("global 'spped'")));
}

TEST(LuaErrors, EndALoopWithoutEnd) {
  Scripted world({.text = R"(
    function step()
      if robot.id == "r1" then while true do end end
      robot.wheels.set_velocity(5, 5)
    end)",
                  .params = R"(most_instructions="1000000")",
                  .robots = 3});
  EXPECT_THAT(world.incident(3), AllOf(HasSubstr("does not come to an end"), HasSubstr("script.lua:3:"),
                                       HasSubstr("robot 'r1'"), HasSubstr("1000000 instructions")));
  EXPECT_EQ(world.world->incidents().controllers_thrown, 1U);
}

TEST(LuaErrors, EndALoopThatCatchesItsErrorsAndOneInACoroutine) {
  EXPECT_THAT(Scripted({.text = "function step() while true do pcall(function() while true do end end) end end",
                        .params = R"(most_instructions="1000000")"})
                  .incident(),
              HasSubstr("does not come to an end"));
  EXPECT_THAT(Scripted({.text = R"(function step()
      while true do coroutine.resume(coroutine.create(function() while true do end end)) end
    end)",
                        .params = R"(most_instructions="1000000")"})
                  .incident(),
              HasSubstr("does not come to an end"));
}

TEST(LuaErrors, EndAnInitWithoutEnd) {
  EXPECT_THAT(Scripted({.text = "function step() end function init() repeat until false end",
                        .params = R"(most_instructions="1000000")"})
                  .problems,
              HasSubstr("does not come to an end"));
}

TEST(LuaErrors, RefuseWhatWouldMakeRunsDiffer) {
  const auto said = [](const std::string& line) {
    return Scripted({.text = "function step() " + line + " end"}).incident();
  };
  EXPECT_THAT(said("io.open('x')"), HasSubstr("io.open is not there"));
  EXPECT_THAT(said("os.getenv('HOME')"), HasSubstr("os.getenv is not there"));
  EXPECT_THAT(said("package.path = package.path .. ';x'"), HasSubstr("--allow-io"));
  EXPECT_THAT(said("loadfile('x')"), HasSubstr("loadfile is not there"));
  EXPECT_THAT(said("for k in pairs({[print] = 1, [step] = 2}) do end"), HasSubstr("no order"));
  EXPECT_THAT(said("string.format('%p', {})"), HasSubstr("%p"));
  EXPECT_THAT(said("require('../secret')"), HasSubstr("there is no module"));
  EXPECT_THAT(said("robot.proximity[9] = 1"), HasSubstr("filled anew"));
  EXPECT_THAT(said("robot.sensors.clock.tick = 1"), HasSubstr("cannot be set"));
  EXPECT_THAT(said("local x = robot.sensors.clock.tack"), HasSubstr("has no field 'tack'"));
}

}  // namespace
}  // namespace tandem::test
