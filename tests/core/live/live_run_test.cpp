// Holding a run: pause, steps, speed, conditions, history, and commands that make no sense.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/live/held.hpp"

namespace tandem::core {
namespace {

using hal::Json;
using testing::HasSubstr;

TEST(LiveRun, IsPausedSteppedAndPlayed) {
  LiveOptions options = Held::paused();
  options.ticks = 200;
  Held run(crowd(), options);
  EXPECT_EQ(run.tick(), 0);
  EXPECT_TRUE(run.live().state().paused);
  run.walk(3);
  EXPECT_EQ(run.tick(), 3);
  EXPECT_TRUE(run.live().state().paused);
  EXPECT_EQ(run.ask({{"do", "play"}})["ok"], true);
  while (run.live().state().ended.empty()) std::this_thread::yield();
  EXPECT_EQ(run.tick(), 200);
  EXPECT_EQ(run.live().state().ended, "its 200 ticks are done");
  EXPECT_THAT(run.error_of({{"do", "play"}}), HasSubstr("go back to an earlier tick"));
  EXPECT_EQ(run.hash_at(100), run.new_ticks.at(100));
  EXPECT_EQ(run.live().state().ended, "");
  const Json state = to_json(run.live().state());
  EXPECT_EQ(state["tick"], 100);
  EXPECT_EQ(state["latest"], 200);
  EXPECT_EQ(state["ended"], nullptr);
}

TEST(LiveRun, KeepsTheSpeedThatIsAskedFor) {
  LiveOptions options;
  options.ticks = 100;
  options.speed = 2.0;  // 10 ticks a second: 50 ms a tick
  Held run(crowd(), options);
  while (run.live().state().ended.empty()) std::this_thread::yield();
  run.end();
  EXPECT_NEAR(hal::to_seconds(run.clock().now_ns()), 99 * 0.05, 0.06);
  EXPECT_NEAR(run.live().state().reached, 2.0, 0.3);
  EXPECT_EQ(run.live().deadline_misses(), 0U);
}

TEST(LiveRun, ComesToItsEndWithoutAViewer) {
  LiveOptions options;
  options.ticks = 20;
  Held run(crowd(), options);
  while (run.live().state().ended.empty()) std::this_thread::yield();
  while (run.error_of({{"do", "hash"}}) != "the run is over") std::this_thread::yield();
  EXPECT_EQ(run.world().tick(), 20);
}

TEST(LiveRun, GoesOnToTheLatestTickWhenItIsStoppedInThePast) {
  Held run(crowd());
  run.walk(30);
  run.hash_at(10);
  run.end();
  EXPECT_EQ(run.world().tick(), 30);
  EXPECT_EQ(run.world().state_hash(), run.new_ticks.at(30));
}

TEST(LiveRun, ShowsWhatNoNewTickShows) {
  Held run(crowd());
  run.walk(20);
  const int before = run.shows;
  run.hash_at(5);
  EXPECT_GT(run.shows, before);
  const int there = run.shows;
  EXPECT_EQ(run.error_of({{"do", "halt"}, {"robot", "ep1"}}), "");
  EXPECT_GT(run.shows, there);
}

TEST(LiveRun, StopsWhenAConditionHolds) {
  Scene scene = crowd("kinematics2d", "shown", 5);
  Held run(scene);
  const auto stops_at = [&](const Json& condition) {
    Json command = condition;
    command["do"] = "stop_when";
    EXPECT_EQ(run.error_of(command), "") << condition;
    EXPECT_EQ(run.ask({{"do", "step"}, {"ticks", 100}})["ok"], true);
    while (run.live().state().stopped_by.empty()) std::this_thread::yield();
    EXPECT_EQ(run.error_of({{"do", "stop_when"}, {"clear", true}}), "");
    return run.tick();
  };
  EXPECT_EQ(stops_at({{"robot", "ep2"}, {"role", "published"}, {"field", "steps"}, {"op", ">"}, {"value", 7}}), 8);
  EXPECT_EQ(run.live().state().stopped_by, "robot 'ep2': published steps > 7 (it is 8)");
  EXPECT_EQ(stops_at({{"robot", "*"}, {"role", "published"}, {"field", "mode"}, {"op", "=="}, {"value", "rest"}}), 12);
  EXPECT_THAT(run.live().state().stopped_by, HasSubstr("published mode == rest"));
  EXPECT_EQ(run.hash_at(3), run.new_ticks.at(3));
  EXPECT_EQ(stops_at({{"robot", "ep0"},
                      {"role", "actuator"},
                      {"port", "differential_steering"},
                      {"field", "right"},
                      {"op", "=="},
                      {"value", 0}}),
            4);
}

TEST(LiveRun, StopsAtAnIncident) {
  Held run(crowd("kinematics2d", "thrower", 3));
  EXPECT_EQ(run.error_of({{"do", "stop_when"}, {"incident", true}}), "");
  EXPECT_EQ(run.ask({{"do", "play"}})["ok"], true);
  while (run.live().state().stopped_by.empty()) std::this_thread::yield();
  EXPECT_EQ(run.tick(), 4);
  EXPECT_THAT(run.live().state().stopped_by, HasSubstr("threw at tick 3"));
}

TEST(LiveRun, TellsTheHistoryOfAField) {
  Held run(crowd("kinematics2d", "shown", 5));
  run.walk(30);
  const std::uint64_t now = run.hash();
  const Json steps = run.ask({{"do", "history"},
                              {"robot", "ep1"},
                              {"role", "published"},
                              {"field", "steps"},
                              {"from", 5},
                              {"to", 25},
                              {"every", 10}});
  EXPECT_EQ(steps["ticks"], (Json{5, 15, 25})) << steps;
  EXPECT_EQ(steps["values"], (Json{5, 15, 25}));
  const Json x = run.ask({{"do", "history"}, {"robot", "ep1"}, {"role", "pose"}, {"field", "x"}});
  EXPECT_EQ(x["ticks"].size(), 31U);
  EXPECT_EQ(run.hash(), now);
  EXPECT_EQ(run.tick(), 30);
  EXPECT_THAT(run.error_of({{"do", "history"}, {"robot", "ep1"}, {"role", "pose"}, {"field", "w"}}),
              HasSubstr("a pose has no field 'w'; there are: x, y, z, heading"));
  EXPECT_THAT(
      run.error_of({{"do", "history"}, {"robot", "ep1"}, {"role", "sensor"}, {"port", "lidar"}, {"field", "x"}}),
      HasSubstr("takes no sensor 'lidar'"));
}

TEST(LiveRun, AnswersWhatMakesNoSense) {
  Held run(crowd());
  const std::uint64_t before = run.hash();
  for (const Json& command :
       {Json(3),
        Json(nullptr),
        Json::array(),
        Json::object(),
        Json{{"do", 4}},
        Json{{"do", "dance"}},
        Json{{"do", "go_to"}},
        Json{{"do", "go_to"}, {"tick", -1}},
        Json{{"do", "go_to"}, {"tick", 1e300}},
        Json{{"do", "go_to"}, {"tick", "x"}},
        Json{{"do", "step"}, {"ticks", 0}},
        Json{{"do", "speed"}},
        Json{{"do", "speed"}, {"times", 0}},
        Json{{"do", "speed"}, {"times", -1}},
        Json{{"do", "play"}, {"speed", "x"}},
        Json{{"do", "stop_when"}},
        Json{{"do", "stop_when"}, {"robot", 3}},
        Json{{"do", "stop_when"}, {"robot", "ep1"}, {"role", "pose"}, {"field", "x"}, {"op", "~"}, {"value", 1}},
        Json{{"do", "stop_when"}, {"robot", "ep1"}, {"role", "pose"}, {"field", "x"}, {"op", "<"}},
        Json{{"do", "stop_when"}, {"robot", "gone"}, {"role", "pose"}, {"field", "x"}, {"op", "<"}, {"value", 1}},
        Json{{"do", "history"}, {"role", "pose"}, {"field", "x"}},
        Json{{"do", "history"}, {"robot", "ep1"}, {"role", "pose"}, {"field", "x"}, {"every", 0}}}) {
    EXPECT_NE(run.error_of(command), "") << hal::to_text(command);
  }
  EXPECT_THAT(run.error_of({{"do", "pla"}}), HasSubstr("Did you mean 'play'"));
  EXPECT_EQ(run.hash(), before);
  EXPECT_EQ(run.tick(), 0);
}

TEST(LiveRun, RefusesWhatNobodyCanCarryOutAnyMore) {
  auto made = make(crowd());
  LiveRun live(*made.world, {});
  int refused = 0;
  std::vector<std::string> errors;
  for (int i = 0; i < 1005; ++i) {
    live.post({{"do", "pause"}}, [&](const Json& answer) {
      ++refused;
      errors.push_back(answer["error"].text());
    });
  }
  EXPECT_EQ(refused, 5);
  EXPECT_THAT(errors.front(), HasSubstr("too many commands wait"));
  live.close();
  EXPECT_EQ(refused, 1005);
  EXPECT_EQ(errors.back(), "the run is over");
}

TEST(LiveRun, GoesToTheLastOfManyPlacesThatAreAskedFor) {
  auto made = make(crowd());
  World& world = *made.world;
  FakedClock clock;
  LiveOptions options = Held::paused();
  options.clock = &clock;
  LiveRun live(world, options);
  world.start();
  live.start();
  std::vector<Json> answers;
  const auto post = [&](const Json& command) {
    live.post(command, [&](const Json& answer) { answers.push_back(answer); });
  };
  const auto step = [&] {
    ASSERT_TRUE(live.before_step());
    world.step();
    live.after_step();
  };
  post({{"do", "step"}, {"ticks", 10}});
  for (int i = 0; i < 10; ++i) step();
  for (const int tick : {3, 5, 99, 7}) post({{"do", "go_to"}, {"tick", tick}});
  post({{"do", "step"}});
  step();
  EXPECT_EQ(world.tick(), 8);
  ASSERT_EQ(answers.size(), 6U);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(answers[i]["skipped"], true);
  EXPECT_EQ(answers[4], (Json{{"ok", true}, {"tick", 7}}));
}

TEST(LiveRun, HasNeitherPauseNorWayBackWithRealRobots) {
  auto made = make(crowd());
  World& world = *made.world;
  LiveOptions options;
  options.real_robots = true;
  LiveRun live(world, options);
  std::vector<std::pair<hal::Tick, Json>> events;
  live.on_event([&](hal::Tick tick, const Json& event) { events.emplace_back(tick, event); });
  world.start();
  std::vector<Json> answers;
  for (const Json& command : {Json{{"do", "pause"}}, Json{{"do", "go_to"}, {"tick", 0}}, Json{{"do", "reset"}},
                              Json{{"do", "undo"}}, Json{{"do", "halt"}, {"robot", "ep1"}}})
    live.post(command, [&](const Json& answer) { answers.push_back(answer); });
  world.step();
  EXPECT_TRUE(live.after_step());
  ASSERT_EQ(answers.size(), 5U);
  EXPECT_THAT(answers[0]["error"].get<std::string>(), HasSubstr("halt them instead"));
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_THAT(answers[i]["error"].get<std::string>(), HasSubstr("real robots take part"));
  EXPECT_EQ(answers[4]["ok"], true);
  EXPECT_TRUE(world.space().halted(world.space().find_robot("ep1")));
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].second["repeatable"], false);
  EXPECT_EQ(live.state().tick, 1);
}

TEST(LiveRun, EndsWhenAnActionCannotBeRepeated) {
  LiveOptions options;
  options.ticks = 20;
  options.repeat = {{5, {{"do", "halt"}, {"robot", "nobody"}}}};
  Held run(crowd(), options);
  while (run.live().state().tick < 5) std::this_thread::yield();
  while (run.error_of({{"do", "hash"}}) != "the run is over") std::this_thread::yield();
  run.end();
  EXPECT_EQ(run.world().tick(), 5);
  EXPECT_THAT(run.live().failure(), HasSubstr("could not be repeated at tick 5: there is no robot 'nobody'"));
}

}  // namespace
}  // namespace tandem::core
