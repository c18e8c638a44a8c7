// What ARGoS' scripts have: each script judges what it is given, and says so by an error.
#include <gmock/gmock.h>

#include "tests/controllers/lua_controller/scripted.hpp"

namespace tandem::test {
namespace {

using ::testing::HasSubstr;

/// Runs a script for some steps; its assertions must hold.
void holds(Script script, int steps = 5) {
  script.text +=
      "\nfunction near(a, b, what) if math.abs(a - b) > 1e-6 then error(what .. ': ' .. a .. ' is not ' .. b, 2) end "
      "end";
  Scripted(script).run(steps);
}

TEST(LuaApi, CallsInitOnceAndStepInEveryStep) {
  Scripted world({.text = R"(
    calls = "file"
    function init() calls = calls .. " init" end
    function step() calls = calls .. " step" log(calls) end)"});
  world.run(2);
  EXPECT_THAT(world.log(), HasSubstr("robot 'r0' at tick 1: file init step step"));
}

TEST(LuaApi, CallsResetWhenTheRunBeginsAnewAndDestroyAtTheEnd) {
  Scripted world({.text = R"(
    n = 0
    function step() n = n + 1 end
    function reset() log("reset at ", n) n = 0 end
    function destroy() log("destroy at ", n) end)"});
  world.run(3);
  ASSERT_TRUE(world.world->reset(5).ok());
  world.run(2);
  world.world.reset();
  EXPECT_THAT(world.log(), HasSubstr("reset at 3"));
  EXPECT_THAT(world.log(), HasSubstr("destroy at 2"));
}

TEST(LuaApi, BeginsAnewWithoutAFunctionReset) {
  Scripted world({.text = "n = 0 function step() n = n + 1 log(n) end"});
  world.run(2);
  ASSERT_TRUE(world.world->reset(5).ok());
  world.said.clear();
  world.run(1);
  EXPECT_THAT(world.log(), HasSubstr(": 1\n"));
}

TEST(LuaApi, TellsIdAndParams) {
  Scripted world({.text = R"(function step()
    log(robot.id, " ", robot.params.color, " ", robot.params.none)
    logerr("and ", 1, " ", true, " ", nil)
  end)",
                  .params = R"(color="red" most_instructions="200000")"});
  world.run(1);
  EXPECT_THAT(world.log(), HasSubstr("r0 red nil"));
  EXPECT_THAT(world.log(), HasSubstr("error: robot 'r0' at tick 0: and 1 true nil"));
}

TEST(LuaApi, DrivesWheelsInCentimetresPerSecond) {
  holds({.text = R"(function step()
    if n then
      near(robot.wheels.velocity_left, 5, "left")
      near(robot.wheels.velocity_right, 10, "right")
      near(robot.wheels.distance_left, 0.5, "rolled left")
      near(robot.wheels.distance_right, 1.0, "rolled right")
    end
    n = true
    assert(robot.wheels.axis_length > 5 and robot.wheels.axis_length < 6)
    robot.wheels.set_velocity(5, 10)
  end)",
         .sensors = "<differential_steering/>"});
}

TEST(LuaApi, HasProximityOfEpucksCounterClockwise) {
  holds({.text = R"(function step()
    assert(#robot.proximity == 8)
    near(robot.proximity[1].angle, math.rad(17), "first")
    assert(robot.proximity[8].angle < 0 and robot.proximity[4].angle > 2)
    assert(robot.proximity[1].value > 0.3 and robot.proximity[8].value > 0.3, robot.proximity[1].value)
    assert(robot.proximity[4].value == 0)
  end)",
         .more = R"(<box id="b" size="0.1,1,0.5" movable="false"><body position="-4.9,-5,0"/></box>)"});
}

TEST(LuaApi, HasPlainNumbersWhereTheFileNamesTheGenericSensors) {
  holds({.text = R"(function step()
    assert(#robot.proximity == 8 and robot.proximity[1] == 0)
    assert(#robot.light == 8 and robot.light[1] == 0)
    assert(#robot.ground == 3 and robot.ground[2] >= 0 and robot.ground[2] <= 1)
  end)",
         .sensors = "<proximity/><light/><ground/>"});
}

TEST(LuaApi, HasTheFootBotsRingsAndGround) {
  holds({.text = R"(function step()
    assert(#robot.proximity == 24 and #robot.light == 24)
    near(robot.proximity[1].angle, math.rad(7.5), "first")
    near(robot.light[24].angle, math.rad(-7.5), "last")
    assert(robot.light[1].value >= 0)
    assert(#robot.base_ground == 8 and #robot.motor_ground == 4)
    assert(robot.motor_ground[1].value >= 0 and robot.motor_ground[1].value <= 1)
    near(robot.motor_ground[1].offset.x, 6.3, "x")
    near(robot.motor_ground[1].offset.y, 1.16, "y")
    near(robot.base_ground[1].offset:length(), 8, "rim")
  end)",
         .robot = "foot-bot",
         .sensors = "<footbot_proximity/><footbot_light/><footbot_base_ground/><footbot_motor_ground/>"});
}

TEST(LuaApi, SpeaksByRangeAndBearing) {
  holds({.text = R"(
    function init() robot.range_and_bearing.set_data(1, 7) end
    function step()
      n = (n or 0) + 1
      robot.range_and_bearing.set_data({n, 9})
      if n < 3 then return end
      local heard = robot.range_and_bearing
      assert(#heard == 1, #heard)
      near(heard[1].range, 50, "range")
      assert(math.abs(heard[1].horizontal_bearing) < 1e-6 or math.abs(heard[1].horizontal_bearing) > 3.1)
      near(heard[1].vertical_bearing, 0, "up")
      assert(#heard[1].data == 2 and heard[1].data[2] == 9 and heard[1].data[1] >= n - 2)
      robot.range_and_bearing.clear_data()
      robot.range_and_bearing.set_data({n, 9})
    end)",
         .sensors = "<range_and_bearing/>",
         .actuators = "<range_and_bearing/>",
         .robots = 2});
}

TEST(LuaApi, LightsLedsAndSeesThemByTheOmnidirectionalCamera) {
  holds({.text = R"(
    function init()
      assert(#robot.colored_blob_omnidirectional_camera == 0)
      robot.colored_blob_omnidirectional_camera.enable()
      robot.leds.set_all_colors("black")
      robot.leds.set_single_color(13, 255, 0, 0)
    end
    function step()
      n = (n or 0) + 1
      if n < 3 then return end
      local blobs = robot.colored_blob_omnidirectional_camera
      if n == 5 then assert(#blobs == 0) return end
      assert(#blobs == 1, #blobs)
      near(blobs[1].distance, 50, "distance")
      assert(math.abs(blobs[1].angle) < 1e-3 or math.abs(blobs[1].angle) > 3.1)
      assert(blobs[1].color.red == 255 and blobs[1].color.green == 0 and blobs[1].color.blue == 0)
      robot.leds.set_single_color(13, "red")
      if n == 4 then robot.colored_blob_omnidirectional_camera.disable() end
    end)",
         .robot = "foot-bot",
         .sensors = R"(<colored_blob_omnidirectional_camera medium="leds"/>)",
         .actuators = R"(<leds medium="leds"/>)",
         .robots = 2});
}

TEST(LuaApi, HasThePerspectiveCamera) {
  holds({.text = R"(
    function init() robot.colored_blob_perspective_camera.enable() robot.leds.set_all_colors(0, 255, 0) end
    function step()
      n = (n or 0) + 1
      if n < 3 or robot.id == "r1" then return end
      local blobs = robot.colored_blob_perspective_camera
      assert(#blobs > 0)
      assert(blobs[1].x > 0 and blobs[1].y > 0 and blobs[1].color.green == 255)
    end)",
         .robot = "foot-bot",
         .sensors = R"(<colored_blob_perspective_camera medium="leds"/>)",
         .actuators = R"(<leds medium="leds"/>)",
         .attributes = R"(perspective_camera_front="true")",
         .robots = 2});
}

TEST(LuaApi, TurnsTheDistanceScanner) {
  holds({.text = R"(
    function init() robot.distance_scanner.enable() robot.distance_scanner.set_rpm(30) end
    function step()
      n = (n or 0) + 1
      if n < 3 then return end
      local scanner = robot.distance_scanner
      assert(#scanner.short_range > 0 and #scanner.long_range > 0)
      local seen
      for i = 1, #scanner.long_range do
        local d = scanner.long_range[i].distance
        assert(d == -2 or d == -1 or d > 0)
        assert(math.abs(scanner.long_range[i].angle) <= 3.2)
      end
      assert(scanner.short_range[1].distance == -2)
      if n == 4 then scanner.set_angle(0.5) end
      if n == 5 then scanner.disable() end
    end)",
         .robot = "foot-bot",
         .sensors = "<footbot_distance_scanner/>",
         .actuators = "<footbot_distance_scanner/>"});
}

TEST(LuaApi, TurnsTheTurretAndGrips) {
  holds({.text = R"(
    function init() robot.turret.set_position_control_mode() robot.turret.set_rotation(0.3) robot.gripper.lock_positive() end
    function step()
      n = (n or 0) + 1
      if n == 15 then
        near(robot.turret.rotation, 0.3, "rotation")
        robot.gripper.lock_negative()
        robot.gripper.lock()
        robot.gripper.unlock()
        robot.turret.set_speed_control_mode()
        robot.turret.set_rotation_speed(-1)
      end
      if n == 20 then assert(robot.turret.rotation < 0.2) robot.turret.set_passive_mode() end
    end)",
         .robot = "foot-bot",
         .sensors = "<footbot_turret_encoder/>",
         .actuators = "<footbot_turret/><footbot_gripper/>",
         .engine = "dynamics2d"},
        25);
}

TEST(LuaApi, FliesToPlaces) {
  holds({.text = R"(
    function init() robot.quadrotor.set_absolute_position(-4, -5, 1) robot.quadrotor.set_absolute_yaw(90) end
    function step()
      n = (n or 0) + 1
      local p, q = robot.positioning.position, robot.positioning.orientation
      if n == 150 then
        assert((p - vector3(-4, -5, 1)):length() < 0.1, tostring(p))
        near(math.floor(math.deg(q:toeulerangles()) + 0.5), 90, "yaw")
        near(math.floor(math.deg(q.angle * q.axis.z) + 0.5), 90, "angle")
        robot.quadrotor.set_relative_position(1, 0, 0)
        robot.quadrotor.set_relative_yaw(-90)
      end
      if n == 300 then assert((p - vector3(-4, -4, 1)):length() < 0.1, tostring(p)) end
    end)",
         .robot = "eye-bot",
         .sensors = "<positioning/>",
         .actuators = "<quadrotor_position/>",
         .engine = "particle3d"},
        301);
}

TEST(LuaApi, FliesWithSpeedsAndTurnsItsCamera) {
  holds({.text = R"(
    function init() robot.quadrotor.set_linear_velocity(0.2, 0, 0.1) robot.quadrotor.set_rotational_speed(0.1) end
    function step()
      n = (n or 0) + 1
      robot.pan_tilt_camera.set_pan(0.2)
      robot.pan_tilt_camera.set_tilt(0.3)
      if n == 30 then
        near(robot.actuators.pan_tilt.tilt, 0.3, "tilt")
        assert(robot.positioning.position.x > -4.9 and robot.battery.available_charge > 0.5)
        assert(robot.battery.time_left > 0)
      end
    end)",
         .robot = "eye-bot",
         .sensors = "<positioning/><battery/>",
         .actuators = "<quadrotor_speed/><pan_tilt/>",
         .engine = "particle3d"},
        31);
}

TEST(LuaApi, DrawsRandomNumbersOfItsOwn) {
  holds({.text = R"(function step()
    local r = robot.random
    local u = r.uniform() assert(u >= 0 and u < 1)
    u = r.uniform(5) assert(u >= 0 and u < 5)
    u = r.uniform(-2, -1) assert(u >= -2 and u < -1)
    u = r.uniform_int(3) assert(u >= 0 and u < 3 and math.type(u) == "integer")
    u = r.uniform_int(4, 6) assert(u == 4 or u == 5)
    u = r.bernoulli(0.5) assert(u == 0 or u == 1)
    assert(r.bernoulli(0) == 0 and r.bernoulli(1) == 1)
    assert(r.gaussian(1) < 8 and r.gaussian(0, 3) == 3)
    assert(r.exponential(2) >= 0 and r.poisson(0) == 0 and r.poisson(100) > 20)
    u = math.random(6) assert(u >= 1 and u <= 6)
    math.randomseed(os.time())
  end)"});
}

TEST(LuaApi, HasVectorsAndQuaternions) {
  holds({.text = R"(function step()
    local a, b = vector2(3, 4), vector2()
    assert(a:length() == 5 and a:dot(vector2(1, 1)) == 7 and a == vector2(a) and a ~= b and a + b == a)
    assert(tostring(a.x) == "3.0" and tostring((a + vector2(1, 1)).y) == "5.0", "components are floats")
    assert(a * 2 == vector2(6, 8) and 2 * a == a - -a and tostring(a) == "3,4")
    near(vector2(1, 0):rotate(math.pi / 2).y, 1, "rotated")
    near(a:normalize():length(), 1, "normalized")
    local c = vector3(1, 0, 0)
    assert(vector3(1, 0, 0):cross(vector3(0, 1, 0)) == vector3(0, 0, 1))
    local q = quaternion(math.pi / 2, vector3(0, 0, 1))
    near(c:rotate(q).y, 1, "turned")
    local angle, axis = (q * q):toangleaxis()
    near(angle, math.pi, "twice")
    near(axis.z, 1, "axis")
    near((q * q:inverse()).w, 1, "and back")
    near(q:toeulerangles(), math.pi / 2, "yaw")
  end)"});
}

TEST(LuaApi, ReachesEveryPortByItsFields) {
  holds({.text = R"(function step()
    n = (n or 0) + 1
    local a = robot.sensors.accelerometer
    assert(#a.force == 3 and a.validity == 2 and a.force[3] > 9 and a.force[4] == nil)
    assert(robot.sensors.clock.tick == n - 1 and robot.sensors.clock.tick_s == 0.1)
    robot.actuators.front_led.on = n % 2 == 0
    assert(robot.actuators.front_led.on == (n % 2 == 0))
    robot.actuators.leds.rgb[1] = 255
    robot.actuators.leds.rgb = {1, 2, 3}
    assert(robot.actuators.leds.rgb[3] == 3 and #robot.actuators.leds.rgb == 48)
    robot.actuators.differential_steering.left = 0.05
    near(os.clock(), 0.1 * (n - 1), "time")
  end)",
         .sensors = "<accelerometer/><clock/><proximity/>",
         .actuators = "<front_led/><leds/><differential_steering/>"});
}

TEST(LuaApi, KeepsGlobalsLocalsAndAddedFieldsOfRobotsApart) {
  holds({.text = R"(
    local mine
    local count = 0
    local function bump() count = count + 1 return count end
    function init()
      mine = robot.id
      name = robot.id
      robot.state = robot.id
      robot.proximity.note = robot.id
      robot.proximity[1].note = robot.id
      math.mine = robot.id
    end
    function step()
      assert(mine == robot.id and name == robot.id and _G.name == name)
      assert(robot.state == robot.id and robot.proximity.note == robot.id)
      assert(robot.proximity[1].note == robot.id and math.mine == robot.id)
      n = (n or 0) + 1
      assert(bump() == n)
      robot.proximity[1].value = 17
      table.sort(robot.proximity, function(a, b) return a.angle < b.angle end)
      if robot.id == "r1" then robot.proximity[3] = nil end
    end)",
         .robots = 40,
         .threads = 2});
}

TEST(LuaApi, RequiresModulesOncePerRobot) {
  holds({.text = R"(
    local counter = require("tools.counter")
    function step()
      assert(require("tools.counter") == counter)
      n = (n or 0) + 1
      assert(counter.next() == n)
      assert(dofile("constant.lua") == 42)
      assert(load("return n")() == n)
    end)",
         .robots = 3,
         .modules = {{"tools/counter.lua", "local n = 0 return {next = function() n = n + 1 return n end}"},
                     {"constant.lua", "return 42"}}});
}

TEST(LuaApi, RunsCoroutines) {
  holds({.text = R"(
    local walk = coroutine.wrap(function() for i = 1, 1000 do coroutine.yield(i) end end)
    function step() n = (n or 0) + 1 assert(walk() == n) end)"});
}

}  // namespace
}  // namespace tandem::test
