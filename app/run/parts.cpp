#include "app/run/parts.hpp"

#include "app/process/progress.hpp"
#include "mixed_reality/time/pacer.hpp"

namespace tandem::app {
namespace {

/// Real time, where nobody else paces the run.
class Pace final : public core::RunPart {
 public:
  explicit Pace(RunPlan& plan) : plan_(plan), pacer_(plan.clock, plan.world->ticks_per_second()) {}
  std::string_view name() const override { return "real time"; }
  core::RunTurn turn() const override { return core::RunTurn::Pace; }
  bool before_tick(core::Run&) override {
    if (!begun_) pacer_.start();
    begun_ = true;
    return true;
  }
  bool after_tick(core::Run&) override {
    (void)pacer_.wait_for_next(*plan_.stop);
    return true;
  }
  hal::Status finish(core::Run&) override {
    plan_.result->figures.deadline_misses = pacer_.ledger().deadline_misses;
    return {};
  }

 private:
  RunPlan& plan_;
  mixed_reality::Pacer pacer_;
  bool begun_ = false;
};

/// How far a run is, on a terminal.
class TerminalProgress final : public core::RunPart {
 public:
  TerminalProgress(std::int64_t steps, std::int64_t ticks_per_second)
      : progress_(std::in_place, steps, ticks_per_second) {}
  std::string_view name() const override { return "progress"; }
  core::RunTurn turn() const override { return core::RunTurn::Tell; }
  bool after_tick(core::Run& run) override {
    progress_->step(run.world().tick());
    return true;
  }
  hal::Status close(core::Run&) override {
    progress_.reset();
    return {};
  }

 private:
  std::optional<Progress> progress_;
};

}  // namespace

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
    if (plan.world->scenario().time_mode == core::TimeMode::Realtime) run.add(std::make_unique<Pace>(plan));
  }
  if (!plan.options.watch.watch)
    run.add(std::make_unique<TerminalProgress>(plan.steps, plan.scenario->ticks_per_second));
  return kDone;
}

}  // namespace tandem::app
