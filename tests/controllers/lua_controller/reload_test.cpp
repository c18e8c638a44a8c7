// Scripts that are changed while their robots run.
#include <gmock/gmock.h>

#include "core/live/source_files.hpp"
#include "core/live/timeline.hpp"
#include "tests/controllers/lua_controller/scripted.hpp"

namespace tandem::test {
namespace {

using core::Timeline;
using hal::Json;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

const std::string kStraight = R"(
  function step() robot.wheels.set_velocity(5 + robot.random.uniform(), 5) end)";
const std::string kTurns = R"(
  local turn = require "tools.turn"
  function init() n = 0 end
  function step() n = n + 1 robot.wheels.set_velocity(turn(n), robot.random.uniform(2, 4)) end)";
const std::string kTurn = "return function(n) return n % 7 end";

/// A world that one can go back in.
class Changed {
 public:
  explicit Changed(const Script& script) : all_(script), timeline_(*all_.world, clock_, {}) {
    all_.world->start();
    timeline_.start();
  }
  core::World& world() { return *all_.world; }
  Scripted& all() { return all_; }
  Timeline& timeline() { return timeline_; }
  void walk(int steps) {
    for (int i = 0; i < steps; ++i) {
      EXPECT_TRUE(timeline_.before_step().ok());
      all_.world->step();
      (void)timeline_.after_step(1000);
    }
  }
  Json reload(const std::string& script, const Json& modules = Json::object()) {
    Json files = modules;
    files["script.lua"] = script;
    const auto done = timeline_.act({{"do", "reload"}, {"controller", "c"}, {"files", files}});
    return done.ok() ? done.value() : Json{{"error", done.error().message}};
  }
  std::uint64_t hash() { return all_.world->state_hash(); }

 private:
  Scripted all_;
  core::LiveClock clock_;
  Timeline timeline_;
};

std::vector<double> places(core::World& world) {
  std::vector<double> all;
  for (std::size_t i = 0; i < world.space().robot_count(); ++i)
    all.push_back(world.space().pose(world.space().robot(i)).x_m);
  return all;
}

TEST(LuaReload, BeginsTheScriptAnewWhereTheRobotsStand) {
  Changed run({.text = kStraight, .robots = 3});
  run.walk(20);
  const auto stood = places(run.world());
  EXPECT_EQ(run.reload("x = (x or 0) + 1 function step() log('x is ', x) end")["robots"], 3);
  EXPECT_EQ(places(run.world()), stood);
  EXPECT_EQ(run.world().tick(), 20);
  run.walk(5);
  EXPECT_EQ(places(run.world()), stood);  // nobody told the wheels to turn
  EXPECT_THAT(run.all().log(), HasSubstr("x is 1"));
}

TEST(LuaReload, IsTheSameWhenTheTicksAreComputedAgain) {
  Changed run({.text = kStraight, .robots = 40, .threads = 2});
  run.walk(10);
  const std::uint64_t early = run.hash();
  run.walk(10);
  EXPECT_EQ(run.reload(kTurns, {{"tools/turn.lua", kTurn}})["robots"], 40);
  run.walk(15);
  ASSERT_EQ(run.timeline().act({{"do", "add"}, {"robot", {{"controller", "c"}, {"x", 3.0}, {"y", 3.0}}}}).ok(), true);
  run.walk(15);
  const std::uint64_t end = run.hash();
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(run.timeline().go_to(10).ok());
    EXPECT_EQ(run.hash(), early);
    ASSERT_TRUE(run.timeline().go_to(50).ok());
    EXPECT_EQ(run.hash(), end);
  }
  const auto undone = run.timeline().undo();
  ASSERT_TRUE(undone.ok());
  EXPECT_EQ(undone.value()["tick"], 35);
}

TEST(LuaReload, GivesNewRobotsTheScriptOfTheirTime) {
  const Json add = {{"do", "add"}, {"robot", {{"controller", "c"}, {"id", "late"}, {"x", 3.0}, {"y", 3.0}}}};
  Changed plain({.text = kStraight, .robots = 2});
  plain.walk(5);
  ASSERT_TRUE(plain.timeline().act(add).ok());
  plain.walk(5);
  Changed run({.text = kStraight, .robots = 2});
  run.walk(5);
  ASSERT_EQ(run.reload("function step() end")["robots"], 2);
  run.walk(5);
  ASSERT_TRUE(run.timeline().undo().ok());
  ASSERT_TRUE(run.timeline().act(add).ok());  // gets the script that the others have again
  run.walk(5);
  EXPECT_EQ(run.hash(), plain.hash());
  ASSERT_EQ(run.reload(kTurns, {{"tools/turn.lua", kTurn}})["robots"], 3);
  ASSERT_TRUE(run.timeline().act({{"do", "reset"}, {"seed", 3}}).ok());
  run.walk(10);
  Changed other({.text = kTurns, .robots = 2, .modules = {{"tools/turn.lua", kTurn}}});
  other.walk(10);
  EXPECT_EQ(run.hash(), other.hash());
}

