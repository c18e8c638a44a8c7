#include "study/sweep/run_once.hpp"

#include <algorithm>
#include <ctime>

namespace tandem::study {
namespace {

double seconds_of(clockid_t clock) noexcept {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string text_of(const core::Problems& problems) {
  std::string text;
  for (const core::Problem& problem : problems) {
    if (!problem.warning) text += (text.empty() ? "" : "; ") + core::to_text(problem);
  }
  return text;
}

/// As `tandem run` counts them; 0: until a hook ends the run.
std::int64_t steps_of(const core::Scenario& scenario) {
  if (!(scenario.length_s > 0.0)) return 0;
  const double ticks = scenario.length_s * static_cast<double>(scenario.ticks_per_second);
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(ticks + 0.5));
}

}  // namespace

/// A world of the plan's configuration and seed, started.
hal::Status Runner::ready(const RunPlan& plan) {
  if (keeps_worlds_ && world_ != nullptr && configuration_ == plan.configuration) return world_->reset(plan.seed);
  world_.reset();
  configuration_ = plan.configuration;
  auto scenario = scenario_of_(plan);
  if (!scenario.ok()) return scenario.error();
  core::WorldOptions options;
  options.seed = plan.seed;
  options.threads = 0;  // the other cores have runs of their own
  core::Problems problems;
  world_ = core::World::make(*scenario, loader_, options, problems);
  if (world_ == nullptr) return hal::Error{text_of(problems)};
  world_->start();
  return {};
}

RunOutcome Runner::run(const RunPlan& plan) {
  const double wall_s = seconds_of(CLOCK_MONOTONIC);
  const double cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  RunOutcome outcome;
  outcome.ended = "failed";
  if (const hal::Status made = ready(plan); !made.ok()) {
    outcome.failure = made.error().message;
    world_.reset();
    return outcome;
  }
  core::World& world = *world_;
  const HangLimit::Watched watched(hang_);
  const std::int64_t steps = steps_of(world.scenario());
  Sampler sampler(measuring_, world.ticks_per_second());
  while (world.state() == core::RunState::Running && (steps == 0 || world.tick() < steps)) {
    HangLimit::step();
    world.step();
    sampler.tick_done(world);
  }
  world.finish();
  outcome.ticks = world.tick();
  outcome.virtual_s = static_cast<double>(world.tick()) / static_cast<double>(world.ticks_per_second());
  outcome.fingerprint = world.state_hash();
  outcome.measures = measure(world, measuring_);
  sampler.take(outcome);
  if (world.state() == core::RunState::Failed) {
    outcome.failure = world.failure();
    world_.reset();
  } else {
    outcome.ended = world.state() == core::RunState::Done ? "hook" : "length";
    const core::Incidents& incidents = world.incidents();
    if (incidents.controllers_thrown > 0)
      outcome.failure = incidents.first.empty() ? "a controller threw" : incidents.first.front();
    outcome.done = outcome.failure.empty();
    if (!outcome.done) outcome.ended = "failed";
  }
  outcome.wall_s = seconds_of(CLOCK_MONOTONIC) - wall_s;
  outcome.cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_s;
  return outcome;
}

}  // namespace tandem::study
