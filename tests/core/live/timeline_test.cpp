// Going back, going on the same or differently, undoing, and repeating.
#include "core/live/timeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>

#include "core/sim/engine_factory.hpp"
#include "tests/core/live/held.hpp"

namespace tandem::core {
namespace {

using hal::Json;
using testing::HasSubstr;

Json move_to(const std::string& robot, double x_m, double y_m) {
  return {{"do", "move"}, {"robot", robot}, {"x", x_m}, {"y", y_m}};
}

class Timelines : public testing::TestWithParam<std::tuple<std::string, int>> {};
INSTANTIATE_TEST_SUITE_P(Engines, Timelines,
                         testing::Combine(testing::ValuesIn(test::engine_kinds()), testing::Values(0, 2)),
                         [](const auto& p) {
                           return std::get<0>(p.param) + "_" + std::to_string(std::get<1>(p.param)) + "threads";
                         });

TEST_P(Timelines, GiveEveryTickTheSameBitsAgain) {
  WorldOptions options;
  options.threads = std::get<1>(GetParam());
  Held run(crowd(std::get<0>(GetParam())), Held::paused(), options);
  run.walk(60);
  const auto straight = run.new_ticks;
  ASSERT_EQ(straight.size(), 61U);
  for (const hal::Tick tick : {37, 5, 59, 0, 60, 13}) EXPECT_EQ(run.hash_at(tick), straight.at(tick)) << tick;
  run.new_ticks.clear();
  run.walk(47);  // from 13 to 60, the same again
  EXPECT_EQ(run.hash(), straight.at(60));
  EXPECT_TRUE(run.new_ticks.empty());  // nothing of it is new
  run.walk(1);
  EXPECT_EQ(run.new_ticks.size(), 1U);
  EXPECT_TRUE(run.events.empty());
}

TEST_P(Timelines, RepeatWhatWasTouchedAtItsTick) {
  WorldOptions options;
  options.threads = std::get<1>(GetParam());
  const Scene scene = crowd(std::get<0>(GetParam()));
  Held run(scene, Held::paused(), options);
  run.walk(10);
  ASSERT_EQ(run.error_of(move_to("ep3", 1.4, 1.4)), "");
  ASSERT_EQ(run.error_of({{"do", "halt"}, {"robot", "ep4"}}), "");
  run.walk(10);
  ASSERT_EQ(run.error_of({{"do", "remove"}, {"robot", "ep5"}}), "");
  ASSERT_EQ(run.error_of({{"do", "add"}, {"robot", {{"controller", "c"}, {"x", -1.5}, {"y", 1.5}}}}), "");
  const std::uint64_t touched = run.hash();
  run.walk(20);
  const auto straight = run.new_ticks;
  EXPECT_EQ(run.hash_at(15), straight.at(15));
  EXPECT_EQ(run.hash_at(40), straight.at(40));
  EXPECT_EQ(run.hash_at(5), straight.at(5));
  EXPECT_EQ(run.hash_at(20), touched);  // with what was touched there
  run.walk(20);
  EXPECT_EQ(run.hash(), straight.at(40));

  // And in another run, without anybody's doing it.
  LiveOptions again = Held::paused();
  again.repeat = actions_of(run.events);
  ASSERT_EQ(again.repeat.size(), 4U);
  Held repeated(scene, again);
  repeated.walk(40);
  EXPECT_EQ(repeated.new_ticks, straight);
  EXPECT_EQ(repeated.events, run.events);
}

TEST(Timeline, TakesAnotherWayWhenSomebodyTouchesThePast) {
  const Scene scene = crowd();
  Held run(scene);
  run.walk(10);
  ASSERT_EQ(run.error_of({{"do", "halt"}, {"robot", "ep1"}}), "");
  run.walk(10);
  ASSERT_EQ(run.error_of({{"do", "halt"}, {"robot", "ep2"}}), "");
  run.walk(10);
  run.hash_at(15);
  const Json touched = run.ask({{"do", "halt"}, {"robot", "ep3"}});
  EXPECT_EQ(touched["dropped"], 1) << hal::to_text(touched);
  EXPECT_EQ(run.live().state().latest, 15);
  EXPECT_THAT(run.error_of({{"do", "go_to"}, {"tick", 20}}), HasSubstr("between 0, the first, and 15, the latest"));
  run.walk(15);
  // Told: halt at 10, halt at 20, back to 15 with one action, halt at 15.
  ASSERT_EQ(run.events.size(), 4U);
  EXPECT_EQ(run.events[2].first, 15);
  EXPECT_EQ(run.events[2].second, (Json{{"kind", "back"},
                                        {"to", 15},
                                        {"before", {{{"step", 10}, {"action", {{"do", "halt"}, {"robot", "ep1"}}}}}}}));
  LiveOptions again = Held::paused();
  again.repeat = actions_of(run.events);
  Held straight(scene, again);
  straight.walk(30);
  EXPECT_EQ(straight.new_ticks.at(30), run.new_ticks.at(30));
}

TEST(Timeline, UndoesTheLastTouch) {
  Held run(crowd());
  run.walk(10);
  const std::uint64_t before = run.hash();
  ASSERT_EQ(run.error_of(move_to("ep1", 1.4, 1.4)), "");
  ASSERT_EQ(run.error_of(move_to("ep1", 1.4, 1.3)), "");  // the same drag
  EXPECT_NE(run.hash(), before);
  const Json undone = run.ask({{"do", "undo"}});
  EXPECT_EQ(undone["undone"]["y"], 1.3) << hal::to_text(undone);
  EXPECT_EQ(run.hash(), before);
  EXPECT_THAT(run.error_of({{"do", "undo"}}), HasSubstr("nothing to undo before tick 10"));
  run.walk(5);
  EXPECT_TRUE(run.events.empty());  // nobody was told of it yet

  ASSERT_EQ(run.error_of({{"do", "halt"}, {"robot", "*"}}), "");
  run.walk(5);
  EXPECT_EQ(run.ask({{"do", "undo"}})["tick"], 15);
  EXPECT_EQ(run.live().state().latest, 15);
  run.walk(5);
  ASSERT_EQ(run.events.size(), 2U);
  EXPECT_EQ(run.events[1].second, (Json{{"kind", "back"}, {"to", 15}, {"before", Json::array()}}));
  Held straight(crowd());
  straight.walk(20);
  EXPECT_EQ(run.new_ticks, straight.new_ticks);
}

TEST(Timeline, BringsBackWhatATouchOfThePastHadDropped) {
  const Scene scene = crowd();
  Held run(scene);
  run.walk(10);
  ASSERT_EQ(run.error_of({{"do", "halt"}, {"robot", "ep1"}}), "");
  run.walk(20);
  const auto straight = run.new_ticks;
  const auto told = run.events;

  // Nothing was told of the other way: the record still has the first one.
  run.hash_at(5);
  EXPECT_EQ(run.ask(move_to("ep2", 1.4, 1.4))["dropped_ticks"], 25);
  EXPECT_EQ(run.ask({{"do", "undo"}})["tick"], 5);
  EXPECT_EQ(run.live().state().latest, 30);
  EXPECT_EQ(run.hash_at(30), straight.at(30));
  run.walk(1);
  EXPECT_EQ(run.events, told);

  // The record has the other way: the first one is recorded again.
  run.hash_at(5);
  ASSERT_EQ(run.error_of(move_to("ep2", 1.4, 1.4)), "");
  run.walk(10);
  ASSERT_NE(run.hash(), straight.at(15));
  run.ask({{"do", "undo"}});
  EXPECT_EQ(run.live().state().latest, 31);
  ASSERT_EQ(run.error_of({{"do", "go_to"}, {"tick", 30}}), "");
  while (run.tick() < 30) std::this_thread::yield();
  run.walk(1);
  EXPECT_EQ(run.new_ticks.at(15), straight.at(15));
  LiveOptions again = Held::paused();
  again.repeat = actions_of(run.events);
  ASSERT_EQ(again.repeat.size(), 1U);
  Held repeated(scene, again);
  repeated.walk(31);
  EXPECT_EQ(repeated.hash(), run.hash());
}

TEST(Timeline, BeginsAnewWithAnotherSeed) {
  Held run(crowd());
  run.walk(10);
  EXPECT_EQ(run.ask({{"do", "reset"}, {"seed", 99}})["seed"], 99);
  EXPECT_EQ(run.tick(), 0);
  EXPECT_EQ(run.live().state().seed, 99U);
  run.new_ticks.clear();
  run.walk(10);
  WorldOptions other;
  other.seed = 99;
  Held straight(crowd(), Held::paused(), other);
  straight.walk(10);
  straight.new_ticks.erase(0);
  EXPECT_EQ(run.new_ticks, straight.new_ticks);
  EXPECT_EQ(run.hash_at(4), straight.new_ticks.at(4));
  EXPECT_THAT(run.error_of({{"do", "undo"}}), HasSubstr("nothing to undo"));
  EXPECT_THAT(run.error_of({{"do", "reset"}, {"seed", "x"}}), HasSubstr("\"seed\" is a whole number"));

  LiveOptions again = Held::paused();
  again.repeat = actions_of(run.events);
  Held repeated(crowd(), again);
  repeated.walk(10);
  EXPECT_EQ(repeated.ask({{"do", "step"}, {"ticks", 10}})["ok"], true);
  while (repeated.live().state().seed != 99 || repeated.live().state().tick < 10) std::this_thread::yield();
  EXPECT_EQ(repeated.hash(), straight.new_ticks.at(10));
}

TEST(Timeline, GoesBackWithHooksThatHaveCheckpointsOfTheirOwn) {
  Scene scene = crowd();
  with_hook(scene, "shepherd", {{"save_at", "10", 0}, {"back_at", "30", 0}});
  Held run(scene);
  run.walk(25);
  const auto straight = run.new_ticks;
  EXPECT_EQ(run.hash_at(5), straight.at(5));  // before the hook's moment is kept
  EXPECT_EQ(run.hash_at(25), straight.at(25));
  EXPECT_EQ(run.ask({{"do", "step"}, {"ticks", 30}})["ok"], true);  // in the sixth the hook goes back to 11
  while (run.live().state().first != 11 || run.live().state().tick < 35) std::this_thread::yield();
  const std::uint64_t there = run.hash();
  EXPECT_THAT(run.error_of({{"do", "go_to"}, {"tick", 10}}), HasSubstr("between 11, the first"));
  EXPECT_EQ(run.hash_at(11), straight.at(11));
  EXPECT_EQ(run.hash_at(35), there);
}

TEST(Timeline, AnyWayThroughARunIsRepeatedExactly) {
  const Scene scene = crowd("dynamics2d", "everything", 12);
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 chance(seed);
    const auto upto = [&](std::uint32_t n) { return static_cast<int>(chance() % n); };
    const auto place = [&] { return -1.8 + 0.1 * upto(37); };
    Held run(scene);
    int added = 0;
    for (int i = 0; i < 60; ++i) {
      const std::string robot = "ep" + std::to_string(upto(12));
      switch (upto(9)) {
        case 0:
        case 1:
          run.walk(1 + upto(12));
          break;
        case 2:
          run.ask({{"do", "go_to"}, {"tick", upto(static_cast<std::uint32_t>(run.live().state().latest) + 1)}});
          break;
        case 3:
          run.ask(move_to(robot, place(), place()));
          break;
        case 4:
          run.ask({{"do", upto(2) == 0 ? "halt" : "release"}, {"robot", robot}});
          break;
        case 5:
          run.ask({{"do", "add"},
                   {"object",
                    {{"shape", "cylinder"},
                     {"x", place()},
                     {"y", place()},
                     {"radius", 0.05},
                     {"height", 0.1},
                     {"movable", upto(2) == 0}}}});
          ++added;
          break;
        case 6:
          run.ask({{"do", "remove"},
                   {"object", "added" + std::to_string(1 + upto(static_cast<std::uint32_t>(added) + 1))}});
          break;
        case 7:
          if (upto(4) == 0) run.ask({{"do", "remove"}, {"robot", robot}});
          break;
        default:
          run.ask({{"do", "undo"}});
      }
    }
    run.walk(5);
    while (run.tick() < run.live().state().latest) run.walk(1);
    run.walk(1);  // one that is new: all is told
    const hal::Tick end = run.tick();
    LiveOptions again = Held::paused();
    again.repeat = actions_of(run.events);
    again.can_go_back = false;
    Held straight(scene, again);
    straight.walk(static_cast<int>(end));
    EXPECT_EQ(straight.hash(), run.hash()) << "seed " << seed << ", " << again.repeat.size() << " actions";
  }
}

TEST(Timeline, SaysWhenTicksComeOutDifferent) {
  // A hook that moves things by what it does not save: its count of going back.
  std::vector<std::string> messages;
  Scene scene = crowd();
  with_hook(scene, "forgetful");
  LiveOptions options = Held::paused();
  options.log = hal::Log([&](hal::Severity, std::string_view text) { messages.emplace_back(text); });
  Held run(scene, options);
  run.walk(50);
  run.hash_at(3);
  run.walk(47);
  run.end();
  ASSERT_FALSE(messages.empty());
  EXPECT_THAT(messages.back(), HasSubstr("came out different when it was computed again: a hook"));
}

/// Paused; what the timeline says is kept.
LiveOptions heard(std::vector<std::string>& messages) {
  LiveOptions options = Held::paused();
  options.log = hal::Log([&](hal::Severity, std::string_view text) { messages.emplace_back(text); });
  return options;
}

TEST_P(Timelines, ComputeTheRunAgainFromItsStartWhereControllersCannotBeCopied) {
  WorldOptions threads;
  threads.threads = std::get<1>(GetParam());
  std::vector<std::string> messages;
  Held run(crowd(std::get<0>(GetParam()), "owner", 20), heard(messages), threads);
  EXPECT_EQ(run.live().state().no_way_back, "");
  run.walk(10);
  ASSERT_EQ(run.error_of(move_to("ep3", 1.4, 1.4)), "");
  run.walk(20);
  const auto straight = run.new_ticks;
  for (const hal::Tick tick : {17, 5, 29, 0, 30}) EXPECT_EQ(run.hash_at(tick), straight.at(tick)) << tick;
  const Json x = run.ask({{"do", "history"}, {"robot", "ep3"}, {"role", "pose"}, {"field", "x"}, {"from", 9}});
  EXPECT_EQ(x["ticks"].size(), 22U) << hal::to_text(x);
  EXPECT_EQ(run.hash(), straight.at(30));
  EXPECT_EQ(run.ask({{"do", "undo"}})["tick"], 10);
  run.walk(20);
  EXPECT_NE(run.hash(), straight.at(30)) << "nothing moved the robot";
  run.end();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_THAT(messages[0], HasSubstr("computes the run again from tick 0: no snapshot: the controller 'owner' of rob"));
}

TEST(Timeline, GoesOnFromItsLastCheckpointsWhereControllersCanBeCopiedNoMore) {
  std::vector<std::string> messages;
  Held run(crowd("kinematics2d", "reluctant", 3), heard(messages));
  run.walk(30);
  const auto straight = run.new_ticks;
  for (const hal::Tick tick : {1, 20, 30, 3}) EXPECT_EQ(run.hash_at(tick), straight.at(tick)) << tick;
  run.end();
  ASSERT_FALSE(messages.empty());
  EXPECT_THAT(messages[0], HasSubstr("computes the run again from tick 2: no snapshot: copying the controller of"));
}

TEST(Timeline, NeedsNoMemoryToComputeARunAgain) {
  std::vector<std::string> messages;
  LiveOptions little = heard(messages);
  little.memory_bytes = 1000;
  Held run(crowd(), little);
  run.walk(20);
  const auto straight = run.new_ticks;
  EXPECT_EQ(run.hash_at(7), straight.at(7));
  run.end();
  EXPECT_THAT(messages.at(0), HasSubstr("more than the 1 MB that may be kept; allow more (--view-memory)"));
}

TEST(Timeline, ARunThatWasBegunAnewHasAWayBackUnlessAHookRemembersTheOneBefore) {
  for (const bool remembers : {false, true}) {
    Scene scene = crowd("kinematics2d", "shown", 3);
    with_hook(scene, "teacher", {{"keeps", remembers ? "true" : "false", 9}});
    LiveOptions little = Held::paused();
    little.memory_bytes = 1000;
    Held run(scene, little);
    run.walk(5);
    ASSERT_EQ(run.error_of({{"do", "reset"}}), "");
    run.new_ticks.clear();
    run.walk(5);
    if (!remembers) {
      EXPECT_EQ(run.hash_at(2), run.new_ticks.at(2));
      continue;
    }
    EXPECT_THAT(run.live().state().no_way_back, HasSubstr("more than the 1 MB that may be kept"));
    EXPECT_THAT(run.error_of({{"do", "go_to"}, {"tick", 2}}), HasSubstr("there is no way back: a checkpoint of this"));
    EXPECT_THAT(run.error_of({{"do", "undo"}}), HasSubstr("more than the 1 MB"));
    EXPECT_EQ(run.error_of({{"do", "halt"}, {"robot", "*"}}), "");
  }
}

/// Steps a world, and lets each tick seem to cost what the test says.
void step(World& world, Timeline& timeline, int ticks, hal::TimeNs cost_ns) {
  for (int i = 0; i < ticks; ++i) {
    ASSERT_TRUE(timeline.before_step().ok());
    world.step();
    timeline.after_step(cost_ns);
  }
}

TEST(Timeline, KeepsItsMemoryAndReachesEveryTick) {
  auto made = make(crowd());
  World& world = *made.world;
  FakedClock clock;
  LiveOptions options;
  world.start();
  options.memory_bytes = 10 * world.snapshot().value().bytes();
  Timeline timeline(world, clock, options);
  timeline.start();
  std::map<hal::Tick, std::uint64_t> hashes;
  for (int i = 0; i < 300; ++i) {
    hashes[world.tick()] = world.state_hash();
    step(world, timeline, 1, 1);  // checkpoints cost nothing by this clock: one a tick
    EXPECT_LE(timeline.bytes(), options.memory_bytes);
  }
  EXPECT_GE(timeline.checkpoints(), 5U);
  EXPECT_LE(timeline.checkpoints(), 10U);
  for (const hal::Tick tick : {0, 1, 77, 150, 299}) {
    EXPECT_LE(timeline.ticks_to(tick), 300 / 2);
    ASSERT_TRUE(timeline.go_to(tick).ok());
    EXPECT_EQ(world.state_hash(), hashes.at(tick)) << tick;
  }
}

/// A second passes whenever somebody looks.
class SlowClock final : public LiveClock {
 public:
  hal::TimeNs now_ns() noexcept override { return now_ns_ += hal::kNsPerSecond; }

