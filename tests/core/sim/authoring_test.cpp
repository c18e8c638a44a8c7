// What authors of controllers and hooks get beside devices: messages, published state, drawings, measures, a new start.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/sim/engine_factory.hpp"
#include "core/space/stores.hpp"
#include "tests/core/scenes.hpp"
#include "tests/plugins/shown.hpp"

namespace tandem::core {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

Scene shown(const std::vector<Element::Attribute>& params = {}) {
  Scene s(4.0, "shown");
  s.scenario.controllers.back().params.attributes = params;
  return s;
}

std::vector<std::uint64_t> hashes(World& world, int steps) {
  std::vector<std::uint64_t> all;
  for (int i = 0; i < steps; ++i) {
    world.step();
    all.push_back(world.state_hash());
  }
  return all;
}

std::string text_of(const hal::Result<std::string>& result) {
  return result.ok() ? result.value() : "error: " + result.error().message;
}

// --- messages ---

TEST(Messages, NameRobotAndTickAndComeInOneOrderForAnyThreads) {
  const auto messages_with = [](std::int64_t threads) {
    auto messages = std::make_shared<std::vector<std::string>>();
    WorldOptions options;
    options.threads = threads;
    options.log = hal::Log([messages](hal::Severity, std::string_view text) { messages->emplace_back(text); });
    auto world = make(shown({{"talks", "true", 0}}).robots(700, 1.8), options);  // three blocks
    EXPECT_TRUE(world.world) << world.all_problems();
    run(*world.world, 3);
    return *messages;
  };
  const auto alone = messages_with(0);
  ASSERT_THAT(alone, SizeIs(700 * 4));
  EXPECT_THAT(alone.front(), AllOf(StartsWith("robot 'ep"), testing::EndsWith("' at tick 0: made")));
  EXPECT_THAT(alone.back(), AllOf(StartsWith("robot 'ep"), testing::EndsWith("' at tick 2: step 3")));
  EXPECT_EQ(messages_with(3), alone);
}

TEST(Messages, ThatAreTooManyAreCounted) {
  std::vector<std::string> messages;
  WorldOptions options;
  options.log = hal::Log([&messages](hal::Severity severity, std::string_view text) {
    messages.emplace_back(text);
    EXPECT_EQ(severity, messages.size() == 1 ? hal::Severity::Info : hal::Severity::Warning);
  });
  auto world = make(shown({{"talks", "true", 0}}).robot("a", 0, 0), options);
  run(*world.world, 200);  // 20 s
  EXPECT_GE(messages.size(), 20U);
  EXPECT_LE(messages.size(), 20U + hal::RobotLog::kBurst);
  EXPECT_THAT(messages, Contains("robot 'a' at tick 190: step 191 (9 messages before it were left out)"));
}

// --- published state ---

TEST(Published, IsReadBetweenStepsAndGoesBackWithTheRun) {
  auto world = make(shown().robot("a", 0, 0).robot("b", 1, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  Space& space = world->space();
  const RobotId a = space.find_robot("a");
  EXPECT_EQ(text_of(space.published_text(a, "mode")), "rest");
  world->start();
  for (int i = 0; i < 3; ++i) world->step();
  EXPECT_EQ(text_of(space.published_text(a, "mode")), "drive");
  EXPECT_EQ(space.published_value(a, "steps").value(), 3.0);
  EXPECT_NE(space.published_value(a, "drawn").value(), space.published_value(space.find_robot("b"), "drawn").value());
  EXPECT_THAT(text_of(space.published_text(a, "drawn")), testing::EndsWith(" m/s"));
  const auto snapshot = world->snapshot();
  ASSERT_TRUE(snapshot.ok()) << snapshot.error().message;
  const double drawn = space.published_value(a, "drawn").value();
  for (int i = 0; i < 5; ++i) world->step();
  EXPECT_EQ(space.published_value(a, "steps").value(), 8.0);
  const double later = space.published_value(a, "drawn").value();
  ASSERT_TRUE(world->restore(snapshot.value()).ok());
  EXPECT_EQ(space.published_value(a, "steps").value(), 3.0);
  EXPECT_EQ(space.published_value(a, "drawn").value(), drawn);
  for (int i = 0; i < 5; ++i) world->step();
  EXPECT_EQ(space.published_value(a, "drawn").value(), later) << "chance goes back, too";
}

TEST(Published, WhatIsNotThereIsAnErrorThatSaysWhatIs) {
  auto world = make(shown().robot("a", 0, 0));
  Space& space = world->space();
  const RobotId a = space.find_robot("a");
  EXPECT_THAT(text_of(space.published_text(a, "mood")),
              HasSubstr("robot 'a' publishes no 'mood'; it publishes: mode, steps, drawn"));
  space.remove_robot(a);
  EXPECT_THAT(text_of(space.published_text(a, "mode")), HasSubstr("no such robot"));
  EXPECT_TRUE(space.published(a).empty());
}

TEST(Published, MustLieInTheControllerUnderANameOfItsOwn) {
  EXPECT_THAT(make(shown({{"wrong", "elsewhere", 0}}).robot("a", 0, 0)).all_problems(),
              HasSubstr("of robot 'a' publishes 'far', which does not lie in the controller itself"));
  EXPECT_THAT(make(shown({{"wrong", "twice", 0}}).robot("a", 0, 0)).all_problems(),
              HasSubstr("publishes two members under the name 'steps'"));
}

TEST(Published, NothingStaysOfARobotThatCouldNotBeAdded) {
  auto world = make(shown().robot("a", 0, 0));
  Space& space = world->space();
  const std::size_t before = space.published(space.find_robot("a")).size();
  const auto added =
      space.add_robot({.id = "b", .controller = "c", .pose = Pose::at(1, 0, 0), .params = {{"wrong", "elsewhere"}}});
  ASSERT_FALSE(added.ok());
  EXPECT_THAT(added.error().message, HasSubstr("does not lie in the controller itself"));
  EXPECT_EQ(space.published(space.find_robot("a")).size(), before);
}

TEST(Published, CountsInTheFingerprint) {
  auto world = make(shown().robot("a", 0, 0));
  world->start();
  world->step();
  const std::uint64_t hash = world->state_hash();
  Space& space = world->space();
  const RobotId a = space.find_robot("a");
  for (const hal::PublishedField& field : space.published(a)) {
    std::byte* const at = space.stores().controller_of(a) + field.offset;
    *at ^= std::byte{1};
    EXPECT_NE(world->state_hash(), hash) << field.name;
    *at ^= std::byte{1};
  }
  EXPECT_EQ(world->state_hash(), hash);
}

// --- parameters of robots that come and go ---

TEST(Params, OfARobotThatIsRemovedAreFreed) {
  auto world = make(shown().robot("a", 0, 0));
  Space& space = world->space();
  const auto kept = [&space] {
    int count = 0;
    for (const RobotBlock& block : space.stores().blocks) {
      for (const auto& params : block.params) count += params != nullptr ? 1 : 0;
    }
    return count;
  };
  for (int i = 0; i < 50; ++i) {
    const auto added = space.add_robot(
        {.id = "b" + std::to_string(i), .controller = "c", .pose = Pose::at(1, 0, 0), .params = {{"talks", "true"}}});
    ASSERT_TRUE(added.ok()) << added.error().message;
    EXPECT_EQ(kept(), 1);
    space.remove_robot(added.value());
    EXPECT_EQ(kept(), 0);
  }
  EXPECT_LE(space.stores().groups.size(), 2U);
}

// --- controllers by their class, drawings, measures ---

TEST(Hooks, ReachControllersByTheirClass) {
  Scene scene = shown();
  auto world = make(with_hook(scene.robot("a", 0, 0), "teacher", {{"pace", "0", 0}}));
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  world->step();
  Space& space = world->space();
  const RobotId a = space.find_robot("a");
  EXPECT_GT(space.published_value(a, "drawn").value(), 0.0);
  world->step();
  EXPECT_EQ(space.published_value(a, "drawn").value(), 0.0) << "the hook told the controller to stand";
}

TEST(Hooks, AreToldOfControllersOfAnotherClassOrSize) {
  auto world = make(Scene(4.0, "drive").robot("a", 0, 0));
  Space& space = world->space();
  const RobotId a = space.find_robot("a");
  EXPECT_EQ(space.controller(a, hal::detail::class_name<test::Shown>(), sizeof(test::Shown)), nullptr);
  auto other = make(shown().robot("a", 0, 0));
  try {
    other->space().controller(a, hal::detail::class_name<test::Shown>(), sizeof(test::Shown) + 8);
    FAIL() << "another size";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("tandem::test::Shown"), HasSubstr("rebuild both")));
  }
  other->space().remove_robot(a);
  EXPECT_EQ(other->space().controller(a, hal::detail::class_name<test::Shown>(), sizeof(test::Shown)), nullptr);
}

TEST(Hooks, DrawForOneStepAndMeasureForTheRun) {
  Scene scene = shown();
  auto world = make(with_hook(scene.robot("a", 0, 0).robot("b", 1, 0), "teacher", {}));
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  for (int i = 0; i < 5; ++i) {
    world->step();
    EXPECT_THAT(world->space().sketch().shapes(), SizeIs(4));
  }
  EXPECT_EQ(world->measures().get("steps"), 5.0);
  EXPECT_EQ(world->measures().get("tick"), 4.0);
  EXPECT_EQ(world->measures().get("nothing"), 0.0);
  const auto snapshot = world->snapshot();
  ASSERT_TRUE(snapshot.ok()) << snapshot.error().message;
  world->step();
  ASSERT_TRUE(world->restore(snapshot.value()).ok());
  EXPECT_EQ(world->measures().get("steps"), 5.0);
}

TEST(Hooks, SeveralPaintOneFloorEachOverThoseBefore) {
  Scene scene = shown();
  scene.robot("a", 1.5, 1.5).field("floor", {{"source", "loop_functions", 5}});
  with_hook(scene, "painter", {{"radius", "0.5", 0}, {"shade", "0", 0}});
  with_hook(scene, "painter", {{"x", "0.4", 0}, {"radius", "0.5", 0}, {"shade", "1", 0}});
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  world->step();
  EXPECT_EQ(world->space().floor(-0.3, 0), 0.0);
  EXPECT_EQ(world->space().floor(0.2, 0), 1.0);
  EXPECT_NEAR(world->space().floor(-1.5, 0), 0.5, 0.01) << "what none paints is grey";
}

// --- a new start ---

class Reset : public testing::TestWithParam<std::string> {
 protected:
  Scene scene(std::uint64_t seed, const std::string& learns) const {
    Scene s = shown({{"learns", learns, 0}});
    s.engine(GetParam()).implementations("noisy").walls().robots(300, 1.7).cylinder(0.3, 0.3, 0.1);
    if (test::engine_traits(GetParam()).forces) s.movable(0.3);
    s.scenario.escape = EscapePolicy::Stop;
    s.scenario.seed = seed;
    return s;
  }
};
INSTANTIATE_TEST_SUITE_P(Engines, Reset, testing::ValuesIn(test::engine_kinds()),
                         [](const auto& kind) { return kind.param; });

TEST_P(Reset, GoesOnAsANewWorldOfThatSeed) {
  for (const std::string learns : {"false", "true"}) {
    auto fresh = make(scene(9, learns));
    ASSERT_TRUE(fresh.world) << fresh.all_problems();
    fresh->start();
    const auto expected = hashes(*fresh.world, 30);

    auto world = make(scene(7, learns));
    ASSERT_TRUE(world.world) << world.all_problems();
    world->start();
    const auto first = hashes(*world.world, 30);
    EXPECT_NE(first, expected);
    // Whatever hooks did meanwhile.
    Space& space = world->space();
    for (int i = 0; i < 20; ++i) space.remove_robot(space.robot(10));
    for (int i = 0; i < 40; ++i)
      (void)space.add_robot(
          {.id = "new" + std::to_string(i), .controller = "c", .pose = Pose::at(-1.7 + 0.08 * i, 1.8, 0)});
    (void)space.add_light({"lamp", 0, 0, 0.3, 2.0});
    (void)hashes(*world.world, 5);

    for (int i = 0; i < 2; ++i) {
      const hal::Status again = world->reset(9);
      ASSERT_TRUE(again.ok()) << again.error().message;
      EXPECT_EQ(world->tick(), 0);
      EXPECT_EQ(world->seed(), 9U);
      EXPECT_EQ(space.robot_count(), 300U);
      EXPECT_EQ(hashes(*world.world, 30), expected);
    }
    ASSERT_TRUE(world->reset(7).ok());
    EXPECT_EQ(hashes(*world.world, 30), first);
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    auto* one = static_cast<test::Shown*>(
        space.controller(space.robot(0), hal::detail::class_name<test::Shown>(), sizeof(test::Shown)));
    ASSERT_NE(one, nullptr);
    EXPECT_EQ(one->runs > 1, learns == "true") << "controllers that can be reset stay";
  }
}

TEST(ANewStart, IsWhatAHookMayAskFor) {
  for (const std::string keeps : {"true", "false"}) {
    Scene scene = shown();
    auto world = make(
        with_hook(scene.robots(5, 1.5), "teacher", {{"reset_at", "9", 0}, {"resets", "2", 0}, {"keeps", keeps, 0}}));
    ASSERT_TRUE(world.world) << world.all_problems();
    world->start();
    for (int i = 0; i < 100; ++i) world->step();
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    if (keeps == "true") {
      EXPECT_EQ(world->seed(), 9U);
      EXPECT_EQ(world->tick(), 80) << "two runs of ten ticks went before";
      EXPECT_EQ(world->measures().get("steps"), 80.0);
    } else {
      EXPECT_EQ(world->seed(), 17U) << "a hook that is made anew knows of no reset";
    }
  }
}

TEST(ANewStart, IsNotToBeHadBeforeTheFirst) {
  Scene scene = shown();
  auto world = make(with_hook(scene.robot("a", 0, 0), "teacher", {{"at_once", "true", 0}}));
  world->start();
  EXPECT_EQ(world->state(), RunState::Failed);
  EXPECT_THAT(world->failure(), HasSubstr("before_run"));
}

TEST(ANewStart, VoidsSnapshots) {
  auto world = make(shown().robot("a", 0, 0));
  world->start();
  const auto snapshot = world->snapshot();
  ASSERT_TRUE(snapshot.ok());
  ASSERT_TRUE(world->reset(3).ok());
  EXPECT_FALSE(world->restore(snapshot.value()).ok());
}

TEST(ANewStart, WithoutPlacesForAllEndsTheRun) {
  Scene scene = shown();
  scene.robots(2, 0.06).scenario.robots.back().distribute->max_trials = 1;  // some seeds put them into one place
  std::uint64_t good = 0, bad = 0;
  for (std::uint64_t seed = 1; seed < 60 && (good == 0 || bad == 0); ++seed) {
    WorldOptions options;
    options.seed = seed;
    (make(scene, options).world != nullptr ? good : bad) = seed;
  }
  ASSERT_TRUE(good != 0 && bad != 0);
  WorldOptions options;
  options.seed = good;
  auto world = make(scene, options);
  world->start();
  EXPECT_FALSE(world->reset(bad).ok());
  EXPECT_EQ(world->state(), RunState::Failed);
  EXPECT_THAT(world->failure(), HasSubstr("reset with seed"));
  ASSERT_TRUE(world->reset(good).ok()) << world->failure();
  EXPECT_EQ(world->space().robot_count(), 2U);
}

}  // namespace
}  // namespace tandem::core
