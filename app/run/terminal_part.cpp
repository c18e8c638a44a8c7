#include "app/process/progress.hpp"
#include "app/process/signals.hpp"
#include "app/run/parts.hpp"
#include "app/view/watch.hpp"

namespace tandem::app {
namespace {

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

/// A table of a run and its robots, on a terminal.
class TerminalWatch final : public core::RunPart {
 public:
  TerminalWatch(const WatchRequest& request, const Watch::Run& run) : watch_(std::in_place, request, run) {}
  std::string_view name() const override { return "watch"; }
  core::RunTurn turn() const override { return core::RunTurn::Tell; }
  hal::Status close(core::Run&) override {
    watch_.reset();
    return {};
  }

 private:
  std::optional<Watch> watch_;
};

}  // namespace

int add_terminal(RunPlan& plan, core::Run& run) {
  if (!plan.options.watch.watch) {
    run.add(std::make_unique<TerminalProgress>(plan.steps, plan.scenario->ticks_per_second));
    return kDone;
  }
  Watch::Run watched{*plan.live, *plan.world, plan.steps, {}, &request_stop};
  if (plan.mixed != nullptr) {
    watched.real = [&mixed = *plan.mixed] { return mixed.status(); };
    watched.roll = [&mixed = *plan.mixed] { return mixed.roll_call(); };
  }
  run.add(std::make_unique<TerminalWatch>(plan.options.watch, watched));
  return kDone;
}

}  // namespace tandem::app
