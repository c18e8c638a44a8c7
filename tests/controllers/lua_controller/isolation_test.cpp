// What a script changes in what all have belongs to the robot that changed it.
#include <gmock/gmock.h>

#include "tests/controllers/lua_controller/scripted.hpp"

namespace tandem::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// What a robot does with what all have, and a number that tells whether it was done.
struct Change {
  std::string statement;
  std::string number;
};

const std::vector<Change> kChanges = {
    {"math.pi = math.pi + 1", "math.pi"},
    {"math.maxinteger = 5", "math.maxinteger % 100"},
    {"math.sin = function() return 3 end", "math.sin(1)"},
    {"math.floor = nil", "math.floor and 1 or 2"},
    {"math = {pi = 1}", "math.pi"},
    {"rawset(math, 'pi', 9)", "math.pi"},
    {"string.format = function() return '77' end", "tonumber(string.format('%d', 5))"},
    {"string.rep = function() return 'abcd' end", "#('x'):rep(9)"},
    {"string.half = function(s) return #s // 2 end", "string.half and ('abcdef'):half() or 0"},
    {"utf8.charpattern = 'x'", "#utf8.charpattern"},
    {"os.time = function() return 4 end", "os.time()"},
    {"table.insert(table, 7)", "#table"},
    {"table.concat = table.unpack", "table.concat == table.unpack and 1 or 0"},
    {"coroutine.wrap = nil", "coroutine.wrap and 1 or 2"},
    {"_G['deb' .. 'ug'].traceback = 3", "debug.traceback == 3 and 1 or 2"},
    {"io.pi = 3", "rawget(io, 'pi') or 0"},
    {"robot.wheels.set = robot.wheels.set_velocity robot.wheels.set_velocity = 5",
     "robot.wheels.set_velocity == 5 and 1 or 2"},
    {"robot.random.uniform = function() return 2 end", "robot.random.uniform() == 2 and 1 or 2"},
    {"robot.wheels = nil", "robot.wheels and 1 or 2"},
    {"robot.sensors.clock = nil", "robot.sensors.clock and 1 or 2"},
    {"robot.id = 'myself'", "#robot.id"},
    {"robot.proximity = 4", "robot.proximity == 4 and 1 or 2"},
    {"robot.proximity[1].mine = 7", "robot.proximity[1].mine or 0"},
    {"robot.range_and_bearing.mine = 7", "robot.range_and_bearing.mine or 0"},
    {"print = 3", "print == 3 and 1 or 2"},
};

const std::string kDevices = "<epuck_proximity/><clock/><range_and_bearing/>";

/// A script in which the robots that `who` is true for do it at tick 1, and all walk by the number.
std::string script_of(const Change& change, const std::string& who) {
  return R"(
    local set, n = robot.wheels.set_velocity, 0
    function step()
      n = n + 1
      if n == 2 and ()" +
         who + ") then " + change.statement + R"( end
      local number = )" +
         change.number + R"(
      set(number % 7, n % 3)
    end)";
}

TEST(LuaIsolation, TheSameBitsForAnyNumberOfThreadsWhateverAllRobotsChange) {
  for (const Change& change : kChanges) {
    std::uint64_t hash = 0;
    for (const std::int64_t threads : {1, 4}) {
      Scripted world({.text = script_of(change, "tonumber(robot.id:sub(2)) % 3 ~= 1"),
                      .sensors = kDevices,
                      .robots = 60,
                      .threads = threads});
      world.run(5);
      if (hash == 0) hash = world.world->state_hash();
      EXPECT_EQ(world.world->state_hash(), hash) << change.statement;
    }
  }
}

TEST(LuaIsolation, ANeighbourNeverSeesIt) {
  for (const Change& change : kChanges) {
    Scripted changed({.text = script_of(change, "robot.id == 'r1'"), .sensors = kDevices, .robots = 3});
    Scripted plain({.text = script_of(change, "false"), .sensors = kDevices, .robots = 3});
    changed.run(6);
    plain.run(6);
    const core::Space& with = changed.world->space();
    const core::Space& without = plain.world->space();
    for (const char* const robot : {"r0", "r2"})
      EXPECT_EQ(with.pose(with.find_robot(robot)).x_m, without.pose(without.find_robot(robot)).x_m)
          << change.statement << " of r1 changed " << robot;
  }
}

