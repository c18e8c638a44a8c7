// What the module `live` adds to a run: people who hold it, the table on the terminal, actions that are done again.
#include "app/live/live_parts.hpp"
#include "app/live/register.hpp"
#include "app/live/watch.hpp"
#include "app/process/terminal.hpp"
#include "app/run/run_module.hpp"

namespace tandem::app {
namespace {

int begin(RunPlan& plan) {
  return read_repeated(plan);
}

int prepare(RunPlan& plan) {
  run_recorded_scripts(plan);
  return told(Watch::check(plan.options.watch, plan.world->space()));
}

int add(RunPlan& plan, core::Run& run) {
  hold(plan, run);
  if (plan.options.watch.watch) watch(plan, run);
  if (!plan.replays() && plan.repeated != nullptr) compare_repeated(plan, run);
  return kDone;
}

constexpr RunModule kLive = {"live", nullptr, &begin, &prepare, &add};

}  // namespace

void register_live(hal::Registrar& registrar) {
  registrar.add(kLive);
}

}  // namespace tandem::app
