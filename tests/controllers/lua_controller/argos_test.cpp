// Scripts of ARGoS in ARGoS' files: its numbers, its readings, its errors, and files where they are allowed.
#include <gmock/gmock.h>

#include "tests/controllers/lua_controller/scripted.hpp"

namespace tandem::test {
namespace {

using testing::HasSubstr;

Script argos(const std::string& text) {
  Script script{.text = text};
  script.root = "argos-configuration";
  script.sensors = "<epuck_proximity/>";
  return script;
}

TEST(ArgosScripts, GetTruthValuesFloatsAndBytesThatWrap) {
  Script script = argos(R"(
    function step()
      local often = 0
      for _ = 1, 1000 do if robot.random.bernoulli(0.1) then often = often + 1 end end
      assert(often > 60 and often < 140, often)
      assert(robot.random.bernoulli(0) == false and robot.random.bernoulli(1) == true)
      assert(math.type(robot.random.uniform_int(3, 9)) == "float")
      robot.range_and_bearing.set_data(1, 300)
      robot.range_and_bearing.set_data(2, -1)
      local heard = robot.range_and_bearing[1]
      if heard then log(heard.data[1], " ", heard.data[2]) end
    end)");
  script.sensors = "<range_and_bearing/>";
  script.actuators = "<range_and_bearing/>";
  script.robots = 2;
  Scripted world(script);
  world.run(3);
  EXPECT_THAT(world.log(), HasSubstr("44 255"));
  script.root = "tandem";
  script.text = "function step() assert(robot.random.bernoulli(0) == 0) robot.range_and_bearing.set_data(1, 300) end";
  EXPECT_THAT(Scripted(script).incident(), HasSubstr("a byte is a number from 0 to 255"));
}

/// An e-puck's sensor at +17 degrees, the first, looks at a wall: the ray is longer than the gap by 1 / cos 17°.
std::string proximity_at(double gap_m, const std::string& root, const std::string& device) {
  Script script =
      argos("function step() local v = robot.proximity[1] log(string.format('%.4f', tonumber(v) or v.value)) end");
  script.root = root;
  script.sensors = device;
  const double x_m = -5.0 + 0.035 * 0.956304755963035 + gap_m + 0.05;  // of the wall, which is 0.1 thick
  script.more = "<box id=\"wall\" size=\"0.1,2,0.5\" movable=\"false\"><body position=\"" + std::to_string(x_m) +
                ",-5,0\" orientation=\"0,0,0\"/></box>";
  Scripted world(script);
  world.run(1);
  return world.said.empty() ? world.problems : world.said.back().substr(world.said.back().rfind(' ') + 1);
}

TEST(ArgosScripts, ReadAnEpucksOwnCurve) {
  const auto curve = [](double gap_m) {
    const double d = gap_m / 0.956304755963035;
    return d > 0.05 ? 0.0 : 298.701 * d * d - 36.8961 * d + 1.08212;
  };
  for (const double gap_m : {0.005, 0.02, 0.04}) {
    EXPECT_NEAR(std::stod(proximity_at(gap_m, "argos-configuration", "<epuck_proximity/>")), curve(gap_m), 2e-4);
    const double d = gap_m / 0.956304755963035;
    EXPECT_NEAR(std::stod(proximity_at(gap_m, "argos-configuration", "<proximity/>")), std::exp(-d), 2e-4);
    EXPECT_NEAR(std::stod(proximity_at(gap_m, "tandem", "<epuck_proximity/>")),
                d < 0.009889556 ? 1.0 : 0.0100527 / (d + 0.000163144), 2e-4)
        << "Tandem's own files keep theirs";
  }
  EXPECT_EQ(proximity_at(0.06, "argos-configuration", "<epuck_proximity/>"), "0.0000");
}

TEST(ArgosScripts, HaveNoiseOnTheReading) {
  // Of a sensor that sees nothing: half of the draws are cut off at 0, the others uniform up to the level.
  for (const std::string device : {"epuck_proximity", "footbot_proximity", "proximity"}) {
    Script script = argos(R"(
      n, zero, sum, most = 0, 0, 0, 0
      function step()
        for i = 1, #robot.proximity do
          local v = type(robot.proximity[i]) == "table" and robot.proximity[i].value or robot.proximity[i]
          n = n + 1
          if v == 0 then zero = zero + 1 end
          sum = sum + v
          most = math.max(most, v)
        end
      end
      function destroy() log(string.format("%.3f %.4f %.3f", zero / n, sum / n, most)) end)");
    script.sensors = "<" + device + " noise_level=\"0.05\"/>";
    Scripted world(script);
    world.run(1000);
    world.world.reset();
    double zero = 0.0, mean = 0.0, most = 0.0;
    ASSERT_FALSE(world.said.empty());
    const std::string said = world.said.back().substr(world.said.back().find(": ") + 2);
    ASSERT_EQ(std::sscanf(said.c_str(), "%lf %lf %lf", &zero, &mean, &most), 3) << said;
    EXPECT_NEAR(zero, 0.5, 0.02) << device;
    EXPECT_NEAR(mean, 0.0125, 0.0006) << device;
    EXPECT_NEAR(most, 0.05, 0.001) << device;
  }
}

TEST(ArgosScripts, SeeLampsByArgosCurves) {
  // The lamp stands ahead, one metre from the robot's axis, at the height of its base.
  const auto seen = [](const std::string& robot, const std::string& device, int sensor) {
    Script script = argos("function step() local l = robot.light[" + std::to_string(sensor) +
                          "] log(string.format('%.5f', type(l) == 'table' and l.value or l)) end");
    script.robot = robot;
    script.sensors = device;
    script.more = R"(<light id="lamp" position="-4,-5,0" color="yellow" intensity="0.5"/>)";
    Scripted world(script);
    world.run(1);
    return world.said.empty() ? -1.0 : std::stod(world.said.back().substr(world.said.back().rfind(' ') + 1));
  };
  const double faced = std::exp(-4.0);  // of a foot-bot: exp(-2 d / I)
  EXPECT_NEAR(seen("foot-bot", "<footbot_light/>", 1), faced * (1.0 - 7.5 / 90.0), 1e-5);
  EXPECT_NEAR(seen("foot-bot", "<footbot_light/>", 4), faced * (1.0 - 52.5 / 90.0), 1e-5);
  EXPECT_EQ(seen("foot-bot", "<footbot_light/>", 12), 0.0);
  EXPECT_EQ(seen("e-puck", "<light/>", 4), 0.0) << "behind";
  EXPECT_GT(seen("e-puck", "<light/>", 1), 0.25) << "(I / d)^2 from the rim, whatever the angle";
  EXPECT_LT(seen("e-puck", "<light/>", 1), 0.27);
}

TEST(ArgosScripts, HearMoreAndLongerThanRealRobots) {
  Script script = argos(R"(
    function step()
      local data = {}
      for i = 1, 30 do data[i] = i end
      robot.range_and_bearing.set_data(data)
      local n = #robot.range_and_bearing
      if n > 0 then
        local d = robot.range_and_bearing[n].data
        log(n, " ", #d, " ", d[30])
      end
    end)");
  script.robot = "foot-bot";
  script.attributes = R"(rab_data_size="30" rab_range="20")";
  script.sensors = R"(<range_and_bearing check_occlusions="false"/>)";
  script.actuators = "<range_and_bearing/>";
  script.robots = 41;
  Scripted world(script);
  world.run(2);
  EXPECT_THAT(world.log(), HasSubstr("40 30 30"));
}

TEST(ArgosScripts, DriveAsFastAsTheyAreTold) {
  Script script = argos("function step() robot.wheels.set_velocity(100, 100) end");
  script.actuators = "<differential_steering/>";
  for (const std::string engine : {"kinematics2d", "dynamics2d"}) {
    script.engine = engine;
    Scripted world(script);
    world.run(11);
    EXPECT_NEAR(world.world->space().pose(world.world->space().find_robot("r0")).x_m, -4.0,
                engine == "dynamics2d" ? 0.1 : 1e-9)
        << engine;
    EXPECT_EQ(world.world->incidents().commands_clamped, 0U);
    EXPECT_THAT(world.problems, HasSubstr("have no limit"));
  }
}

TEST(ArgosScripts, HaveArgosErrorsOfWheels) {
  // a = f (w + b), b drawn once a robot, f every tick: over many robots and ticks the means and deviations.
  Script script = argos(R"(
    function step()
      robot.wheels.set_velocity(10, 10)
      local v = robot.wheels.velocity_left
      if v ~= 0 then n = (n or 0) + 1 sum = (sum or 0) + v squares = (squares or 0) + v * v end
    end
    function destroy() log(string.format("%.6f %.6f", sum / n, squares / n - (sum / n) ^ 2)) end)");
  script.sensors = "<differential_steering/>";
  script.actuators =
      R"(<differential_steering bias_avg="0.02" bias_stddev="0.01" factor_avg="0.5" factor_stddev_left="0.1"/>)";
  script.robots = 200;
  Scripted world(script);
  world.run(100);
  world.world.reset();
  double mean = 0.0, between = 0.0, within = 0.0;
  int robots = 0;
  for (const std::string& said : world.said) {
    double one = 0.0, variance = 0.0;
    if (std::sscanf(said.substr(said.find(": ") + 2).c_str(), "%lf %lf", &one, &variance) != 2) continue;
    ++robots;
    mean += one;
    between += one * one;
    within += variance;
  }
  ASSERT_EQ(robots, 200);
  mean /= robots;
  EXPECT_NEAR(mean, 0.5 * 12.0, 0.15) << "cm/s";
  EXPECT_NEAR(std::sqrt(within / robots), 0.1 * 12.0, 0.06);
  EXPECT_NEAR(std::sqrt(between / robots - mean * mean), 0.5, 0.12) << "1 cm/s of bias, halved, and little else";
}

TEST(ArgosScripts, TakeRangesOfErrors) {
  Script script = argos(R"(
    least, most = 1e9, -1e9
    function step()
      local v = robot.wheels.velocity_left
      least = math.min(least, v) most = math.max(most, v)
    end
    function destroy() log(string.format("%.3f %.3f", least, most)) end)");
  script.sensors = R"(<differential_steering vel_noise_range="-0.1:0.2" dist_noise_range="-10.5:13.7"/>
    <positioning pos_noise_range="-0.01:0.02" angle_noise_range="-0.1:0.1"/><battery noise_range="-0.1:0.05"/>)";
  Scripted world(script);
  world.run(3000);
  world.world.reset();
  double least = 0.0, most = 0.0;
  ASSERT_EQ(std::sscanf(world.said.back().substr(world.said.back().find(": ") + 2).c_str(), "%lf %lf", &least, &most),
            2);
  EXPECT_NEAR(least, -0.1, 0.001);
  EXPECT_NEAR(most, 0.2, 0.001);
  script.sensors = R"(<differential_steering vel_noise_range="0.2:-0.1"/>)";
  EXPECT_THAT(Scripted(script).problems, HasSubstr("is no range: write its least value first"));
}

TEST(ArgosScripts, GoThroughTablesWithTableKeysInTheOrderInWhichTheseWereMade) {
  const char* const text = R"(
    local keys, made = {}, {}
    for i = 1, 50 do made[i] = {number = i} end
    for i = 50, 1, -1 do keys[made[(i * 7) % 50 + 1]] = i end
    function step()
      local last, seen = 0, 0
      for k in pairs(keys) do assert(k.number > last) last = k.number seen = seen + 1 end
      assert(seen == 50)
      local key, all = next(keys), 0
      while key do all = all + 1 key = next(keys, key) end
      assert(all == 50)
    end)";
  Scripted world(Script{.text = text, .robots = 3});
  world.run(3);
}

TEST(ArgosScripts, HaveWeakTablesThatKeepAndFinalizersAtTheEnd) {
  Scripted world(Script{.text = R"(
    weak = setmetatable({}, {__mode = "k"})
    weak[{}] = true
    list = setmetatable({}, {__mode = "v"})
    list[1] = {}
    for i = 1, 3 do setmetatable({i = i}, {__gc = function(o) log("ends ", o.i) end}) end
    function step()
      for i = 1, 20000 do local t = {i} end
      collectgarbage()
      assert(next(weak) and list[1])
    end)"});
  world.run(30);
  EXPECT_EQ(world.log().find("ends"), std::string::npos);
  world.world.reset();
  const std::string log = world.log();
  EXPECT_LT(log.find("ends 3"), log.find("ends 2"));
  EXPECT_LT(log.find("ends 2"), log.find("ends 1"));
  EXPECT_NE(log.find("ends 1"), std::string::npos);
}

TEST(ArgosScripts, MayUseFilesWhereThatIsAllowedAndSaid) {
  Script script{.text = R"(
    local folder = robot.params.folder
    package.path = folder .. "other/?.lua;" .. package.path
    local tool = require("tool")
    function step()
      local file = assert(io.open(folder .. "out.txt", "a"))
      file:write(tool.name, " ", loadfile(folder .. "other/tool.lua")().name, "\n")
      file:close()
      assert(os.time() > 1e9 and os.getenv("PATH") and os.date("%Y") ~= "1970")
      assert(not pcall(os.exit))
    end)",
                .robots = 2};
  const std::string folder = testing::TempDir() + "/tandem_lua_io_" + std::to_string(getpid()) + "/";
  std::filesystem::create_directories(folder + "other");
  std::ofstream(folder + "other/tool.lua") << "return {name = 'tool'}";
  script.params = "allow_io=\"true\" folder=\"" + folder + "\"";
  Scripted world(script);
  world.run(2);
  std::ifstream out(folder + "out.txt");
  const std::string written{std::istreambuf_iterator<char>(out), {}};
  EXPECT_EQ(written, "tool tool\ntool tool\ntool tool\ntool tool\n");
  const std::string log = world.log();
  const std::size_t said = log.find("(allow_io)");
  EXPECT_NE(said, std::string::npos) << log;
  EXPECT_EQ(log.find("(allow_io)", said + 1), std::string::npos) << "once";
  std::filesystem::remove_all(folder);
}

TEST(ArgosScripts, LoseNothingThatTheyLogWhereAllIsKept) {
  Scripted world(Script{.text = "n = 0 function step() n = n + 1 log('line ', n) end", .robots = 2});
  world.run(100);
  EXPECT_EQ(world.said.size() + world.kept.size(), 200U);
  EXPECT_LT(world.said.size(), 60U);
  EXPECT_EQ(world.log().find("left out"), std::string::npos);
}

}  // namespace
}  // namespace tandem::test
