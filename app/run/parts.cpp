#include "app/run/parts.hpp"

#include "app/experiment/reading.hpp"
#include "app/run/time_parts.hpp"
#include "core/run/named_parts.hpp"

namespace tandem::app {
bool is_held(const RunOptions& options) noexcept {
  return options.hold.wanted || options.view.on || options.watch.watch || !options.repeat.empty();
}

int add_real_robots(RunPlan& plan, core::Run& run) {
  return plan.side != nullptr ? plan.side->add_robots(run) : kDone;
}

int add_desk(RunPlan& plan, core::Run& run) {
  return plan.side != nullptr ? plan.side->add_parts(run) : kDone;
}

int add_views(RunPlan& plan, core::Run& run) {
  for (const char* name : {"pictures", "window"}) {
    const RunModule* const module = module_of(plan, name);
    if (module == nullptr) continue;
    if (const int code = module->add(plan, run); code != kDone) return code;
  }
  return kDone;
}

int add_hold(RunPlan& plan, core::Run& run) {
  if (const RunModule* const live = module_of(plan, "live"); live != nullptr) {
    if (const int code = live->add(plan, run); code != kDone) return code;
  } else {
    run.add(std::make_unique<core::Length>(plan.steps));
    if (plan.world->scenario().time_mode == core::TimeMode::Realtime) {
      plan.pacer.emplace(plan.clock, plan.world->ticks_per_second());
      run.add(pace_part(*plan.pacer));
    }
  }
  if (!plan.options.watch.watch) run.add(progress_part(plan.steps, plan.scenario->ticks_per_second));
  return kDone;
}

int add_named_parts(RunPlan& plan, core::Run& run) {
  core::Problems problems;
  core::add_named_parts(run, plan.loader.catalog(), problems);
  print_problems(problems);
  return core::has_errors(problems) ? kBadInput : kDone;
}

}  // namespace tandem::app
