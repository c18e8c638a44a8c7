#include "app/live/command_log.hpp"
#include "app/live/live_parts.hpp"
#include "core/live/live_run.hpp"
#include "core/live/repeat.hpp"

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
    plan_.live_failure = live_->failure();
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
  HoldReal(RunPlan& plan, std::unique_ptr<core::LiveRun> live) : plan_(plan), live_(std::move(live)) {}
  std::string_view name() const override { return "commands"; }
  core::RunTurn turn() const override { return core::RunTurn::Desk; }
  bool after_tick(core::Run&) override {
    (void)live_->after_step();
    return true;
  }
  hal::Status finish(core::Run&) override {
    plan_.live_failure = live_->failure();
    live_->close();
    return {};
  }

 private:
  RunPlan& plan_;
  std::unique_ptr<core::LiveRun> live_;
};

core::LiveOptions options_of(const RunPlan& plan) {
  const RunOptions& options = plan.options;
  RealRobots* const real = plan.real;
  core::LiveOptions live;
  live.ticks = plan.steps;
  live.paused = real != nullptr ? real->paused() : options.hold.paused;
  if (real != nullptr) {
    live.pause_real = [real](bool paused) {
      if (!paused) return real->go_on();
      real->pause();
      return hal::Status();
    };
  }
  live.speed = options.hold.speed;
  const bool to_follow = options.watch.watch && !plan.reading.says_pace() && !plan.replays();
  if (!live.speed && (plan.world->scenario().time_mode == core::TimeMode::Realtime || to_follow)) live.speed = 1.0;
  live.real_robots = real != nullptr;
  live.stay = options.hold.stay;
  live.can_go_back = options.hold.wanted || options.view.on;
  live.memory_bytes = options.hold.memory_MB * 1'000'000;
  if (plan.repeated != nullptr) live.repeat = plan.repeated->actions;
  live.log = plan.world_log;
  live.stop = plan.stop;
  return live;
}

}  // namespace

void hold(RunPlan& plan, core::Run& run) {
  auto live = std::make_unique<core::LiveRun>(*plan.world, options_of(plan));
  plan.live = live.get();
  live->on_event([&run](hal::Tick tick, const hal::Json& event) { run.tell(tick, event); });
  plan.commands = std::make_shared<CommandLog>([&log = plan.log](std::string_view text) { log.keep(text); }, *live);
  if (plan.real == nullptr) {
    run.add(std::make_unique<Hold>(plan, std::move(live)));
    return;
  }
  run.add(std::make_unique<core::Length>(plan.steps));
  run.add(std::make_unique<HoldReal>(plan, std::move(live)));
}

}  // namespace tandem::app
