#include "app/process/signals.hpp"
#include "app/robots/mixed_run.hpp"
#include "app/run/parts.hpp"
#include "mixed_reality/time/pacer.hpp"

namespace tandem::app {
namespace {

/// People who pause a simulated run, go back in it, and end it.
class Hold final : public core::RunPart {
 public:
  Hold(RunPlan& plan, std::unique_ptr<core::LiveRun> live) : plan_(plan), live_(std::move(live)) {}
  std::string_view name() const override { return "hold"; }
  core::RunTurn turn() const override { return core::RunTurn::Hold; }

  bool before_tick(core::Run&) override {
    if (!begun_) live_->start();
    begun_ = true;
    return live_->before_step();
  }
  bool after_tick(core::Run&) override { return live_->after_step(); }
  hal::Status finish(core::Run&) override {
    plan_.result->figures.deadline_misses = live_->deadline_misses();
    live_->close();
    return {};
  }

 private:
  RunPlan& plan_;
  std::unique_ptr<core::LiveRun> live_;
  bool begun_ = false;
};

/// Commands to a run with real robots: nobody can go back in it. They are carried out after what is written of a tick,
/// within its time.
class HoldReal final : public core::RunPart {
 public:
  explicit HoldReal(std::unique_ptr<core::LiveRun> live) : live_(std::move(live)) {}
  std::string_view name() const override { return "commands"; }
  core::RunTurn turn() const override { return core::RunTurn::Desk; }
  bool after_tick(core::Run&) override {
    (void)live_->after_step();
    return true;
  }
  hal::Status finish(core::Run&) override {
    live_->close();
    return {};
  }

 private:
  std::unique_ptr<core::LiveRun> live_;
};

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

core::LiveOptions options_of(const RunPlan& plan) {
  const RunOptions& options = plan.options;
  mixed_reality::MixedSession* const mixed = plan.mixed;
  core::LiveOptions live;
  live.ticks = plan.steps;
  live.paused = mixed != nullptr ? mixed->paused() : options.hold.paused;
  if (mixed != nullptr) {
    live.pause_real = [mixed](bool paused) {
      if (!paused) return mixed->go_on();
      mixed->pause();
      return hal::Status();
    };
  }
  live.speed = options.hold.speed;
  if (!live.speed && plan.world->scenario().time_mode == core::TimeMode::Realtime) live.speed = 1.0;
  live.real_robots = mixed != nullptr;
  live.stay = options.hold.stay;
  live.can_go_back = (options.hold.wanted || options.view.on) && plan.lockstep == nullptr;  // peers cannot be put back
  live.memory_bytes = options.hold.memory_MB * 1'000'000;
  live.repeat = plan.repeated.actions;
  live.log = plan.world_log;
  live.stop = plan.stop;
  return live;
}

}  // namespace

int add_hold(RunPlan& plan, core::Run& run) {
  const RunOptions& options = plan.options;
  const bool held = options.hold.wanted || options.view.on || options.watch.watch || !options.repeat.empty();
  if (!held && plan.mixed == nullptr) {
    run.add(std::make_unique<core::Length>(plan.steps));
    if (plan.world->scenario().time_mode == core::TimeMode::Realtime) run.add(std::make_unique<Pace>(plan));
    return kDone;
  }
  auto live = std::make_unique<core::LiveRun>(*plan.world, options_of(plan));
  plan.live = live.get();
  live->on_event([&run](hal::Tick tick, const hal::Json& event) { run.tell(tick, event); });
  plan.commands.emplace([&log = plan.log](std::string_view text) { log.keep(text); }, *live);
  if (plan.mixed == nullptr) {
    run.add(std::make_unique<Hold>(plan, std::move(live)));
    return kDone;
  }
  run.add(std::make_unique<core::Length>(plan.steps));
  run.add(std::make_unique<HoldReal>(std::move(live)));
  return kDone;
}

}  // namespace tandem::app