TEST(LuaIsolation, TheRobotThatChangedItSeesIt) {
  for (const Change& change : kChanges) {
    Scripted world({.text = script_of(change, "robot.id == 'r1'") + "\nlocal all = step function step() all() log(" +
                            change.number + ") end",
                    .sensors = kDevices,
                    .robots = 3});
    world.run(1);
    ASSERT_EQ(world.said.size(), 3U) << change.statement;
    const auto number = [&](std::size_t i) { return world.said[i].substr(world.said[i].rfind(": ")); };
    const std::string before = number(1);
    world.said.clear();
    world.run(2);
    EXPECT_NE(number(4), before) << change.statement;
    EXPECT_EQ(number(3), before) << change.statement;
  }
}

TEST(LuaIsolation, FunctionsThatAScriptAddsToLibrariesWhenItLoadsAreThere) {
  Scripted world({.text = R"(
    math.sign = function(x) return x < 0 and -1 or 1 end
    function string.trim(s) return (s:gsub("^%s+", ""):gsub("%s+$", "")) end
    function table.sum(t) local n = 0 for _, x in ipairs(t) do n = n + x end return n end
    local floor = math.floor
    math.floor = function(x) return floor(x) + 100 end
    local set = robot.wheels.set_velocity
    robot.wheels.set_velocity = function(l, r) set(l / 2, r / 2) end
    function step()
      assert(math.sign(-3) == -1 and math.floor(2.5) == 102 and math.sqrt(4) == 2 and math.pi > 3)
      assert(("  a b "):trim() == "a b" and string.trim(" x") == "x" and ("x"):rep(2) == "xx")
      assert(table.sum({1, 2, 3}) == 6 and #table.concat({"a", "b"}) == 2)
      robot.wheels.set_velocity(10, 10)
    end)",
                  .robots = 3});
  world.run(10);
  const core::Space& space = world.world->space();
  EXPECT_NEAR(space.pose(space.find_robot("r2")).x_m, -4.0 + 9 * 0.005, 1e-6);  // 5 cm/s from the second tick on
}

TEST(LuaIsolation, LibrariesCanBeLookedThrough) {
  Scripted world({.text = R"(function step()
      local names, again = {}, {}
      for name in pairs(math) do names[#names + 1] = name end
      math.mine = 1
      for name in pairs(math) do again[#again + 1] = name end
      assert(#again == #names + 1 and next(string) == "byte" and rawget(math, "pi") == math.pi)
      local parts = {}
      for name in pairs(robot) do parts[#parts + 1] = name end
      assert(table.concat(parts, " ") == "actuators id params proximity random sensors wheels", table.concat(parts, " "))
    end)"});
  world.run(1);
}

TEST(LuaIsolation, MetatablesOfVectorsAndTextsAreOutOfReach) {
  Scripted world({.text = R"(function step()
      assert(getmetatable(vector2()) == false and getmetatable("") == false and getmetatable(math) == false)
      assert(vector2(3, 4).__index == nil and vector2(3, 4):length() == 5)
      assert(not pcall(setmetatable, vector3(), {}) and not pcall(rawset, robot.proximity, 1, 2))
    end)"});
  world.run(1);
}

TEST(LuaIsolation, GoesWithTheRobotIntoACheckpoint) {
  Scripted world({.text = R"(
    local n = 0
    function step()
      n = n + 1
      if n == 5 then string.half = function(s) return #s // 2 end math.pi = 1 end
      if n == 15 then string.half = nil end
      robot.wheels.set_velocity(math.pi, string.half and ("abcdefgh"):half() or 1)
    end)",
                  .robots = 4});
  world.run(2);
  const auto early = world.world->snapshot();
  ASSERT_TRUE(early.ok()) << early.error().message;
  world.run(8);
  const auto late = world.world->snapshot();
  world.run(10);
  const std::uint64_t end = world.world->state_hash();
  for (const bool from_early : {true, false, true}) {
    ASSERT_TRUE(world.world->restore(from_early ? early.value() : late.value()).ok());
    world.run(from_early ? 18 : 10);
    EXPECT_EQ(world.world->state_hash(), end) << from_early;
  }
}

TEST(LuaIsolation, TheLengthOfAListWithHolesIsTheSameInEveryInterpreter) {
  // A border of a list with holes depends on the places of all its entries: those of texts on the seed of their hashes.
  std::string first;
  for (int run = 0; run < 8; ++run) {
    Scripted world({.text = R"(function step()
        local all = {}
        for seed = 1, 40 do
          local t = {}
          for i = 1, 30 do
            t["k" .. (i * seed) % 17] = i
            if (i * seed) % 3 ~= 0 then t[i] = i else t[i // 2] = nil end
          end
          all[#all + 1] = #t
        end
        log(table.concat(all, " "))
      end)"});
    world.run(1);
    if (first.empty()) first = world.log();
    EXPECT_EQ(world.log(), first);
  }
}

}  // namespace
}  // namespace tandem::test
