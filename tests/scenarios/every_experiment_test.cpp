// Promises that hold for every experiment of configs/, and so for every shipped controller, hook and engine.
#include <filesystem>
#include <gtest/gtest.h>
#include <set>

#include "app/catalog.hpp"
#include "core/config/reader.hpp"
#include "core/live/timeline.hpp"
#include "tests/controllers/experiment.hpp"

namespace tandem::test {
namespace {

namespace fs = std::filesystem;

/// Enough for robots to meet; fewer where there are many of them.
int ticks_for(const core::World& world) {
  return static_cast<int>(std::clamp<std::size_t>(20000 / (world.space().robot_count() + 1), 20, 200));
}

/// Ports that runs of this test side by side do not share.
std::vector<std::string> on_own_ports(const std::string& experiment) {
  if (experiment != "footbot_manual.xml") return {};
  const int port = 20000 + 2 * (getpid() % 10000);
  return {"controllers.footbot_manual[hand].params.port=" + std::to_string(port),
          "arena.foot-bot[fb1].controller.params.port=" + std::to_string(port + 1)};
}

std::uint64_t hash_after(core::World& world, int ticks) {
  for (int i = 0; i < ticks; ++i) world.step();
  EXPECT_NE(world.state(), core::RunState::Failed) << world.failure();
  return world.state_hash();
}

class EveryExperiment : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Of, EveryExperiment, testing::ValuesIn(experiments()),
                         [](const auto& name) { return fs::path(name.param).stem().string(); });

TEST_P(EveryExperiment, GivesTheSameBitsFromItsSavedSettings) {
  fs::current_path(kSourceDir);
  std::string saved;
  std::uint64_t hash = 0;
  int ticks = 0;
  {
    const Experiment first(GetParam(), on_own_ports(GetParam()), {}, "", app::catalog());
    saved = core::effective_settings(first->scenario());
    ticks = ticks_for(*first.world);
    first->start();
    hash = hash_after(*first.world, ticks);
  }
  core::Problems problems;
  const auto scenario = core::read_experiment_text(saved, "saved.xml", {}, app::catalog(), problems);
  for (const core::Problem& p : problems) EXPECT_TRUE(p.warning) << core::to_text(p);
  ASSERT_TRUE(scenario);
  hal::PluginLoader loader({std::string(kBuildDir) + "/lib"}, app::catalog());
  const auto second = core::World::make(*scenario, loader, {}, problems);
  ASSERT_TRUE(second) << core::to_text(problems.back());
  EXPECT_EQ(core::effective_settings(second->scenario()), saved);
  second->start();
  EXPECT_EQ(hash_after(*second, ticks), hash);
}

TEST_P(EveryExperiment, GivesTheSameBitsWhenItBeginsAnew) {
  fs::current_path(kSourceDir);
  const Experiment experiment(GetParam(), on_own_ports(GetParam()), {}, "", app::catalog());
  const int ticks = ticks_for(*experiment.world);
  experiment->start();
  const std::uint64_t hash = hash_after(*experiment.world, ticks);
  const std::uint64_t seed = experiment->seed();
  const hal::Status other = experiment->reset(seed + 1);
  ASSERT_TRUE(other.ok()) << other.error().message;
  (void)hash_after(*experiment.world, ticks);
  const hal::Status again = experiment->reset(seed);
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(hash_after(*experiment.world, ticks), hash);
}

TEST_P(EveryExperiment, GivesEveryTickTheSameBitsAgain) {
  fs::current_path(kSourceDir);
  const Experiment experiment(GetParam(), on_own_ports(GetParam()), {}, "", app::catalog());
  core::World& world = *experiment.world;
  const int ticks = ticks_for(world);
  world.start();
  core::LiveClock clock;
  core::Timeline timeline(world, clock, {});
  timeline.start();
  if (!timeline.no_way_back().empty()) GTEST_SKIP() << timeline.no_way_back();
  std::vector<std::uint64_t> hashes{world.state_hash()};
  for (int i = 0; i < ticks; ++i) {
    if (i == ticks / 3) {  // somebody touches it on the way
      const std::string first = world.space().robot_name(world.space().robot(0));
      EXPECT_TRUE(timeline.act({{"do", "halt"}, {"robot", first}}).ok());
      hashes.back() = world.state_hash();
    }
    ASSERT_TRUE(timeline.before_step().ok());
    world.step();
    timeline.after_step(1000);
    hashes.push_back(world.state_hash());
  }
  for (const int tick : {ticks / 2, 1, ticks / 3, ticks, 0, ticks - 1}) {
    const hal::Status there = timeline.go_to(tick);
    ASSERT_TRUE(there.ok()) << there.error().message;
    EXPECT_EQ(world.state_hash(), hashes[static_cast<std::size_t>(tick)]) << tick;
  }
}

TEST_P(EveryExperiment, GoesOnAlikeFromACheckpoint) {
  fs::current_path(kSourceDir);
  const Experiment experiment(GetParam(), on_own_ports(GetParam()), {}, "", app::catalog());
  experiment->start();
  const int ticks = ticks_for(*experiment.world) / 2;
  (void)hash_after(*experiment.world, ticks);
  const auto kept = experiment->snapshot();
  ASSERT_TRUE(kept.ok()) << kept.error().message;
  const std::uint64_t hash = hash_after(*experiment.world, ticks);
  const hal::Status back = experiment->restore(kept.value());
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(hash_after(*experiment.world, ticks), hash);
}

TEST(Experiments, UseEveryShippedControllerAndHook) {
  std::set<std::string> used;
  for (const std::string& name : experiments()) {
    core::Problems problems;
    const auto scenario =
        core::read_experiment(std::string(kSourceDir) + "/configs/" + name, {}, app::catalog(), problems);
    ASSERT_TRUE(scenario) << name;
    for (const auto& controller : scenario->controllers) used.insert(fs::path(controller.library).stem().string());
    for (const auto& hook : scenario->hooks) used.insert(fs::path(hook.library).stem().string());
  }
  for (const char* folder : {"controllers", "hooks"}) {
    for (const auto& entry : fs::directory_iterator(std::string(kSourceDir) + "/" + folder)) {
      const std::string name = entry.path().filename().string();
      if (name == "puppet" || !fs::exists(entry.path() / "plugin.cpp")) continue;  // puppets: driven from outside
      EXPECT_TRUE(used.contains("lib" + name) || used.contains(name)) << folder << "/" << name;
    }
  }
}

TEST(SavedSettings, ShowTheDefaultsOfEveryPart) {
  const Experiment experiment("epuck_push.xml");
  const std::string text = core::effective_settings(experiment->scenario());
  for (const char* shown : {"<proximity implementation=\"default\" show_rays=", "velocity_iterations=\"8\"",
                            "<params alpha=", "<battery model=\"time\"", "random_seed="})
    EXPECT_NE(text.find(shown), std::string::npos) << shown << " in\n" << text;
}

}  // namespace
}  // namespace tandem::test
