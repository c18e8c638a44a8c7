// How long a call may take, and how much memory: counted, so that a robot ends at the same tick everywhere, and alone.
#include <gmock/gmock.h>

#include "tests/controllers/lua_controller/scripted.hpp"

namespace tandem::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kFew = R"(most_instructions="1000000")";

std::string ended(const std::string& body, const std::string& params = kFew) {
  return Scripted({.text = "function step() " + body + " end", .params = params}).incident();
}

TEST(LuaLimits, NoHandlerOfErrorsPutsTheEndOff) {
  EXPECT_THAT(ended("xpcall(error, function() while true do end end)"), HasSubstr("does not come to an end"));
  EXPECT_THAT(ended("xpcall(function() while true do end end, function() while true do end end)"),
              HasSubstr("does not come to an end"));
  EXPECT_THAT(ended("return pcall(function() while true do end end)"), HasSubstr("does not come to an end"));
  EXPECT_THAT(
      ended("local x <close> = setmetatable({}, {__close = function() while true do end end}) while true do end"),
      HasSubstr("does not come to an end"));
}

TEST(LuaLimits, AHandlerOfErrorsIsCalledAsEver) {
  Scripted world({.text = R"(function step()
      local ok, said, more = xpcall(function(a, b) return a + b, "x" end, print, 2, 3)
      assert(ok and said == 5 and more == "x")
      ok, said = xpcall(function(a) error({a}) end, function(e) return e[1] + 1 end, 7)
      assert(not ok and said == 8)
      local co = coroutine.wrap(function() return xpcall(function() coroutine.yield(4) return 5 end, print) end)
      assert(co() == 4)
      local done, five = co()
      assert(done == true and five == 5)
    end)"});
  world.run(2);
}

TEST(LuaLimits, LibraryFunctionsThatTakeLongCount) {
  for (const std::string call :
       {"string.find(('a'):rep(400), ('a*'):rep(40) .. 'b')", "string.match(('x'):rep(3000), '.-.-.-b')",
        "string.gsub(('a'):rep(400), ('a*'):rep(40) .. 'b', '')",
        "for _ in ('a'):rep(400):gmatch(('a*'):rep(40) .. 'b') do end", "string.rep('', 1 << 60)",
        "table.move({}, 1, 1 << 60, 2)",
        "table.insert(setmetatable({}, {__len = function() return 1 << 60 end}), 1, 1)",
        "local s = ('x'):rep(1000000) while true do s = s .. 'x' end"})
    EXPECT_THAT(ended(call), HasSubstr("does not come to an end")) << call;
}

TEST(LuaLimits, TheCountIsExactForAnyNumberOfThreadsAndNeighbours) {
  // Each robot takes a few more turns in every step, and leaves where it was when the count ended it.
  const std::string text = R"(
    local me, n = tonumber(robot.id:sub(2)), 0
    function step()
      n = n + 1
      robot.wheels.set_velocity(n, n)
      local s = ""
      for i = 1, 80000 + 900 * n + 20 * me do
        if i % 1000 == 0 then s = s .. tostring(i) local t = {i, me, s} end
      end
    end)";
  std::string first;
  std::uint64_t hash = 0;
  for (const std::int64_t threads : {1, 3, 5}) {
    Scripted world({.text = text, .params = R"(most_instructions="100000")", .robots = 40, .threads = threads});
    ASSERT_NE(world.world, nullptr) << world.problems;
    for (int i = 0; i < 30; ++i) world.world->step();
    EXPECT_GT(world.world->incidents().controllers_thrown, 0U);
    const std::string all = world.incidents();
    if (first.empty()) {
      first = all;
      hash = world.world->state_hash();
    }
    EXPECT_EQ(all, first);
    EXPECT_EQ(world.world->state_hash(), hash);
  }
  Scripted alone({.text = text, .params = R"(most_instructions="100000")", .robots = 1});
  for (int i = 0; i < 30; ++i) alone.world->step();
  const std::string lonely = alone.incidents();
  ASSERT_NE(lonely.find(" threw"), std::string::npos) << lonely;
  EXPECT_THAT(first, HasSubstr(lonely.substr(lonely.find(" threw"))));
}

TEST(LuaLimits, ARobotThatFillsItsMemoryEndsAloneAndAtTheSameTickEverywhere) {
  const std::string text = R"(
    local kept = {}
    function step()
      robot.wheels.set_velocity(5, 5)
      if robot.id == "r3" or robot.id == "r40" then
        for i = 1, 20000 do kept[#kept + 1] = {#kept} end
      end
      local garbage = {}
      for i = 1, 100 do garbage[i] = {robot.id .. i} end
    end)";
  std::string first;
  for (const std::int64_t threads : {1, 2, 5}) {
    Scripted world({.text = text, .params = R"(most_memory="8")", .robots = 60, .threads = threads});
    ASSERT_NE(world.world, nullptr) << world.problems;
    for (int i = 0; i < 20; ++i) world.world->step();
    EXPECT_EQ(world.world->incidents().controllers_thrown, 2U);
    const std::string all = world.incidents();
    EXPECT_THAT(all, AllOf(HasSubstr("robot 'r3' (and 1 more) threw"), HasSubstr("8 MiB")));
    if (first.empty()) first = all;
    EXPECT_EQ(all, first);
  }
}

TEST(LuaLimits, OneCallThatTakesMemoryWithoutEndHasNoNeighbourPay) {
  for (const std::string grab : {"local t = {} while true do t[#t + 1] = ('x'):rep(1000000) .. #t end",
                                 "local s = ('x'):rep(1 << 30)", "local t = {} for i = 1, 1e9 do t[i] = {} end",
                                 "while true do pcall(function() local s = ('x'):rep(1 << 30) end) end",
                                 "local t = {} while true do t[#t + 1] = coroutine.create(step) end"}) {
    Scripted world(
        {.text = "kept = ('x'):rep(500000) function step() robot.wheels.set_velocity(5, 5) if robot.id == 'r1' then " +
                 grab + " end kept = kept:sub(2) .. 'y' end",
         .robots = 3});
    ASSERT_NE(world.world, nullptr) << world.problems;
    for (int i = 0; i < 3; ++i) world.world->step();
    EXPECT_EQ(world.world->incidents().controllers_thrown, 1U) << grab;
    EXPECT_THAT(world.incident(), AllOf(HasSubstr("robot 'r1'"), HasSubstr("memory"))) << grab;
  }
}

TEST(LuaLimits, GarbageIsNoMemory) {
  Scripted world({.text = R"(function step()
      local t
      for i = 1, 3000 do t = {i, {i}, tostring(i) .. ("x"):rep(100)} end
    end)",
                  .params = R"(most_memory="1")"});
  world.run(200);
}

TEST(LuaLimits, WhatACoroutineHoldsIsMemory) {
  Scripted world({.text = R"(
    local all = {}
    function step()
      for i = 1, 20 do
        local walk = coroutine.wrap(function() local t = {} for k = 1, 2000 do t[k] = {k} end coroutine.yield() return t end)
        walk()
        all[#all + 1] = walk
      end
    end)",
                  .params = R"(most_memory="4")"});
  EXPECT_THAT(world.incident(20), HasSubstr("4 MiB"));
}

}  // namespace
}  // namespace tandem::test
