#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "app/robots/lockstep_peers.hpp"
#include "app/robots/mixed_run.hpp"
#include "app/robots/motion_memory.hpp"
#include "app/robots/real_robots.hpp"
#include "app/run/parts.hpp"

namespace tandem::app {
namespace {

/// Real robots: paces the run, and stops them at its end.
class RealRobots final : public core::RunPart {
 public:
  RealRobots(RunPlan& plan, std::unique_ptr<mixed_reality::MixedSession> session)
      : plan_(plan), session_(std::move(session)) {}
  std::string_view name() const override { return "real robots"; }
  core::RunTurn turn() const override { return core::RunTurn::Pace; }

  hal::Status join(core::Run&) override { return session_->begin(); }
  bool before_tick(core::Run&) override { return session_->before_tick(*plan_.stop); }
  bool after_tick(core::Run& run) override {
    const core::World& world = run.world();
    const bool over = plan_.steps > 0 && world.tick() >= plan_.steps;
    session_->after_tick(over || world.state() != core::RunState::Running, *plan_.stop);
    return true;
  }
  hal::Status finish(core::Run&) override {
    plan_.look = {};
    session_->stop_robots();
    return {};
  }
  hal::Status close(core::Run&) override {
    plan_.guarded_to_the_end = plan_.guarded->guarded();
    session_->shut_down();
    plan_.log.end_robots();
    report_ = session_->report();
    plan_.result->real = &report_;
    plan_.result->figures.deadline_misses = report_.pace.deadline_misses;
    plan_.left = plan_.guarded->release_rested();
    return {};
  }

 private:
  RunPlan& plan_;
  std::unique_ptr<mixed_reality::MixedSession> session_;
  mixed_reality::MixedReport report_;
};

mixed_reality::MixedOptions options_of(RunPlan& plan) {
  mixed_reality::MixedOptions options;
  options.log = plan.log.robots();
  options.on_roll = [&log = plan.log, shown_s = 0.0](const mixed_reality::MixedSession& session) mutable {
    if (wall_seconds() - shown_s < 0.1) return;
    shown_s = wall_seconds();
    log.show_robots(session.roll_call());
  };
  options.hold = plan.options.hold.paused || plan.scenario->desk.hold;
  options.while_paused = [&plan] {
    if (plan.look) plan.look();
  };
  options.scheduling = [] { return std::make_unique<mixed_reality::SystemScheduling>(); };
  options.before_commands = [&plan] {
    plan.guarded->update();
    plan.hub_faults.apply(plan.clock.now_ns());
  };
  return options;
}

/// Links are opened by who claims the robots and knows of no failed motion of theirs.
hal::Status connect(RunPlan& plan, mixed_reality::MixedSession& session) {
  if (!plan.options.anyway) {
    if (const hal::Status moved = check_motions(plan.guarded->robots()); !moved.ok()) return moved;
  }
  if (const hal::Status claimed = plan.guarded->claim(); !claimed.ok()) return claimed;
  return session.connect(*plan.stop);
}

/// Peers of a run in lock-step.
class Lockstep final : public core::RunPart {
 public:
  Lockstep(RunPlan& plan, std::unique_ptr<mixed_reality::LockstepRun> peers) : plan_(plan), peers_(std::move(peers)) {}
  std::string_view name() const override { return "lock-step"; }
  core::RunTurn turn() const override { return core::RunTurn::Pace; }
  hal::Status close(core::Run& run) override {
    const bool finished = end_of(run, plan_.steps).finished();
    report_ = peers_->report();
    plan_.result->peers = &report_;
    peers_->finish(!finished, finished ? "the run is over" : "the run ended early");
    return {};
  }

 private:
  RunPlan& plan_;
  std::unique_ptr<mixed_reality::LockstepRun> peers_;
  mixed_reality::LockstepReport report_;
};

}  // namespace

int add_real_robots(RunPlan& plan, core::Run& run) {
  if (!has_real_robots(*plan.scenario)) return kDone;
  const mixed_reality::MixedOptions options = options_of(plan);
  if (options.hold && !plan.options.view.on && !plan.options.watch.watch && plan.scenario->desk.lcm.empty())
    return complain(kBadInput,
                    "nobody could start this run, which is to wait for that: add --view or --watch, or "
                    "<desk lcm=…> in the file");
  auto made = make_session(plan.loader.catalog(), plan.made, *plan.guarded, plan.clock, options);
  if (!made.ok()) return complain(kBadInput, made.error().message);
  auto session = std::move(made).value();
  const hal::Status connected = connect(plan, *session);
  const int code = connected.ok() ? kDone : complain(kFailedRunning, connected.error().message);
  if (code != kDone) return plan.stop->load() ? interrupted_code() : code;
  plan.mixed = session.get();
  run.add(std::make_unique<RealRobots>(plan, std::move(session)));
  return kDone;
}

int add_lockstep(RunPlan& plan, core::Run& run) {
  int code = kDone;
  auto peers = join_peers(*plan.world, plan.loader, *plan.stop, plan.world_log, code);
  if (code != kDone) return plan.stop->load() ? interrupted_code() : code;
  if (peers == nullptr) return kDone;
  plan.lockstep = peers.get();
  run.add(std::make_unique<Lockstep>(plan, std::move(peers)));
  return kDone;
}

}  // namespace tandem::app