 private:
  hal::TimeNs now_ns_ = 0;
};

TEST(Timeline, SaysHowFarALongWayIsAndLeavesItWhenAsked) {
  auto made = make(crowd("kinematics2d", "owner", 3));
  World& world = *made.world;
  SlowClock clock;
  std::vector<std::string> messages;
  world.start();
  Timeline timeline(world, clock, heard(messages));
  timeline.start();
  step(world, timeline, 20, 1);
  int asked = 0;
  timeline.on_way = [&] { return ++asked < 3; };
  EXPECT_THAT(timeline.go_to(15).error().message, HasSubstr("the way to tick 15 was left"));
  EXPECT_EQ(asked, 3);
  EXPECT_LT(world.tick(), 15);
  EXPECT_THAT(messages.back(), HasSubstr("computing again: tick " + std::to_string(world.tick()) + " of 15"));
  EXPECT_TRUE(timeline.known());
}

TEST(Timeline, LooksBackAndIsWhereItWas) {
  auto made = make(crowd());
  World& world = *made.world;
  FakedClock clock;
  world.start();
  Timeline timeline(world, clock, {});
  timeline.start();
  std::vector<double> x_m;
  const auto x = [&] { return world.space().pose(world.space().find_robot("ep7")).x_m; };
  for (int i = 0; i < 30; ++i) {
    x_m.push_back(x());
    step(world, timeline, 1, 1000);
  }
  ASSERT_TRUE(timeline.act({{"do", "halt"}, {"robot", "ep7"}}).ok());
  const std::uint64_t now = world.state_hash();
  std::vector<double> seen;
  ASSERT_TRUE(timeline.look_back(10, 29, [&](hal::Tick) { seen.push_back(x()); }).ok());
  EXPECT_EQ(seen, std::vector<double>(x_m.begin() + 10, x_m.end()));
  EXPECT_EQ(world.state_hash(), now);
  EXPECT_FALSE(timeline.look_back(10, 31, [](hal::Tick) {}).ok());
}

}  // namespace
}  // namespace tandem::core
