#include "study/sweep/run_once.hpp"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <optional>

#include "core/record/checkpoint_file.hpp"
#include "core/run/named_parts.hpp"
#include "core/sim/settings.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::study {
namespace {

double seconds_of(clockid_t clock) noexcept {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// As `tandem run` counts them; 0: until a hook ends the run.
std::int64_t steps_of(const core::Scenario& scenario) {
  if (!(scenario.length_s > 0.0)) return 0;
  const double ticks = scenario.length_s * static_cast<double>(scenario.ticks_per_second);
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(ticks + 0.5));
}

}  // namespace

/// What a sweep wants of its run: samples after each tick, and what is needed to go on from there.
class Runner::Measured final : public core::RunPart {
 public:
  Measured(Runner& runner, const RunPlan& plan, Sampler& sampler) : runner_(runner), plan_(plan), sampler_(sampler) {}
  std::string_view name() const override { return "sweep"; }
  core::RunTurn turn() const override { return core::RunTurn::Outputs; }
  bool before_tick(core::Run&) override {
    HangLimit::step();
    return true;
  }
  bool after_tick(core::Run& run) override {
    sampler_.tick_done(run.world());
    if (!runner_.checkpoints_.empty() && seconds_of(CLOCK_MONOTONIC) - runner_.kept_s_ > runner_.keep_every_s_)
      runner_.keep(plan_, sampler_);
    return true;
  }

 private:
  Runner& runner_;
  const RunPlan& plan_;
  Sampler& sampler_;
};

/// A world of the plan's configuration and seed, started.
hal::Status Runner::ready(const RunPlan& plan) {
  if (keeps_worlds_ && !takes_long_ && world_ != nullptr && configuration_ == plan.configuration)
    return world_->reset(plan.seed);
  return make(plan);
}

hal::Status Runner::make(const RunPlan& plan) {
  world_.reset();
  configuration_ = plan.configuration;
  auto scenario = scenario_of_(plan);
  if (!scenario.ok()) return scenario.error();
  core::WorldOptions options;
  options.seed = plan.seed;
  options.threads = 0;  // the other cores have runs of their own
  core::Problems problems;
  world_ = core::World::make(*scenario, loader_, options, problems);
  if (world_ == nullptr) return hal::Error{core::errors_of(problems)};
  world_->start();
  if (!checkpoints_.empty()) world_->begin_saving();
  return {};
}

/// The run from where it was kept. Error: it was not, or cannot go on; its world is to be made anew.
hal::Status Runner::go_on(const RunPlan& plan, Sampler& sampler) {
  const std::string path = checkpoint_of(checkpoints_, plan.number);
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return {};
  auto kept = core::read_checkpoint(path);
  if (!kept.ok()) return kept.error();
  if (hal::count_of(kept->about, "seed") != plan.seed || hal::whole_of(kept->about, "run", -1) != plan.number)
    return hal::Error{"another run"};
  if (const hal::Status made = make(plan); !made.ok()) return made;
  std::string state;
  hal::Archive archive(kept->state);
  archive(sampler, state);
  if (!archive.at_end()) return hal::Error{"not whole"};
  if (const hal::Status loaded = world_->load(state); !loaded.ok()) return loaded;
  return world_->state_hash() == kept->fingerprint ? hal::Status{} : hal::Status{hal::Error{"another state"}};
}

/// Its state, for whoever makes it again. One that cannot be kept begins anew then.
void Runner::keep(const RunPlan& plan, Sampler& sampler) {
  kept_s_ = seconds_of(CLOCK_MONOTONIC);
  takes_long_ = true;
  auto state = world_->save();
  if (!state.ok() || world_->state() != core::RunState::Running) return;
  hal::Archive archive;
  archive(sampler, state.value());
  const hal::Json about{{"run", plan.number}, {"seed", plan.seed}};
  std::error_code there;
  std::filesystem::create_directories(checkpoints_, there);
  (void)core::write_checkpoint(checkpoint_of(checkpoints_, plan.number),
                               {about, world_->tick(), world_->state_hash(), false, archive.take(), {}});
}

std::string checkpoint_of(const std::string& folder, std::int64_t run) {
  return folder + "/run-" + std::to_string(run) + ".ckpt";
}

RunOutcome Runner::run(const RunPlan& plan) {
  const double wall_s = seconds_of(CLOCK_MONOTONIC);
  const double cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  RunOutcome outcome;
  outcome.ended = "failed";
  const auto failed = [&](const hal::Status& why) {
    outcome.failure = why.error().message;
    world_.reset();
    return outcome;
  };
  if (const hal::Status made = ready(plan); !made.ok()) return failed(made);
  std::optional<Sampler> sampler(std::in_place, measuring_, world_->ticks_per_second());
  if (!checkpoints_.empty() && !go_on(plan, *sampler).ok()) {
    sampler.emplace(measuring_, world_->ticks_per_second());
    if (const hal::Status made = make(plan); !made.ok()) return failed(made);
  }
  core::World& world = *world_;
  const HangLimit::Watched watched(hang_);
  kept_s_ = wall_s;
  takes_long_ = false;
  core::Run run(world, never_);
  run.add(std::make_unique<core::Length>(steps_of(world.scenario())));
  run.add(std::make_unique<Measured>(*this, plan, *sampler));
  core::Problems problems;
  core::add_named_parts(run, loader_.catalog(), problems);
  if (core::has_errors(problems)) return failed(hal::Error{core::errors_of(problems)});
  if (!run.join()) return failed(hal::Error{run.failure()});
  while (run.tick()) {
  }
  run.end();
  if (!checkpoints_.empty()) {
    std::error_code none;
    std::filesystem::remove(checkpoint_of(checkpoints_, plan.number), none);
  }
  outcome.ticks = world.tick();
  outcome.virtual_s = static_cast<double>(world.tick()) / static_cast<double>(world.ticks_per_second());
  outcome.fingerprint = world.state_hash();
  outcome.measures = measure(world, measuring_);
  sampler->take(outcome);
  if (world.state() == core::RunState::Failed) {
    outcome.failure = world.failure();
    world_.reset();
  } else {
    const bool by_part = run.ended_by() != nullptr && run.ended_by()->turn() == core::RunTurn::Added;
    outcome.ended = world.state() == core::RunState::Done ? "hook" : by_part ? "part" : "length";
    const core::Incidents& incidents = world.incidents();
    outcome.failure = run.failure();
    if (incidents.controllers_thrown > 0)
      outcome.failure = incidents.causes.empty() ? "a controller threw" : incidents.causes.front().text();
    outcome.done = outcome.failure.empty();
    if (!outcome.done) outcome.ended = "failed";
  }
  outcome.wall_s = seconds_of(CLOCK_MONOTONIC) - wall_s;
  outcome.cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_s;
  return outcome;
}

}  // namespace tandem::study