TEST(LuaReload, OfAScriptThatCannotBeginLeavesTheOldOne) {
  Changed run({.text = kStraight, .robots = 3});
  Changed twin({.text = kStraight, .robots = 3});
  run.walk(10);
  twin.walk(10);
  EXPECT_THAT(run.reload("function step()\n  x = = 1\nend")["error"].get<std::string>(),
              MatchesRegex("[^ ]*script\\.lua:2: syntax error: unexpected symbol near '='"))
      << "no robot, and nothing of the program's own parts";
  EXPECT_THAT(run.reload("function init()\n error('no') end function step() end")["error"].get<std::string>(),
              HasSubstr("script.lua:2: no"));
  EXPECT_THAT(run.reload("robot.wheels.set_velocity(1, 1)")["error"].get<std::string>(),
              HasSubstr("no function step()"));
  EXPECT_THAT(run.reload("require 'none' function step() end")["error"].get<std::string>(),
              HasSubstr("no module 'none'"));
  EXPECT_THAT(run.reload("-- caf\xE9\nfunction step() end")["error"].get<std::string>(), HasSubstr("UTF-8"));
  run.walk(10);
  twin.walk(10);
  EXPECT_EQ(run.hash(), twin.hash());
}

TEST(LuaReload, StopsThoseThatCannotBeginAndFreesThoseThatHadStopped) {
  Changed run({.text = "function step() error('wrong') end", .robots = 3});
  run.walk(2);
  EXPECT_EQ(run.world().incidents().controllers_thrown, 3U);
  const Json done = run.reload(
      "function init() if robot.id == 'r1' then error('not me') end end function step() robot.wheels.set_velocity(5, "
      "5) end");
  EXPECT_EQ(done["robots"], 2);
  EXPECT_EQ(done["stopped"], 1);
  EXPECT_THAT(done["error_of_first"].get<std::string>(), HasSubstr("not me"));
  const auto stood = places(run.world());
  run.walk(5);
  const auto stand = places(run.world());
  EXPECT_GT(stand[0], stood[0]);
  EXPECT_EQ(stand[1], stood[1]);
  EXPECT_GT(stand[2], stood[2]);
}

TEST(LuaReload, KeepsInTheActionTheModulesThatItAsksFor) {
  Changed run({.text = kStraight, .robots = 2, .modules = {{"tools/turn.lua", kTurn}}});
  Json command = {{"do", "reload"}, {"controller", "c"}, {"files", {{"script.lua", kTurns}}}};
  ASSERT_TRUE(core::reload(run.world(), command).ok());
  EXPECT_EQ(command["files"]["tools/turn.lua"], kTurn);
  const Json files = core::source_files(run.world());
  EXPECT_EQ(files["c"].size(), 2U);
  EXPECT_EQ(files["c"][0]["text"], kTurns);
  run.all().write("tools/turn.lua", "return function(n) return 1 end");
  EXPECT_TRUE(core::reloads_to(files, run.world()).empty());
  Changed now({.text = kStraight, .robots = 2});
  const auto actions = core::reloads_to(files, now.world());
  ASSERT_EQ(actions.size(), 1U);
  EXPECT_EQ(actions[0].action["files"]["tools/turn.lua"], kTurn);
}

TEST(LuaReload, SaysWhatMakesNoSense) {
  Changed run({.text = kStraight});
  const auto error = [&](Json command) {
    const auto done = core::reload(run.world(), command);
    return done.ok() ? "none" : done.error().message;
  };
  EXPECT_THAT(error({{"do", "reload"}}), HasSubstr("\"controller\""));
  EXPECT_THAT(error({{"controller", "c"}}), HasSubstr("\"files\""));
  EXPECT_THAT(error({{"controller", "d"}, {"files", {{"a", "b"}}}}), HasSubstr("Did you mean 'c'"));
  EXPECT_THAT(error({{"controller", "c"}, {"files", {{"a", 1}}}}), HasSubstr("'a' is a text"));
}

}  // namespace
}  // namespace tandem::test
