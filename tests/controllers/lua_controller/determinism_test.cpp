// The same bits for any number of threads, on every run, and on from a checkpoint.
#include <gmock/gmock.h>

#include "tests/controllers/lua_controller/scripted.hpp"

namespace tandem::test {
namespace {

using ::testing::HasSubstr;

/// Walks by chance, with state in globals, locals, closures and tables, and an order of tables that decides.
const std::string kWalk = R"(
  local left = 0
  local history = {}
  local function later(n) local count = n return function() count = count - 1 return count end end
  function init() names = {} countdown = later(5) for i = 1, 20 do names["key" .. i] = robot.random.uniform() end end
  function step()
    left = left - 1
    if left <= 0 then left = robot.random.uniform_int(1, 6) turn = robot.random.gaussian(3) end
    local sum = 0
    for k, v in pairs(names) do sum = (sum + v) * 0.7 + #k end
    names["key" .. robot.random.uniform_int(1, 20)] = math.sin(sum) ^ 2
    history[#history + 1] = sum
    if #history > 10 then table.remove(history, 1) end
    if countdown() <= 0 then countdown = later(#history) end
    local seen = 0
    for i = 1, #robot.proximity do seen = seen + robot.proximity[i].value end
    robot.wheels.set_velocity(4 + math.cos(sum) + seen, 4 - turn + countdown() * 0.1)
  end)";

TEST(LuaRuns, AreTheSameForAnyNumberOfThreads) {
  std::uint64_t hash = 0;
  for (const std::int64_t threads : {1, 2, 5}) {
    Scripted world({.text = kWalk, .robots = 600, .threads = threads});
    world.run(30);
    if (hash == 0) hash = world.world->state_hash();
    EXPECT_EQ(world.world->state_hash(), hash) << threads;
  }
}

TEST(LuaRuns, GoOnFromACheckpointAsTheyDid) {
  Scripted world({.text = kWalk, .robots = 30});
  world.run(20);
  const auto early = world.world->snapshot();
  ASSERT_TRUE(early.ok()) << early.error().message;
  world.run(20);
  const auto late = world.world->snapshot();
  ASSERT_TRUE(late.ok());
  world.run(20);
  const std::uint64_t end = world.world->state_hash();
  for (const bool from_early : {true, false, true, true}) {
    ASSERT_TRUE(world.world->restore(from_early ? early.value() : late.value()).ok());
    world.run(from_early ? 40 : 20);
    EXPECT_EQ(world.world->state_hash(), end) << from_early;
  }
}

TEST(LuaRuns, DoNotDependOnCheckpoints) {
  Scripted plain({.text = kWalk, .robots = 10});
  plain.run(40);
  Scripted with({.text = kWalk, .robots = 10});
  for (int i = 0; i < 4; ++i) {
    with.run(10);
    ASSERT_TRUE(with.world->snapshot().ok());
  }
  EXPECT_EQ(with.world->state_hash(), plain.world->state_hash());
}

TEST(LuaRuns, BeginAnewAsANewWorldWould) {
  Scripted first({.text = kWalk, .robots = 10});
  first.run(20);
  ASSERT_TRUE(first.world->reset(3).ok());
  first.run(20);
  Scripted second({.text = kWalk, .robots = 10});
  second.run(20);
  EXPECT_EQ(first.world->state_hash(), second.world->state_hash());
}

TEST(LuaRuns, SayThatACoroutineCannotBeKept) {
  Scripted world({.text = R"(
    local walk = coroutine.wrap(function() while true do coroutine.yield() end end)
    function step() walk() end)"});
  world.run(1);
  const auto snapshot = world.world->snapshot();
  ASSERT_FALSE(snapshot.ok());
  EXPECT_THAT(snapshot.error().message, HasSubstr("coroutine"));
  EXPECT_THAT(snapshot.error().message, HasSubstr("robot 'r0'"));
}

TEST(LuaRuns, VisitTablesInOrder) {
  Scripted world({.text = R"(function step()
    local t = {[2.5] = 1, b = 1, a = 1, [true] = 1, [-1] = 1, 7, 8}
    local keys = {}
    for k in pairs(t) do keys[#keys + 1] = tostring(k) end
    log(table.concat(keys, " "))
    assert(next({}) == nil and next({5}) == 1 and next({a = 1, b = 2}, "a") == "b")
    log(tostring({}) .. " " .. string.format("%s", print))
    local words = {"b", "a", "c"}
    table.sort(words)
    assert(table.concat(words) == "abc" and 2 ^ 10 == 1024 and 3 ^ -1 == 1 / 3)
  end)"});
  world.run(1);
  EXPECT_THAT(world.log(), HasSubstr("-1 1 2 2.5 a b true\n"));
  EXPECT_THAT(world.log(), HasSubstr("table: 1 function: 2\n"));
}

}  // namespace
}  // namespace tandem::test
