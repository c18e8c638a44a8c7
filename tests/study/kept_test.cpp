// Runs that take long are kept on the way: one whose process is killed goes on in another.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/record/checkpoint_file.hpp"
#include "study/sweep/run_once.hpp"
#include "tests/core/scenes.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::study {
namespace {

using scenarios::eventually;
using scenarios::Folder;

/// Runs of robots that push one another, of so many ticks.
struct Runs {
  explicit Runs(std::int64_t ticks) {
    core::Scene s(2.0, "everything");
    s.engine("dynamics2d")
        .param("left", "0.06")
        .param("right", "0.05")
        .implementations("noisy")
        .walls()
        .robots(20, 0.4);
    scenario = s.scenario;
    scenario.length_s = static_cast<double>(ticks) / static_cast<double>(scenario.ticks_per_second);
  }
  RunOutcome run(const std::string& folder) {
    Runner runner(scenario_of, *loader, measuring, true, 0.0, folder, 0.0);  // kept after every tick
    return runner.run(plan);
  }

  core::Scenario scenario;
  std::unique_ptr<hal::PluginLoader> loader = std::make_unique<hal::PluginLoader>(
      std::vector<std::filesystem::path>{std::string(test::kBuildDir) + "/lib"}, test::catalog());
  ScenarioOf scenario_of = [this](const RunPlan&) -> hal::Result<core::Scenario> { return scenario; };
  Measuring measuring{{"*"}, {}, 0.5};
  RunPlan plan{.number = 3, .seed = 11};
};

TEST(Kept, ARunWhoseProcessIsKilledGoesOnInAnother) {
  const Folder folder;
  const std::string kept = checkpoint_of(folder.path().string(), 3);
  const pid_t child = fork();
  if (child == 0) {
    (void)Runs(1'000'000).run(folder.path().string());
    _exit(0);
  }
  const auto tick_of = [&] {
    const auto checkpoint = core::read_checkpoint(kept);
    return checkpoint.ok() ? checkpoint.value().tick : 0;
  };
  ASSERT_TRUE(eventually([&] { return tick_of() > 40; }, 60));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const hal::Tick killed_at = tick_of();
  ASSERT_GT(killed_at, 40);

  const RunOutcome whole = Runs(killed_at + 20).run({});
  const RunOutcome gone_on = Runs(killed_at + 20).run(folder.path().string());
  EXPECT_TRUE(gone_on.done) << gone_on.failure;
  EXPECT_EQ(gone_on.fingerprint, whole.fingerprint);
  EXPECT_EQ(gone_on.ticks, whole.ticks);
  EXPECT_EQ(gone_on.measures, whole.measures);
  EXPECT_EQ(gone_on.sample_ticks, whole.sample_ticks);
  EXPECT_FALSE(scenarios::fs::exists(kept));
}

TEST(Kept, WhatIsNotOfThisRunIsLeftAlone) {
  const Folder folder;
  const RunOutcome whole = Runs(20).run({});
  scenarios::fs::path file = checkpoint_of(folder.path().string(), 3);
  std::ofstream(file) << "nothing";
  EXPECT_EQ(Runs(20).run(folder.path().string()).fingerprint, whole.fingerprint);
  ASSERT_TRUE(core::write_checkpoint(file, {{{"run", 3}, {"seed", 11}}, 5, 7, false, "no state", {}}).ok());
  EXPECT_EQ(Runs(20).run(folder.path().string()).fingerprint, whole.fingerprint);
}

}  // namespace
}  // namespace tandem::study
